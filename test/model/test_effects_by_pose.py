# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that depend on where the robot stands, or turn it by its heading, live and recorded."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from test.model.drives import ROBOT
from test.model.test_effects_live_and_recorded import assert_alike, drive, estimates
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.effects.contract.demands import typical
from werrimbi_odom.effects.shapes import mean_sin, share_inside
from werrimbi_odom.model.effect import Effect, Parameter, body_effect, wheel_effect
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.trajectory import trajectory


@body_effect(rate=Parameter("rad/m", 0.0, 0.05, (-1.0, 1.0), "heading gained per metre"))
def pull(motion: Any, drive: Any, rate: float) -> Any:
    """A cable turns the robot towards the west.

    Formula    turn += rate * path * sin(heading)     [rad] = [rad/m] * [m]
    Signature  a heading error that follows the heading
    Ruler      push it along a chalk line with the cable plugged in
    """
    return motion._replace(turn=motion.turn + rate * abs(motion.along) * mean_sin(drive.heading))


@wheel_effect(
    loss=Parameter("", 0.0, 0.2, (-0.9, 0.9), "share of the travel that is lost"),
    x=Parameter("m", 0.3, 0.3, (-99.0, 99.0), "where it is", tries=(0.3,)),
)
def spot(travel: Any, drive: Any, loss: float, x: float) -> Any:
    """Wheels slip on a spot of oil.

    Formula    travel *= 1 - loss, inside half a metre of (x, 0.1)      [m]
    Signature  an error along where the spot is, and nowhere else
    Ruler      look at the floor
    """
    kept = 1.0 - loss * share_inside(drive.x, drive.y, x, 0.1, 0.5)
    return WheelTravel(travel.left * kept, travel.right * kept)


@pytest.mark.parametrize("effect", [pull, spot], ids=lambda effect: effect.name)
def test_it_keeps_the_laws(effect: Effect) -> None:
    check_effect(effect)


@pytest.mark.parametrize(
    "effects",
    [(pull,), (spot,), (spot, pull)],
    ids=lambda effects: "+".join(effect.name for effect in effects),
)
def test_it_acts_alike_live_and_recorded(effects: tuple[Effect, ...]) -> None:
    robot = replace(ROBOT, effects=tuple(effect.using(**typical(effect)) for effect in effects))
    live, recorded = Odometer(robot), trajectory(robot, *drive(), start=Pose())
    assert_alike(estimates(live, drive()), recorded)
    plain = trajectory(ROBOT, *drive())
    assert np.hypot(recorded.x[-1] - plain.x[-1], recorded.y[-1] - plain.y[-1]) > 0.01


def test_a_turn_that_jumps_with_the_heading_is_refused() -> None:
    @body_effect(rate=Parameter("rad/m", 0.0, 5.0, (-9.0, 9.0), "heading gained per metre"))
    def torn(motion: Any, drive: Any, rate: float) -> Any:
        """Turn left where the heading's fine digits say so.

        Formula    turn += rate * path * sin(1e4 heading)
        Signature  none
        Ruler      none
        """
        wave = np.sin(1e4 * drive.heading.start)
        return motion._replace(turn=motion.turn + rate * abs(motion.along) * wave)

    with pytest.raises(AssertionError, match=r"splitting|gently"):
        check_effect(torn)
