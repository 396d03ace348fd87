"""The starting clips, written in beats. Most give one half and are mirrored for the other."""

from __future__ import annotations

import math

from clips import Choreography, Stand
from rig import Arm, Body

UP = (1.0, -0.1, 0.25)
OUT = (0.0, -0.55, -1.0)
BACK = (0.45, -0.5, -0.9)
FRONT = (0.8, -0.9, -0.2)
BENT = (0.55, -0.85, -0.5)

#: arms that many dances share
RELAXED = Arm((0.14, -0.38, 0.12), elbow=BENT, roll=15)
SWING_FRONT = Arm((-0.06, -0.14, 0.36), elbow=FRONT, roll=15, flex=6)
SWING_BACK = Arm((0.16, -0.36, -0.22), elbow=BACK, roll=0, flex=4)
HIP = Arm((0.0, -0.39, 0.1), elbow=(1, 0.05, -0.55), flex=35, dev=-20)


def two_step() -> Choreography:
    left = [
        Stand(0, 1.5, 0.08, 0, 16), Stand(2, 4.5, 0.38, 0.02, 18),
        Stand(5, 6.5, 0.10, -0.03, 14), Stand(7, 7.55, -0.16, 0.07, 20, heel=(34, 30, 34)),
    ]  # fmt: skip
    keys = [
        (0, dict(h=0.925, w=0.72, roll=5, side=9, twist=16, turn=8, tilt=6, bend=6, look=-6, head_tilt=6,
                 la=Arm((0.2, -0.4, -0.2), elbow=BACK, flex=5), ra=Arm((-0.04, -0.1, 0.38), elbow=FRONT, roll=20))),
        (0.5, dict(h=0.945, w=0.7)),
        (1, dict(h=0.925, w=0.3, roll=-5, side=-5, twist=-10, turn=0, tilt=4, bend=2, look=10, head_tilt=-5,
                 la=Arm((0.28, -0.08, 0.24), elbow=BENT, roll=25), ra=Arm((0.26, -0.2, 0.2), elbow=BENT, roll=25))),
        (1.5, dict(w=0.36)),
        (2, dict(h=0.915, w=0.74, roll=6, side=12, twist=20, turn=4, tilt=6, bend=7, look=8, head_tilt=8,
                 la=Arm((0.32, -0.36, -0.12), elbow=BACK), ra=Arm((-0.1, -0.06, 0.36), elbow=FRONT, roll=20))),
        (3, dict(h=0.955, w=0.9, roll=9, side=16, twist=-16, turn=-6, tilt=2, bend=-2, look=26, head_tilt=9,
                 la=Arm((0.22, 0.3, 0.24), elbow=(1, -0.7, 0), roll=20, flex=14), ra=Arm((0.18, -0.2, 0.3), elbow=BENT, roll=30))),
    ]  # fmt: skip
    return Choreography("two-step", "Two-step", "Step, close, step, touch: the groove that fits every song.", 8, left, keys, bounce=0.045)


