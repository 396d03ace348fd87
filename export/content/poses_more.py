"""Poses of the library beyond the dancer's first forty: basics, krump and popping, vogue, ballroom, more ballet, floor and jumps."""

from __future__ import annotations

from collections.abc import Callable

from rig import Arm, Body, Foot, mirrored

#: add(name, group, body, share of the weight on the left foot; None = no balancing)
Add = Callable[[str, str, Body, float | None], None]

SIDE = (0.0, -0.55, -1.0)  # arm to the side: the elbow looks down and back
FRONT = (0.7, -1.0, -0.1)  # arm in front: the elbow looks down and out
OVERHEAD = (1.0, -0.1, 0.25)  # arm overhead: the elbow looks out and a little forward
ON_HIP = Arm((-0.01, -0.4, 0.1), elbow=(1, 0.05, -0.55), flex=35, dev=-20)


def basics(add: Add) -> None:
    """Plain positions of the body: where most people begin."""
    add("Relaxed", "Basics", Body(
        left=Foot(0.1, 0.03, 12), right=Foot(-0.1, -0.02, -14), h=0.945, roll=2, side=2, bend=3, twist=3, look_up=-2,
        la=Arm((0.08, -0.5, 0.06)), ra=Arm((0.07, -0.49, 0.09))), 0.5)
    add("Contrapposto", "Basics", Body(
        left=Foot(0.16, 0.1, 26), right=Foot(-0.07, -0.02, -12), h=0.945, roll=-8, side=-13, turn=6, twist=-9,
        look=16, look_up=2, head_tilt=6,
        la=Arm((0.12, -0.47, 0.08)), ra=Arm((0.08, -0.5, 0.02))), 0.14)
    add("Hands on hips", "Basics", Body(
        left=Foot(0.17, 0.02, 22), right=Foot(-0.17, 0.0, -20), h=0.93, roll=3, side=4, bend=-3, look=-8, look_up=4,
        la=ON_HIP, ra=ON_HIP), 0.56)
    add("Walk", "Basics", Body(
        left=Foot(0.07, 0.28, 6), right=Foot(-0.07, -0.26, -8, heel=40), h=0.9, tilt=3, turn=0, roll=2, twist=-16,
        look=2, la=Arm((0.1, -0.42, -0.22), elbow=(0.4, 0, -1)), ra=Arm((0.06, -0.4, 0.27), elbow=(0.4, -0.6, -0.8))), 0.6)
    add("Forward lunge", "Basics", Body(
        left=Foot(0.1, 0.46, 4), right=Foot(-0.1, -0.46, -6, heel=54), h=0.63, tilt=3, bend=-3, twist=4, look_up=2,
        la=ON_HIP, ra=ON_HIP), 0.6)
    add("Side lunge", "Basics", Body(
        left=Foot(0.36, 0.0, 32), right=Foot(-0.4, 0.0, -14, roll=-14), h=0.68, roll=0, side=8, tilt=16, bend=8, look=14, look_up=-2,
        la=Arm((0.16, -0.32, 0.3), elbow=(1, 0, -0.6)), ra=Arm((0.46, -0.12, 0.06), elbow=SIDE, flex=-8)), 0.8)
    add("Squat", "Basics", Body(
        left=Foot(0.24, 0.0, 26), right=Foot(-0.24, 0.02, -28), h=0.5, tilt=26, bend=10, twist=6, side=3, look_up=-2,
        la=Arm((-0.04, 0.0, 0.5), elbow=FRONT, flex=4), ra=Arm((-0.02, -0.02, 0.49), elbow=FRONT, flex=4)), 0.5)
    add("Chair sit", "Basics", Body(
        left=Foot(0.1, 0.1, 8), right=Foot(-0.12, 0.16, -10), h=0.56, tilt=20, bend=12, roll=2, twist=-6, look=8, look_up=2,
        la=Arm((0.02, -0.22, 0.4), elbow=(0.8, -0.5, -0.5), flex=10), ra=Arm((0.02, -0.24, 0.39), elbow=(0.8, -0.5, -0.5), flex=10)), 0.5)
    add("Kneel", "Basics", Body(
        left=Foot(0.13, 0.36, 8), right=Foot(-0.12, -0.42, -4, heel=62), h=0.5, tilt=4, bend=6, turn=0, twist=10, look_up=-4,
        la=Arm((-0.03, -0.3, 0.36), elbow=(1, -0.2, -0.4), flex=15), ra=Arm((0.12, -0.46, 0.06))), None)
    add("Reach up", "Basics", Body(
        left=Foot(0.1, 0.03, 14, heel=24), right=Foot(-0.1, -0.02, -14, heel=20), h=0.98, bend=-5, side=2, roll=2, look_up=30, twist=4,
        la=Arm((0.02, 0.5, 0.08), elbow=OVERHEAD, flex=-6), ra=Arm((0.07, 0.48, 0.14), elbow=OVERHEAD, flex=-6)), 0.5)
    add("Star", "Basics", Body(
        left=Foot(0.44, 0.0, 34), right=Foot(-0.42, 0.0, -32), h=0.85, roll=2, bend=-3, side=3, look_up=8,
        la=Arm((0.4, 0.32, 0.02), elbow=(0.8, -0.8, -0.4), roll=30, flex=-8), ra=Arm((0.43, 0.27, 0.02), elbow=(0.8, -0.8, -0.4), roll=30, flex=-8)), 0.52)
    add("Clap", "Basics", Body(
        left=Foot(0.19, 0.02, 18), right=Foot(-0.12, 0.0, -12, heel=18), h=0.91, roll=4, side=7, turn=6, twist=8, bend=3, look=8, look_up=-4, head_tilt=5,
        la=Arm((-0.15, -0.04, 0.36), elbow=(1, -0.7, -0.2), roll=-40, flex=-18), ra=Arm((-0.17, -0.02, 0.36), elbow=(1, -0.7, -0.2), roll=-40, flex=-18)), 0.84)
    add("Point ahead", "Basics", Body(
        left=Foot(0.14, 0.18, 8), right=Foot(-0.14, -0.16, -28, heel=12), h=0.89, tilt=4, turn=14, twist=-6, look=-12,
        la=ON_HIP, ra=Arm((-0.02, 0.05, 0.52), elbow=(1, -0.8, 0), flex=0)), 0.62)
    add("Big wave", "Basics", Body(
        left=Foot(0.12, 0.0, 16), right=Foot(-0.14, 0.04, -18), h=0.94, roll=-4, side=-9, twist=-6, look=-8, look_up=6, head_tilt=-6,
        la=Arm((0.09, -0.5, 0.04)), ra=Arm((0.3, 0.38, 0.1), elbow=(0.8, -0.9, -0.2), roll=10, dev=18, flex=-6)), 0.4)


