"""Writes tests/golden/*: small arrays that vitest and pytest both check, so that Python and TypeScript cannot drift apart.

    python export/golden.py --out tests/golden

Everything in them is made up (samples.py); no recorded dance is in them. Numbers are computed in float64 where the model
is not involved. `tolerance` stands in each file.
"""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

import curves
import dance_metrics
import danceformer_data
import metrics
from export_onnx import compress, run_onnx, to_onnx, write_arrays
from loss import key_weight
from model import INPUT_NAMES, OUTPUT_NAME, KeyPoseDancer, LocalPositionalEmbedding, ModelConfig, positional_encoding
from rotation import (
    angle_between,
    axis_angle_to_matrix,
    axis_angle_to_quaternion,
    heading,
    matrix_to_quaternion,
    matrix_to_six_d,
    quaternion_to_axis_angle,
    slerp,
)
from samples import randomise, synthetic_inputs, synthetic_motion
from skeleton import forward_kinematics, mirror_motion, world_rotations
from spec import FPS, JOINT_COUNT, ROTATION_SIZE, SPEC, spec_hash
from windows import key_distances, to_local_frame


def rounded(values: Tensor, digits: int = 9) -> list:
    """Nested lists of rounded numbers, for JSON."""
    def walk(item):
        return [walk(i) for i in item] if isinstance(item, list) else round(item, digits) if isinstance(item, float) else item

    return walk(values.tolist())


def rotations() -> dict:
    """Axis-angle, quaternion, 6D, SLERP, heading and angle of hand-picked and random rotations, edge cases first."""
    rng = torch.Generator().manual_seed(1)
    picked = torch.tensor(
        [[0, 0, 0], [1e-9, 0, 0], [math.pi / 2, 0, 0], [0, math.pi / 2, 0], [0, 0, -math.pi / 2], [0, 3.14, 0], [2, 2, 0.5]],
        dtype=torch.float64,
    )
    axis_angle = torch.cat([picked, torch.randn(9, 3, dtype=torch.float64, generator=rng)])
    quaternion = axis_angle_to_quaternion(axis_angle)
    matrix = axis_angle_to_matrix(axis_angle)
    other = quaternion.roll(3, 0)
    fraction = torch.linspace(0, 1, len(axis_angle), dtype=torch.float64)[:, None]
    return {
        "tolerance": 1e-5,
        "axisAngle": rounded(axis_angle),
        "quaternion": rounded(quaternion),
        "sixD": rounded(matrix_to_six_d(matrix)),
        "axisAngleBack": rounded(quaternion_to_axis_angle(matrix_to_quaternion(matrix))),
        "heading": rounded(heading(matrix)),
        "headingNote": "forward axis used while its horizontal length is at least 0.1, else -up * sign(forward.y)",
        "slerp": {
            "from": rounded(quaternion),
            "to": rounded(other),
            "fraction": rounded(fraction[:, 0]),
            "result": rounded(slerp(quaternion, other, fraction)),
            "angle": rounded(angle_between(matrix, matrix.roll(3, 0))),
            "note": "q and -q are the same rotation",
        },
    }


def kinematics() -> dict:
    """World joint positions and rotations of the rest pose and three random poses; the mirror of the last."""
    rng = torch.Generator().manual_seed(2)
    axis_angle = torch.randn(4, JOINT_COUNT, 3, dtype=torch.float64, generator=rng) * 0.6
    axis_angle[0] = 0
    root = torch.randn(4, 3, dtype=torch.float64, generator=rng)
    root[0] = torch.tensor([0.0, 0.955, 0.0])
    matrices = axis_angle_to_matrix(axis_angle)
    motion = torch.cat([matrix_to_six_d(matrices).flatten(-2), root], -1)
    mirrored = metrics.matrices_of(mirror_motion(motion))
    return {
        "tolerance": 1e-5,
        "axisAngle": rounded(axis_angle.flatten(1)),
        "root": rounded(root),
        "positions": rounded(forward_kinematics(matrices, root)),
        "worldQuaternions": rounded(matrix_to_quaternion(world_rotations(matrices))),
        "mirroredAxisAngle": rounded(quaternion_to_axis_angle(matrix_to_quaternion(mirrored)).flatten(1)),
    }