def bounce_groove() -> Choreography:
    left = [Stand(0, 5.5, 0.17, 0.03, 20, heel=(12, 0, 22)), Stand(6, 7.6, 0.2, -0.08, 26, heel=(26, 20, 30))]
    keys = [
        (0, dict(h=0.91, w=0.62, roll=5, side=12, twist=32, turn=11, tilt=9, bend=12, pop=-6, look=4, head_tilt=6,
                 la=Arm((0.04, 0.0, 0.4), elbow=FRONT, roll=15, shrug=6), ra=Arm((0.22, -0.38, -0.22), elbow=BACK))),
        (0.5, dict(pop=8, bend=0, h=0.93)),
        (1, dict(h=0.9, w=0.4, roll=-5, side=-12, twist=-32, turn=-11, tilt=9, bend=12, pop=-6, look=-4, head_tilt=-6,
                 la=Arm((0.22, -0.38, -0.22), elbow=BACK), ra=Arm((0.0, 0.06, 0.38), elbow=FRONT, roll=15, shrug=6))),
        (1.5, dict(pop=8, bend=0, h=0.93)),
        (2, dict(h=0.9, w=0.72, roll=7, side=18, twist=16, turn=26, tilt=7, bend=5, pop=4, look=16, head_tilt=10,
                 la=Arm((0.42, 0.06, 0.16), elbow=OUT, roll=35), ra=Arm((-0.1, -0.1, 0.36), elbow=(1, -0.5, 0), roll=10))),
        (2.5, dict(pop=-4, bend=10)),
        (3, dict(h=0.88, w=0.82, roll=8, side=22, twist=-19, turn=31, tilt=4, bend=-5, pop=10, look=22, head_tilt=12,
                 la=Arm((0.1, -0.4, 0.2), elbow=BENT, roll=20), ra=Arm((0.34, 0.22, 0.24), elbow=(0.9, -0.8, -0.2), roll=40))),
        (3.5, dict(pop=-4, bend=8)),
    ]  # fmt: skip
    return Choreography("bounce-groove", "Bounce groove", "Feet stay, knees ride the beat, shoulders answer.", 8, left, keys, bounce=0.055, nod=8)


def house_step() -> Choreography:
    # shuffle: side, cross behind, side on half beats, then a hop with the free knee up; jacking chest
    left = [
        Stand(0, 0.9, 0.12, 0.0, 18), Stand(1.5, 2.3, 0.36, -0.02, 20),
        Stand(3, 4.3, 0.16, 0.1, 12, arc=0.3, kick=(0.05, 0, 0.16)), Stand(4.75, 5.4, 0.2, -0.16, -4, heel=(24, 8, 26)),
        Stand(6, 7.55, -0.04, 0.0, 22),
    ]  # fmt: skip
    keys = [
        (0, dict(h=0.885, w=0.7, roll=-4, side=6, twist=20, turn=10, tilt=12, bend=16, pop=-10, look=-8,
                 la=Arm((0.34, -0.24, -0.2), elbow=BACK, flex=8), ra=Arm((-0.02, -0.06, 0.36), elbow=FRONT))),
        (0.5, dict(pop=9, bend=2, h=0.915)),
        (0.75, dict(w=0.3)),
        (1, dict(h=0.885, w=0.3, roll=4, side=-6, twist=-18, turn=-4, tilt=12, bend=16, pop=-10, look=6,
                 la=Arm((0.3, -0.14, 0.28), elbow=(1, 0, -0.2), flex=10), ra=Arm((0.34, -0.1, 0.1), elbow=OUT))),
        (1.5, dict(pop=9, bend=2, h=0.915, w=0.68)),
        (2, dict(h=0.875, w=0.66, roll=5, side=8, twist=14, turn=10, tilt=14, bend=18, pop=-12, look=-4,
                 la=Arm((0.2, -0.36, -0.28), elbow=BACK), ra=Arm((0.02, -0.2, 0.38), elbow=FRONT))),
        (2.5, dict(pop=10, bend=0, h=0.935, w=0.16)),
        (3, dict(h=0.895, w=0.55, roll=6, side=-10, twist=-24, turn=-8, tilt=5, bend=6, pop=-4, look=14,
                 la=Arm((0.2, 0.14, 0.3), elbow=(1, -0.6, 0), roll=20), ra=Arm((0.36, -0.2, -0.16), elbow=OUT))),
        (3.5, dict(pop=9, bend=2, h=0.925, w=0.8)),
    ]  # fmt: skip
    return Choreography("house-step", "House step", "Quick feet under a jacking chest.", 8, left, keys, bounce=0.05, nod=6)