def krump_and_pop(add: Add) -> None:
    """Krump (big, driven from the chest) and popping (joint by joint)."""
    add("Krump stomp", "Krump & pop", Body(
        left=Foot(0.32, 0.2, 26, y=0.42, pitch=14), right=Foot(-0.16, -0.06, -26), h=0.84, tilt=16, bend=24, roll=9, side=-6, turn=-8, twist=-20,
        look=8, look_up=2, la=Arm((0.34, -0.18, 0.24), elbow=(0.8, 0.3, -0.5), roll=-30, flex=20), ra=Arm((0.3, -0.3, -0.2), elbow=(0.6, 0.2, -1), flex=15)), 0.0)
    add("Chest pop", "Krump & pop", Body(
        left=Foot(0.24, 0.04, 24), right=Foot(-0.22, -0.06, -26), h=0.84, tilt=6, bend=-20, pop=24, roll=-3, side=-5, twist=10, look=4, look_up=28,
        la=Arm((0.3, -0.3, -0.22), elbow=(0.4, 0.2, -1), roll=30, flex=25), ra=Arm((0.28, -0.33, -0.2), elbow=(0.4, 0.2, -1), roll=30, flex=25)), 0.5)
    add("Krump jab", "Krump & pop", Body(
        left=Foot(0.22, 0.26, 14), right=Foot(-0.22, -0.2, -34, heel=26), h=0.77, tilt=14, bend=16, roll=4, turn=-20, twist=44, look=22, look_up=-2,
        la=Arm((0.14, -0.18, 0.16), elbow=(0.8, -0.1, -0.9), roll=-10, flex=15), ra=Arm((-0.1, 0.0, 0.49), elbow=(1, -0.4, 0), roll=-30, flex=5)), 0.72)
    add("Robot", "Krump & pop", Body(
        left=Foot(0.11, 0.02, 4), right=Foot(-0.11, -0.02, -4), h=0.925, tilt=4, turn=0, look=26, look_up=-2, twist=-4,
        la=Arm((0.16, -0.26, 0.26), elbow=(0.4, -1, -0.4), roll=10, flex=0), ra=Arm((0.26, 0.22, 0.14), elbow=(0.9, -0.9, 0.1), roll=-10, flex=0)), 0.5)
    add("Puppet", "Krump & pop", Body(
        left=Foot(0.14, 0.02, -12, heel=18, knee=(-0.3, 0.1, 1)), right=Foot(-0.14, 0.0, 14, heel=4, knee=(0.3, 0.1, 1)), h=0.88, tilt=6, bend=14, side=-9, roll=3, look=-14, look_up=-24, head_tilt=-16,
        la=Arm((0.3, -0.16, 0.12), elbow=(0.7, 0.9, -0.3), roll=-10, flex=50), ra=Arm((0.24, -0.28, 0.14), elbow=(0.8, 0.7, -0.3), roll=-10, flex=45)), 0.42)
    add("Arm wave", "Krump & pop", Body(
        left=Foot(0.17, 0.0, 20), right=Foot(-0.15, 0.02, -18, heel=12), h=0.9, roll=5, side=-8, twist=4, look=34, look_up=-4, head_tilt=-5,
        la=Arm((0.44, 0.1, 0.12), elbow=(0.05, 1, -0.5), roll=-20, flex=48), ra=Arm((0.45, -0.1, 0.14), elbow=(0.1, -1, -0.4), roll=-10, flex=-38)), 0.66)
    add("Box tut", "Krump & pop", Body(
        left=Foot(0.14, 0.02, 14), right=Foot(-0.14, 0.0, -12), h=0.91, tilt=2, roll=3, side=4, turn=-8, twist=4, look=6, look_up=-2,
        la=Arm((-0.06, 0.02, 0.3), elbow=(1, 0.2, 0.1), roll=-20, flex=8), ra=Arm((0.12, 0.22, 0.26), elbow=(0.8, -1, 0.2), roll=0, flex=52)), 0.6)
    add("Lock", "Krump & pop", Body(
        left=Foot(0.2, 0.04, 26), right=Foot(-0.2, 0.0, -26), h=0.78, tilt=10, bend=12, pop=6, roll=-4, side=-8, look_up=4, twist=-4,
        la=Arm((0.24, -0.28, 0.2), elbow=(1, 0.6, -0.3), roll=-20, flex=30), ra=Arm((0.26, -0.24, 0.22), elbow=(1, 0.6, -0.3), roll=-20, flex=30)), 0.46)


