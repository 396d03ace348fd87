"""Posing kit: describe a body in a dancer's words, get 24 SMPL-order rotations that stand on the floor.

Conventions are those of web/core/spec.json: metres, Y up, floor y = 0, facing +Z, left = +X. Angles of the public
descriptions are degrees; results are radians. Legs and arms are solved in closed form as ball joint + hinge, so knees
and elbows can bend one way only.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import torch

sys.path.append(str(Path(__file__).resolve().parents[1]))
import spec  # noqa: E402
from rotation import matrix_to_axis_angle  # noqa: E402
from skeleton import forward_kinematics, world_rotations  # noqa: E402

JOINTS, PARENTS, TOE_HEIGHT = spec.JOINTS, spec.PARENTS, spec.TOE_HEIGHT
OFFSETS = np.array(spec.OFFSETS, float)

#: hip, knee, ankle, toe joint indices by side (0 = left, 1 = right)
LEGS = ((1, 4, 7, 10), (2, 5, 8, 11))
#: collar, shoulder, elbow, wrist, hand
ARMS = ((13, 16, 18, 20, 22), (14, 17, 19, 21, 23))
SIDE_SIGN = (1.0, -1.0)

#: (joint at one end, joint at the other end, share of body mass): rounded segment shares of an adult
MASSES = (
    (0, 3, 0.14), (3, 6, 0.12), (6, 12, 0.23), (12, 15, 0.08),
    (16, 18, 0.028), (17, 19, 0.028), (18, 20, 0.016), (19, 21, 0.016), (20, 22, 0.006), (21, 23, 0.006),
    (1, 4, 0.1), (2, 5, 0.1), (4, 7, 0.0465), (5, 8, 0.0465), (7, 10, 0.0145), (8, 11, 0.0145),
)  # fmt: skip


def rx(degrees: float) -> np.ndarray:
    """Rotation about X."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def ry(degrees: float) -> np.ndarray:
    """Rotation about Y."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def rz(degrees: float) -> np.ndarray:
    """Rotation about Z."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def about(axis: np.ndarray, degrees: float) -> np.ndarray:
    """Rotation about any axis (Rodrigues)."""
    x, y, z = axis / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    a = np.radians(degrees)
    return np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * (k @ k)


def axis_angle(matrix: np.ndarray) -> np.ndarray:
    """Axis-angle [..., 3] of rotation matrices [..., 3, 3], angle in 0..pi."""
    return matrix_to_axis_angle(torch.from_numpy(matrix)).numpy()


def _frame(along: np.ndarray, toward: np.ndarray) -> np.ndarray:
    """Orthonormal frame (columns) whose first axis is `along` and whose second leans to `toward`."""
    a = along / np.linalg.norm(along)
    b = toward - a * (a @ toward)
    if np.linalg.norm(b) < 1e-6:
        b = np.cross(a, [0.3, 0.5, 0.8])
    b = b / np.linalg.norm(b)
    return np.stack([a, b, np.cross(a, b)], 1)


@dataclass(frozen=True)
class Foot:
    """Where a foot is. On the floor: `x`, `z` under the ankle when flat, `yaw` (turn-out is + for left, - for right),
    `heel` = heel raised by so many degrees over the ball of the foot. In the air: `y` = ankle height, `pitch` = toes
    down. `knee` = direction of the knee in the world, default: over the toes. `toes` = how far the toes bend up,
    default: so that they lie on the floor under a raised heel. `point` = pointed by so many degrees against the shin
    (a lifted foot; replaces yaw, pitch and roll)."""

    x: float
    z: float
    yaw: float = 0
    heel: float = 0
    y: float | None = None
    pitch: float = 0
    roll: float = 0
    knee: tuple[float, float, float] | None = None
    toes: float | None = None
    point: float | None = None

    @property
    def planted(self) -> bool:
        """Whether the ball of the foot is on the floor."""
        return self.y is None