def disco_point() -> Choreography:
    left = [
        Stand(0, 3.55, 0.14, 0.0, 18, heel=(12, 0, 20)),
        Stand(4, 4.5, 0.19, 0.1, 26, heel=(30, 30, 34)), Stand(5, 5.5, 0.14, 0.02, 20, heel=(26, 22, 26)),
        Stand(6, 6.5, 0.22, 0.09, 28, heel=(30, 30, 34)), Stand(7, 7.6, 0.06, 0.02, 20, heel=(26, 22, 26)),
    ]  # fmt: skip
    sky = Arm((0.27, 0.42, 0.1), elbow=(1, -0.4, -0.2), roll=10, flex=-6)
    across = Arm((-0.24, -0.34, 0.32), elbow=(0.8, -0.2, 0.5), roll=-20, flex=0)
    keys = [
        (0, dict(h=0.935, w=0.84, roll=9, side=15, twist=-14, turn=-4, tilt=0, bend=-5, look=-28, look_up=20, head_tilt=2, la=HIP, ra=sky)),
        (0.5, dict(h=0.945, w=0.78, roll=2)),
        (1, dict(h=0.915, w=0.86, roll=8, side=6, twist=18, turn=8, tilt=6, bend=10, look=20, look_up=-14, head_tilt=8, la=HIP, ra=across)),
        (1.5, dict(h=0.945, roll=1)),
        (2, dict(h=0.935, w=0.84, roll=10, side=16, twist=-16, turn=-6, tilt=0, bend=-6, look=-30, look_up=22, head_tilt=0,
                 la=Arm((0.04, -0.37, 0.12), elbow=(1, 0.05, -0.55), flex=35, dev=-20), ra=Arm((0.36, 0.34, 0.08), elbow=(1, -0.6, -0.2), flex=-8))),
        (3, dict(h=0.895, w=0.62, roll=-3, side=-2, twist=4, turn=0, tilt=9, bend=11, look=0, look_up=-4, head_tilt=-4,
                 la=Arm((-0.12, -0.22, 0.3), elbow=(1, -0.3, -0.1), roll=-10, flex=12), ra=Arm((-0.12, -0.04, 0.32), elbow=(1, -0.35, 0), roll=-20, flex=10))),
        (3.5, dict(h=0.915, w=0.4, la=Arm((-0.12, -0.04, 0.32), elbow=(1, -0.35, 0), roll=-20, flex=10),
                   ra=Arm((-0.12, -0.24, 0.27), elbow=(1, -0.3, -0.1), roll=-10, flex=12))),
    ]  # fmt: skip
    return Choreography("disco-point", "Disco point", "Point to the sky, point across, roll the arms.", 8, left, keys, bounce=0.035, nod=2)