def vogue(add: Add) -> None:
    """Lines, frames and the floor."""
    add("Face frame", "Vogue", Body(
        left=Foot(0.05, 0.14, 20, heel=20, knee=(-0.2, 0, 1)), right=Foot(-0.1, -0.06, -30), h=0.93, roll=-8, side=-10, turn=18, twist=-12, bend=-4,
        look=-6, look_up=6, head_tilt=-6, la=Arm((-0.06, 0.1, 0.19), elbow=(1, -0.5, 0.3), roll=-10, flex=-40), ra=Arm((-0.06, 0.34, 0.1), elbow=(1, 0.25, 0.1), flex=30)), 0.1)
    add("Catwalk", "Vogue", Body(
        left=Foot(-0.02, 0.3, 8), right=Foot(-0.03, -0.26, -14, heel=52), h=0.905, roll=10, side=13, turn=-6, twist=22, bend=-8, look=-6, look_up=6,
        la=ON_HIP, ra=Arm((0.16, -0.46, -0.06), elbow=(0.5, 0, -1), flex=-30)), 0.72)
    add("Over the top", "Vogue", Body(
        left=Foot(0.2, 0.02, 34), right=Foot(-0.12, 0.02, -20), h=0.9, roll=-8, side=-15, turn=-10, twist=-10, bend=-4, look=28, look_up=2, head_tilt=-6,
        la=Arm((-0.1, 0.38, 0.1), elbow=(1, 0.35, 0.2), roll=-10, flex=55), ra=Arm((-0.02, 0.22, -0.04), elbow=(1, 0.6, 0.1), flex=35)), 0.16)
    add("Profile", "Vogue", Body(
        left=Foot(0.1, 0.22, 14, heel=38), right=Foot(-0.1, -0.1, -30), h=0.9, turn=58, tilt=-6, bend=-14, roll=4, twist=-16, look=-4, look_up=14,
        la=Arm((0.2, 0.2, 0.36), elbow=(0.8, -0.8, 0), flex=-40), ra=Arm((0.16, -0.4, -0.22), elbow=(0.3, 0, -1), flex=-40)), 0.1)
    add("Duckwalk", "Vogue", Body(
        left=Foot(0.1, 0.56, 4, y=0.2, pitch=-20), right=Foot(-0.08, 0.02, -22, heel=66), h=0.47, tilt=0, bend=6, turn=-4, twist=10, look=-10, look_up=2,
        la=Arm((0.02, 0.12, 0.44), elbow=(0.8, -0.6, 0), roll=-20, flex=42), ra=Arm((0.36, 0.16, 0.22), elbow=(0.4, -1, -0.4), flex=-40)), 0.0)
    add("Dip", "Vogue", Body(
        left=Foot(0.1, 0.52, 4, y=0.78, point=50, knee=(0.1, 1, -0.6)), right=Foot(-0.12, 0.32, -10), h=0.13, tilt=-84, bend=-14, side=4, twist=6, look_up=84,
        la=Arm((0.46, 0.2, 0.08), elbow=(0, -1, 0.2), flex=-10), ra=Arm((0.2, 0.44, 0.02), elbow=(1, 0.1, 0.1), flex=-10)), None)


