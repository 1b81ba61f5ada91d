# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""~/reset and set_pose on the real node."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from geometry_msgs.msg import PoseWithCovarianceStamped

PLANE = np.ix_((0, 1, 5), (0, 1, 5))
COVARIANCE = np.array([[0.04, 0.01, 0.002], [0.01, 0.09, -0.003], [0.002, -0.003, 0.01]])


def pose_message(covariance: np.ndarray = COVARIANCE, **changes: float) -> Any:
    """At (2, -1), heading north, in odom."""
    message = PoseWithCovarianceStamped()
    message.header.frame_id = "odom"
    values = {"x": 2.0, "y": -1.0, "qx": 0.0, "qz": math.sqrt(0.5), "qw": math.sqrt(0.5)} | changes
    pose = message.pose.pose
    pose.position.x, pose.position.y = values["x"], values["y"]
    pose.orientation.x, pose.orientation.z = values["qx"], values["qz"]
    pose.orientation.w = values["qw"]
    whole = np.zeros((6, 6))
    whole[PLANE] = covariance
    message.pose.covariance = whole.ravel()
    return message


def test_reset_sets_everything_to_zero(node: Any) -> None:
    node.drive([(100, 50)] * 30 + [(0, 50)] * 10)
    node.reset()
    message = node.drive([(0, 0)])
    assert (message.pose.pose.position.x, message.pose.pose.position.y) == (0.0, 0.0)
    assert message.pose.pose.orientation.w == 1.0
    assert not np.asarray(message.pose.covariance).reshape(6, 6)[PLANE].any()


def test_set_pose_goes_on_from_there(node: Any) -> None:
    node.drive([(100, 50)] * 30)
    node.set_pose(pose_message())
    message = node.drive([(0, 0)])
    position, orientation = message.pose.pose.position, message.pose.pose.orientation
    assert (position.x, position.y) == (2.0, -1.0)
    assert 2.0 * math.atan2(orientation.z, orientation.w) == pytest.approx(0.5 * math.pi)
    got = np.asarray(message.pose.covariance).reshape(6, 6)[PLANE]
    np.testing.assert_allclose(got, COVARIANCE, rtol=1e-9)
    message = node.drive([(2000, 1000)])
    way = 2.0 * math.pi * 0.05
    assert message.pose.pose.position.y == pytest.approx(-1.0 + way, abs=1e-9)
    carried = np.array([[1.0, 0.0, -way], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    got = np.asarray(message.pose.covariance).reshape(6, 6)[PLANE]
    np.testing.assert_allclose(got, carried @ COVARIANCE @ carried.T, atol=1e-5)


INDEFINITE = np.diag([0.01, -0.01, 0.01])
LOPSIDED = COVARIANCE + np.array([[0, 0.01, 0], [0, 0, 0], [0, 0, 0]])
HIDDEN_NEGATIVE = np.diag([1e6, 1.0, -1e-4])  # small beside the largest entry, but not to a heading
HIDDEN_TOO_CLOSE = np.array([[1e10, 0.0, 0.0], [0.0, 1.0, 2.0], [0.0, 2.0, 1.0]])
TOO_CLOSE = np.array([[0.01, 0.02, 0.0], [0.02, 0.01, 0.0], [0.0, 0.0, 0.01]])

REFUSED = {
    "frame": (pose_message(), "wrong frame"),
    "nan": (pose_message(x=math.nan), "pose not finite"),
    "infinite": (pose_message(y=math.inf), "pose not finite"),
    "far": (pose_message(x=1e13), "pose out of range"),
    "nan_quaternion": (pose_message(qw=math.nan), "pose not finite"),
    "no_rotation": (pose_message(qz=0.0, qw=0.0), "orientation not a rotation"),
    "tilted": (pose_message(qx=0.5, qz=0.5, qw=math.sqrt(0.5)), "orientation not planar"),
    "nan_covariance": (pose_message(COVARIANCE * math.nan), "covariance not finite"),
    "huge_covariance": (pose_message(COVARIANCE * 1e30), "covariance out of range"),
    "asymmetric": (pose_message(LOPSIDED), "covariance not symmetric"),
    "negative": (pose_message(INDEFINITE), "covariance not positive semi-definite"),
    "indefinite": (pose_message(TOO_CLOSE), "covariance not positive semi-definite"),
    "beside_a_large_one": (
        pose_message(HIDDEN_NEGATIVE),
        "covariance not positive semi-definite",
    ),
    "correlation_of_2": (pose_message(HIDDEN_TOO_CLOSE), "covariance not positive semi-definite"),
    "long_quaternion": (pose_message(qz=1e200, qw=0.0), "orientation not a rotation"),
    "long_tilted": (pose_message(qx=1e200, qz=0.0, qw=0.0), "orientation not a rotation"),
}
REFUSED["frame"][0].header.frame_id = "map"
# Half of what set_pose keeps for a busy node: more at once and DDS may rightly drop the oldest.
QUEUE = 5


@pytest.fixture(scope="module")
def counts_after_all(node: Any) -> dict[str, int]:
    """Counts once every pose above has been sent; none of them has moved the robot."""
    node.reset()
    for sent, (message, _) in enumerate(REFUSED.values(), start=1):
        node.send(PoseWithCovarianceStamped, "set_pose", message)
        if sent % QUEUE == 0 or sent == len(REFUSED):
            node.counted(Counter(), refused_set_pose=sent)
    assert node.drive([(0, 0)]).pose.pose.position.x == 0.0
    return node.counts()


@pytest.mark.parametrize("case", REFUSED)
def test_a_pose_that_cannot_be_set(node: Any, counts_after_all: dict[str, int], case: str) -> None:
    cause = REFUSED[case][1]
    same = sum(cause == other for _, other in REFUSED.values())
    assert counts_after_all[f"refused set_pose: {cause}"] == same
    assert node.stderr().count(f"set_pose refused: {cause}: ") == 1
