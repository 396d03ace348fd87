"""The page's dance of curves in Blender, where that is installed (`pip install bpy`): its keys, and what is between them."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from spec import SPEC

ROOT = Path(__file__).resolve().parents[2]
JOINTS = SPEC["skeleton"]["joints"]
# Frames a second of the scene; keys lie between frames too.
FPS = 30


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """Blender with the file open, and what it should show."""
    bpy = pytest.importorskip("bpy", reason="Blender is not installed: pip install bpy")
    if shutil.which("npx") is None or not (ROOT / "node_modules").is_dir():
        pytest.skip("node writes the files: run npm install first")
    folder = tmp_path_factory.mktemp("curves")
    subprocess.run(["npx", "tsx", "export/tests/curve_files.ts", str(folder)], cwd=ROOT, check=True,
                   capture_output=True, timeout=300)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = FPS
    bpy.ops.import_scene.gltf(filepath=str(folder / "curves.glb"))
    return bpy, json.loads((folder / "curves-truth.json").read_text())


def key_times(bpy) -> dict[str, np.ndarray]:
    """Key times of every animated property, seconds; all its numbers have the same."""
    times: dict[str, np.ndarray] = {}
    for curve in bpy.data.actions[0].layers[0].strips[0].channelbags[0].fcurves:
        own = np.array([point.co[0] for point in curve.keyframe_points]) / FPS
        np.testing.assert_array_equal(times.setdefault(curve.data_path, own), own)
        assert {point.interpolation for point in curve.keyframe_points} == {"BEZIER"}
    return times


def distances(bpy, wanted: dict) -> np.ndarray:
    """How far each bone's head is from where it should be at each time, metres, Y up. [times, 24]"""
    armature = next(each for each in bpy.data.objects if each.type == "ARMATURE")
    seen = []
    for time in wanted["times"]:
        frame = time * FPS
        bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
        heads = [armature.matrix_world @ armature.pose.bones[name].head for name in JOINTS]
        seen.append([[x, z, -y] for x, y, z in heads])
    return np.linalg.norm(np.array(seen) - np.array(wanted["joints"]).reshape(-1, 24, 3), axis=-1)


def test_every_key_pose_is_a_key_and_exact(scene):
    bpy, truth = scene
    times = key_times(bpy)
    assert len(times) == 25
    for own in times.values():
        for wanted in [truth["keyPoses"], truth["knots"]["times"]]:
            # A key pose is on its frame.
            assert max(np.abs(own - time).min() for time in wanted) < 0.5 / FPS + 1e-4
    assert distances(bpy, truth["knots"]).max() < 1e-4


def test_few_keys_are_no_knots(scene):
    bpy, truth = scene
    knots = len(truth["knots"]["times"])
    assert sum(len(own) for own in key_times(bpy).values()) < 1.3 * 25 * knots


def test_between_the_keys_it_is_within_a_centimetre(scene):
    bpy, truth = scene
    assert distances(bpy, truth["middles"]).max() < 0.01
