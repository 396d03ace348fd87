"""Rotations and kinematics against closed forms."""

import math

import torch

from rotation import (
    angle_between,
    axis_angle_to_matrix,
    axis_angle_to_quaternion,
    heading,
    matrix_to_axis_angle,
    matrix_to_quaternion,
    matrix_to_six_d,
    quaternion_to_matrix,
    six_d_to_matrix,
    slerp,
    yaw_matrix,
)
from skeleton import MIRRORED_JOINTS, forward_kinematics, mirror_motion, world_rotations
from spec import JOINT_COUNT, JOINTS, OFFSETS, PARENTS, ROTATION_SIZE


def random_axis_angle(*shape: int) -> torch.Tensor:
    vector = torch.randn(*shape, 3, dtype=torch.float64, generator=torch.Generator().manual_seed(0))
    # Angles in 0..pi have one axis-angle only, so that a round trip must give the same numbers.
    return vector / vector.norm(dim=-1, keepdim=True) * torch.linspace(0, 3.1, vector[..., 0].numel()).view(*shape, 1)


def test_quarter_turn_about_y_takes_z_to_x():
    matrix = axis_angle_to_matrix(torch.tensor([0.0, math.pi / 2, 0.0], dtype=torch.float64))
    assert torch.allclose(matrix @ torch.tensor([0.0, 0, 1], dtype=torch.float64), torch.tensor([1.0, 0, 0], dtype=torch.float64))
    assert torch.allclose(matrix, yaw_matrix(torch.tensor(math.pi / 2, dtype=torch.float64)))


def test_round_trips():
    axis_angle = random_axis_angle(50)
    matrix = axis_angle_to_matrix(axis_angle)
    assert torch.allclose(matrix_to_axis_angle(matrix), axis_angle, atol=1e-9)
    assert torch.allclose(six_d_to_matrix(matrix_to_six_d(matrix)), matrix, atol=1e-9)
    assert torch.allclose(quaternion_to_matrix(matrix_to_quaternion(matrix)), matrix, atol=1e-9)
    assert torch.allclose(torch.linalg.det(matrix), torch.ones(50, dtype=torch.float64))


def test_matrix_to_quaternion_of_half_turns():
    for axis in torch.eye(3, dtype=torch.float64):
        quaternion = matrix_to_quaternion(axis_angle_to_matrix(axis * math.pi))
        assert torch.allclose(quaternion.abs()[:3], axis, atol=1e-9)


def test_six_d_is_column_0_then_column_1():
    matrix = axis_angle_to_matrix(torch.tensor([0.3, -0.2, 0.9]))
    assert torch.equal(matrix_to_six_d(matrix), torch.cat([matrix[:, 0], matrix[:, 1]]))


def test_gram_schmidt_makes_any_two_vectors_a_rotation():
    matrix = six_d_to_matrix(torch.tensor([2.0, 0, 0, 1, 3, 0]))
    assert torch.allclose(matrix, torch.eye(3), atol=1e-6)


def test_slerp_runs_at_even_speed_along_the_shorter_arc():
    a = axis_angle_to_quaternion(torch.tensor([0.0, 0, 0], dtype=torch.float64))
    b = -axis_angle_to_quaternion(torch.tensor([0.0, 1.2, 0], dtype=torch.float64))
    for fraction in (0.0, 0.25, 1.0):
        mixed = quaternion_to_matrix(slerp(a, b, torch.tensor([fraction], dtype=torch.float64)))
        assert torch.allclose(matrix_to_axis_angle(mixed)[1], torch.tensor(1.2 * fraction, dtype=torch.float64), atol=1e-9)


def test_angle_between():
    a, b = axis_angle_to_matrix(torch.tensor([[0.0, 0.5, 0], [0, -0.7, 0]], dtype=torch.float64))
    assert math.isclose(float(angle_between(a, b)), 1.2, abs_tol=1e-9)


def test_heading_upright_and_lying():
    assert math.isclose(float(heading(axis_angle_to_matrix(torch.tensor([0.2, 0.0, 0.0])))), 0.0, abs_tol=1e-6)
    assert math.isclose(float(heading(axis_angle_to_matrix(torch.tensor([0.0, 1.0, 0.0])))), 1.0, abs_tol=1e-6)
    # Face down with the head towards +Z, and on the back with the head towards -Z: both face +Z.
    assert math.isclose(float(heading(axis_angle_to_matrix(torch.tensor([math.pi / 2, 0.0, 0.0])))), 0.0, abs_tol=1e-5)
    assert math.isclose(float(heading(axis_angle_to_matrix(torch.tensor([-math.pi / 2, 0.0, 0.0])))), 0.0, abs_tol=1e-5)


def test_rest_pose_is_the_sum_of_offsets():
    matrices = torch.eye(3).expand(JOINT_COUNT, 3, 3)
    positions = forward_kinematics(matrices, torch.tensor([1.0, 2.0, 3.0]))
    joint, expected = JOINTS.index("left_foot"), torch.tensor([1.0, 2.0, 3.0])
    while joint > 0:
        expected = expected + torch.tensor(OFFSETS[joint])
        joint = PARENTS[joint]
    assert torch.allclose(positions[JOINTS.index("left_foot")], expected, atol=1e-6)


def test_fk_equals_the_joint_by_joint_definition():
    matrices = axis_angle_to_matrix(random_axis_angle(2, JOINT_COUNT))
    root = torch.tensor([[0.1, 1.0, 0.2], [0.0, 0.9, 0.0]], dtype=torch.float64)
    positions, world = forward_kinematics(matrices, root), world_rotations(matrices)
    for item in range(2):
        place, turned = [root[item]], [matrices[item, 0]]
        for joint in range(1, JOINT_COUNT):
            parent = PARENTS[joint]
            place.append(place[parent] + turned[parent] @ torch.tensor(OFFSETS[joint], dtype=torch.float64))
            turned.append(turned[parent] @ matrices[item, joint])
        assert torch.allclose(positions[item], torch.stack(place), atol=1e-9)
        assert torch.allclose(world[item], torch.stack(turned), atol=1e-9)


def test_mirror_reflects_every_joint_and_is_its_own_inverse():
    matrices = axis_angle_to_matrix(random_axis_angle(JOINT_COUNT))
    motion = torch.cat([matrix_to_six_d(matrices).flatten(), torch.tensor([0.3, 1.0, -0.2], dtype=torch.float64)])
    mirrored = mirror_motion(motion)
    assert torch.allclose(mirror_motion(mirrored), motion)

    def place(values: torch.Tensor) -> torch.Tensor:
        return forward_kinematics(six_d_to_matrix(values[:ROTATION_SIZE].view(JOINT_COUNT, 6)), values[ROTATION_SIZE:])

    expected = place(motion)[MIRRORED_JOINTS] * torch.tensor([-1.0, 1, 1], dtype=torch.float64)
    assert torch.allclose(place(mirrored), expected, atol=1e-9)
