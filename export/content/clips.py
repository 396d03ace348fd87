"""Turns a choreography (foot plan + keyed body channels on beats) into a looping clip of poses.

A foot plan lists where and when the ball of a foot stands; between two stands the foot swings on an arc. Everything
else is a set of channels with values at beats, joined by monotone periodic cubics, so that a key is hit and held without
overshoot. The pelvis follows the weight so that the centre of mass travels from foot to foot.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from rig import LEGS, OFFSETS, TOE_HEIGHT, TOE_SHARE, Arm, Body, Foot, Solved, ry, rx, solve

SCALARS = ("h", "turn", "tilt", "roll", "bend", "twist", "side", "pop", "look", "look_up", "head_tilt", "w", "dx", "dz")
ARM_PARTS = ("hand", "elbow", "flex", "dev", "roll", "shrug")
#: channels that change sign in a left-right mirror
ODD = ("turn", "roll", "twist", "side", "look", "head_tilt", "dx")
PEEL = 28.0


@dataclass(frozen=True)
class Stand:
    """The ball of a foot stands on the floor from `start` to `end` (beats). x, z: under the ankle of the flat foot.

    `heel` = degrees at (landing, middle, leaving); `turn_to` = yaw at the end when the foot pivots on its ball;
    `arc` = how high the foot is lifted on its way to this stand, `kick` = extra forward and side offset of that arc.
    """

    start: float
    end: float
    x: float
    z: float
    yaw: float = 10
    heel: tuple[float, float, float] = (14, 0, 26)
    turn_to: float | None = None
    arc: float = 0.07
    kick: tuple[float, float, float] = (0, 0, 0)

    def ball(self) -> np.ndarray:
        """World position of the toe joint on the floor (left foot; mirror for the right)."""
        return np.array([self.x, 0, self.z])


@dataclass
class Choreography:
    """A clip before it is solved. With `mirrored`, only the first half is written; the second is its mirror image."""

    id: str
    name: str
    description: str
    beats: int
    left: list[Stand]
    keys: list[tuple[float, dict]]
    right: list[Stand] = field(default_factory=list)
    mirrored: bool = True
    base: Body = field(default_factory=Body)
    bounce: float = 0.04
    #: bounces per beat and shift of the lowest point, in beats
    bounce_rate: float = 1.0
    bounce_shift: float = 0.0
    nod: float = 5.0
    balance: float = 0.75
    drag: float = 6.0


def flip_arm_names(name: str) -> str:
    """la <-> ra."""
    return {"la": "ra", "ra": "la"}.get(name, name)


def mirrored_key(values: dict) -> dict:
    """The left-right mirror image of a key."""
    out = {}
    for name, value in values.items():
        value = (1 - value) if name == "w" else (-value if name in ODD else value)
        out[flip_arm_names(name)] = value
    return out


def mirrored_stand(stand: Stand, shift: float) -> Stand:
    """The same stand of the other foot, `shift` beats later (yaw stays 'turn-out': its sign is the side's)."""
    kick = (-stand.kick[0], stand.kick[1], stand.kick[2])
    turn_to = None if stand.turn_to is None else -stand.turn_to
    return replace(
        stand, start=stand.start + shift, end=stand.end + shift, x=-stand.x, yaw=-stand.yaw, turn_to=turn_to, kick=kick
    )


class Curve:
    """Periodic cubic through keys; slopes are limited (Fritsch and Carlson 1980) so that keys are never overshot."""

    def __init__(self, times, values, period: float):
        order = np.argsort(times)
        self.period = period
        self.t = np.asarray(times, float)[order]
        self.v = np.asarray(values, float)[order]
        if len(self.t) > 1:
            gap = np.append(np.diff(self.t), self.t[0] + period - self.t[-1])
            shape = (-1,) + (1,) * (self.v.ndim - 1)
            slope = (np.roll(self.v, -1, 0) - self.v) / gap.reshape(shape)
            before = np.roll(slope, 1, 0)
            weight = (gap / (gap + np.roll(gap, 1))).reshape(shape)
            mean = weight * before + (1 - weight) * slope
            limit = 3 * np.minimum(np.abs(slope), np.abs(before))
            # at a turning point a little slope is kept: a full stop of every channel at every key looks mechanical
            soft = np.where(slope * before > 0, np.clip(mean, -limit, limit), 0.18 * mean)
            self.m, self.gap = soft, gap

    def __call__(self, t: float):
        if len(self.t) == 1:
            return self.v[0]
        t = (t - self.t[0]) % self.period + self.t[0]
        i = int(np.searchsorted(self.t, t, "right")) - 1
        h = self.gap[i]
        s = (t - self.t[i]) / h
        j = (i + 1) % len(self.t)
        return (
            (1 + 2 * s) * (1 - s) ** 2 * self.v[i] + s * (1 - s) ** 2 * h * self.m[i]
            + s * s * (3 - 2 * s) * self.v[j] + s * s * (s - 1) * h * self.m[j]
        )  # fmt: skip


def smooth(s: float) -> float:
    """Quintic ease, zero speed and acceleration at both ends."""
    s = min(1.0, max(0.0, s))
    return s * s * s * (10 - 15 * s + 6 * s * s)


class FootTrack:
    """One foot through the loop."""

    def __init__(self, stands: list[Stand], side: int, period: float):
        self.stands = sorted(stands, key=lambda s: s.start)
        self.side, self.period = side, period
        self.toe = OFFSETS[LEGS[side][3]]

    def _ball(self, stand: Stand) -> np.ndarray:
        flat = np.array([stand.x, TOE_HEIGHT - self.toe[1], stand.z])
        return flat + ry(stand.yaw) @ self.toe

    def _stand_angles(self, stand: Stand, t: float) -> tuple[float, float]:
        """Yaw and heel at time t of a stand."""
        length = stand.end - stand.start
        land, mid, leave = stand.heel
        down = smooth((t - stand.start) / min(0.3, length / 3))
        up = smooth((t - stand.end + min(0.45, length / 2.5)) / min(0.45, length / 2.5))
        heel = land + (mid - land) * down + (leave - mid) * up
        yaw = stand.yaw
        if stand.turn_to is not None:
            yaw += (stand.turn_to - yaw) * smooth((t - stand.start) / length)
        return yaw, heel

    def at(self, t: float) -> tuple[Foot, np.ndarray, bool]:
        """Foot, position of its ball, and whether it is planted, at beat t."""
        t = t % self.period
        for stand in self.stands:
            for shift in (0, self.period):
                if stand.start <= t + shift <= stand.end:
                    yaw, heel = self._stand_angles(stand, t + shift)
                    ball = self._ball(stand)
                    flat = ball - ry(yaw) @ self.toe
                    return Foot(flat[0], flat[2], yaw, heel=max(0.0, heel)), ball, True
        return self._swing(t)

    def _swing(self, t: float) -> tuple[Foot, np.ndarray, bool]:
        best = None
        for index, stand in enumerate(self.stands):
            following = self.stands[(index + 1) % len(self.stands)]
            for shift in (-self.period, 0, self.period):
                leave = stand.end + shift
                arrive = following.start + shift + (self.period if index + 1 == len(self.stands) else 0)
                if leave < t < arrive:
                    best = (stand, following, leave, arrive)
        assert best, f"foot plan has no stand and no swing at beat {t}"
        a, b, leave, arrive = best
        s = (t - leave) / (arrive - leave)
        go, hump = smooth(s), np.sin(np.pi * s) ** 2
        ball = self._ball(a) * (1 - go) + self._ball(b) * go
        ball = ball + hump * np.array([b.kick[0], b.arc + b.kick[1], b.kick[2]])
        yaw_a, heel_a = self._stand_angles(a, a.end)
        yaw = yaw_a + (b.yaw - yaw_a) * go
        heel = heel_a + (b.heel[0] - heel_a) * go + hump * (16 - 22 * s)
        toes = TOE_SHARE * (heel_a * (1 - smooth(s * 2.5)) + b.heel[0] * smooth(s * 2.5 - 1.5))
        ankle = ball - ry(yaw) @ rx(heel) @ self.toe
        return Foot(ankle[0], ankle[2], yaw, y=ankle[1], pitch=heel, toes=toes), ball, False


class ClipSolver:
    """Samples a choreography at any beat."""

    def __init__(self, plan: Choreography):
        self.plan = plan
        half = plan.beats / 2
        keys, left, right = list(plan.keys), list(plan.left), list(plan.right)
        if plan.mirrored:
            keys += [(t + half, mirrored_key(v)) for t, v in plan.keys]
            right = [mirrored_stand(s, half) for s in plan.left]
        self.feet = (FootTrack(wrap(left, plan.beats), 0, plan.beats), FootTrack(wrap(right, plan.beats), 1, plan.beats))
        self.curves: dict[str, Curve] = {}
        for name in SCALARS:
            self._curve(name, [(t, v[name]) for t, v in keys if name in v])
        for side in ("la", "ra"):
            for part in ARM_PARTS:
                self._curve(f"{side}.{part}", [(t, getattr(v[side], part)) for t, v in keys if side in v])
        self.drags = np.zeros((1, 2, 2))
        self.shifts = np.zeros((1, 3))
        self.drops = np.zeros(1)

    def _curve(self, name: str, keys: list[tuple[float, object]]) -> None:
        if keys:
            self.curves[name] = Curve([t for t, _ in keys], [v for _, v in keys], self.plan.beats)

    def _arm(self, side: str, t: float, drag: np.ndarray) -> Arm:
        base: Arm = getattr(self.plan.base, side)
        values = {p: self.curves[f"{side}.{p}"](t) for p in ARM_PARTS if f"{side}.{p}" in self.curves}
        arm = replace(base, **values)
        hand = clear_of_torso(np.array(arm.hand, float))
        return replace(arm, hand=tuple(hand), elbow=tuple(arm.elbow), flex=arm.flex + drag[0], dev=arm.dev + drag[1])

    def body(self, t: float) -> tuple[Body, np.ndarray]:
        """Body at beat t and where its centre of mass should be (x, _, z)."""
        plan = self.plan
        values = {n: float(self.curves[n](t)) for n in SCALARS if n in self.curves}
        w, dx, dz = values.pop("w", 0.5), values.pop("dx", 0.0), values.pop("dz", 0.0)
        (left, ball_l, _), (right, ball_r, _) = self.feet[0].at(t), self.feet[1].at(t)
        target = w * ball_l + (1 - w) * ball_r + ry(plan.base.turn) @ np.array([dx, 0, dz - 0.06])
        wave = 0.5 + 0.5 * np.cos(2 * np.pi * (t * plan.bounce_rate - plan.bounce_shift))
        body = replace(plan.base, **values)
        drag = interpolate_loop(self.drags, t / plan.beats)
        shift = interpolate_loop(self.shifts, t / plan.beats)
        body = replace(
            body, left=left, right=right, x=target[0] + shift[0], z=target[2] + shift[2],
            h=body.h - plan.bounce * wave - float(interpolate_loop(self.drops, t / plan.beats)), look_up=body.look_up - plan.nod * (wave - 0.4),
            la=self._arm("la", t, drag[0]), ra=self._arm("ra", t, drag[1]),
        )  # fmt: skip
        return body, target

    def prepare(self, rate: int = 8) -> None:
        """Settles balance and wrist drag over the loop; call once before sampling."""
        n = int(self.plan.beats * rate)
        shifts = np.zeros((n, 3))
        for _ in range(2):
            for i in range(n):
                body, target = self.body(i / rate)
                error = target - solve(body, PEEL).centre_of_mass()
                shifts[i] += self.plan.balance * error
            shifts[:, 1] = 0
            self.shifts = smooth_loop(shifts, 1.2)
        self._sink(n, rate)
        wrists, palms, fingers = np.zeros((n, 2, 3)), np.zeros((n, 2, 3)), np.zeros((n, 2, 3))
        for i in range(n):
            s = solve(self.body(i / rate)[0], PEEL)
            for side in (0, 1):
                wrists[i, side] = s.points[20 + side] - s.points[9]
                palms[i, side] = s.world[20 + side] @ np.array([0, -1.0, 0])
                fingers[i, side] = s.world[20 + side] @ np.array([0, 0, -1.0])
        speed = (np.roll(wrists, -1, 0) - np.roll(wrists, 1, 0)) * rate / 2
        raw = np.stack([-(speed * palms).sum(-1), -(speed * fingers).sum(-1)], -1) * self.plan.drag
        self.drags = smooth_loop(np.clip(raw, -24, 24), 1.0)

    def _sink(self, n: int, rate: int) -> None:
        """Lowers the pelvis where a planted foot would otherwise leave the floor; wider than needed, so it stays smooth."""
        for _ in range(3):
            need = np.zeros(n)
            for i in range(n):
                body, _ = self.body(i / rate)
                while need[i] < 0.2 and any("floor foot" in w for w in solve(replace(body, h=body.h - need[i]), PEEL).warnings):
                    need[i] += 0.01
            if not need.any():
                return
            wide = np.max([np.roll(need, k) for k in range(-2, 3)], 0)
            self.drops = (self.drops if len(self.drops) == n else np.zeros(n)) + smooth_loop(wide, 1.0)

    def sample(self, t: float) -> Solved:
        """Solved pose at beat t."""
        return solve(self.body(t)[0], PEEL)


def wrap(stands: list[Stand], period: float) -> list[Stand]:
    """Brings stands into one loop (start within 0..period)."""
    out = []
    for s in stands:
        k = np.floor(s.start / period) * period
        out.append(replace(s, start=s.start - k, end=s.end - k))
    return out


def clear_of_torso(hand: np.ndarray) -> np.ndarray:
    """Pushes a hand out of the trunk, an upright ellipse in the chest's frame (hand counts from the shoulder)."""
    near = float(np.linalg.norm(hand))
    if near < 0.24:
        # straight through the shoulder the arm would flip over: go round in front
        hand = hand + (0.24 - near) * np.array([0.6, 0, 0.8])
    x, z = (hand[0] + 0.19) / 0.185, (hand[2] - 0.01) / 0.17
    depth = np.hypot(x, z)
    if hand[1] > 0.03 or depth >= 1 or depth < 1e-6:
        return hand
    fade = min(1.0, (0.03 - hand[1]) / 0.08)
    x, z = x / depth, z / depth
    pushed = np.array([x * 0.185 - 0.19, hand[1], z * 0.17 + 0.01])
    return hand + (pushed - hand) * fade


def smooth_loop(values: np.ndarray, width: float) -> np.ndarray:
    """Gaussian smoothing along a periodic first axis; width in samples."""
    reach = int(np.ceil(3 * width))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    weights /= weights.sum()
    return sum(w * np.roll(values, k, 0) for w, k in zip(weights, range(-reach, reach + 1)))


def interpolate_loop(values: np.ndarray, phase: float) -> np.ndarray:
    """Periodic Catmull-Rom interpolation along the first axis; phase in loops."""
    n = len(values)
    position = (phase % 1.0) * n
    i, s = int(position), position - int(position)
    a, b, c, d = (values[(i + k) % n] for k in (-1, 0, 1, 2))
    return b + 0.5 * s * (c - a + s * (2 * a - 5 * b + 4 * c - d + s * (3 * (b - c) + d - a)))
