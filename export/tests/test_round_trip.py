"""The page's motion files in other people's readers: numpy and, where it is installed, Blender (`pip install bpy`)."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from spec import SPEC

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> tuple[Path, dict]:
    """A synthetic dance in every format, and its true joints."""
    if shutil.which("npx") is None or not (ROOT / "node_modules").is_dir():
        pytest.skip("node writes the files: run npm install first")
    folder = tmp_path_factory.mktemp("motion")
    subprocess.run(["npx", "tsx", "export/tests/motion_files.ts", str(folder)], cwd=ROOT, check=True,
                   capture_output=True, timeout=120)
    truth = json.loads((folder / "truth.json").read_text())
    truth["joints"] = np.array(truth["joints"]).reshape(-1, 24, 3)
    truth["root"] = np.array(truth["root"]).reshape(-1, 3)
    truth["rotations"] = np.array(truth["rotations"]).reshape(-1, 24, 3)
    return folder, truth


def joints_of(rotations: np.ndarray, root: np.ndarray) -> np.ndarray:
    """Forward kinematics in plain numpy. rotations [N, 24, 3] axis-angle, root [N, 3] metres -> [N, 24, 3]."""
    local = matrices(rotations)
    parents = SPEC["skeleton"]["parents"]
    offsets = np.array(SPEC["skeleton"]["offsets"])
    world, places = [local[:, 0]], [root]
    for joint in range(1, 24):
        above = parents[joint]
        world.append(world[above] @ local[:, joint])
        places.append(places[above] + np.einsum("nij,j->ni", world[above], offsets[joint]))
    return np.stack(places, axis=1)


def matrices(axis_angle: np.ndarray) -> np.ndarray:
    """Rodrigues' formula. [..., 3] radians -> [..., 3, 3]."""
    angle = np.linalg.norm(axis_angle, axis=-1)[..., None, None]
    x, y, z = np.moveaxis(axis_angle / np.maximum(angle[..., 0], 1e-12), -1, 0)
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*x.shape, 3, 3)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def test_numpy_reads_the_npz_without_pickle(files):
    folder, truth = files
    data = np.load(folder / "dance.npz", allow_pickle=False)
    frames = len(truth["joints"])
    assert {name: data[name].shape for name in data.files} == {
        "smpl_poses": (frames, 72), "smpl_trans": (frames, 3), "smpl_scaling": (1,),
        "poses": (frames, 156), "trans": (frames, 3), "betas": (16,), "gender": (), "mocap_framerate": (), "posebeat": (),
    }
    assert json.loads(str(data["posebeat"])) == truth["origin"]
    assert str(data["gender"]) == "neutral"
    assert float(data["mocap_framerate"]) == truth["fps"]
    assert data["smpl_poses"].dtype == np.float32


def test_the_aist_arrays_are_the_dance(files):
    folder, truth = files
    data = np.load(folder / "dance.npz")
    np.testing.assert_allclose(data["smpl_poses"].reshape(-1, 24, 3), truth["rotations"], atol=1e-6)
    joints = joints_of(data["smpl_poses"].reshape(-1, 24, 3), data["smpl_trans"] / data["smpl_scaling"])
    assert np.linalg.norm(joints - truth["joints"], axis=-1).max() < 1e-3


def test_the_amass_arrays_are_the_dance_on_another_axis(files):
    folder, truth = files
    data = np.load(folder / "dance.npz")
    body = np.zeros((len(data["poses"]), 24, 3))
    body[:, :22] = data["poses"][:, :66].reshape(-1, 22, 3)
    # Our hands have joints that SMPL-H has fingers for: compare what both have.
    joints = joints_of(body, data["trans"])[:, :22]
    upright = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # Z up -> Y up
    assert np.linalg.norm(joints @ upright.T - truth["joints"][:, :22], axis=-1).max() < 1e-3
    assert not data["poses"][:, 66:].any()


def test_json_is_read_without_any_reader_of_ours(files):
    folder, truth = files
    raw = json.loads((folder / "dance.json").read_text())
    assert raw["joints"] == SPEC["skeleton"]["joints"]
    assert raw["origin"] == truth["origin"]
    np.testing.assert_allclose(np.array(raw["root"]), truth["root"], atol=1e-6)
    quaternions = np.array(raw["rotations"]).reshape(len(truth["root"]), 24, 4)
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=-1), 1, atol=1e-5)


def in_blender(bpy, joints: list[str], frames: list[float]) -> np.ndarray:
    """Where the imported bones begin at each frame of the scene, Y up. [N, 24, 3]"""
    armature = next(each for each in bpy.data.objects if each.type == "ARMATURE")
    out = []
    for frame in frames:
        bpy.context.scene.frame_set(int(frame))
        heads = [armature.matrix_world @ armature.pose.bones[name].head for name in joints]
        out.append([[x, z, -y] for x, y, z in heads])
    return np.array(out)


@pytest.mark.parametrize("name,scale,step", [("dance.bvh", 1, 1), ("dance-60-cm.bvh", 0.01, 2)])
def test_blender_reads_the_bvh(files, name, scale, step):
    bpy = pytest.importorskip("bpy", reason="Blender is not installed: pip install bpy")
    folder, truth = files
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_anim.bvh(filepath=str(folder / name), global_scale=scale, update_scene_fps=True)
    count = len(truth["joints"])
    scene = bpy.context.scene
    assert scene.render.fps / scene.render.fps_base == pytest.approx(truth["fps"] * step, abs=0.01)
    start, end = bpy.data.actions[0].frame_range
    assert (start, end) == (1, (count - 1) * step + 1)
    seen = in_blender(bpy, SPEC["skeleton"]["joints"], [1 + i * step for i in range(count)])
    assert np.linalg.norm(seen - truth["joints"], axis=-1).max() < 1e-3


@pytest.mark.parametrize("kind", ["glb", "fbx"])
def test_blender_reads_glb_and_fbx(files, kind):
    bpy = pytest.importorskip("bpy", reason="Blender is not installed: pip install bpy")
    folder, truth = files
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = int(truth["fps"])
    read = bpy.ops.import_scene.gltf if kind == "glb" else bpy.ops.import_scene.fbx
    read(filepath=str(folder / f"dance.{kind}"))
    start, end = bpy.data.actions[0].frame_range
    count = len(truth["joints"])
    assert end - start == pytest.approx(count - 1, abs=1e-3)
    seen = in_blender(bpy, SPEC["skeleton"]["joints"], [start + i for i in range(count)])
    assert np.linalg.norm(seen - truth["joints"], axis=-1).max() < 1e-3
