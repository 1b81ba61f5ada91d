# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""However a law is written: the live node, a recorded run and the predicted legs see it alike."""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable
from dataclasses import astuple, fields, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from test.model.drives import ROBOT
from test.model.test_effects_live_and_recorded import assert_alike, drive, estimates
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.effects.shapes import mean_sin, share_inside
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.prediction import predict_all, predicted_legs
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Effect, Parameter, body_effect, wheel_effect
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.trajectory import trajectory

PAGE = """The floor carries the robot to one side.

Formula    sideways += amount * path * sin(heading)
Signature  an error that follows the heading
Ruler      drive a line there and back
"""
AMOUNT = Parameter("m/m", 0.0, 0.05, (-0.2, 0.2), "drift per metre of path")


def sway(drive: Any) -> Any:
    return mean_sin(drive.heading)


class Compass:
    def sway(self, drive: Any) -> Any:
        return mean_sin(drive.heading)

    def __call__(self, drive: Any) -> Any:
        return self.sway(drive)


@functools.cache
def reader(name: str) -> Callable[[Any], Any]:
    return operator.attrgetter(name)


def of_field(name: str, drive: Any) -> Any:
    return mean_sin(operator.attrgetter(name)(drive))


helpers = SimpleNamespace(sway=sway)
compass = Compass()
method, partial = compass.sway, functools.partial(of_field, "heading")
START = Pose(-0.4, 0.3, 0.9)
PARTS = ("head", "ing")


def only_when_fast(drive: Any) -> Any:
    if np.max(np.abs(drive.speed.end)) < 0.1:
        return 0.0 * drive.speed.end
    return np.where(np.abs(drive.speed.end) < 0.1, 0.0, 1.0) * sway(drive)


HEADING = [field.name for field in fields(Drive)].index("heading")
"""Place of it among all."""

WAYS: dict[str, Callable[[Any], Any]] = {
    "a closure": lambda drive: mean_sin(drive.heading),
    "a helper": lambda drive: sway(drive),
    "a helper of a module": lambda drive: helpers.sway(drive),
    "a method": lambda drive: method(drive),
    "an object that is called": lambda drive: compass(drive),
    "a partial": lambda drive: partial(drive),
    "an attrgetter, cached": lambda drive: mean_sin(reader("heading")(drive)),
    "a computed name": lambda drive: mean_sin(getattr(drive, "".join(PARTS))),
    "a copy of the drive": lambda drive: sway(replace(drive, duration=drive.duration)),
    "all fields of the drive": lambda drive: mean_sin(astuple(drive)[HEADING]),
    "a match": lambda drive: _matched(drive),
}


def _matched(drive: Any) -> Any:
    match drive:
        case Drive(heading=seen):
            return mean_sin(seen)


def drifting(way: Callable[[Any], Any]) -> Effect:
    def drifts(motion: Any, drive: Any, amount: float) -> Any:
        moved = amount * abs(motion.along) * way(drive)
        return motion._replace(sideways=motion.sideways + moved)

    drifts.__doc__ = PAGE
    return body_effect(amount=AMOUNT)(drifts)


def slipping(way: Callable[[Any], Any], **declared: Any) -> Effect:
    def slips(travel: Any, drive: Any, amount: float) -> Any:
        share = 1.0 + amount * way(drive)
        return travel._replace(left=travel.left * share)

    slips.__doc__ = PAGE
    return wheel_effect(amount=AMOUNT, **declared)(slips)


def assert_three_alike(effect: Effect) -> None:
    """Live, recorded, predicted; the reference is what the robot itself says, without noise."""
    robot = replace(ROBOT, effects=(effect.using(amount=0.05),))
    ticks = drive()
    path = trajectory(robot, *ticks, start=START)
    live = Odometer(robot)
    live.set_pose(START)
    assert_alike(estimates(live, ticks), path)
    reference = Reference(path.time, path.x, path.y, path.yaw)
    record = Ticks(ticks.time, ticks.left.astype(float), ticks.right.astype(float))
    runs = concatenated([match(Run("run", Path("run"), record, reference), robot, 0.3)])
    model = Model(robot, ({},))
    moved = runs.finish - runs.start
    ahead = (moved[:, 0] + 1j * moved[:, 1]) * np.exp(-1j * runs.start[:, 2])
    truth = np.stack([ahead.real, ahead.imag, moved[:, 2]], axis=-1)
    assert runs.count > 20
    plain = predicted_legs(Model(ROBOT, ({},)), runs)
    assert np.abs(plain - truth).max() > 1e-3  # else this would say nothing
    for predicted in (predicted_legs(model, runs), predict_all(model, runs).relative):
        np.testing.assert_allclose(predicted, truth, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("way", WAYS)
def test_a_drift_by_the_heading(way: str) -> None:
    check_effect(drifting(WAYS[way]))
    assert_three_alike(drifting(WAYS[way]))


@pytest.mark.parametrize("way", WAYS)
def test_a_wheel_that_slips_by_the_heading(way: str) -> None:
    assert_three_alike(slipping(WAYS[way]))


def test_a_look_that_depends_on_the_values() -> None:
    assert_three_alike(drifting(only_when_fast))


def test_a_place_that_nobody_declared() -> None:
    """An effect need not say that it looks at the place; one that says so is taken as well."""

    def on_the_spot(drive: Any) -> Any:
        return 4.0 * share_inside(drive.x, drive.y, -0.2, 0.5, 0.8)

    assert_three_alike(slipping(on_the_spot))
    assert_three_alike(slipping(on_the_spot, pose=True))


def test_a_place_that_is_looked_at_only_when_facing_backwards() -> None:
    def on_the_spot(drive: Any) -> Any:
        backwards = np.cos(drive.heading.start) < 0.0
        if not np.any(backwards):
            return 0.0 * drive.duration
        return 4.0 * backwards * share_inside(drive.x, drive.y, -0.2, 0.5, 0.8)

    assert_three_alike(slipping(on_the_spot))


def test_a_map_of_the_floor_is_asked_only_where_the_robot_is() -> None:
    """A place that nobody knows yet would be no row of the map."""
    slippery = np.random.default_rng(2).random((400, 400))

    def by_the_map(drive: Any) -> Any:
        rows = np.clip(np.asarray(drive.x.start / 0.5 + 200.0), 0, 399).astype(int)
        columns = np.clip(np.asarray(drive.y.start / 0.5 + 200.0), 0, 399).astype(int)
        return slippery[rows, columns]

    assert_three_alike(slipping(by_the_map))