def salsa_basic() -> Choreography:
    # on1: forward on the first beat, back on the fifth; the pause beats belong to the hips
    left = [
        Stand(0, 1.4, 0.08, 0.2, 12, heel=(10, 0, 30)), Stand(2, 4.5, 0.07, 0.02, 16, heel=(20, 0, 24)),
        Stand(5, 7.45, 0.1, 0.03, 16, heel=(20, 0, 26)),
    ]  # fmt: skip
    right = [Stand(6, 8.35, -0.08, 0.0, -16, heel=(20, 0, 24)), Stand(0.95, 3.45, -0.11, -0.03, -18, heel=(20, 0, 30)),
             Stand(4, 5.4, -0.08, -0.24, -22, heel=(26, 12, 30))]  # fmt: skip
    frame_l = Arm((0.06, -0.2, 0.32), elbow=(0.9, -0.8, -0.3), roll=10, flex=8)
    frame_r = Arm((0.1, -0.24, 0.26), elbow=(0.9, -0.6, -0.5), roll=10, flex=10)
    keys = [
        (0, dict(h=0.935, w=0.72, roll=8, side=13, twist=-29, turn=0, tilt=4, bend=0, look=2, head_tilt=2, la=Arm((0.24, -0.3, -0.1), elbow=BACK, roll=10), ra=Arm((-0.04, -0.06, 0.4), elbow=FRONT, roll=10))),
        (1, dict(h=0.945, w=0.24, roll=-11, side=-17, twist=19, turn=0, tilt=2, look=-4, head_tilt=-3, la=Arm((0.0, -0.1, 0.4), elbow=FRONT, roll=10), ra=Arm((0.24, -0.32, -0.1), elbow=BACK, roll=10))),
        (2, dict(h=0.95, w=0.72, roll=12, side=19, twist=-19, turn=8, tilt=1, look=8, head_tilt=4, la=frame_l, ra=Arm((0.42, 0.0, 0.16), elbow=OUT, roll=25))),
        (3, dict(h=0.955, w=0.86, roll=-5, side=-7, twist=13, turn=-8, look=14, head_tilt=-2, la=Arm((0.4, 0.1, 0.22), elbow=OUT, roll=25), ra=Arm((0.24, 0.38, 0.14), elbow=(1, -0.5, -0.1), roll=20))),
        (3.5, dict(roll=7, w=0.9)),
        (4, dict(h=0.925, w=0.42, roll=-11, side=-12, twist=32, turn=8, tilt=-2, bend=-3, look=0, la=Arm((-0.04, -0.08, 0.4), elbow=FRONT, roll=10), ra=Arm((0.24, -0.34, -0.14), elbow=BACK, roll=10))),
        (5, dict(h=0.945, w=0.76, roll=11, side=17, twist=-19, turn=0, tilt=2, look=4, head_tilt=3, la=Arm((0.26, -0.3, -0.1), elbow=BACK, roll=10), ra=Arm((0.0, -0.1, 0.4), elbow=FRONT, roll=10))),
        (6, dict(h=0.95, w=0.26, roll=-12, side=-19, twist=19, turn=-12, tilt=1, look=-10, head_tilt=-4, la=Arm((0.42, 0.02, 0.18), elbow=OUT, roll=25), ra=frame_r)),
        (7, dict(h=0.955, w=0.14, roll=5, side=7, twist=-13, turn=-4, look=-14, head_tilt=2, la=Arm((-0.02, 0.42, 0.1), elbow=(1, 0.1, 0.1), roll=0, flex=14), ra=Arm((0.2, -0.2, 0.24), elbow=BENT, roll=20))),
        (7.5, dict(roll=-7, w=0.12)),
    ]  # fmt: skip
    return Choreography("salsa-basic", "Salsa basic", "Forward and back with Cuban hips.", 8, left, keys, right=right, mirrored=False, bounce=0.02, nod=2)


def waltz_sway() -> Choreography:
    # balance steps in 3/4: side on one, rise on two, lower on three; mirrored every two bars
    left = [
        Stand(0, 4.4, 0.32, 0.0, 22, heel=(10, 0, 34)), Stand(5, 6.5, 0.12, -0.04, 22, heel=(36, 0, 24)),
        Stand(7, 8.6, -0.14, -0.1, 14, heel=(34, 30, 30)), Stand(9, 11.5, -0.02, 0.14, 20, heel=(14, 0, 30)),
    ]  # fmt: skip
    open_l = Arm((0.46, 0.04, 0.1), elbow=OUT, flex=-4, roll=10)
    keys = [
        (0, dict(h=0.85, w=0.7, roll=-4, side=22, twist=11, turn=26, tilt=4, bend=-4, look=26, look_up=2, head_tilt=10,
                 la=open_l, ra=Arm((0.02, 0.4, 0.2), elbow=UP, flex=16, roll=-10))),
        (1, dict(h=0.965, w=0.85, roll=5, side=31, twist=6, turn=19, tilt=0, bend=-8, look=32, look_up=10, head_tilt=12,
                 la=Arm((0.47, -0.06, 0.06), elbow=OUT, flex=-6), ra=Arm((-0.08, 0.44, 0.16), elbow=UP, flex=20, roll=-10))),
        (2, dict(h=0.93, w=0.86, roll=3, side=14, twist=-8, turn=0, bend=0, look=10, look_up=0, head_tilt=4,
                 la=Arm((0.3, -0.22, 0.24), elbow=BENT, roll=20), ra=Arm((0.2, 0.14, 0.36), elbow=FRONT, flex=8))),
        (3, dict(h=0.86, w=0.5, roll=2, side=-11, twist=25, turn=45, tilt=8, bend=8, look=-4, look_up=-10, head_tilt=-6,
                 la=Arm((0.0, -0.24, 0.36), elbow=(0.9, -0.5, -0.1), flex=14), ra=Arm((0.0, -0.16, 0.38), elbow=(0.9, -0.5, -0.1), flex=14))),
        (4, dict(h=0.95, w=0.34, roll=-4, side=-14, twist=8, turn=26, tilt=0, bend=-10, look=0, look_up=14, head_tilt=-8,
                 la=Arm((0.2, 0.3, 0.3), elbow=(0.9, -0.5, 0), flex=4), ra=Arm((0.16, 0.34, 0.28), elbow=(0.9, -0.5, 0), flex=4))),
        (5, dict(h=0.93, w=0.36, roll=-3, side=-6, twist=-6, turn=0, tilt=2, bend=-2, look=-12, look_up=4, head_tilt=-4,
                 la=Arm((0.34, 0.22, 0.22), elbow=OUT, flex=-4), ra=Arm((0.44, 0.06, 0.12), elbow=OUT, flex=-6))),
    ]  # fmt: skip
    return Choreography("waltz-sway", "Waltz sway", "Three in a bar: sink, rise and float.", 12, left, keys, bounce=0.0, nod=0, drag=8)


