"""Rotations as torch tensors of any leading shape: axis-angle (3), quaternion x y z w (4), matrix (3, 3), 6D (6).

6D is the first two COLUMNS of the matrix, column 0 then column 1 (Zhou et al. 2019, "On the Continuity of Rotation
Representations in Neural Networks").
"""

from __future__ import annotations

import torch
from torch import Tensor

# Below this horizontal length the forward axis is "nearly vertical" and the body's up axis says where it faces.
VERTICAL_FORWARD = 0.1


def axis_angle_to_quaternion(axis_angle: Tensor) -> Tensor:
    """[..., 3] radians -> [..., 4] unit quaternion x y z w. Exact at zero (Taylor for small angles)."""
    angle = axis_angle.norm(dim=-1, keepdim=True)
    # sin(a/2)/a tends to 1/2; the series avoids 0/0.
    scale = torch.where(angle < 1e-4, 0.5 - angle * angle / 48, torch.sin(angle / 2) / angle.clamp_min(1e-12))
    return torch.cat([axis_angle * scale, torch.cos(angle / 2)], dim=-1)


def quaternion_to_axis_angle(quaternion: Tensor) -> Tensor:
    """[..., 4] x y z w -> [..., 3] radians, angle in 0..pi (the shorter of the two equal rotations)."""
    quaternion = torch.where(quaternion[..., 3:] < 0, -quaternion, quaternion)
    vector, w = quaternion[..., :3], quaternion[..., 3:]
    length = vector.norm(dim=-1, keepdim=True)
    angle = 2 * torch.atan2(length, w)
    scale = torch.where(length < 1e-7, torch.full_like(length, 2.0), angle / length.clamp_min(1e-12))
    return vector * scale


def quaternion_to_matrix(quaternion: Tensor) -> Tensor:
    """[..., 4] unit x y z w -> [..., 3, 3]."""
    x, y, z, w = quaternion.unbind(-1)
    column0 = torch.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], -1)
    column1 = torch.stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], -1)
    column2 = torch.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], -1)
    return torch.stack([column0, column1, column2], -1)


def matrix_to_quaternion(matrix: Tensor) -> Tensor:
    """[..., 3, 3] -> [..., 4] x y z w. Of the four algebraic forms the one with the largest divisor is taken, so none loses digits."""
    m = [[matrix[..., i, j] for j in range(3)] for i in range(3)]
    a, b, c = m[0][0], m[1][1], m[2][2]
    from_w = torch.stack([m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1 + a + b + c], -1)
    from_x = torch.stack([1 + a - b - c, m[0][1] + m[1][0], m[0][2] + m[2][0], m[2][1] - m[1][2]], -1)
    from_y = torch.stack([m[0][1] + m[1][0], 1 - a + b - c, m[1][2] + m[2][1], m[0][2] - m[2][0]], -1)
    from_z = torch.stack([m[0][2] + m[2][0], m[1][2] + m[2][1], 1 - a - b + c, m[1][0] - m[0][1]], -1)
    positive = (a + b + c > 0)[..., None]
    x_largest = ((a >= b) & (a >= c))[..., None]
    y_largest = (b >= c)[..., None]
    quaternion = torch.where(positive, from_w, torch.where(x_largest, from_x, torch.where(y_largest, from_y, from_z)))
    return quaternion / quaternion.norm(dim=-1, keepdim=True)


def axis_angle_to_matrix(axis_angle: Tensor) -> Tensor:
    """[..., 3] -> [..., 3, 3]."""
    return quaternion_to_matrix(axis_angle_to_quaternion(axis_angle))


def matrix_to_axis_angle(matrix: Tensor) -> Tensor:
    """[..., 3, 3] -> [..., 3]."""
    return quaternion_to_axis_angle(matrix_to_quaternion(matrix))


def matrix_to_six_d(matrix: Tensor) -> Tensor:
    """[..., 3, 3] -> [..., 6]: column 0 then column 1."""
    return torch.cat([matrix[..., :, 0], matrix[..., :, 1]], dim=-1)