@dataclass(frozen=True)
class Arm:
    """Wrist target from the shoulder in the chest's frame as (out, up, forward), metres; `elbow` = direction to which
    the elbow points, same frame. `flex` bends the hand to the palm, `dev` to the little finger, `roll` turns the
    palm (+ = palm up / supination). `world` replaces `hand` by a place in the world. `shrug` lifts the shoulder."""

    hand: tuple[float, float, float] = (0.06, -0.48, 0.05)
    elbow: tuple[float, float, float] = (0.35, -0.3, -0.9)
    flex: float = 8
    dev: float = 0
    roll: float = 0
    shrug: float = 0
    world: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class Body:
    """A whole pose. Angles in degrees: `turn` heading (+ = to the left), `tilt` pelvis forward, `roll` left hip up,
    `bend` spine forward, `twist` chest to the left, `side` chest leaning left, `pop` chest forward (upper against
    lower back); `look` gaze to the left of the heading, `look_up`, `head_tilt` ear to the left shoulder."""

    left: Foot = Foot(0.1, 0, 8)
    right: Foot = Foot(-0.1, 0, -8)
    h: float = 0.93
    x: float = 0
    z: float = 0
    turn: float = 0
    tilt: float = 0
    roll: float = 0
    bend: float = 0
    twist: float = 0
    side: float = 0
    pop: float = 0
    look: float = 0
    look_up: float = 0
    head_tilt: float = 0
    la: Arm = field(default_factory=Arm)
    ra: Arm = field(default_factory=Arm)


@dataclass
class Solved:
    """Local rotation matrices (24 x 3 x 3), root (3), world positions (24 x 3), world rotations and warnings."""

    local: np.ndarray
    root: np.ndarray
    points: np.ndarray
    world: np.ndarray
    warnings: list[str]

    def rotations(self) -> np.ndarray:
        """72 axis-angle numbers."""
        return axis_angle(self.local).reshape(-1)

    def centre_of_mass(self) -> np.ndarray:
        """Whole-body centre of mass, metres."""
        total = sum(m for _, _, m in MASSES)
        return sum(m * (self.points[a] + self.points[b]) / 2 for a, b, m in MASSES) / total