def hip_hop_rock() -> Choreography:
    left = [Stand(0, 2.4, 0.18, 0.2, 14, heel=(16, 0, 20)), Stand(3, 3.55, 0.3, -0.06, 32, heel=(12, 6, 16)), Stand(4, 7.5, 0.22, -0.14, 26, heel=(18, 0, 30))]
    keys = [
        (0, dict(h=0.86, w=0.7, roll=4, side=5, twist=26, turn=-8, tilt=20, bend=22, pop=-5, look=4, look_up=-2,
                 la=Arm((0.28, -0.06, -0.2), elbow=(0.4, 0.8, -0.8), flex=10), ra=Arm((-0.08, -0.16, 0.36), elbow=(1, -0.3, 0), flex=10))),
        (0.5, dict(h=0.89, bend=12, pop=6)),
        (1, dict(h=0.85, w=0.22, roll=-6, side=-8, twist=-20, turn=6, tilt=0, bend=-6, pop=8, look=0, look_up=6, head_tilt=-6,
                 la=Arm((-0.02, -0.08, 0.34), elbow=(1, -0.5, 0), roll=10), ra=Arm((0.26, -0.32, 0.1), elbow=(1, 0, -0.6), roll=20))),
        (1.5, dict(h=0.88, w=0.4, pop=-2)),
        (2, dict(h=0.84, w=0.68, roll=5, side=10, twist=22, turn=-4, tilt=18, bend=20, pop=-6, look=10, look_up=-4,
                 la=Arm((0.24, -0.16, -0.24), elbow=(0.4, 0.6, -0.8)), ra=Arm((0.04, -0.3, 0.36), elbow=(1, -0.2, 0)))),
        (2.5, dict(h=0.85, w=0.3, bend=8)),
        (3, dict(h=0.81, w=0.5, roll=0, side=0, twist=0, turn=0, tilt=10, bend=12, pop=6, look=0, look_up=4, head_tilt=0,
                 la=Arm((0.22, 0.12, 0.26), elbow=(1, -0.5, -0.2), roll=-10, flex=-10), ra=Arm((-0.1, -0.3, 0.3), elbow=(1, 0, -0.1), roll=-10))),
        (3.5, dict(h=0.88, pop=-6, bend=16,
                   la=Arm((-0.1, -0.3, 0.3), elbow=(1, 0, -0.1), roll=-10), ra=Arm((0.2, -0.04, 0.26), elbow=(1, -0.4, -0.2), flex=-10))),
    ]  # fmt: skip
    return Choreography("hip-hop-rock", "Hip-hop rock", "Low and wide: rock in, rock out, hit.", 8, left, keys, bounce=0.05, nod=8)


