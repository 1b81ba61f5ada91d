# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Headings at the start of runs whose reference measures positions only: where a fit begins."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import START_YAW, Model
from werrimbi_odom.inference.fitting.prediction import predict
from werrimbi_odom.inference.fitting.whitened_innovations import Point, unexpected
from werrimbi_odom.inference.legs.matched_run import MatchedRun
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_FIRST_NODES = 12
ALL_ROUND = np.arange(8) * 0.25 * np.pi
"""Trial directions [rad]."""


def first_heading(robot: Robot, run: MatchedRun) -> float | None:
    """Start heading that aligns the first legs with the measured positions; None if measured."""
    if run.measured.has_yaw[0]:
        return None
    heading, pose, predicted = 0.0, 0j, [0j]
    for x, y, turn in predict(robot, run, 0.0).relative:
        pose += np.exp(1j * heading) * complex(x, y)
        heading += turn
        predicted.append(pose)
    mirror = -1.0 if view_of(robot.effects).mirrored else 1.0
    measured = run.measured.x + 1j * mirror * run.measured.y
    usable = np.flatnonzero(run.measured.has_position)[:_FIRST_NODES]
    if usable.size < 2:
        return 0.0
    shape = np.array(predicted)[usable] - predicted[usable[0]]
    return float(np.angle(np.sum(np.conj(shape) * (measured[usable] - measured[usable[0]]))))


def only_first_heading(run: MatchedRun) -> bool:
    """Whether a heading was measured at the first pose alone, and positions tell it as well."""
    told = run.measured.has_position.sum() >= rules.FEW_POSES
    return bool(told and run.measured.has_yaw[0] and not run.measured.has_yaw[1:].any())


def turned_to_the_first_legs(runs: Concatenated, point: Point) -> tuple[Point, float]:
    """Re-estimate unmeasured start headings from the first legs, where that lowers the cost.

    A heading fitted without some effect can be so far off once the effect is in that least squares
    does not converge. Also return the sum of the squared whitened innovations.
    """
    return _cheapest(runs, point, [_of_the_first_legs(runs, point.model)])


def turned_to_all_sides(runs: Concatenated, point: Point) -> Point:
    """Re-estimate unmeasured start headings from the first legs, or from trial headings all round.

    In a drive that begins with spins on the spot the first legs do not tell the heading, and least
    squares would not find one that is far away.
    """
    if not starts_unmeasured(point.model):
        return point
    known = [own.get(START_YAW) for own in point.model.own]
    tried = [[None if at is None else at + turn for at in known] for turn in ALL_ROUND[1:]]
    return _cheapest(runs, point, [_of_the_first_legs(runs, point.model), *tried])[0]


def _of_the_first_legs(runs: Concatenated, model: Model) -> list[float | None]:
    return [first_heading(model.of_run(index), run) for index, run in enumerate(runs.runs)]


def _cheapest(
    runs: Concatenated, point: Point, headings: Iterable[Sequence[float | None]]
) -> tuple[Point, float]:
    """Choose the start heading of each run among its own and some others, by the run's cost."""
    chosen = point.model.own
    least = squares_of_runs(runs, point)
    for tried in headings:
        own = tuple(
            dict(mine) if at is None else {**mine, START_YAW: at}
            for mine, at in zip(point.model.own, tried, strict=True)
        )
        squares = squares_of_runs(runs, replace(point, model=Model(point.model.robot, own)))
        better = squares < least
        least = np.where(better, squares, least)
        chosen = tuple(
            new if took else mine for new, mine, took in zip(own, chosen, better, strict=True)
        )
    return replace(point, model=Model(point.model.robot, chosen)), float(np.sum(least))


def starts_unmeasured(model: Model) -> bool:
    """Whether a run starts with a heading that was not measured."""
    return any(START_YAW in mine for mine in model.own)


def squares_of_runs(runs: Concatenated, point: Point) -> Floats:
    """Sum of the squared whitened innovations of each run, shape (runs,)."""
    of_legs = np.sum(unexpected(runs, point).whitened() ** 2, axis=-1)
    return np.asarray(np.add.reduceat(of_legs, runs.legs[:-1]))
