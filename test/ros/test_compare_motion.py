# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Held, carried and slipping are told while they last, and nothing else is taken for them."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest

pytest.importorskip("rclpy")

from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.ros.compare_legs import Both
from werrimbi_odom.ros.compare_motion import Motion
from werrimbi_odom.ros.compare_track import TimedPose

PERIOD = 0.1
Speeds = tuple[float, float]


def states(
    wheels: Callable[[float], Speeds],
    robot: Callable[[float], Speeds],
    seconds: float = 30.0,
    sigma: tuple[float, float] = (0.005, 0.01),
    late: float = 0.0,
) -> list[tuple[float, str]]:
    """What is told of a drive: the state at each change, and when [s]."""
    noise = np.random.default_rng(1)
    covariance = PoseCovariance(sigma[0] ** 2, 0.0, 0.0, sigma[0] ** 2, 0.0, sigma[1] ** 2)
    time = np.arange(0.0, seconds, 0.01)
    rolled, moved = (_path(which, time) for which in (wheels, robot))
    motion, found = Motion(), []
    path = np.concatenate([[0.0], np.cumsum(np.abs([wheels(t)[0] for t in time[1:]]) * 0.01)])
    turned = np.concatenate([[0.0], np.cumsum(np.abs([wheels(t)[1] for t in time[1:]]) * 0.01)])
    for row in range(0, time.size, round(PERIOD / 0.01)):
        seen = moved[max(row - round(late / 0.01), 0)] + noise.normal(
            0.0, (*sigma[:1] * 2, sigma[1])
        )
        both = Both(
            TimedPose(time[row], Pose(*rolled[row]), covariance, path[row], turned[row]),
            TimedPose(time[row], Pose(*seen), covariance),
        )
        found.append((float(time[row]), motion.take(both)))
    return [next(group) for _, group in itertools.groupby(found, key=lambda item: item[1])]


def _path(speeds: Callable[[float], Speeds], time: np.ndarray) -> np.ndarray:
    poses = [np.zeros(3)]
    for t in time[1:]:
        speed, rate = speeds(float(t))
        x, y, yaw = poses[-1]
        poses.append(np.array([x + speed * np.cos(yaw) * 0.01, y + speed * np.sin(yaw) * 0.01,
                               yaw + rate * 0.01]))  # fmt: skip
    return np.array(poses)


def patrol(t: float) -> Speeds:
    """Lines, curves, spins and stops, a second and a half of each and more."""
    return ((0.0, 0.0), (0.4, 0.0), (0.3, 0.5), (0.0, 0.8), (-0.3, 0.0), (0.3, -0.4))[
        int(t / 2.5) % 6
    ]


@pytest.mark.parametrize("late", [0.0, 0.4], ids=["prompt", "late"])
def test_a_patrol_is_driving_even_where_the_reference_is_late(late: float) -> None:
    assert {state for _, state in states(patrol, patrol, late=late)} <= {"standing", "driving"}


def test_a_wheel_of_a_tenth_more_is_no_slip() -> None:
    wide = states(patrol, lambda t: (patrol(t)[0], 0.9 * patrol(t)[1]))
    assert {state for _, state in wide} <= {"standing", "driving"}


def test_a_robot_that_is_held_is_told_within_three_seconds() -> None:
    found = states(lambda t: (0.3, 0.0), lambda t: (0.0, 0.0) if 10 <= t < 18 else (0.3, 0.0))
    ((begin, _),) = [each for each in found if each[1] == "held"]
    assert 11.0 < begin < 13.5
    assert found[-1][1] == "driving"
    assert found[-1][0] < 20.0


def test_a_robot_that_is_carried_is_told() -> None:
    found = states(
        lambda t: (0.0, 0.0) if 10 <= t < 18 else (0.3, 0.0),
        lambda t: (0.4, 0.3) if 10 <= t < 18 else (0.3, 0.0),
    )
    ((begin, _),) = [each for each in found if each[1] == "carried"]
    assert begin < 13.5
    assert found[-1][1] == "driving"


def test_wheels_that_spin_are_told_to_slip() -> None:
    found = states(lambda t: (0.3, 0.0), lambda t: (0.12, 0.0) if 10 <= t < 18 else (0.3, 0.0))
    ((begin, _),) = [each for each in found if each[1] == "slipping"]
    assert begin < 13.5


def test_a_jump_of_the_reference_is_none_of_them() -> None:
    def jumping(t: float) -> Speeds:
        return (0.3, 0.0) if not 10 <= t < 10.01 else (50.0, 0.0)

    found = states(lambda t: (0.3, 0.0), jumping)
    assert {state for _, state in found} <= {"standing", "driving"}


def test_wheels_and_reference_that_never_agree_are_a_mistake_of_the_set_up() -> None:
    motion = Motion()
    covariance = PoseCovariance(1e-6, 0.0, 0.0, 1e-6, 0.0, 1e-6)
    for step in range(200):
        t = 0.1 * step
        motion.take(
            Both(
                TimedPose(t, Pose(0.6 * t, 0.0, 0.0), covariance, 0.6 * t, 0.0),
                TimedPose(t, Pose(0.3 * t, 0.0, 0.0), covariance),
            )
        )
    fine, words = motion.status()
    assert not fine
    assert "hardly ever go together" in words