def kick_step() -> Choreography:
    # charleston family: step, kick, step back, touch
    left = [Stand(0, 2.5, 0.08, 0.1, 10, heel=(10, 0, 24)), Stand(3, 4.35, 0.09, -0.24, 14, heel=(30, 26, 40)),
            Stand(6, 7.5, 0.08, -0.12, 14, heel=(24, 0, 30), arc=0.34, kick=(0.02, 0.14, 1.15))]  # fmt: skip
    keys = [
        (0, dict(h=0.925, w=0.78, roll=5, side=4, twist=18, turn=-4, tilt=6, bend=6, look=0, la=Arm((0.14, -0.38, -0.3), elbow=BACK), ra=Arm((-0.06, -0.04, 0.4), elbow=FRONT))),
        (1, dict(h=0.925, w=0.98, roll=-6, side=-4, twist=-22, turn=2, tilt=-4, bend=6, look=4, la=Arm((0.02, 0.02, 0.44), elbow=FRONT), ra=Arm((0.28, -0.28, -0.3), elbow=BACK))),
        (2, dict(h=0.925, w=0.34, roll=-4, side=-6, twist=8, turn=0, tilt=4, bend=2, look=-6, la=Arm((0.3, -0.16, 0.1), elbow=OUT), ra=Arm((0.3, -0.2, 0.16), elbow=OUT))),
        (3, dict(h=0.895, w=0.3, roll=5, side=8, twist=22, turn=6, tilt=12, bend=14, look=8, head_tilt=5, la=Arm((0.24, -0.3, -0.32), elbow=BACK), ra=Arm((-0.02, 0.04, 0.4), elbow=FRONT))),
    ]  # fmt: skip
    return Choreography("kick-step", "Kick step", "Step, kick, step back, touch: Charleston's grandchild.", 8, left, keys, bounce=0.045, nod=3)


def wave_arms(phase: float) -> tuple[Arm, Arm]:
    """A bump that runs from the left fingers over the shoulders to the right fingers; phase 0..1."""

    def bump(place: float) -> float:
        return math.exp(-(((phase - place) / 0.17) ** 2))

    def arm(hand_at: float, elbow_at: float, shoulder_at: float) -> Arm:
        up = -0.12 + 0.42 * bump(hand_at) - 0.2 * bump(elbow_at)
        out = 0.46 - 0.12 * bump(elbow_at) - 0.08 * bump(hand_at)
        elbow = (0.0, 2.4 * bump(elbow_at) - 0.6, -0.8)
        flex = 22 - 66 * bump(hand_at) + 34 * bump(elbow_at)
        return Arm((out, up, 0.1), elbow=elbow, flex=flex, shrug=22 * bump(shoulder_at))

    return arm(0.05, 0.26, 0.42), arm(0.95, 0.74, 0.58)


def arm_waves() -> Choreography:
    left = [Stand(0, 2.4, 0.2, 0.02, 20, heel=(10, 0, 20)), Stand(3, 5.5, 0.1, -0.04, 14, heel=(18, 0, 22)), Stand(6, 7.5, 0.26, 0.04, 26, heel=(20, 0, 22))]
    keys = []
    for i in range(5):
        phase = i / 4
        la, ra = wave_arms(phase * 1.1 - 0.05)
        sway = 1 - 2 * phase
        keys.append((i / 2, dict(
            w=0.5 + 0.3 * sway, roll=9 * sway, side=18 * sway, twist=-18 * sway, turn=8 * sway, look=36 * sway, head_tilt=10 * sway,
            h=0.93 if i % 2 else 0.9, pop=10 if i % 2 else -6, bend=0 if i % 2 else 5, look_up=4, la=la, ra=ra)))
    keys += [
        (3, dict(h=0.93, w=0.3, roll=-3, side=-6, twist=20, turn=4, pop=10, bend=-8, look=-8, head_tilt=-8, look_up=14,
                 la=Arm((0.1, 0.34, 0.26), elbow=UP, flex=-20), ra=Arm((0.08, -0.2, 0.34), elbow=FRONT, flex=16))),
        (3.5, dict(h=0.89, w=0.24, roll=-8, side=-16, twist=-4, turn=-4, pop=-8, bend=12, look=-24, head_tilt=-10, look_up=-6,
                 la=Arm((0.2, 0.02, 0.4), elbow=FRONT, flex=20), ra=Arm((0.26, 0.32, 0.24), elbow=UP, flex=-20))),
    ]  # fmt: skip
    return Choreography("arm-waves", "Arm waves", "A wave runs from hand to hand through the shoulders.", 8, left, keys, bounce=0.03, nod=3, drag=3)