def positional() -> dict:
    """Rows of eq. 7, the distances to neighbouring keys and the local embedding (eq. 8-10) away from sentinels; weights of eq. 15."""
    mask = torch.zeros(40)
    mask[[5, 12, 30]] = 1
    to_previous, to_next = key_distances(mask)
    local = LocalPositionalEmbedding(ModelConfig.named("tiny"))
    with torch.no_grad():
        rows = local(to_previous[None], to_next[None])[0]
    inside = (to_previous >= 0) & (to_next >= 0)
    return {
        "tolerance": 1e-5,
        "width": 32,
        "rows": [0, 1, 7, 100],
        "encoding": rounded(positional_encoding(512, 32)[[0, 1, 7, 100]]),
        "keyFrames": [5, 12, 30],
        "frames": 40,
        "toPrevious": to_previous.int().tolist(),
        "toNext": to_next.int().tolist(),
        "localFrames": torch.nonzero(inside)[:, 0].tolist(),
        "local": rounded(rows[inside]),
        "weight": rounded(key_weight(mask[None].double(), 3.0, 0.1)[0]),
    }


def measures() -> dict:
    """All measures of one made-up dance, and its local frame."""
    rng = torch.Generator().manual_seed(3)
    motion = synthetic_motion(60, rng).double()
    other = synthetic_motion(60, rng).double()
    key_frames = torch.tensor([0, 15, 44])
    beats = torch.arange(2, 60, 9).double()
    quaternions = matrix_to_quaternion(metrics.matrices_of(motion))
    keys = quaternion_to_axis_angle(matrix_to_quaternion(metrics.matrices_of(other[key_frames])))
    local = to_local_frame(motion, 30)
    found = metrics.motion_beats(motion)
    return {
        "tolerance": 1e-4,
        "fps": FPS,
        "quaternions": rounded(quaternions.flatten(1), 7),
        "root": rounded(motion[:, ROTATION_SIZE:], 7),
        "keyFrames": key_frames.tolist(),
        "keyPoses": rounded(keys.flatten(1)),
        "beatFrames": beats.tolist(),
        "consistencyError": metrics.consistency_error(motion, key_frames, other[key_frames, :ROTATION_SIZE]),
        "smoothness": metrics.smoothness(motion),
        "meanJerk": metrics.mean_jerk(motion),
        "motionBeatFrames": metrics.motion_beats(motion).tolist(),
        "beatHitRate": [metrics.beat_hit_rate(motion, beats, d) for d in range(1, 6)],
        "footSkate": metrics.foot_skate(motion),
        "motionExtremaFrames": metrics.motion_beats(motion, extrema=True).tolist(),
        "freeze": {"threshold": 0.6, "seconds": metrics.longest_freeze(metrics.mean_joint_speed(metrics.joints(motion)), 0.6)},
        "other": {
            "quaternions": rounded(matrix_to_quaternion(metrics.matrices_of(other)).flatten(1), 7),
            "root": rounded(other[:, ROTATION_SIZE:], 7),
        },
        "npss": dance_metrics.npss(motion, other),
        "poseFrechet": dance_metrics.frechet_distance(*(dance_metrics.pose_vectors(m) for m in (motion, other))),
        "velocityFrechet": dance_metrics.frechet_distance(*(dance_metrics.velocity_vectors(m) for m in (motion, other))),
        "positionVariance": dance_metrics.position_variance([metrics.joints(m) for m in (motion, other, motion.roll(20, 0))]),
        "beatConsistency": dance_metrics.beat_consistency(found, beats),
        "localFrame": {"seedFrames": 30, "firstFrame": rounded(local[0]), "lastFrame": rounded(local[-1])},
        "notes": {
            "smoothness": "sd / |mean| over all frame differences of the 147 numbers (6D + root), population sd",
            "meanJerk": "mean length of third differences x fps^3 of root-aligned joint positions",
            "motionBeats": "strict local minima (v[t] < v[t-1], v[t] <= v[t+1]) of mean root-aligned joint speed; v[t] is between "
            "frames t and t + 1, so the beat is at t + 0.5",
            "other": "npss, poseFrechet and velocityFrechet compare the dance with the other one",
            "positionVariance": "over the dance, the other one, and the dance rolled by 20 frames",
            "beatConsistency": "sigma 0.05 s",
            "footSkate": "mean horizontal toe-joint speed from t - 1 to t over toes with y < toeHeight + 0.03 at t",
        },
    }