def ballroom(add: Add) -> None:
    """Frames and figures of a couple's dance, danced alone."""
    hold_left = Arm((0.34, 0.13, 0.3), elbow=(0.6, -1, -0.3), roll=10, flex=-10)
    hold_right = Arm((0.05, -0.02, 0.34), elbow=(1, -0.05, 0.1), roll=0, flex=10)
    add("Waltz hold", "Ballroom", Body(
        left=Foot(0.09, 0.16, 4), right=Foot(-0.08, -0.12, -8, heel=16), h=0.94, side=-4, bend=-6, twist=6, look=32, look_up=6,
        la=hold_left, ra=hold_right), 0.64)
    add("Promenade", "Ballroom", Body(
        left=Foot(0.34, 0.1, 44), right=Foot(-0.1, -0.02, -2, heel=20), h=0.87, turn=24, twist=-18, side=-5, bend=-6, look=34, look_up=4,
        la=Arm((0.47, 0.1, 0.16), elbow=SIDE, roll=20, flex=-8), ra=hold_right), 0.7)
    add("Oversway", "Ballroom", Body(
        left=Foot(0.44, 0.06, 42), right=Foot(-0.42, 0.0, -16, roll=-16), h=0.72, roll=-4, side=-32, turn=10, twist=-8, bend=-10, look=-34, look_up=12, head_tilt=-14,
        la=Arm((0.46, 0.2, 0.1), elbow=SIDE, roll=20, flex=-10), ra=Arm((0.12, 0.0, 0.36), elbow=(1, -0.1, 0.1), flex=10)), 0.7)
    add("Tango corte", "Ballroom", Body(
        left=Foot(0.1, 0.46, 10), right=Foot(-0.12, -0.3, -34, heel=24), h=0.76, tilt=-4, bend=-12, roll=4, turn=-6, twist=16, side=4, look=34, look_up=2,
        la=Arm((0.38, 0.06, 0.3), elbow=(0.5, -1, -0.4), flex=-10), ra=Arm((0.04, -0.06, 0.34), elbow=(1, -0.1, 0.1), flex=10)), 0.16)
    add("Paso doble", "Ballroom", Body(
        left=Foot(0.06, 0.1, 12, heel=32), right=Foot(-0.06, -0.04, -14), h=0.93, tilt=-4, bend=-20, pop=8, roll=-3, turn=26, twist=14, look=-14, look_up=-8,
        la=Arm((0.18, 0.42, 0.18), elbow=(1, -0.2, 0), roll=-20, flex=35), ra=Arm((0.34, 0.28, 0.2), elbow=(1, -0.5, -0.1), roll=-20, flex=35)), 0.12)
    add("Curtsy", "Ballroom", Body(
        left=Foot(0.06, 0.14, 30), right=Foot(0.12, -0.3, -34, heel=52), h=0.7, tilt=10, bend=10, roll=-2, side=3, turn=-6, look=4, look_up=-22, head_tilt=6,
        la=Arm((0.38, -0.3, 0.08), elbow=(0.3, 0, -1), roll=20, flex=-15), ra=Arm((0.36, -0.32, 0.08), elbow=(0.3, 0, -1), roll=20, flex=-15)), 0.62)