def slow_contemporary() -> Choreography:
    left = [
        Stand(0, 4.3, 0.4, 0.06, 38, heel=(18, 0, 26)), Stand(5, 11.2, 0.12, 0.02, 18, heel=(24, 0, 34)),
        Stand(12, 15.2, 0.1, -0.2, 24, heel=(30, 6, 30)),
    ]  # fmt: skip
    keys = [
        (0, dict(h=0.79, w=0.7, roll=3, side=20, twist=-6, turn=12, tilt=4, bend=-6, look=30, look_up=4, head_tilt=12,
                 la=Arm((0.42, -0.12, 0.18), elbow=OUT, roll=20), ra=Arm((0.06, 0.46, 0.1), elbow=UP, flex=-4))),
        (1, dict(h=0.76, w=0.78, roll=5, side=32, twist=-4, turn=16, bend=0, look=34, look_up=-4, head_tilt=18,
                 la=Arm((0.36, -0.26, 0.2), elbow=(0.4, 0.2, -1), roll=30), ra=Arm((-0.06, 0.5, 0.06), elbow=UP, flex=-10))),
        (2, dict(h=0.81, w=0.5, roll=0, side=6, twist=14, turn=0, tilt=12, bend=26, pop=-6, look=0, look_up=-20, head_tilt=2,
                 la=Arm((0.2, -0.2, 0.34), elbow=(1, 0, -0.2), flex=14), ra=Arm((0.06, 0.1, 0.46), elbow=FRONT, flex=6))),
        (3, dict(h=0.85, w=0.24, roll=-4, side=-10, twist=26, turn=-20, tilt=2, bend=6, look=-16, look_up=-4, head_tilt=-6,
                 la=Arm((-0.14, -0.1, 0.36), elbow=(1, -0.3, 0), flex=20), ra=Arm((0.44, -0.02, 0.12), elbow=OUT, flex=-6))),
        (4, dict(h=0.93, w=0.16, roll=-6, side=-18, twist=-16, turn=-28, tilt=-4, bend=-18, look=-20, look_up=28, head_tilt=-10,
                 la=Arm((0.02, 0.48, 0.14), elbow=UP, flex=-8), ra=Arm((0.44, 0.16, -0.1), elbow=OUT, roll=30, flex=-14))),
        (5, dict(h=0.87, w=0.44, roll=-2, side=-6, twist=-24, turn=-8, tilt=6, bend=4, look=-24, look_up=0, head_tilt=-4,
                 la=Arm((0.3, 0.18, 0.34), elbow=FRONT, flex=4), ra=Arm((0.36, -0.24, -0.18), elbow=OUT, flex=8))),
        (6, dict(h=0.81, w=0.5, roll=0, side=2, twist=0, turn=12, tilt=-14, bend=46, pop=-8, look=4, look_up=-32, head_tilt=0,
                 la=Arm((-0.1, -0.14, 0.38), elbow=(1, 0.1, -0.1), roll=-30, flex=26), ra=Arm((-0.1, -0.2, 0.36), elbow=(1, 0, -0.1), roll=-30, flex=26))),
        (7, dict(h=0.9, w=0.3, roll=-5, side=-8, twist=8, turn=0, tilt=-2, bend=-16, look=-6, look_up=24, head_tilt=-6,
                 la=Arm((0.4, 0.14, 0.14), elbow=OUT, roll=40, flex=-12), ra=Arm((0.38, 0.06, 0.2), elbow=OUT, roll=40, flex=-12))),
    ]  # fmt: skip
    return Choreography("slow-contemporary", "Slow contemporary", "Long lines: reach, fold, open.", 16, left, keys, bounce=0.0, nod=0, drag=10)