def curve_samples() -> dict:
    """A short dance of Kochanek-Bartels curves on uneven keys, root and one joint's quaternion, and what it samples to."""
    rng = torch.Generator().manual_seed(4)
    times = torch.tensor([0.5, 1.1, 1.4, 2.6], dtype=torch.float64)
    intervals = len(times) - 1
    turns = axis_angle_to_quaternion(torch.randn(3 * intervals + 1, 1, 3, dtype=torch.float64, generator=rng) * 0.8)
    turns = curves.align_signs(turns)[:, 0]
    root = torch.randn(3 * intervals + 1, 3, dtype=torch.float64, generator=rng) * 0.3
    knots = torch.cat([root, turns], 1)
    keys, inner = knots[::3], knots[:-1].unflatten(0, (-1, 3))[:, 1:]
    tcb = torch.rand(intervals, 3, 7, dtype=torch.float64, generator=rng) * 1.6 - 0.8
    tcb[1, :, 0] = 0
    at = torch.linspace(0.3, 2.8, 41, dtype=torch.float64)
    made = curves.Curves(times, keys, inner, tcb)
    values = curves.sample(made, at)
    rows = curves.knot_rows(made)
    arriving, leaving = curves.tangents(*rows)
    return {
        "tolerance": 1e-6,
        "note": "7 channels: root x y z, quaternion x y z w of one joint (its samples scaled to length 1)",
        "times": rounded(times),
        "keys": rounded(keys),
        "inner": rounded(inner),
        "tensionContinuityBias": rounded(tcb),
        "knotTimes": rounded(rows[0][:, 0]),
        "arriving": rounded(arriving),
        "leaving": rounded(leaving),
        "at": rounded(at),
        "root": rounded(values[:, :3]),
        "quaternions": rounded(values[:, 3:] / values[:, 3:].norm(dim=-1, keepdim=True)),
    }


def beat_music_samples() -> dict:
    """Made-up MFCC, energy, chroma and onsets of 45 frames, some of them silent: the 53 numbers of a frame and the 57 of a beat."""
    rng = np.random.default_rng(6)
    frames = 45
    mfcc = np.round(rng.standard_normal((frames, danceformer_data.MFCC)).cumsum(0) * 4 - 20, 3)
    energy = np.round(-20 + 6 * rng.standard_normal(frames), 3)
    energy[:4] = -90  # silent
    chroma = rng.random((frames, 12))
    chroma = np.round(chroma / np.linalg.norm(chroma, axis=1, keepdims=True), 5)
    onset = np.round(rng.random(frames), 5)
    beats, downbeats = np.array([0.21, 0.6, 1.02, 1.41]), np.array([0.6])
    table = danceformer_data.frame_features(mfcc, energy, chroma, onset)
    heard = danceformer_data.beat_music(table, beats, danceformer_data.bar_places(beats, downbeats, 3))
    between = danceformer_data.interval_music(torch.from_numpy(table), torch.tensor([6.3]), torch.tensor([18.0]), 8)
    return {
        "tolerance": 1e-4,
        "mfcc": mfcc.tolist(),
        "energy": energy.tolist(),
        "chroma": chroma.tolist(),
        "onset": onset.tolist(),
        "beats": beats.tolist(),
        "downbeats": downbeats.tolist(),
        "beatsPerBar": 3,
        "frameFeatures": rounded(torch.from_numpy(table), 6),
        "beatMusic": rounded(torch.from_numpy(heard), 6),
        "interval": {"startSeconds": 0.21, "endSeconds": 0.6, "music": rounded(between[0], 6)},
    }


def tiny_model() -> KeyPoseDancer:
    """A model of random weights, small enough for tests."""
    torch.manual_seed(11)
    return randomise(KeyPoseDancer(ModelConfig.named("tiny")), 11).eval()


def write_tiny(out: Path) -> None:
    """tiny.onnx and one window through it (tiny.json + tiny.bin)."""
    model = tiny_model()
    proto = compress(to_onnx(model, "tiny"), "fp16", "tiny")
    (out / "tiny.onnx").write_bytes(proto.SerializeToString())
    inputs = synthetic_inputs(1, 20, 48, 5)
    arrays = {name: inputs[name].numpy() for name in INPUT_NAMES}
    arrays[OUTPUT_NAME] = run_onnx(proto, inputs)
    write_arrays(out, "tiny", arrays, {"tolerance": 1e-4})


def contract() -> dict:
    """The hash of the spec that all of this belongs to."""
    return {"specHash": spec_hash(), "version": SPEC["version"]}


SECTIONS = {
    "spec": "contract",
    "rotations": "rotations",
    "kinematics": "kinematics",
    "positional": "positional",
    "metrics": "measures",
    "curves-samples": "curve_samples",
    "beat-music": "beat_music_samples",
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", required=True)
    args = parser.parse_args()
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    for name, section in SECTIONS.items():
        (out / f"{name}.json").write_text(json.dumps(globals()[section]()) + "\n", encoding="utf-8")
    write_tiny(out)


if __name__ == "__main__":
    main()