def forward(local: np.ndarray, root: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """World positions (24 x 3) and rotations (24 x 3 x 3) of local rotations (24 x 3 x 3)."""
    matrices = torch.from_numpy(local)
    points = forward_kinematics(matrices, torch.from_numpy(np.asarray(root, float)))
    return points.numpy(), world_rotations(matrices).numpy()


def _hinge(a: np.ndarray, b: np.ndarray, axis: np.ndarray, sign: float, distance: float, limits: tuple[float, float]):
    """Angle (degrees, >= 0) of a hinge between bones a and b for an end-to-end distance; returns angle, reach error."""
    # |a + R(t) b|^2 = |a|^2 + |b|^2 + 2 a.(R(t) b), and a.(R(t) b) = p + q cos t + r sin t (Rodrigues)
    n = axis / np.linalg.norm(axis)
    p = (a @ n) * (b @ n)
    q = a @ b - p
    r = sign * (a @ np.cross(n, b))
    wanted = (distance**2 - a @ a - b @ b) / 2 - p
    size = np.hypot(q, r)
    phase = np.degrees(np.arctan2(r, q))
    angle = phase + np.degrees(np.arccos(np.clip(wanted / size, -1, 1)))
    angle = float(np.clip(angle, *limits))
    reach = np.linalg.norm(a + about(n, sign * angle) @ b)
    return angle, distance - reach


#: a raised heel bends the toes by this share of its angle
TOE_SHARE = 0.85
KNEE_LIMITS = (3.0, 150.0)
ELBOW_LIMITS = (4.0, 148.0)


def foot_frame(foot: Foot, side: int, heel_extra: float = 0) -> tuple[np.ndarray, np.ndarray]:
    """World ankle position and foot rotation. Raising the heel pivots over the ball of the foot."""
    toe_offset = OFFSETS[LEGS[side][3]]
    if foot.y is not None:
        return np.array([foot.x, foot.y, foot.z]), ry(foot.yaw) @ rx(foot.pitch) @ rz(foot.roll)
    flat = ry(foot.yaw)
    toe = np.array([foot.x, TOE_HEIGHT - toe_offset[1], foot.z]) + flat @ toe_offset
    rotation = flat @ rx(foot.heel + heel_extra) @ rz(foot.roll)
    return toe - rotation @ toe_offset, rotation


def leg_length() -> float:
    """Longest hip-to-ankle distance that the knee limits allow, metres."""
    _, knee, ankle, _ = LEGS[0]
    return float(np.linalg.norm(OFFSETS[knee] + rx(KNEE_LIMITS[0]) @ OFFSETS[ankle]))


def solve(body: Body, peel: float = 0.0) -> Solved:
    """Solves a described body. `peel` = how many degrees a planted heel may rise by itself when the hip is too far."""
    local = np.tile(np.eye(3), (24, 1, 1))
    warnings: list[str] = []
    root = np.array([body.x, body.h, body.z])
    heading = ry(body.turn)
    local[0] = heading @ rx(body.tilt) @ rz(body.roll)
    for joint, share, pop in ((3, 0.32, -0.6), (6, 0.36, 0.2), (9, 0.32, 0.9)):
        # a forward chest pop = lower back forward, upper back arched: both ends keep the shoulders level
        local[joint] = ry(body.twist * share) @ rx(body.bend * share - body.pop * pop) @ rz(-body.side * share)
    points, world = forward(local, root)
    _solve_head(body, local, world)
    for side in (0, 1):
        _solve_leg(body, side, local, points, world, peel, warnings)
        _solve_arm(body, side, local, points, world, warnings)
    points, world = forward(local, root)
    return Solved(local, root, points, world, warnings)


def _solve_head(body: Body, local: np.ndarray, world: np.ndarray) -> None:
    wanted = ry(body.turn + body.look) @ rx(-body.look_up) @ rz(-body.head_tilt)
    m = world[9].T @ wanted
    # YXZ Euler angles of the head against the chest, so that each has its own limit
    pitch = np.degrees(np.arcsin(np.clip(-m[1, 2], -1, 1)))
    yaw = np.degrees(np.arctan2(m[0, 2], m[2, 2]))
    tilt = np.degrees(np.arctan2(m[1, 0], m[1, 1]))
    yaw, pitch, tilt = np.clip(yaw, -72, 72), np.clip(pitch, -48, 45), np.clip(tilt, -32, 32)
    for joint, share in ((12, 0.45), (15, 0.55)):
        local[joint] = ry(yaw * share) @ rx(pitch * share) @ rz(tilt * share)


def _solve_leg(body, side, local, points, world, peel, warnings) -> None:
    hip, knee, ankle, toe = LEGS[side]
    foot = body.left if side == 0 else body.right
    a, b = OFFSETS[knee], OFFSETS[ankle]
    extra, step = 0.0, 1.0
    while True:
        target, foot_rotation = foot_frame(foot, side, extra)
        reach = target - points[hip]
        angle, error = _hinge(a, b, np.array([1.0, 0, 0]), 1, float(np.linalg.norm(reach)), KNEE_LIMITS)
        if error < 1e-4 or not foot.planted or extra >= peel:
            break
        extra += step
    if extra and extra < peel:
        # the last whole degree overshoots: bisect so that heels peel smoothly over time
        low, high = extra - step, extra
        for _ in range(12):
            extra = (low + high) / 2
            target, foot_rotation = foot_frame(foot, side, extra)
            angle, error = _hinge(a, b, np.array([1.0, 0, 0]), 1, float(np.linalg.norm(target - points[hip])), KNEE_LIMITS)
            low, high = (low, extra) if error < 1e-5 else (extra, high)
        reach = target - points[hip]
    if abs(error) > 0.004:
        kind = "floor foot" if foot.planted else "lifted foot"
        warnings.append(f"{kind} {JOINTS[ankle]} out of reach by {error * 100:.1f} cm")
    bone = a + rx(angle) @ b
    knee_way = np.array(foot.knee, float) if foot.knee else ry(foot.yaw) @ np.array([0, 0.15, 1.0])
    hip_world = _frame(reach, knee_way) @ _frame(bone, np.array([0, 0, 1.0])).T
    local[hip] = world[0].T @ hip_world
    local[knee] = rx(angle)
    local[ankle] = (hip_world @ local[knee]).T @ foot_rotation if foot.point is None else rx(foot.point)
    if not foot.planted:
        # only the floor can press an ankle further than muscles do
        local[ankle] = _soften(local[ankle], 45, 20)
    if foot.toes is not None:
        local[toe] = rx(-foot.toes)
    elif foot.planted:
        local[toe] = rx(-TOE_SHARE * (foot.heel + extra))


def _soften(matrix: np.ndarray, free: float, extra: float) -> np.ndarray:
    """A rotation whose angle is left alone up to `free` degrees and then approaches free + extra smoothly."""
    vector = axis_angle(matrix)
    angle = float(np.degrees(np.linalg.norm(vector)))
    if angle <= free:
        return matrix
    return about(vector, free + extra * (1 - np.exp((free - angle) / extra)))


def _solve_arm(body, side, local, points, world, warnings) -> None:
    collar, shoulder, elbow, wrist, _ = ARMS[side]
    arm = body.la if side == 0 else body.ra
    sign = SIDE_SIGN[side]
    flip = np.array([sign, 1, 1])
    chest, origin = world[9], points[9]
    rest = OFFSETS[collar] + OFFSETS[shoulder]
    if arm.world is None:
        wanted = rest + flip * np.array(arm.hand)
    else:
        wanted = chest.T @ (np.array(arm.world) - origin)
    away = (wanted - rest) * flip
    away = away / max(0.2, float(np.linalg.norm(away)))
    # scapular rhythm: the collar bone helps when the arm is lifted, reaches forward or crosses the body
    lift = 24 * max(0.0, (away[1] + 0.25) / 1.25) ** 1.5 + arm.shrug
    reach_forward = 14 * away[2] + 8 * min(0.0, away[0]) * -1
    local[collar] = ry(-sign * reach_forward) @ rz(sign * lift)
    shoulder_at = OFFSETS[collar] + local[collar] @ OFFSETS[shoulder]
    if arm.world is None:
        # `hand` counts from the lifted shoulder, so that a full reach is a straight arm in every direction
        wanted = shoulder_at + flip * np.array(arm.hand)
    a, b = OFFSETS[elbow], OFFSETS[wrist]
    target = wanted - shoulder_at
    axis = np.array([0, 1.0, 0])
    angle, error = _hinge(a, b, axis, -sign, float(np.linalg.norm(target)), ELBOW_LIMITS)
    if arm.world is not None and abs(error) > 0.01:
        warnings.append(f"{JOINTS[wrist]} misses its place by {error * 100:.1f} cm")
    bone = a + ry(-sign * angle) @ b
    # the elbow points away from where the forearm folds: back (-Z) in the upper arm's rest frame
    upper = _frame(target, flip * np.array(arm.elbow, float)) @ _frame(bone, np.array([0, 0, -1.0])).T
    local[shoulder] = local[collar].T @ upper
    # supination turns the palm up: about the forearm, shared by forearm and wrist as in a real arm
    local[elbow] = ry(-sign * angle) @ about(b, -0.6 * arm.roll * 1.0)
    local[wrist] = about(b, -0.4 * arm.roll) @ rz(-sign * arm.flex) @ ry(sign * arm.dev)


def mirrored(body: Body) -> Body:
    """The left-right mirror image of a pose."""

    def foot(f: Foot) -> Foot:
        knee = None if f.knee is None else (-f.knee[0], f.knee[1], f.knee[2])
        return replace(f, x=-f.x, yaw=-f.yaw, roll=-f.roll, knee=knee)

    signs = {name: -getattr(body, name) for name in ("x", "turn", "roll", "twist", "side", "look", "head_tilt")}
    return replace(body, left=foot(body.right), right=foot(body.left), la=body.ra, ra=body.la, **signs)


def balance(body: Body, weight: float, rounds: int = 14, peel: float = 0.0) -> Body:
    """Moves the pelvis sideways and forward until the centre of mass is over the feet (`weight` = share on the left)."""
    middles = []
    for side, foot in ((0, body.left), (1, body.right)):
        toe = OFFSETS[LEGS[side][3]]
        along = 0.045 + 0.075 * min(1.0, foot.heel / 35)
        middles.append(np.array([foot.x, 0, foot.z]) + ry(foot.yaw) @ np.array([toe[0] * 0.6, 0, along]))
    target = weight * middles[0] + (1 - weight) * middles[1]
    for _ in range(rounds):
        error = target - solve(body, peel).centre_of_mass()
        body = replace(body, x=body.x + error[0], z=body.z + error[2])
    return body


def settle(body: Body, weight: float | None, peel: float = 0.0) -> Body:
    """Balances, and lowers the pelvis as far as needed for planted feet to be reached."""
    for _ in range(80):
        body = balance(body, weight, peel=peel) if weight is not None else body
        if not any("floor foot" in w for w in solve(body, peel).warnings):
            return body
        body = replace(body, h=body.h - 0.006)
    return body
