# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Support of an effect: its inputs and output channels, found by evaluating it on trial."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.inference.fitting.candidate import Candidate, usual_view
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.identifiable import NOT_BY_COURSE
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.drive_of_run import mirrored
from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.effects_over_run import watched
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

ON_THE_FLOOR = frozenset({"heading", "x", "y"})
"""Quantities of a drive that have a meaning only in axes common to all drives."""

ACCELERATIONS = frozenset({"left_acceleration", "right_acceleration"})

LAGGING = ACCELERATIONS | {"castor_angle"}
"""Quantities that are known only to within a delay: a law of them may be early or late."""


class Support(NamedTuple):
    """Inputs and outputs of an effect's law."""

    inputs: frozenset[str]
    """Quantities of `Drive`, and extra channels, that the law reads."""
    outputs: frozenset[str]
    """Error channels that it can explain: left, right, along, sideways, heading."""
    even: bool = False
    """Whether it is the same law for a robot seen in a mirror."""


def support_of(candidate: Candidate, drive: Drive[Floats]) -> Support:
    """Support of a candidate, by evaluation on the steps of recorded runs."""
    effect = candidate.effect
    if effect.stage == "reference" and usual_view(effect).wander != 0.0:
        return _OF_A_GYRO
    if effect.stage not in ("wheels", "body"):
        return Support(frozenset(), frozenset())
    seen = watched(drive)
    before = _unit_motion(effect, drive)
    outputs: set[str] = set()
    for coordinate in candidate.coordinates:
        after = effect.apply(before, seen, **candidate.with_value(coordinate, 1.0).values)
        changed = [not np.allclose(part, 1.0, rtol=0.0, atol=1e-15) for part in after]
        if effect.stage == "wheels":
            outputs |= _OF_WHEELS[changed[0], changed[1]]
        else:
            names = ("along", "sideways", "heading")
            outputs |= {name for name, is_so in zip(names, changed, strict=True) if is_so}
    return Support(frozenset(seen.asked), frozenset(outputs))


def is_even(law: AppliedEffect, drive: Drive[Floats]) -> bool:
    """Whether a law of wheels or body does the mirror image to a robot seen in a mirror."""
    if law.effect.stage not in ("wheels", "body"):
        return False
    one = np.ones_like(drive.duration)
    of_wheels = law.effect.stage == "wheels"
    before: Any = WheelTravel(one, 2.0 * one) if of_wheels else BodyMotion(one, one, one)

    def seen_in_mirror(moved: Any) -> Any:
        if of_wheels:
            return WheelTravel(moved.right, moved.left)
        return BodyMotion(moved.along, -moved.sideways, -moved.turn)

    after = law.effect.apply(before, drive, **law.values)
    other = law.effect.apply(seen_in_mirror(before), mirrored(drive), **law.values)
    changed, its = (
        np.subtract(now, was) for now, was in ((after, before), (seen_in_mirror(other), before))
    )
    return bool(np.allclose(changed, its, rtol=0.0, atol=1e-6 * np.max(np.abs(changed))))


def askable(effects: Sequence[Effect], runs: Concatenated, robot: Robot) -> tuple[Effect, ...]:
    """Effects that the reference can show: a slope of the floor needs axes fixed to the floor.

    Effects that read a channel are kept: their other inputs are not known here.
    """
    effects = able(effects, runs, robot)
    if not runs.own_axes:
        return effects
    drive = runs.drive(robot)
    return tuple(
        each for each in effects if each.lacks(()) or not _reads(each, ON_THE_FLOOR, drive)
    )


def able(effects: Sequence[Effect], runs: Concatenated, robot: Robot) -> tuple[Effect, ...]:
    """Effects that such counters can show, and such a robot and such a reference can have.

    The acceleration by a coarse counter is that of its steps, which a linear law adds up to the
    true one, and no other does. A scan tells place and heading of one instant: no gyro has a part
    in it, and its heading is not later than its place, unless a gyro's headings were put in. Where
    no heading was measured, none is late or drifts. Where headings were laid upon the direction of
    the path, the robot drives along them by construction. A clock gains nothing where the
    recorder's shows that it does not. A robot that is driven by four wheels has no castor.
    """
    if robot.wheels_a_side > 1:
        effects = [each for each in effects if not _of_a_castor(each)]
    if runs.has_coarse_counters:
        drive = runs.drive(robot)
        effects = [each for each in effects if each.lacks(()) or not _bends(each, drive)]
    if runs.of_one_rate:
        effects = [each for each in effects if not _of_a_clock(each)]
    if runs.has_course_headings:
        effects = [each for each in effects if each.name not in NOT_BY_COURSE]
    of_places = runs.positions_alone or runs.own_axes
    if not of_places or runs.has_gyro_headings:
        return tuple(effects)
    return tuple(each for each in effects if each.stage != "reference" or not _of_a_gyro(each))


def _of_a_castor(effect: Effect) -> bool:
    return effect.sketch is not None and effect.sketch.drawing == "castor"


def _of_a_clock(effect: Effect) -> bool:
    """Whether an effect is of a clock that runs at another rate."""
    return effect.stage == "reference" and usual_view(effect).clock_drift != 0.0


def _of_a_gyro(effect: Effect) -> bool:
    """Whether an effect is of headings that another sensor gives than places."""
    view = usual_view(effect)
    return bool(view.heading_delay != 0.0 or view.wander != 0.0)


def _reads(effect: Effect, inputs: frozenset[str], drive: Drive[Floats]) -> bool:
    return not inputs.isdisjoint(support_of(_typical(effect), drive).inputs)


def _bends(effect: Effect, drive: Drive[Floats]) -> bool:
    """Whether a law of the acceleration is no straight line of it."""
    if not _reads(effect, ACCELERATIONS, drive):
        return False
    law = _typical(effect)
    before = _unit_motion(effect, drive)
    none, half, whole = (
        drive.but(**{name: factor * getattr(drive, name) for name in ACCELERATIONS})
        for factor in (0.0, 0.5, 1.0)
    )
    for coordinate in law.coordinates:
        values = law.with_value(coordinate, 1.0).values
        after = [np.stack(effect.apply(before, seen, **values)) for seen in (none, half, whole)]
        if not np.allclose(after[0] + after[2], 2.0 * after[1], rtol=0.0, atol=1e-12):
            return True
    return False


def _unit_motion(effect: Effect, drive: Drive[Floats]) -> Any:
    """Motion of 1 in each step and coordinate, as an effect of wheels or of the body takes it."""
    one = np.ones_like(drive.duration)
    return WheelTravel(one, one) if effect.stage == "wheels" else BodyMotion(one, one, one)


def _typical(effect: Effect) -> Candidate:
    shape = {name: item.typical for name, item in effect.parameters.items() if item.tries}
    return Candidate(effect, shape)


_OF_A_GYRO = Support(frozenset({"time"}), frozenset({"sideways", "heading"}))
"""Of a heading that drifts with time: in axes that turn, what is driven ahead goes sideways. Other
views of a reference are geometry, exact, and leave nothing of a law."""

_OF_WHEELS = {
    (False, False): frozenset[str](),
    (True, False): frozenset({"left"}),
    (False, True): frozenset({"right"}),
    (True, True): frozenset({"left", "right", "along", "heading"}),
}
