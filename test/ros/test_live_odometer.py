# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The odometer of the node, with an effect of one's own that has no value for some travels."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

pytest.importorskip("rclpy")

from builtin_interfaces.msg import Time

from werrimbi_odom.effects.functions import log
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.ros.live_odometer import LiveOdometer, rehearse


@wheel_effect(
    top=Parameter("m", 0.0, 50.0, (0.0, 100.0), "travel between two messages that cannot be")
)
def slipping_late(travel: Any, drive: Any, top: float) -> Any:
    """Wheels slip the more, the nearer a step is to the longest.

    Formula    travel *= 1 + 0.01 log(1 - travel / top)      [m]
    Signature  distances shrink with the speed
    Ruler      a tape
    """
    return WheelTravel(*(side * (1.0 + 0.01 * log(1.0 - side / top)) for side in travel))


def robot(top: float) -> Robot:
    return replace(Robot(0.35, 0.05, 2000.0, 2000.0), effects=(slipping_late.using(top=top),))


def test_counts_of_which_a_law_has_no_value_are_refused_and_the_pose_stays() -> None:
    tracker = LiveOdometer(robot(50.0), PieceTolerance(), EncoderLimits())
    tracker.take(Time(sec=1), 0.0, 0.0)
    tracker.take(Time(sec=2), 2000.0, 2000.0)
    pose = tracker.pose
    assert pose.x > 0.3
    with pytest.raises(InputError, match="beyond all numbers"):
        tracker.take(Time(sec=3), 2e6, 2e6)
    assert tracker.pose == pose


def test_a_law_that_has_no_value_at_usual_speeds_is_refused_with_the_robot() -> None:
    rehearse(robot(50.0), PieceTolerance())
    with pytest.raises(InputError, match="beyond all numbers"):
        rehearse(robot(1.0), PieceTolerance())
