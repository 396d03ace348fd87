"""Key poses on beats, the music around and between them, and training batches for both stages of DanceFormer.

Songs are heard through what `npx tsx export/features.ts --danceformer` wrote (53 numbers a frame); AIST++ has stored MFCC and chroma, put
through the same steps here. It stores no energy: the first MFCC, the mean of the logarithmic mel bands, stands for it.
Clips without music give key poses on made-up grids, with the music missing.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from curves import align_signs
from data import CHROMA, Clip
from dance_metrics import pose_vectors
from metrics import matrices_of
from rotation import matrix_to_quaternion
from skeleton import mirror_motion
from spec import FPS, MOTION_SIZE, ONSET, ROTATION_SIZE, SPEC
from suggest import BEAT_SIZE, FARTHEST, STYLES

PART = SPEC["danceformer"]
FEATURES = len(PART["featureNames"])
MFCC = 13
DELTA_REACH = 4
SILENT_BELOW = 60.0
CLIP = 4.0
# Genres of the data that go by the name of another style, for want of clips.
STYLE_OF = {"LA hip-hop": "hip-hop", "middle hip-hop": "hip-hop", "ballet jazz": "street jazz"}


@dataclass
class Dance:
    """A clip as DanceFormer sees it. N frames, U beats of its song."""

    clip: Clip
    motion: tuple[Tensor, Tensor]  # [N, 147] as recorded and mirrored
    valid: Tensor  # [N] bool: every joint and the root are real
    style: Tensor  # [11] one-hot or zero
    beats: Tensor  # [U] frames of the clip, fractional; may lie outside it
    music: Tensor  # [U, 57] of the beats; empty without music
    frames: Tensor  # [F, 53] features of the song; empty without music
    start: float  # frame of the song at which the clip begins
    channels: tuple[Tensor, Tensor] = field(default_factory=tuple)  # [N, 99] of both motions, quaternion signs continuous
    vectors: tuple[Tensor, Tensor] = field(default_factory=tuple)  # [N, 69] joints as the body sees them

    @property
    def has_music(self) -> bool:
        return len(self.frames) > 0


def deltas(values: np.ndarray) -> np.ndarray:
    """Least-squares slope over nine frames; rows past the ends repeat the first and last (web/core/mfcc.ts)."""
    count = len(values)
    at = np.arange(count)
    out = np.zeros_like(values)
    for n in range(1, DELTA_REACH + 1):
        out += n * (values[np.minimum(at + n, count - 1)] - values[np.maximum(at - n, 0)])
    return out / (2 * sum(n * n for n in range(1, DELTA_REACH + 1)))


def frame_features(mfcc: np.ndarray, energy: np.ndarray, chroma: np.ndarray, onset: np.ndarray) -> np.ndarray:
    """[F, 13], [F] decibels, [F, 12], [F] -> [F, 53], as web/core/beat-features.ts `frameFeatures` makes them."""
    slope = deltas(mfcc)
    columns = np.concatenate([mfcc, slope, deltas(slope), energy[:, None]], 1)
    sounding = energy > energy.max() - SILENT_BELOW
    mean, spread = columns[sounding].mean(0), np.maximum(columns[sounding].std(0), 1e-6)
    evened = np.clip((columns - mean) / spread, -CLIP, CLIP) * sounding[:, None]
    return np.concatenate([evened, chroma, onset[:, None]], 1).astype(np.float32)


def beat_music(frames: np.ndarray, times: np.ndarray, bar: np.ndarray) -> np.ndarray:
    """Music of beats [U, 57]: features [F, 53], beat times in seconds [U], place in the bar as a share of it [U] (NaN: unknown)."""
    out = np.zeros((len(times), BEAT_SIZE), np.float32)
    count, reach = len(frames), PART["beatWindowSeconds"] / 2
    for number, time in enumerate(times):
        first, last = max(0, int(np.ceil((time - reach) * FPS))), min(count - 1, int(np.floor((time + reach) * FPS)))
        if last >= first:
            at = np.arange(first, last + 1)
            weight = 0.54 + 0.46 * np.cos(np.pi * (at / FPS - time) / reach)
            out[number, :FEATURES] = (weight[:, None] * frames[at]).sum(0) / weight.sum()
        middle, near = int(np.floor(time * FPS + 0.5)), PART["onsetPeakFrames"]
        low, high = max(0, middle - near), min(count - 1, middle + near)
        if high >= low:
            out[number, FEATURES] = frames[low : high + 1, -1].max()
    known = ~np.isnan(bar)
    out[known, FEATURES + 1] = np.sin(2 * np.pi * bar[known])
    out[known, FEATURES + 2] = np.cos(2 * np.pi * bar[known])
    if len(times) > 1:
        period = np.append(np.diff(times), times[-1] - times[-2])
        out[:, FEATURES + 3] = np.log2(period / 0.5)
    return out


def bar_places(beats: np.ndarray, downbeats: np.ndarray, per_bar: int) -> np.ndarray:
    """Place of each beat in its bar, 0 to 1; counted back before the first downbeat; NaN without any."""
    if len(downbeats) == 0 or len(beats) == 0:
        return np.full(len(beats), np.nan)
    marked = np.unique([int(np.abs(beats - time).argmin()) for time in downbeats])
    index = np.arange(len(beats))
    last = marked[np.maximum(np.searchsorted(marked, index, side="right") - 1, 0)]
    return ((index - last) % per_bar) / per_bar


def interval_music(frames: Tensor, start: Tensor, end: Tensor, steps: int) -> Tensor:
    """Features [F, 53] at `steps` moments of intervals from `start` to `end` [n] (frames of the song) -> [n, steps, 53]."""
    share = (torch.arange(steps) + 0.5) / steps
    at = (start[:, None] + (end - start)[:, None] * share).clamp(0, len(frames) - 1)
    low = at.floor().long()
    high = (low + 1).clamp(max=len(frames) - 1)
    part = (at - low)[..., None].to(frames)
    return frames[low] * (1 - part) + frames[high] * part


def _song(folder: Path, name: str) -> tuple[np.ndarray, dict] | None:
    header = folder / f"{name}.json"
    if not header.exists():
        return None
    info = json.loads(header.read_text(encoding="utf-8"))
    if info["names"] != PART["featureNames"]:
        raise ValueError(f"{header}: made without --danceformer, or for another spec.json")
    return np.fromfile(folder / f"{name}.f32", dtype="<f4").reshape(-1, FEATURES), info


def make_dance(clip: Clip, entry: dict, path: Path, features: Path) -> Dance:
    """Adds to a clip what DanceFormer needs. `path` is its npz, `features` what features.ts --danceformer wrote."""
    z = np.load(path, allow_pickle=False)
    frames, start, beats, music = np.zeros((0, FEATURES), np.float32), 0.0, clip.beats.numpy().astype(np.float64), None
    if "mfcc" in z.files:
        mfcc = np.asarray(z["mfcc"], np.float64)[:, :MFCC]
        table = clip.music.numpy()
        frames = frame_features(mfcc, mfcc[:, 0], table[:, :CHROMA], table[:, ONSET])
        bar = bar_places(beats, clip.downbeats.numpy(), 4)
        music = beat_music(frames, beats / FPS, bar)
    elif "audio_start_s" in z.files and (found := _song(features, path.stem)):
        frames, info = found
        times = np.asarray(info["beats"], np.float64)
        start = float(z["audio_start_s"]) * FPS
        bar = bar_places(times, np.asarray(info["downbeats"]), int(info["beatsPerBar"]))
        music, beats = beat_music(frames, times, bar), times * FPS - start
    else:
        beats = np.zeros(0)
    style = torch.zeros(len(STYLES))
    genre = STYLE_OF.get(entry.get("genre") or "", entry.get("genre"))
    if genre in STYLES:
        style[STYLES.index(genre)] = 1
    motions = (clip.motion, mirror_motion(clip.motion))
    return Dance(
        clip=clip,
        motion=motions,
        valid=clip.valid.all(-1) & clip.root_valid,
        style=style,
        beats=torch.from_numpy(beats).float(),
        music=torch.zeros(0, BEAT_SIZE) if music is None else torch.from_numpy(music),
        frames=torch.from_numpy(np.ascontiguousarray(frames)),
        start=start,
        channels=tuple(motion_to_channels(motion) for motion in motions),
        vectors=tuple(pose_vectors(motion) for motion in motions),
    )


def motion_to_channels(motion: Tensor) -> Tensor:
    """[N, 147] -> [N, 99]: root, quaternions with continuous signs."""
    return torch.cat([motion[:, ROTATION_SIZE:], align_signs(matrix_to_quaternion(matrices_of(motion))).flatten(1)], 1)


def load_dances(data: Path, features: Path, clips: list[Clip]) -> list[Dance]:
    """All clips (of the prepared folder) as dances, in the order of the manifest."""
    manifest = json.loads((data / "manifest.json").read_text(encoding="utf-8"))
    return [make_dance(clip, entry, data / entry["file"], features) for clip, entry in zip(clips, manifest, strict=True)]


def song_of(dance: Dance) -> str:
    """What dances must share to be held out together: the AIST++ track, else the clip itself."""
    parts = dance.clip.name.split("_")
    return parts[4] if dance.clip.source == "aist" and len(parts) > 4 else dance.clip.name


def split_dances(dances: list[Dance]) -> tuple[list[Dance], list[Dance], list[Dance]]:
    """(training, development, validation). Development takes every ninth training song that has music: choices are made on it, so that
    the validation tracks stay unseen until the end."""
    training = [dance for dance in dances if dance.clip.split == "train"]
    songs = sorted({song_of(dance) for dance in training if dance.has_music})
    held = set(songs[4::9])
    return (
        [dance for dance in training if song_of(dance) not in held],
        [dance for dance in training if song_of(dance) in held and dance.has_music],
        [dance for dance in dances if dance.clip.split == "val"],
    )


def grid(dance: Dance, rng: torch.Generator, spacing: tuple[float, float] = (0.4, 0.8)) -> Tensor:
    """A made-up beat grid over a clip, frames: one spacing (seconds, uniform) and phase."""
    uniform = float(torch.rand((), generator=rng))
    period = (spacing[0] + (spacing[1] - spacing[0]) * uniform) * FPS
    phase = float(torch.rand((), generator=rng)) * period
    return torch.arange(phase, dance.clip.frames - 1, period)


@dataclass
class KeyRows:
    """Rows of beats for stage 1. B rows, N beats."""

    poses: Tensor  # [B, N, 147]
    valid: Tensor  # [B, N] 1 where the pose is there and real
    vectors: Tensor  # [B, N, 69]
    music: Tensor  # [B, N + 12, 57]: from 6 beats before the first to 6 after the last
    music_mask: Tensor  # [B, N + 12]
    style: Tensor  # [B, 11]
    next_index: Tensor  # [B, N] the beat of the row that is fixed ahead, or -1


class KeySampler:
    """Endless random rows of beats; everything random comes from one generator."""

    margin = 6

    def __init__(
        self, dances: list[Dance], rows: int, beats: int, seed: int, style_dropout: float = 0.4, music_dropout: float = 0.15, aist: float = 2.0
    ) -> None:
        """`aist`: how much oftener AIST++ is taken than its length says, beside other dances with music (1) and those without (0.5)."""
        self.rows, self.beats = rows, beats
        self.style_dropout, self.music_dropout = style_dropout, music_dropout
        self.dances = [dance for dance in dances if dance.clip.frames > 60]
        weight = [dance.clip.frames * (aist if dance.clip.source == "aist" else 1.0 if dance.has_music else 0.5) for dance in self.dances]
        self.weights = torch.tensor(weight)
        self.rng = torch.Generator().manual_seed(seed)

    def batch(self) -> KeyRows:
        chosen = torch.multinomial(self.weights, self.rows, replacement=True, generator=self.rng)
        rows = [self.row(self.dances[int(number)]) for number in chosen]
        return KeyRows(*(torch.stack(parts) for parts in zip(*rows)))

    def row(self, dance: Dance, augment: bool = True, start: int | None = None) -> tuple[Tensor, ...]:
        """One row of a dance, from a random beat (or beat `start` of those inside it)."""
        uniform = lambda: float(torch.rand((), generator=self.rng))  # noqa: E731
        count, margin = self.beats, self.margin
        times = dance.beats if dance.has_music else grid(dance, self.rng)
        music = dance.music
        if augment and dance.has_music and uniform() < 0.12:  # a beat tracker may take every second beat
            offset = int(uniform() * 2)
            times, music = times[offset::2], music[offset::2].clone()
            music[:, FEATURES + 3] += 1
        inside = torch.nonzero((times >= 0) & (times <= dance.clip.frames - 1))[:, 0]
        if len(inside) == 0:
            inside = torch.zeros(1, dtype=torch.long)
        if start is None:
            start = int(uniform() * max(1, len(inside) - count // 2))
        index = int(inside[start]) + torch.arange(count)
        jitter = float(torch.randn((), generator=self.rng)) * 0.7 if augment else 0.0
        at = times[index.clamp(max=len(times) - 1)] + jitter
        frame = at.round().long()
        there = (index < len(times)) & (frame >= 0) & (frame < dance.clip.frames)
        frame = frame.clamp(0, dance.clip.frames - 1)
        mirrored = int(augment and uniform() < 0.5)
        around = int(inside[start]) + torch.arange(-margin, count + margin)
        heard = (around >= 0) & (around < len(music))
        if augment and uniform() < self.music_dropout:
            heard = torch.zeros_like(heard)
        sounds = torch.zeros(len(around), BEAT_SIZE)
        if heard.any():
            sounds[heard] = music[around[heard]]
        style = dance.style * (0.0 if augment and uniform() < self.style_dropout else 1.0)
        valid = there & dance.valid[frame]
        return (
            dance.motion[mirrored][frame],
            valid.float(),
            dance.vectors[mirrored][frame],
            sounds,
            heard.float(),
            style,
            self.fixed_ahead(valid) if augment else torch.full((count,), -1),
        )

    def fixed_ahead(self, valid: Tensor) -> Tensor:
        """For each beat the next one (after it) that is fixed, -1 for none: in a third of the rows none, else of random density."""
        count = len(valid)
        share = (0.0, 0.5, 0.25, 0.12, 0.06, 0.0)[int(torch.randint(0, 6, (), generator=self.rng))]
        fixed = (torch.rand(count, generator=self.rng) < share) & (valid > 0)
        result, ahead = torch.full((count,), -1), -1
        for beat in range(count - 1, -1, -1):
            result[beat] = ahead if ahead - beat <= FARTHEST else -1
            if fixed[beat]:
                ahead = beat
        return result


@dataclass
class Intervals:
    """Rows of N = 4 intervals in a row with the keys around them, for stage 2. S = 9 moments an interval."""

    keys: Tensor  # [B, N + 3, 99] key poses: one before, the N + 1 of the row, one after
    outer: Tensor  # [B, 2] 1 where the one before and the one after are there
    seconds: Tensor  # [B, N + 2]: lengths between those keys
    music: Tensor  # [B, N, 8, 53]
    target: Tensor  # [B, N, S, 99]
    valid: Tensor  # [B, N] 1 where every frame of the interval is real


class IntervalSampler:
    """Endless random rows of intervals: between beats, every second beat, or on grids of any spacing."""

    def __init__(self, dances: list[Dance], rows: int, seed: int, intervals: int = 4, moments: int = 9, beats_share: float = 0.65) -> None:
        self.rows, self.intervals, self.moments, self.beats_share = rows, intervals, moments, beats_share
        self.dances = [dance for dance in dances if dance.clip.frames > 90]
        weight = [dance.clip.frames * (3.0 if dance.clip.source == "aist" else 1.0) for dance in self.dances]
        self.weights = torch.tensor(weight)
        self.rng = torch.Generator().manual_seed(seed)
        self.bad = {id(dance): torch.cat([torch.zeros(1), (~dance.valid).float().cumsum(0)]) for dance in self.dances}

    def batch(self) -> Intervals:
        chosen = torch.multinomial(self.weights, self.rows, replacement=True, generator=self.rng)
        rows = [self.row(self.dances[int(number)]) for number in chosen]
        return Intervals(*(torch.stack(parts) for parts in zip(*rows)))

    def times(self, dance: Dance) -> Tensor:
        """A list of key times inside the dance, frames."""
        draw = float(torch.rand((), generator=self.rng))
        last = dance.clip.frames - 1
        if dance.has_music and draw < self.beats_share:
            times = dance.beats + float(torch.randn((), generator=self.rng)) * 0.5
            times = times[(times >= 0) & (times <= last)]
            if draw > 0.8 * self.beats_share:
                times = times[int(torch.randint(0, 2, (), generator=self.rng)) :: 2]
            if len(times) >= self.intervals + 1:
                return times
        longest = min(1.6, last / FPS / (self.intervals + 1.5))
        return grid(dance, self.rng, (0.25, longest))

    def row(self, dance: Dance, mirrored: int | None = None) -> tuple[Tensor, ...]:
        """A random row of a dance."""
        count = self.intervals
        times = self.times(dance)
        first = int(torch.randint(0, len(times) - count, (), generator=self.rng))
        if mirrored is None:
            mirrored = int(torch.randint(0, 2, (), generator=self.rng))
        outer = (torch.rand(2, generator=self.rng) > 0.06).tolist()
        return self.cut(dance, times, first, bool(mirrored), outer, float(torch.rand((), generator=self.rng)) < 0.15)

    def cut(self, dance: Dance, times: Tensor, first: int, mirrored: bool, outer: list[bool], silent: bool) -> tuple[Tensor, ...]:
        """The row whose first key is `times[first]`."""
        count = self.intervals
        index = torch.arange(first - 1, first + count + 2)
        present = [bool(index[0] >= 0) and outer[0], bool(index[-1] < len(times)) and outer[1]]
        at = times[index.clamp(0, len(times) - 1)]
        if not present[0]:
            at[0] = at[1]
        if not present[1]:
            at[-1] = at[-2]
        channels = dance.channels[mirrored]
        seconds = (at[1:] - at[:-1]) / FPS
        start, end = at[1:-2], at[2:-1]
        share = (torch.arange(self.moments) + 0.5) / self.moments
        moments = start[:, None] + (end - start)[:, None] * share
        if dance.has_music and not silent:
            music = interval_music(dance.frames, start + dance.start, end + dance.start, PART["curve"]["intervalSteps"])
        else:
            music = torch.zeros(count, PART["curve"]["intervalSteps"], FEATURES)
        bad = self.bad[id(dance)]
        valid = bad[(end.ceil().long() + 1).clamp(max=len(bad) - 1)] == bad[start.floor().long()]
        return (
            at_times(channels, at),
            torch.tensor(present, dtype=torch.float32),
            seconds,
            music,
            at_times(channels, moments),
            valid.float(),
        )


def at_times(channels: Tensor, at: Tensor) -> Tensor:
    """Channels [N, 99] at fractional frames [...] -> [..., 99], quaternions of length 1."""
    at = at.clamp(0, len(channels) - 1)
    low = at.floor().long()
    high = (low + 1).clamp(max=len(channels) - 1)
    part = (at - low)[..., None]
    mixed = channels[low] * (1 - part) + channels[high] * part
    quaternions = mixed[..., 3:].unflatten(-1, (-1, 4))
    return torch.cat([mixed[..., :3], (quaternions / quaternions.norm(dim=-1, keepdim=True)).flatten(-2)], -1)


def absent_poses(batch: int, count: int) -> Tensor:
    """[B, count, 147] that stand for no pose: identity rotations at the origin."""
    stand = torch.zeros(MOTION_SIZE)
    stand[0:ROTATION_SIZE:6] = 1
    stand[4:ROTATION_SIZE:6] = 1
    return stand.expand(batch, count, MOTION_SIZE)