def ballet(add: Add) -> None:
    """Positions at the barre and one turn."""
    add("First position", "Ballet", Body(
        left=Foot(0.07, 0.0, 52), right=Foot(-0.07, 0.0, -52), h=0.95, bend=-2, look=18, look_up=4, twist=2,
        la=Arm((0.46, -0.06, 0.18), elbow=(0.1, -0.4, -1), flex=8), ra=Arm((0.1, -0.41, 0.23), elbow=(1, 0, -0.5), flex=14)), 0.5)
    add("Grand plie", "Ballet", Body(
        left=Foot(0.28, 0.0, 58), right=Foot(-0.28, 0.0, -58), h=0.6, bend=-3, side=6, look=24, look_up=4, twist=3,
        la=Arm((0.48, -0.02, 0.14), elbow=(0.1, -0.4, -1), flex=5), ra=Arm((0.0, 0.45, 0.17), elbow=(1, 0.2, 0.2), flex=14)), 0.5)
    add("Tendu", "Ballet", Body(
        left=Foot(0.26, 0.06, 50, heel=38), right=Foot(-0.06, 0.0, -48), h=0.94, roll=2, bend=-3, side=-3, look=30, look_up=6,
        la=Arm((0.47, 0.06, 0.16), elbow=(0.1, -0.4, -1), flex=6), ra=Arm((0.44, -0.08, 0.22), elbow=(0.2, -0.3, -1), flex=10)), 0.0)
    add("Pirouette", "Ballet", mirrored(Body(
        left=Foot(0.05, 0.12, 46, y=0.56, point=52, knee=(1, 0.2, 0.5)), right=Foot(-0.05, 0.0, -32, heel=46), h=0.985, roll=4, bend=-2, turn=-30, look=56, look_up=4,
        la=Arm((-0.08, -0.16, 0.37), elbow=(1, -0.1, 0.1), flex=16), ra=Arm((-0.08, -0.16, 0.37), elbow=(1, -0.1, 0.1), flex=16))), 1.0)


