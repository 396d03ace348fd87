"""Training windows: a stretch of a clip in its local frame, with random key poses and augmentation."""

from __future__ import annotations

from dataclasses import dataclass, field

import torch
from torch import Tensor

from data import CHROMA, Clip, beat_columns
from rotation import heading, matrix_to_six_d, six_d_to_matrix, yaw_matrix
from skeleton import MIRRORED_JOINTS, mirror_motion
from spec import BEAT, DOWNBEAT, FPS, JOINT_COUNT, ROTATION_SIZE, SEED_FRAMES


@dataclass
class Augmentation:
    """How far a training window may stray from the recording. Probabilities are per window."""

    mirror: float = 0.5
    tempo: tuple[float, float] = (0.85, 1.2)
    music_dropout: float = 0.15
    seed_noise: float = 0.5  # probability of a disturbed seed, as the model's own output is at generation
    seed_noise_size: float = 0.03  # standard deviation of the 6D numbers
    no_keys: float = 0.04
    few_keys: float = 0.06  # one or two keys in the whole window
    random_keys: float = 0.16  # uniformly scattered
    beat_keys: float = 0.35  # on every, every second or every fourth beat
    key_spacing: tuple[float, float] = (0.4, 2.2)  # seconds, log-uniform, for evenly spaced keys
    key_drop: float = 0.1  # of the keys of a regular pattern


NO_AUGMENTATION = Augmentation(0, (1, 1), 0, 0)


@dataclass
class Window:
    """One sample; T = music frames, S = seed frames. Collated along a new first axis."""

    music: Tensor  # [T, 15]
    seed: Tensor  # [S, 147]
    key_poses: Tensor  # [T, 144]
    key_mask: Tensor  # [T]
    to_previous: Tensor  # [T]
    to_next: Tensor  # [T]
    target: Tensor  # [T, 147]
    valid: Tensor  # [T, 24] float: which joints count in the loss
    root_valid: Tensor  # [T] float
    beats: Tensor = field(default_factory=lambda: torch.zeros(0))


def to_local_frame(motion: Tensor, seed_frames: int) -> Tensor:
    """Motion [N, 147] with root x, z at the origin and heading +Z at the last seed frame; root y is kept."""
    rotations = six_d_to_matrix(motion[:, :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6)))
    anchor = seed_frames - 1
    turn = yaw_matrix(-heading(rotations[anchor, 0]))
    pelvis = matrix_to_six_d(turn @ rotations[:, 0])
    root = motion[:, ROTATION_SIZE:].clone()
    root[:, [0, 2]] -= root[anchor, [0, 2]].clone()
    root = root @ turn.T
    return torch.cat([pelvis, motion[:, 6:ROTATION_SIZE], root], -1)


def key_distances(key_mask: Tensor) -> tuple[Tensor, Tensor]:
    """[T] mask -> frames back to the nearest key at or before t and on to the nearest at or after t; -1 where there is none."""
    frames = key_mask.shape[0]
    t = torch.arange(frames)
    held = torch.where(key_mask > 0, t, torch.full_like(t, -1))
    previous = torch.cummax(held, 0).values
    ahead = torch.where(key_mask > 0, t, torch.full_like(t, frames))
    following = torch.cummin(ahead.flip(0), 0).values.flip(0)
    to_previous = torch.where(previous < 0, torch.full_like(t, -1), t - previous)
    to_next = torch.where(following >= frames, torch.full_like(t, -1), following - t)
    return to_previous.float(), to_next.float()


def choose_keys(frames: int, beats: Tensor, augmentation: Augmentation, rng: torch.Generator) -> Tensor:
    """Random key frames (int64, ascending) in [0, frames) in the patterns that users and the engine make."""
    draw = float(torch.rand((), generator=rng))
    keep = lambda count, drop: torch.rand(count, generator=rng) >= drop  # noqa: E731
    a = augmentation
    if draw < a.no_keys:
        return torch.zeros(0, dtype=torch.long)
    draw -= a.no_keys
    if draw < a.few_keys:
        count = int(torch.randint(1, 3, (), generator=rng))
        return torch.randint(0, frames, (count,), generator=rng).unique()
    draw -= a.few_keys
    if draw < a.random_keys:
        seconds = frames / FPS
        count = max(1, round(seconds * (0.3 + 1.5 * float(torch.rand((), generator=rng)))))
        return torch.randint(0, frames, (count,), generator=rng).unique()
    draw -= a.random_keys
    inside = beats[(beats > -0.5) & (beats < frames - 0.5)].round().long()
    if draw < a.beat_keys and len(inside) > 1:
        step = (1, 2, 2, 4)[int(torch.randint(0, 4, (), generator=rng))]
        chosen = inside[int(torch.randint(0, step, (), generator=rng)) :: step]
    else:
        low, high = (torch.tensor(s * FPS).log() for s in a.key_spacing)
        spacing = float((low + (high - low) * torch.rand((), generator=rng)).exp())
        start = float(torch.rand((), generator=rng)) * spacing
        chosen = torch.arange(start, frames, spacing).floor().long().clamp(max=frames - 1)
    return chosen[keep(len(chosen), a.key_drop)].unique()


def _resample(values: Tensor, positions: Tensor) -> Tensor:
    """Rows of `values` [N, d] at fractional `positions`, linearly; past the ends the last row holds."""
    positions = positions.clamp(0, values.shape[0] - 1)
    low = positions.floor().long()
    high = (low + 1).clamp(max=values.shape[0] - 1)
    fraction = (positions - low)[:, None].to(values.dtype)
    return values[low] * (1 - fraction) + values[high] * fraction


