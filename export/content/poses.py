"""Authors public/library/poses.json: the library of key poses, each described in words of the body (see rig.py).

    python export/content/poses.py [--sheet FILE.png]
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from poses_more import ballet, ballroom, basics, floor_and_air, krump_and_pop, vogue
from rig import Arm, Body, Foot, Solved, forward, mirrored, rz, settle, solve

OUT = Path(__file__).resolve().parents[2] / "public/library/poses.json"

UP_ELBOW = (1.0, -0.1, 0.25)  # arm overhead: the elbow looks out and a little forward
SIDE_ELBOW = (0.0, -0.55, -1.0)  # arm to the side: the elbow looks down and back
FRONT_ELBOW = (0.7, -1.0, -0.1)  # arm in front: the elbow looks down and out
HIP_HAND = Arm((-0.01, -0.4, 0.1), elbow=(1, 0.05, -0.55), flex=35, dev=-20)


def pose_list() -> list[tuple[str, str, str, Body, float | None]]:
    """(id, name, group, body, share of the weight on the left foot; None = no balancing, e.g. in the air)."""
    p: list[tuple[str, str, str, Body, float | None]] = []

    def add(name: str, group: str, body: Body, weight: float | None) -> None:
        p.append((name.lower().replace(" ", "-").replace("'", ""), name, group, body, weight))

    basics(add)

    # -- Groove: relaxed, one hip out, the whole body rides the beat
    add("Hip lean", "Groove", Body(
        left=Foot(0.13, 0.0, 18), right=Foot(-0.17, 0.1, -32, heel=24),
        h=0.915, roll=9, side=17, turn=-6, twist=14, tilt=2, look=24, look_up=-4, head_tilt=7,
        la=Arm((0.13, -0.36, 0.17), elbow=(0.8, -0.5, -0.7), roll=20), ra=Arm((0.17, -0.14, 0.3), elbow=(0.9, -0.7, -0.3), roll=35, flex=15)), 0.88)
    add("Snap low", "Groove", Body(
        left=Foot(0.26, -0.02, 22), right=Foot(-0.16, 0.02, -20),
        h=0.83, roll=-8, side=-18, tilt=12, bend=12, twist=-24, turn=10, look=-22, look_up=-12, head_tilt=-9,
        la=Arm((0.2, -0.34, 0.22), elbow=(1, -0.1, -0.6), roll=30, flex=20), ra=Arm((0.22, -0.3, -0.12), elbow=(0.8, 0.3, -0.8), flex=-15)), 0.28)
    add("Shoulder pop", "Groove", Body(
        left=Foot(0.16, 0.06, 14, heel=20), right=Foot(-0.14, -0.05, -24),
        h=0.9, roll=-7, side=-13, turn=22, twist=-34, tilt=5, bend=2, look=-28, head_tilt=-7,
        la=Arm((0.04, -0.4, 0.16), elbow=(0.9, 0, -0.7), shrug=17, roll=10), ra=Arm((0.12, -0.42, -0.12), elbow=(0.7, 0.1, -0.9), shrug=-3, flex=-25)), 0.2)
    add("Two-step sway", "Groove", Body(
        left=Foot(0.2, 0.0, 16), right=Foot(-0.03, -0.07, -14, heel=32),
        h=0.9, roll=7, side=11, turn=8, twist=-16, tilt=4, bend=5, look=-10, head_tilt=9,
        la=Arm((0.06, -0.22, 0.31), elbow=(1, -0.6, -0.4), roll=25), ra=Arm((0.25, -0.27, 0.08), elbow=(0.7, -0.1, -0.9), roll=15)), 0.92)
    add("Easy lean back", "Groove", Body(
        left=Foot(0.14, 0.24, 14, heel=0), right=Foot(-0.13, -0.08, -34),
        h=0.86, roll=-5, side=-8, tilt=-9, bend=-12, turn=-14, twist=18, look=8, look_up=6, head_tilt=-8,
        la=Arm((0.12, -0.2, 0.33), elbow=FRONT_ELBOW, roll=60, flex=-20), ra=Arm((0.2, -0.33, 0.18), elbow=(1, -0.1, -0.6), roll=40, flex=-12)), 0.16)

    # -- Hip-hop: low, grounded, sharp angles
    add("B-boy stance", "Hip-hop", Body(
        left=Foot(0.21, 0.03, 26), right=Foot(-0.2, -0.06, -30),
        h=0.87, roll=-5, side=-9, tilt=-3, bend=-7, turn=16, twist=-14, look=-14, look_up=4, head_tilt=-11,
        la=Arm((-0.28, -0.21, 0.19), elbow=(1, -0.55, 0.1), roll=0, flex=12), ra=Arm((-0.22, -0.14, 0.24), elbow=(1, -0.6, 0.1), roll=10, flex=25)), 0.36)
    add("Rock forward", "Hip-hop", Body(
        left=Foot(0.17, 0.24, 12), right=Foot(-0.19, -0.2, -24, heel=34),
        h=0.78, roll=4, side=6, tilt=24, bend=24, turn=-10, twist=26, look=6, look_up=-4, pop=-4,
        la=Arm((0.26, -0.12, -0.22), elbow=(0.4, 0.8, -0.8), flex=20), ra=Arm((-0.06, -0.16, 0.38), elbow=(1, -0.3, 0), roll=-10, flex=20)), 0.78)
    add("Block it", "Hip-hop", Body(
        left=Foot(0.3, 0.02, 32), right=Foot(-0.25, 0.02, -30),
        h=0.72, roll=3, side=8, tilt=8, bend=8, turn=-6, twist=24, look=26, look_up=-2, head_tilt=4,
        la=Arm((0.26, 0.12, 0.2), elbow=(0.9, -0.8, -0.2), roll=-10, flex=-30), ra=Arm((-0.16, -0.3, 0.26), elbow=(1, 0.2, -0.1), roll=-20, flex=-25)), 0.62)
    add("Body roll", "Hip-hop", Body(
        left=Foot(0.12, 0.05, 14), right=Foot(-0.13, -0.04, -16, heel=14),
        h=0.86, tilt=-14, bend=-4, pop=17, roll=4, side=4, turn=-28, twist=12, look=24, look_up=16,
        la=Arm((0.2, -0.38, -0.16), elbow=(0.6, 0, -1), flex=-25), ra=Arm((0.22, -0.36, -0.14), elbow=(0.6, 0, -1), flex=-25)), 0.62)
    add("Running man", "Hip-hop", Body(
        left=Foot(0.09, 0.24, 4, y=0.42, pitch=24), right=Foot(-0.09, -0.07, -10, heel=8),
        h=0.88, tilt=6, bend=10, roll=5, turn=-4, twist=22, look=0, look_up=-6,
        la=Arm((0.1, -0.24, -0.28), elbow=(0.5, 0.1, -1), flex=10), ra=Arm((-0.02, -0.1, 0.32), elbow=(0.9, -1, -0.2), flex=10)), 0.0)

    # -- House: torso jacks, loose legs
    add("Jack", "House", Body(
        left=Foot(0.18, 0.04, 20), right=Foot(-0.17, -0.04, -20, heel=10),
        h=0.8, tilt=20, bend=30, pop=-13, roll=-4, side=-6, turn=12, twist=-14, look=-4, look_up=-14,
        la=Arm((0.26, -0.14, 0.28), elbow=(1, 0.1, -0.3), roll=-10, flex=25), ra=Arm((0.28, -0.2, 0.22), elbow=(1, 0.1, -0.3), roll=-10, flex=25)), 0.45)
    add("Loose legs", "House", Body(
        left=Foot(0.2, 0.14, 42, y=0.31, pitch=30, knee=(0.75, 0.3, 0.8)), right=Foot(-0.08, -0.02, -18),
        h=0.87, tilt=3, bend=6, roll=7, side=-10, turn=-10, twist=-16, look=22, look_up=-8, head_tilt=-5,
        la=Arm((0.3, -0.2, 0.16), elbow=(0.9, -0.2, -0.7), roll=40, flex=-12), ra=Arm((0.2, 0.02, 0.33), elbow=(1, -0.8, -0.1), roll=20, flex=15)), 0.0)
    add("Skate", "House", Body(
        left=Foot(0.24, 0.12, 30), right=Foot(-0.26, -0.26, -34, heel=52),
        h=0.77, tilt=16, bend=14, roll=6, side=-6, turn=18, twist=-30, look=10, look_up=-2, head_tilt=6,
        la=Arm((0.26, -0.22, -0.24), elbow=(0.3, 0.5, -1), flex=15), ra=Arm((-0.05, -0.1, 0.42), elbow=(1, -0.5, 0), roll=20, flex=5)), 0.9)
    add("Cross stomp", "House", Body(
        left=Foot(-0.06, 0.2, -4), right=Foot(-0.15, -0.1, -38, heel=36),
        h=0.84, tilt=7, bend=9, roll=6, side=12, turn=-20, twist=30, look=16, look_up=-10, head_tilt=6,
        la=Arm((0.3, -0.02, -0.16), elbow=SIDE_ELBOW, roll=20, flex=-15), ra=Arm((-0.08, -0.24, 0.3), elbow=(1, -0.4, -0.2), flex=20)), 0.78)

    # -- Disco
    add("Point to the sky", "Disco", Body(
        left=Foot(0.18, 0.06, 28, heel=28), right=Foot(-0.15, -0.02, -16),
        h=0.925, roll=-10, side=-16, turn=-8, twist=-12, look=-28, look_up=26, head_tilt=-6, bend=-5,
        la=HIP_HAND, ra=Arm((0.24, 0.43, 0.1), elbow=(1, -0.4, -0.2), roll=10, flex=-6)), 0.1)
    add("Point across", "Disco", Body(
        left=Foot(0.17, -0.02, 20), right=Foot(-0.16, 0.07, -26, heel=26),
        h=0.89, roll=9, side=13, turn=8, twist=16, tilt=5, bend=7, look=22, look_up=-16, head_tilt=8,
        la=HIP_HAND, ra=Arm((-0.26, -0.3, 0.34), elbow=(0.8, -0.2, 0.5), roll=-20, flex=0)), 0.86)
    add("Night fever", "Disco", Body(
        left=Foot(0.24, 0.02, 32), right=Foot(-0.16, 0.0, -14),
        h=0.88, roll=-9, side=-20, turn=0, twist=8, bend=-3, look=34, look_up=4, head_tilt=-4,
        la=Arm((0.49, 0.1, 0.02), elbow=SIDE_ELBOW, flex=-10, roll=30), ra=Arm((-0.02, 0.2, -0.03), elbow=(1, 0.45, 0.1), flex=30)), 0.12)
    add("Roll the arms", "Disco", Body(
        left=Foot(0.13, 0.0, 14, heel=16), right=Foot(-0.14, 0.02, -16),
        h=0.84, roll=-7, side=-9, turn=-14, twist=-18, tilt=10, bend=10, look=14, look_up=-3, head_tilt=5,
        la=Arm((-0.12, -0.03, 0.33), elbow=(1, -0.35, 0), roll=-20, flex=10), ra=Arm((-0.12, -0.23, 0.27), elbow=(1, -0.3, -0.2), roll=-10, flex=15)), 0.2)
    add("Hustle hip", "Disco", mirrored(Body(
        left=Foot(0.04, 0.2, 26, heel=6), right=Foot(-0.1, -0.08, -32),
        h=0.915, roll=-11, side=-15, turn=26, twist=-34, look=-24, look_up=4, head_tilt=-8, bend=-4,
        la=Arm((0.22, 0.24, 0.2), elbow=(1, -0.7, -0.3), roll=40, flex=-30), ra=Arm((-0.01, -0.4, 0.08), elbow=(1, 0.1, -0.4), flex=35, dev=-20))), 0.88)

    # -- Latin
    add("Cuban hip", "Latin", Body(
        left=Foot(0.05, 0.02, 24), right=Foot(-0.17, 0.13, -30, heel=36, knee=(0.15, 0.1, 1)),
        h=0.925, roll=12, side=21, turn=-18, twist=26, look=18, look_up=2, head_tilt=6, bend=-4,
        la=Arm((0.25, -0.12, 0.27), elbow=(0.9, -0.7, -0.3), roll=-10, flex=-15), ra=Arm((0.3, -0.02, 0.12), elbow=(0.7, -0.8, -0.6), roll=0, flex=-25)), 0.9)
    add("New Yorker", "Latin", Body(
        left=Foot(-0.02, 0.26, 18), right=Foot(-0.12, -0.22, -42, heel=48),
        h=0.885, roll=5, side=-4, turn=34, twist=16, look=14, look_up=8, bend=-8,
        la=Arm((0.44, 0.16, -0.14), elbow=SIDE_ELBOW, roll=40, flex=-12), ra=Arm((0.1, 0.1, 0.47), elbow=FRONT_ELBOW, roll=30, flex=-8)), 0.86)
    add("Salsa back break", "Latin", Body(
        left=Foot(0.1, 0.12, 12), right=Foot(-0.1, -0.26, -26, heel=34),
        h=0.86, roll=-8, side=-9, turn=6, twist=-20, tilt=-2, look=-2, look_up=0, head_tilt=4,
        la=Arm((0.05, -0.2, 0.32), elbow=(0.9, -0.8, -0.3), roll=10, flex=10), ra=Arm((0.14, -0.26, 0.06), elbow=(0.8, -0.2, -1), roll=10, flex=15)), 0.4)
    add("Crown turn", "Latin", Body(
        left=Foot(0.03, 0.05, 22, heel=34), right=Foot(-0.05, -0.1, -26, heel=40),
        h=0.955, roll=7, side=9, turn=-40, twist=20, look=58, look_up=8, bend=-6,
        la=Arm((0.02, 0.4, 0.13), elbow=(1, 0.1, 0.2), roll=20, flex=25), ra=Arm((-0.14, -0.18, 0.29), elbow=(1, -0.6, 0), roll=15, flex=20)), 0.62)
    add("Flamenco", "Latin", Body(
        left=Foot(0.06, -0.03, 28), right=Foot(-0.06, 0.1, -22, heel=30, knee=(0.1, 0.1, 1)),
        h=0.93, roll=7, side=10, turn=24, twist=-36, bend=-9, look=-44, look_up=-12, pop=6,
        la=Arm((0.1, 0.44, 0.13), elbow=(1, 0.3, -0.2), roll=-30, flex=30), ra=Arm((-0.1, -0.28, 0.27), elbow=(1, -0.2, 0.1), roll=-20, flex=30)), 0.92)

    # -- Ballet and contemporary
    add("Arabesque", "Ballet", mirrored(Body(
        left=Foot(0.06, 0.0, 30), right=Foot(-0.14, -0.86, -50, y=0.98, point=52, knee=(-1, -0.6, -0.1)),
        h=0.945, turn=-14, tilt=36, roll=-6, bend=-46, side=4, look=20, look_up=8,
        la=Arm((0.46, 0.1, 0.14), elbow=SIDE_ELBOW, roll=10, flex=-5), ra=Arm((0.08, 0.26, 0.44), elbow=(0.9, -0.6, -0.1), flex=-6))), 0)
    add("Passe", "Ballet", Body(
        left=Foot(0.06, 0.1, 50, y=0.58, point=52, knee=(1, 0.2, 0.4)), right=Foot(-0.05, 0.0, -34, heel=42),
        h=0.985, roll=5, side=1, bend=-3, look=24, look_up=8, head_tilt=-4,
        la=Arm((-0.03, 0.46, 0.16), elbow=(1, 0.2, 0.2), roll=-10, flex=18), ra=Arm((0.42, -0.04, 0.22), elbow=(0.2, -0.3, -1), flex=12)), 0.0)
    add("Attitude", "Ballet", Body(
        left=Foot(0.34, -0.42, 40, y=0.72, point=50, knee=(1, 0.25, -0.1)), right=Foot(-0.04, 0.0, -30),
        h=0.93, turn=12, tilt=14, roll=10, bend=-24, twist=6, side=-10, look=-30, look_up=12,
        la=Arm((0.42, 0.02, 0.2), elbow=(0.1, -0.3, -1), flex=10), ra=Arm((0.05, 0.43, 0.13), elbow=(1, 0.2, 0.2), flex=18)), 0.0)
    add("Deep fourth", "Ballet", Body(
        left=Foot(0.1, 0.44, 34), right=Foot(-0.12, -0.34, -36, heel=26),
        h=0.79, turn=4, tilt=8, roll=3, bend=-14, side=12, twist=14, look=34, look_up=14,
        la=Arm((0.47, 0.08, -0.02), elbow=SIDE_ELBOW, flex=-8), ra=Arm((0.0, 0.44, 0.14), elbow=(1, 0.2, 0.2), flex=15)), 0.7)
    add("Side reach", "Contemporary", Body(
        left=Foot(0.46, 0.0, 46), right=Foot(-0.38, 0.0, -24),
        h=0.72, roll=6, side=34, turn=0, twist=-8, bend=4, look=36, look_up=-4, head_tilt=18,
        la=Arm((0.36, -0.24, 0.2), elbow=(0.4, 0.2, -1), roll=30), ra=Arm((-0.02, 0.49, 0.06), elbow=(1, 0.1, 0.2), flex=-8)), 0.78)
    add("Contraction", "Contemporary", Body(
        left=Foot(0.1, 0.06, 12, heel=24), right=Foot(-0.12, -0.08, -16),
        h=0.78, tilt=-20, bend=56, pop=-12, turn=-20, twist=10, roll=-3, look=16, look_up=-34,
        la=Arm((-0.12, -0.1, 0.4), elbow=(1, 0.1, -0.1), roll=-30, flex=30), ra=Arm((-0.1, -0.18, 0.38), elbow=(1, 0, -0.1), roll=-30, flex=30)), 0.42)
    add("Open release", "Contemporary", Body(
        left=Foot(0.1, 0.3, 20), right=Foot(-0.12, -0.16, -34, heel=12),
        h=0.86, tilt=-5, bend=-26, roll=4, side=8, twist=20, turn=-12, look=24, look_up=42,
        la=Arm((0.42, 0.2, -0.2), elbow=(0, -0.8, -0.7), roll=60, flex=-20), ra=Arm((0.4, -0.2, -0.24), elbow=(0, -0.6, -0.9), roll=60, flex=-20)), 0.45)
    add("Tilt", "Contemporary", Body(
        left=Foot(0.85, 0.14, 60, y=1.08, point=50, knee=(-0.3, 0.9, 0.5)), right=Foot(-0.04, 0, -30),
        h=0.925, roll=32, side=-8, turn=-6, twist=4, bend=2, look=-30, look_up=-6, head_tilt=-14,
        la=Arm((0.18, 0.48, 0.04), elbow=(1, -0.2, -0.2), flex=-6), ra=Arm((0.42, -0.28, 0.08), elbow=(0.3, 0.1, -1), flex=-10)), 0.0)
    add("Kneeling reach", "Contemporary", Body(
        left=Foot(0.14, 0.32, 16), right=Foot(-0.14, -0.5, -4, y=0.075, point=58, knee=(-0.1, -0.5, 1)),
        h=0.545, tilt=4, bend=-10, roll=2, side=8, twist=20, turn=6, look=6, look_up=30,
        la=Arm((0.4, -0.22, -0.18), elbow=(0.2, -0.3, -1), flex=-15), ra=Arm((0.04, 0.38, 0.35), elbow=(0.9, -0.5, 0), flex=-8)), None)

    # -- Street: floor work and freezes
    add("Toprock", "Street", Body(
        left=Foot(-0.12, 0.24, -22), right=Foot(-0.1, -0.14, -30, heel=50),
        h=0.84, tilt=8, bend=6, roll=5, turn=-36, twist=40, side=4, look=32, look_up=-2,
        la=Arm((0.42, -0.08, -0.2), elbow=SIDE_ELBOW, flex=-10), ra=Arm((-0.12, -0.04, 0.37), elbow=(1, -0.6, 0.1), flex=15)), 0.66)
    add("Floor freeze", "Street", Body(
        left=Foot(0.6, 0.36, 36, y=0.115, pitch=-36, knee=(0.35, 1, 0.2)), right=Foot(-0.1, 0.16, -24, heel=44),
        h=0.33, tilt=-20, roll=14, bend=6, side=-34, twist=-16, turn=8, look=20, look_up=10, head_tilt=6,
        la=Arm((0.28, 0.42, 0.14), elbow=(1, -0.2, -0.2), flex=-10), ra=Arm(world=(-0.36, 0.075, -0.3), elbow=(0.7, 0.1, -0.8), flex=-70)), None)
    add("Low spread", "Street", Body(
        left=Foot(0.26, 0.1, 40, heel=30), right=Foot(-0.58, 0.04, -34, roll=-16),
        h=0.46, x=0.1, tilt=44, bend=34, roll=-4, side=6, twist=-26, turn=0, look=-14, look_up=4,
        la=Arm(world=(0.2, 0.08, 0.52), elbow=(0.9, 0.2, -0.4), flex=-60), ra=Arm((0.46, 0.14, -0.16), elbow=SIDE_ELBOW, flex=-10)), None)

    # -- Jumps
    add("Star jump", "Jumps", Body(
        left=Foot(0.54, -0.02, 40, y=0.56, point=45), right=Foot(-0.5, 0.04, -40, y=0.5, point=45),
        h=1.2, roll=3, side=-4, bend=-10, turn=4, look=0, look_up=16,
        la=Arm((0.36, 0.36, 0.03), elbow=(0.8, -0.8, -0.4), roll=20, flex=-10), ra=Arm((0.4, 0.31, 0.02), elbow=(0.8, -0.8, -0.4), roll=20, flex=-10)), None)
    add("Leap", "Jumps", Body(
        left=Foot(0.05, 0.72, 6, y=0.84, point=50, knee=(0.1, 1, 0.2)), right=Foot(-0.12, -0.72, -24, y=0.76, point=52, knee=(-0.4, -1, 0)),
        h=1.15, tilt=6, bend=-18, turn=0, twist=18, side=-2, look=6, look_up=10,
        la=Arm((0.44, 0.18, -0.1), elbow=SIDE_ELBOW, flex=-6), ra=Arm((0.06, 0.18, 0.44), elbow=FRONT_ELBOW, flex=-6)), None)
    add("Tuck kick", "Jumps", Body(
        left=Foot(0.12, 0.6, 4, y=0.86, point=38, knee=(0.1, 1, 0.3)), right=Foot(-0.12, -0.22, -10, y=0.62, point=42, knee=(-0.2, 0, 1)),
        h=1.12, tilt=-6, bend=22, twist=20, turn=-12, look=12, look_up=-4,
        la=Arm((0.3, -0.02, -0.28), elbow=(0.2, 0, -1), flex=-6), ra=Arm((0.1, -0.04, 0.44), elbow=(0.8, -0.7, 0), flex=8)), None)

    # -- Finish
    add("Big finish", "Finish", Body(
        left=Foot(0.34, 0.1, 36), right=Foot(-0.36, -0.1, -34, heel=16),
        h=0.8, roll=5, side=6, bend=-10, turn=-8, twist=12, look=10, look_up=18,
        la=Arm((0.3, 0.4, 0.06), elbow=(1, -0.5, -0.2), roll=20, flex=-12), ra=Arm((0.46, -0.08, 0.14), elbow=SIDE_ELBOW, roll=30, flex=-15)), 0.66)
    add("Bow", "Finish", Body(
        left=Foot(0.05, 0.2, 14), right=Foot(-0.14, -0.2, -30, heel=24),
        h=0.8, tilt=34, bend=34, turn=10, twist=-14, look=0, look_up=-44,
        la=Arm((0.42, 0.06, -0.2), elbow=(0.2, 0.2, -1), roll=20, flex=-10), ra=Arm((-0.14, -0.3, 0.26), elbow=(1, 0, -0.1), flex=25)), 0.6)
    add("Hat tip", "Finish", Body(
        left=Foot(0.1, 0.12, 20, heel=46, knee=(-0.25, 0, 1)), right=Foot(-0.08, -0.04, -26),
        h=0.925, roll=-8, side=-12, turn=-16, twist=-6, bend=4, look=4, look_up=-20, head_tilt=-9,
        la=Arm((0.3, -0.34, -0.04), elbow=(0.7, 0.1, -0.8), flex=-35), ra=Arm((0.0, 0.2, 0.22), elbow=(1, 0.1, 0.1), flex=12)), 0.08)
    add("Cool stop", "Finish", Body(
        left=Foot(0.26, 0.1, 38, heel=0), right=Foot(-0.08, -0.06, -24),
        h=0.89, roll=-9, side=-14, turn=30, twist=-24, bend=-8, look=-26, look_up=4, head_tilt=-8,
        la=Arm((0.42, -0.2, 0.2), elbow=(0.3, -0.2, -1), roll=60, flex=-20), ra=Arm((-0.18, -0.06, 0.25), elbow=(1, -0.4, 0.1), flex=25)), 0.16)
    for more in (krump_and_pop, vogue, ballroom, ballet, floor_and_air):
        more(add)
    # a group keeps together, wherever its poses were described
    order = list(dict.fromkeys(group for _, _, group, _, _ in p))
    return sorted(p, key=lambda pose: order.index(pose[2]))


def reference_poses() -> list[tuple[str, str, str, Solved]]:
    """The two stances that rigs are drawn in, exactly symmetrical: arms level, and arms 45 degrees down."""
    out = []
    for ident, name, down in (("t-pose", "T-pose", 0), ("a-pose", "A-pose", 45)):
        local = np.tile(np.eye(3), (24, 1, 1))
        local[16], local[17] = rz(-down), rz(down)
        points, world = forward(local, np.array([0, 0.955, 0]))
        out.append((ident, name, "Basics", Solved(local, points[0], points, world, [])))
    return out


def solved_poses() -> list[tuple[str, str, str, Solved]]:
    """All poses, balanced and solved."""
    out = reference_poses()
    for ident, name, group, body, weight in pose_list():
        # a little free peel of the back heel keeps legs straight without floating
        out.append((ident, name, group, solve(settle(body, weight, peel=6), peel=6)))
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sheet", help="also draw contact sheets FILE-0.png, FILE-1.png, ...")
    options = parser.parse_args()
    poses = solved_poses()
    document = {
        "version": 1,
        "poses": [
            {"id": i, "name": n, "group": g, "rotations": [round(float(v), 4) + 0.0 for v in s.rotations()]}
            for i, n, g, s in poses
        ],
    }
    OUT.parent.mkdir(parents=True, exist_ok=True)
    lines = ",\n".join(json.dumps(p, separators=(",", ":")) for p in document["poses"])
    OUT.write_text('{"version":1,"poses":[\n' + lines + "\n]}\n")
    for ident, _, _, s in poses:
        low = s.points[:, 1].min()
        notes = s.warnings + ([f"lowest joint {low:.3f} m"] if low < 0.02 else [])
        if notes:
            print(ident, notes)
    print(len(poses), "poses,", OUT.stat().st_size, "bytes")
    if options.sheet:
        from render import draw, sheet

        for start in range(0, len(poses), 12):
            items = [(f"{g}: {n}", [draw(s.points, s.world, a) for a in (0, -35, -90)]) for i, n, g, s in poses[start : start + 12]]
            sheet(items, 3, f"{options.sheet}-{start // 12}.png")


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    main()
