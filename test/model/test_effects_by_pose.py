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
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.driven_motion import features
from werrimbi_odom.model.effect import Effect, Parameter, body_effect, wheel_effect
from werrimbi_odom.model.effects_over_run import driven_from_measured
from werrimbi_odom.model.measured_poses import MeasuredPoses
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


def test_only_steps_whose_pose_may_move_are_evaluated_again() -> None:
    """Followed from measured poses; the places come out as if each pass took all steps."""
    sizes = []

    @wheel_effect(loss=Parameter("", 0.0, 0.2, (-0.9, 0.9), "share of the travel that is lost"))
    def patch(travel: Any, drive: Any, loss: float) -> Any:
        """Wheels slip on a spot of oil.

        Formula    travel *= 1 - loss, inside 0.2 m of (1, 0)      [m]
        Signature  an error along where the spot is, and nowhere else
        Ruler      look at the floor
        """
        sizes.append(travel.left.size)
        kept = 1.0 - loss * share_inside(drive.x, drive.y, 1.0, 0.0, 0.2)
        return WheelTravel(travel.left * kept, travel.right * kept)

    count, leg = 400, 25
    robot = replace(ROBOT, effects=(patch.using(loss=0.2),))
    raw = WheelTravel(np.full(count, 0.01), np.full(count, 0.01))
    run = features(robot, np.full(count, 0.02), raw, (0.0, 0.0), None)
    first = np.arange(count) // leg * leg
    poses = MeasuredPoses(np.zeros(count), first, 0.01 * first + 0j, first)
    found = driven_from_measured(robot, raw, run, lambda: poses).motion.along
    assert sizes[:2] == [count, count]
    assert 0 < sum(sizes[2:]) < 0.2 * count
    x, expected = 0.0, []
    for step in range(count):
        x = 0.01 * step if step % leg == 0 else x + expected[-1]
        way = [
            Span(np.array([part]), np.array([part + more]))
            for part, more in ((x, 0.01), (0.0, 0.0))
        ]
        expected.append(0.01 * (1.0 - 0.2 * float(share_inside(*way, 1.0, 0.0, 0.2)[0])))
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11)


def test_a_stretch_is_one_where_headings_and_places_are_measured_in_turn() -> None:
    """A step may be followed from a later one, too: those before the first measured pose."""
    yaw_from = np.array([1, 1, 1, 1, 4, 4, 6, 7])
    place_from = np.array([1, 1, 2, 2, 2, 5, 6, 7])
    poses = MeasuredPoses(np.arange(8.0), yaw_from, 1j * np.arange(8.0), place_from)
    moved = np.arange(8) == 3
    np.testing.assert_array_equal(np.flatnonzero(poses.reached_from(moved, True)), np.arange(6))
    np.testing.assert_array_equal(np.flatnonzero(poses.reached_from(moved, False)), np.arange(4))
    last = poses.of(np.arange(8) > 5)
    assert last.yaw_from.tolist() == last.place_from.tolist() == [0, 1]
    assert last.yaw.tolist() == [6.0, 7.0]