def six_d_to_matrix(six_d: Tensor) -> Tensor:
    """[..., 6] -> [..., 3, 3] by Gram-Schmidt (Zhou et al. 2019, eq. 15): any two independent columns become a rotation."""
    return torch.stack(gram_schmidt(six_d[..., :3], six_d[..., 3:]), dim=-1)


def gram_schmidt(a: Tensor, b: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    """Two [..., 3] vectors -> three orthonormal columns, the first along `a`."""
    column0 = unit(a)
    column1 = unit(b - (column0 * b).sum(-1, keepdim=True) * column0)
    return column0, column1, cross(column0, column1)


def unit(vector: Tensor) -> Tensor:
    """[..., n] scaled to length 1 (a zero vector stays finite)."""
    return vector / (vector * vector).sum(-1, keepdim=True).add(1e-12).sqrt()


def cross(a: Tensor, b: Tensor) -> Tensor:
    """Cross product over the last axis, as plain multiplications (torch.cross exports to more ONNX nodes)."""
    ax, ay, az = a.split(1, -1)
    bx, by, bz = b.split(1, -1)
    return torch.cat([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], -1)


def slerp(a: Tensor, b: Tensor, fraction: Tensor) -> Tensor:
    """Spherical interpolation of unit quaternions [..., 4] along the shorter arc; `fraction` [..., 1] in 0..1."""
    dot = (a * b).sum(-1, keepdim=True)
    b = torch.where(dot < 0, -b, b)
    dot = dot.abs().clamp(max=1.0)
    # Nearly equal rotations: sin(angle) tends to 0, linear weights are exact enough.
    close = dot > 0.9995
    angle = torch.acos(dot.clamp(max=0.9995))
    sine = torch.sin(angle)
    weight_a = torch.where(close, 1 - fraction, torch.sin((1 - fraction) * angle) / sine)
    weight_b = torch.where(close, fraction, torch.sin(fraction * angle) / sine)
    mixed = weight_a * a + weight_b * b
    return mixed / mixed.norm(dim=-1, keepdim=True)


def slerp_matrices(a: Tensor, b: Tensor, fraction: Tensor) -> Tensor:
    """`slerp` of rotation matrices [..., 3, 3]; `fraction` [..., 1]."""
    return quaternion_to_matrix(slerp(matrix_to_quaternion(a), matrix_to_quaternion(b), fraction))


def angle_between(a: Tensor, b: Tensor) -> Tensor:
    """Geodesic angle [...] in radians between matrices [..., 3, 3]; atan2 keeps its digits near 0 and pi."""
    quaternion = matrix_to_quaternion(a.transpose(-1, -2) @ b)
    return 2 * torch.atan2(quaternion[..., :3].norm(dim=-1), quaternion[..., 3].abs())


def heading(pelvis: Tensor) -> Tensor:
    """Heading angle [...] about +Y of pelvis rotations [..., 3, 3]: atan2(f.x, f.z) of the forward axis f = R (0, 0, 1).

    A body that lies or bends (f nearly vertical) faces where its up axis points: down-looking bodies have their head
    forward, up-looking ones their head behind, hence f = -R (0, 1, 0) sign(f.y).
    """
    forward, up = pelvis[..., :, 2], pelvis[..., :, 1]
    vertical = (forward[..., 0] ** 2 + forward[..., 2] ** 2).sqrt() < VERTICAL_FORWARD
    spare = torch.where(forward[..., 1:2] >= 0, -up, up)
    forward = torch.where(vertical[..., None], spare, forward)
    return torch.atan2(forward[..., 0], forward[..., 2])


def yaw_matrix(angle: Tensor) -> Tensor:
    """Rotation [..., 3, 3] about +Y by angle [...] (turns +Z towards +X)."""
    c, s, zero, one = torch.cos(angle), torch.sin(angle), torch.zeros_like(angle), torch.ones_like(angle)
    rows = [torch.stack([c, zero, s], -1), torch.stack([zero, one, zero], -1), torch.stack([-s, zero, c], -1)]
    return torch.stack(rows, -2)