def vogue_hits() -> Choreography:
    left = [
        Stand(0, 1.5, 0.1, 0.14, 26, heel=(14, 0, 30)), Stand(2, 4.5, 0.22, 0.0, 30, heel=(10, 0, 26)),
        Stand(5, 6.5, 0.05, -0.06, 22, heel=(22, 0, 30)), Stand(7, 7.6, 0.2, 0.1, 36, heel=(40, 40, 40)),
    ]  # fmt: skip
    keys = [
        (0, dict(h=0.92, w=0.6, roll=8, side=6, twist=-20, turn=24, tilt=0, bend=-6, look=-24, look_up=6, head_tilt=-4,
                 la=Arm((0.08, 0.3, 0.2), elbow=UP, flex=30, roll=-20), ra=Arm((0.44, 0.08, 0.06), elbow=OUT, flex=-30))),
        (0.6, dict(la=Arm((0.1, 0.3, 0.2), elbow=UP, flex=30, roll=-20), ra=Arm((0.44, 0.1, 0.06), elbow=OUT, flex=-30))),
        (1, dict(h=0.94, w=0.3, roll=-9, side=-14, twist=10, turn=4, bend=-2, look=20, look_up=0, head_tilt=8,
                 la=Arm((-0.06, 0.14, 0.2), elbow=(1, 0.2, 0.1), flex=30), ra=Arm((0.0, -0.38, 0.12), elbow=(1, 0.05, -0.5), flex=35, dev=-20))),
        (1.6, dict(la=Arm((-0.04, 0.16, 0.2), elbow=(1, 0.2, 0.1), flex=30))),
        (2, dict(h=0.86, w=0.55, roll=4, side=12, twist=24, turn=-10, tilt=6, bend=4, look=20, look_up=-6, head_tilt=6,
                 la=Arm((0.48, 0.12, 0.04), elbow=OUT, flex=-34), ra=Arm((-0.02, 0.2, -0.02), elbow=(1, 0.45, 0.1), flex=30))),
        (2.6, dict(la=Arm((0.48, 0.14, 0.06), elbow=OUT, flex=-34), ra=Arm((-0.02, 0.22, 0.0), elbow=(1, 0.45, 0.1), flex=30))),
        (3, dict(h=0.94, w=0.9, roll=10, side=18, twist=-24, turn=-24, tilt=0, bend=-8, look=34, look_up=8, head_tilt=8,
                 la=Arm((-0.12, -0.24, 0.28), elbow=(1, -0.1, 0), flex=20), ra=Arm((0.04, 0.46, 0.12), elbow=UP, flex=30, roll=-20))),
        (3.6, dict(ra=Arm((0.08, 0.44, 0.12), elbow=UP, flex=30, roll=-20))),
    ]  # fmt: skip
    return Choreography("vogue-hits", "Vogue hits", "A picture on every beat: lines, angles, attitude.", 8, left, keys, bounce=0.02, nod=0, drag=3)


def choreographies() -> list[Choreography]:
    """All starting clips, in the order of the menu."""
    plans = [
        two_step(), bounce_groove(), house_step(), disco_point(), hip_hop_rock(), kick_step(),
        salsa_basic(), arm_waves(), vogue_hits(), slow_contemporary(), waltz_sway(),
    ]  # fmt: skip
    assert all(isinstance(p.base, Body) for p in plans)
    return plans