def cut_window(
    clip: Clip,
    start: int,
    music_frames: int,
    rng: torch.Generator,
    augmentation: Augmentation = NO_AUGMENTATION,
    keys: Tensor | None = None,
    seed_frames: int = SEED_FRAMES,
) -> Window:
    """Cuts seed + music frames of `clip` from `start` on. Frames past the clip's end are held and do not count in the loss."""
    uniform = lambda: float(torch.rand((), generator=rng))  # noqa: E731
    a, total = augmentation, seed_frames + music_frames
    speed = a.tempo[0] + (a.tempo[1] - a.tempo[0]) * uniform()
    positions = start + torch.arange(total) * speed
    motion = _resample(clip.motion, positions)
    if speed != 1:
        rotations = six_d_to_matrix(motion[:, :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6)))
        motion = torch.cat([matrix_to_six_d(rotations).flatten(-2), motion[:, ROTATION_SIZE:]], -1)
    inside = positions <= clip.frames - 1
    # A resampled frame is real only if both frames it lies between are.
    valid = (_resample(clip.valid.float(), positions) > 0.999) & inside[:, None]
    root_valid = (_resample(clip.root_valid.float()[:, None], positions)[:, 0] > 0.999) & inside
    beats, downbeats = ((b - start) / speed - seed_frames for b in (clip.beats, clip.downbeats))
    music = _resample(clip.music, positions[seed_frames:]) * inside[seed_frames:, None]
    music[:, [BEAT, DOWNBEAT]] = beat_columns(music_frames, beats, downbeats)
    if uniform() < a.music_dropout:
        music = torch.zeros_like(music)
    chroma = music[:, :CHROMA]
    music[:, :CHROMA] = chroma / chroma.norm(dim=-1, keepdim=True).clamp_min(1e-6)
    if uniform() < a.mirror:
        motion, valid = mirror_motion(motion), valid[:, MIRRORED_JOINTS]
    motion = to_local_frame(motion, seed_frames)
    seed, target = motion[:seed_frames], motion[seed_frames:]
    target_valid, target_root = valid[seed_frames:], root_valid[seed_frames:]

    if keys is None:
        keys = choose_keys(music_frames, beats, a, rng)
    key_mask = torch.zeros(music_frames)
    key_mask[keys] = 1
    key_mask *= target_valid.all(-1)
    to_previous, to_next = key_distances(key_mask)
    key_poses = target[:, :ROTATION_SIZE] * key_mask[:, None]
    if uniform() < a.seed_noise:
        seed = _disturb(seed, a.seed_noise_size, rng)
    return Window(
        music, seed, key_poses, key_mask, to_previous, to_next, target, target_valid.float(), target_root.float(), beats
    )


def _disturb(seed: Tensor, size: float, rng: torch.Generator) -> Tensor:
    """Seed with slow random drift and a smoothed course: what the end of a generated window looks like."""
    frames = seed.shape[0]
    knots = torch.randn(1, seed.shape[1], 5, generator=rng) * size * torch.rand((), generator=rng)
    drift = torch.nn.functional.interpolate(knots, size=frames, mode="linear", align_corners=True)[0].T
    drift[:, ROTATION_SIZE:] *= 0.5
    noisy = seed + drift
    if float(torch.rand((), generator=rng)) < 0.5:
        padded = torch.cat([noisy[:1].expand(2, -1), noisy, noisy[-1:].expand(2, -1)])
        noisy = padded.unfold(0, 5, 1).mean(-1)
    rotations = six_d_to_matrix(noisy[:, :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6)))
    # The local frame has its origin at the last seed frame, disturbed or not.
    root = noisy[:, ROTATION_SIZE:].clone()
    root[:, [0, 2]] -= root[-1, [0, 2]].clone()
    return torch.cat([matrix_to_six_d(rotations).flatten(-2), root], -1)


def collate(windows: list[Window]) -> dict[str, Tensor]:
    """Windows of one length -> a batch of stacked tensors (beats stay out: their number differs)."""
    names = [name for name in vars(windows[0]) if name != "beats"]
    return {name: torch.stack([getattr(window, name) for window in windows]) for name in names}


class WindowSampler:
    """Endless random batches. A batch has one length, drawn from `lengths`, and about `tokens` frames.

    Its whole state is the generator, so a resumed run goes on with the batches it would have seen.
    """

    def __init__(
        self,
        clips: list[Clip],
        tokens: int = 1800,
        lengths: tuple[int, ...] = (90, 120, 180, 240),
        augmentation: Augmentation | None = None,
        seed: int = 0,
        seed_frames: int = SEED_FRAMES,
    ) -> None:
        self.augmentation = augmentation or Augmentation()
        self.lengths, self.tokens, self.seed_frames = lengths, tokens, seed_frames
        # A clip must give a whole seed and at least half a second to predict.
        self.clips = [clip for clip in clips if clip.frames >= seed_frames + FPS // 2]
        if not self.clips:
            raise ValueError("no clip is long enough for a window")
        self.weights = torch.tensor([float(clip.frames) for clip in self.clips])
        self.rng = torch.Generator().manual_seed(seed)

    def batch(self) -> dict[str, Tensor]:
        """The next batch."""
        length = self.lengths[int(torch.randint(0, len(self.lengths), (), generator=self.rng))]
        count = max(1, round(self.tokens / (length + self.seed_frames)))
        chosen = torch.multinomial(self.weights, count, replacement=True, generator=self.rng)
        return collate([self._window(self.clips[int(i)], length) for i in chosen])

    def _window(self, clip: Clip, length: int) -> Window:
        fastest = self.augmentation.tempo[1]
        room = clip.frames - int((self.seed_frames + length) * fastest)
        start = int(torch.randint(0, max(room, 0) + 1, (), generator=self.rng))
        return cut_window(clip, start, length, self.rng, self.augmentation, seed_frames=self.seed_frames)

