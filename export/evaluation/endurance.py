"""Three minutes of windows chained without key poses: does the dance drift away from what people do, does it freeze?

Validation songs are shorter than that, so a song is played again and again from its first downbeat to its last.
"""

from __future__ import annotations

import torch
from torch import Tensor

import metrics
from dance_metrics import PoseDistribution
from data import Clip, beat_columns
from evaluation.dances import free_rollout
from evaluation.runners import Run
from evaluation.shipped import Order, Song, make_dances
from spec import BEAT, DOWNBEAT, FPS, SEED_FRAMES, SPEC

MINUTE = 60 * FPS
OVERLAP = SPEC["model"]["overlapFrames"]


def looped_song(clip: Clip, frames: int) -> Song | None:
    """The clip's music [frames, 15] from its first downbeat to its last, over and over; None where that is less than 8 s of music."""
    bars = clip.downbeats if len(clip.downbeats) > 2 else clip.beats
    bars = bars[(bars >= 0) & (bars < clip.frames - 1)]
    if len(bars) < 2 or float(bars[-1] - bars[0]) < 8 * FPS or not clip.music.any():
        return None
    first, length = float(bars[0]), float(bars[-1] - bars[0])
    # Each frame sounds like the frame of the recording that it stands for; beats keep their exact places.
    source = (first + torch.arange(frames, dtype=torch.float64) % length).round().long().clamp(max=clip.frames - 1)
    music = clip.music[source].clone()

    def repeated(times: Tensor) -> Tensor:
        once = times[(times >= first - 1e-3) & (times < first + length - 1e-3)] - first
        rounds = torch.arange(int(frames / length) + 1) * length
        every = (rounds[:, None] + once[None, :]).flatten()
        return every[every < frames].float()

    beats, downbeats = repeated(clip.beats), repeated(clip.downbeats)
    music[:, [BEAT, DOWNBEAT]] = beat_columns(frames, beats, downbeats)
    return Song(music, beats, downbeats)


def judge(dance: Tensor, poses: PoseDistribution) -> dict:
    """Figures of a long dance [N, 147]."""
    distance = poses.distance(dance)
    speed = metrics.mean_joint_speed(metrics.joints(dance))
    first, last = distance[:MINUTE].mean(), distance[-MINUTE:].mean()
    return {
        "distance_first_minute": round(float(first), 3),
        "distance_last_minute": round(float(last), 3),
        "distance_ratio": round(float(last / first), 3),
        "distance_largest": round(float(distance.max()), 3),
        "freeze_s": round(metrics.longest_freeze(speed), 3),
        "speed_first_minute": round(float(speed[:MINUTE].mean()), 4),
        "speed_last_minute": round(float(speed[-MINUTE:].mean()), 4),
    }


def endurance(clips: list[Clip], training: list[Clip], run: Run, model: object | None, minutes: float = 3, most: int = 2) -> dict:
    """{dance: {song: figures}}, and what real training frames have. `model` (a path) adds the page's dance to the first song."""
    frames = round(minutes * MINUTE)
    poses = PoseDistribution([clip.motion[clip.valid.all(-1) & clip.root_valid] for clip in training])
    songs = {clip.name: (clip, looped_song(clip, frames)) for clip in sorted(clips, key=lambda clip: -clip.frames)}
    songs = dict([(name, found) for name, found in songs.items() if found[1]][:most])
    result: dict = {
        "minutes": minutes,
        "real_mean": round(float(poses.usual.mean()), 3),
        "real_95": round(poses.quantile(0.95), 3),
        "network, no fillers": {
            name: judge(free_rollout(song.music, clip.motion[:SEED_FRAMES], run, OVERLAP), poses)
            for name, (clip, song) in songs.items()
        },
    }
    if model and songs:
        name, (_, song) = next(iter(songs.items()))
        made = make_dances(model, [Order(song, {"page": {"fillers": True}})])[0]["page"]
        result["shipped, fillers on"] = {name: judge(made, poses)}
    return result