def floor_and_air(add: Add) -> None:
    """Hands on the floor, or nothing on it."""
    add("Plank", "Street", Body(
        left=Foot(0.08, -0.82, 0, y=0.16, pitch=64), right=Foot(-0.11, -0.81, 0, y=0.32, point=30, knee=(-0.1, -1, 0.2)), h=0.42, tilt=73, bend=2, twist=2, look_up=-48,
        la=Arm(world=(0.22, 0.075, 0.52), elbow=(0.6, -1, -0.2), flex=-74), ra=Arm(world=(-0.22, 0.075, 0.5), elbow=(0.6, -1, -0.2), flex=-74)), None)
    add("Crab", "Street", Body(
        left=Foot(0.2, 0.46, 14), right=Foot(-0.14, 0.76, -8, y=0.6, pitch=-10, knee=(0, 1, 0.1)), h=0.33, tilt=-50, bend=10, twist=0, look_up=16,
        la=Arm(world=(0.24, 0.075, -0.4), elbow=(0.4, 0.2, -1), flex=-62), ra=Arm(world=(-0.24, 0.075, -0.4), elbow=(0.4, 0.2, -1), flex=-62)), None)
    add("Front split", "Street", Body(
        left=Foot(0.07, 0.77, 6, y=0.09, point=44, knee=(0.2, 1, 0.1)), right=Foot(-0.07, -0.74, -14, y=0.09, point=50, knee=(-0.8, -1, -0.2)), h=0.18, tilt=30, bend=-32, twist=14, look_up=10,
        la=Arm((0.36, 0.34, 0.06), elbow=(0.8, -0.8, -0.3), flex=-10), ra=Arm((0.4, 0.26, 0.14), elbow=(0.8, -0.8, -0.3), flex=-10)), None)
    add("Floor sit", "Street", Body(
        left=Foot(0.16, 0.42, 8, knee=(0.15, 1, 0.4)), right=Foot(-0.06, 0.78, -10, y=0.08, pitch=-45, knee=(0, 1, 0.1)), h=0.12, tilt=-22, bend=10, roll=2, twist=16, look=10, look_up=4,
        la=Arm((0.04, -0.16, 0.4), elbow=(1, -0.3, -0.3), flex=20), ra=Arm(world=(-0.28, 0.075, -0.34), elbow=(0.4, 0.1, -1), flex=-60)), None)
    add("Handstand", "Street", Body(
        left=Foot(0.1, 0.12, 0, y=1.62, point=40, knee=(0.3, 0.2, -1)), right=Foot(-0.12, -0.42, 0, y=1.5, point=40, knee=(-0.2, 0.2, -1)), h=1.09, tilt=178, bend=-12, twist=3, look_up=0,
        la=Arm(world=(0.2, 0.08, 0.1), elbow=(0.8, 0.2, 0.6), flex=-78), ra=Arm(world=(-0.2, 0.08, 0.1), elbow=(0.8, 0.2, 0.6), flex=-78)), None)
    add("Tuck jump", "Jumps", Body(
        left=Foot(0.11, 0.14, 6, y=0.78, point=38, knee=(0.2, 0.8, 1)), right=Foot(-0.11, 0.1, -8, y=0.76, point=38, knee=(-0.2, 0.8, 1)), h=1.2, tilt=6, bend=22, twist=5, look_up=6,
        la=Arm((0.36, 0.2, 0.24), elbow=(0.6, -0.9, -0.3), flex=-6), ra=Arm((0.42, 0.12, 0.2), elbow=(0.6, -0.9, -0.3), flex=-6)), None)
    add("Toe touch", "Jumps", Body(
        left=Foot(0.72, 0.38, 40, y=1.24, point=48, knee=(0.3, 1, 0.2)), right=Foot(-0.74, 0.34, -40, y=1.2, point=48, knee=(-0.3, 1, 0.2)), h=1.2, tilt=2, bend=24, twist=3, look_up=8,
        la=Arm((0.42, -0.04, 0.3), elbow=(0.5, -0.8, -0.3), flex=-4), ra=Arm((0.36, 0.02, 0.37), elbow=(0.5, -0.8, -0.3), flex=-4)), None)
    add("Stag leap", "Jumps", Body(
        left=Foot(0.08, 0.18, 6, y=0.8, point=48, knee=(0.2, 0.7, 1)), right=Foot(-0.14, -0.68, -24, y=0.9, point=52, knee=(-0.4, -1, 0)), h=1.16, tilt=4, bend=-16, twist=-8, look_up=16,
        la=Arm((0.42, 0.24, 0.08), elbow=SIDE, flex=-8), ra=Arm((0.04, 0.47, 0.14), elbow=OVERHEAD, flex=-8)), None)
