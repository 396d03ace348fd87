"""Measures of paper B (NPSS, PFD, VFD, PVar, BC), diversity, and how far poses lie from the poses of real dance.

Motion is [N, 147] as everywhere; web/core/dance-metrics.ts holds the same definitions. Where paper B leaves something open, what is
taken here stands in the docstring.
"""

from __future__ import annotations

import torch
from torch import Tensor

from metrics import joints, matrices_of
from rotation import heading, matrix_to_quaternion, yaw_matrix
from spec import FPS, ROTATION_SIZE

BEAT_SIGMA = 0.05  # seconds; paper B prints none, the Beat Alignment Score it starts from has 3 frames at 60 per second


def _turned_back(vectors: Tensor, motion: Tensor) -> Tensor:
    """World vectors [N, 24, 3] as seen by a body that faces +Z in every frame; the pelvis' own, always 0, is left out: [N, 69]."""
    turn = yaw_matrix(-heading(matrices_of(motion[:, :6])[:, 0]))
    return (vectors @ turn.transpose(-1, -2))[:, 1:].flatten(1)


def pose_vectors(motion: Tensor, positions: Tensor | None = None) -> Tensor:
    """Where the joints are as seen by the body itself [N, 69], metres: what PFD compares.

    `positions`: the root-aligned joints of `motion` if they are known already; so in the functions below.
    """
    return _turned_back(joints(motion) if positions is None else positions, motion)


def velocity_vectors(motion: Tensor, positions: Tensor | None = None) -> Tensor:
    """How the joints move relative to the pelvis, seen in the body's heading [N - 1, 69], m/s: what VFD compares."""
    positions = joints(motion) if positions is None else positions
    return _turned_back(positions.diff(dim=0) * FPS, motion[:-1])


def frechet_distance(a: Tensor, b: Tensor) -> float:
    """Frechet distance of two sets of vectors [n, d], [m, d], each taken as a Gaussian (population covariance).

    |mean_a - mean_b|^2 + tr(A + B - 2 (A^1/2 B A^1/2)^1/2): the squared unit of the vectors.
    """
    a, b = a.double(), b.double()
    means = [x.mean(0) for x in (a, b)]
    cov_a, cov_b = ((x - mean).T @ (x - mean) / len(x) for x, mean in zip((a, b), means))
    values, vectors = torch.linalg.eigh(cov_a)
    root = vectors * values.clamp_min(0).sqrt() @ vectors.T
    cross = torch.linalg.eigvalsh(root @ cov_b @ root).clamp_min(0).sqrt().sum()
    # Rounding makes the distance of a set to itself a little negative.
    return max(0.0, float(((means[0] - means[1]) ** 2).sum() + cov_a.trace() + cov_b.trace() - 2 * cross))


def power_values(motion: Tensor, positions: Tensor | None = None) -> Tensor:
    """What NPSS is taken over [N, 168]: 24 quaternions (signs continuous, first w >= 0), 24 root-aligned positions in metres."""
    quaternion = matrix_to_quaternion(matrices_of(motion).double())
    first = torch.where(quaternion[:1, :, 3:] < 0, -1.0, 1.0)
    turned = torch.where((quaternion[1:] * quaternion[:-1]).sum(-1, keepdim=True) < 0, -1.0, 1.0)
    signs = torch.cat([first, turned]).cumprod(0)
    positions = joints(motion) if positions is None else positions
    return torch.cat([(quaternion * signs).flatten(1), positions.double().flatten(1)], -1)


def npss_of(real: Tensor, made: Tensor) -> float:
    """NPSS (Gopalakrishnan et al. 2019) of value sequences [N, d]: earth mover's distance between the normalised power spectra
    (all N bins of the Fourier transform), mean over the dimensions weighted by the real power."""
    powers = [torch.fft.fft(values.double(), dim=0).abs() ** 2 for values in (real, made)]
    totals = [power.sum(0) for power in powers]
    shares = [(power / total.clamp_min(1e-12)).cumsum(0) for power, total in zip(powers, totals)]
    distance = (shares[0] - shares[1]).abs().sum(0)
    return float((distance * totals[0]).sum() / totals[0].sum().clamp_min(1e-12))


def npss(real: Tensor, made: Tensor) -> float:
    """NPSS of two motions [N, 147] of one length, over quaternions and root-aligned positions (paper B, section 5.2)."""
    return npss_of(power_values(real), power_values(made))


def position_variance(dances: list[Tensor]) -> float:
    """PVar in the form that paper B uses where each piece of music has one dance: variance over dances of each joint's root-aligned
    position (x, y, z added; population variance), mean over frames and joints, m^2. `dances`: positions [N, 24, 3] of one length."""
    positions = torch.stack(dances).double()
    return float(positions.var(0, correction=0).sum(-1).mean())


def beat_consistency(found: Tensor, beats: Tensor) -> float:
    """BC (paper B, eq. 1): mean over the musical beats of exp(-d^2 / 2 sigma^2), d to the nearest motion beat; all in frames.

    NaN without musical beats, 0 without motion beats.
    """
    if len(beats) == 0:
        return float("nan")
    if len(found) == 0:
        return 0.0
    distance = (beats[:, None] - found[None, :]).abs().min(1).values / FPS
    return float(torch.exp(-(distance.double() ** 2) / (2 * BEAT_SIGMA**2)).mean())


def pairwise_distance(dances: list[Tensor]) -> float:
    """Diversity: mean joint distance in metres between any two of the dances (root-aligned positions [N, 24, 3])."""
    pairs = [(dances[i] - dances[j]).norm(dim=-1).mean() for i in range(len(dances)) for j in range(i + 1, len(dances))]
    return float(torch.stack(pairs).mean())


class PoseDistribution:
    """Gaussian of the poses of real dance: joint positions as seen by the body itself, and the pelvis' height (70 numbers)."""

    def __init__(self, motions: list[Tensor], floor: float = 0.005) -> None:
        """`floor` (metres) is the least deviation that a direction is given: joints that hardly move must not decide."""
        poses = torch.cat([self.vectors(motion) for motion in motions]).double()
        self.mean = poses.mean(0)
        covariance = (poses - self.mean).T @ (poses - self.mean) / len(poses)
        self.values, self.directions = torch.linalg.eigh(covariance)
        self.values = self.values.clamp_min(0) + floor**2
        self.usual = self.distance_of(poses).sort().values  # what the real frames themselves have

    @staticmethod
    def vectors(motion: Tensor) -> Tensor:
        """[N, 147] -> [N, 70]."""
        return torch.cat([pose_vectors(motion), motion[:, ROTATION_SIZE + 1 : ROTATION_SIZE + 2]], -1)

    def distance_of(self, poses: Tensor) -> Tensor:
        """Mahalanobis distance [N] of pose vectors [N, 70], divided by sqrt(70): real frames have a mean square of about 1."""
        centred = (poses.double() - self.mean) @ self.directions
        return (centred**2 / self.values).mean(-1).sqrt()

    def distance(self, motion: Tensor) -> Tensor:
        """The same of motion [N, 147]."""
        return self.distance_of(self.vectors(motion))

    def quantile(self, share: float) -> float:
        """Distance below which this share of the real frames lie."""
        return float(self.usual[min(len(self.usual) - 1, int(share * len(self.usual)))])
