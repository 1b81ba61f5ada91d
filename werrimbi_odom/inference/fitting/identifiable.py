# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which numbers the data hold: directions in which a fit may move, and those that it must not.

The three multipliers are taken as base, ratio of the radii, and size of both. A heading knows the
right and the left radius over the base, two numbers: base and ratio are then fitted and both radii
keep their mean as it was given, for that is what a tape knows best. (An effect with a length of its
own would tell them apart, at the price of that length: play over base is known, play is not.) What
is held is neither told with an error bar, nor written, nor offered as a rival.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.fitting.design import Design
from werrimbi_odom.inference.fitting.free_parameters import (
    MULTIPLIERS,
    FreeParameter,
    Model,
    changed,
)
from werrimbi_odom.inference.linear import admitted, covariance_of, nuisance
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

SIZE = "wheel_radius_scale"
CALIBRATED = ("track_width", "unequal_wheel_radii", SIZE)
"""Effects that are the robot file's own multipliers by another name, the first to be kept first."""


@dataclass(frozen=True, slots=True)
class Directions:
    """What a fit may move: q directions in the p columns of a design."""

    names: tuple[str, ...]
    """Of each: a number, or one of `CALIBRATED`."""
    matrix: Floats
    """Moves of the columns for a unit of each, shape (p, q)."""
    limits: Floats
    """Standard deviation of each above which the data say less than is known beforehand, (q,)."""
    shared: list[int]
    """Those that all runs have in common."""
    held: tuple[str, ...]
    """Shared directions that the data do not determine."""

    def covariance(self, flat: Floats) -> Floats:
        """Covariance of the columns' values (p, p) for whitened derivatives (n, p)."""
        inside = covariance_of(flat @ self.matrix)
        return np.asarray(self.matrix @ inside @ self.matrix.T)


def every_direction(columns: Sequence[tuple[FreeParameter, int]], robot: Robot) -> Directions:
    """All directions of a design's columns; those of single runs have no limit."""
    names = [number.name for number, _ in columns]
    found: list[tuple[str, dict[int, float], float, bool]] = []
    calibrated = all(name in names for name in MULTIPLIERS)
    if calibrated:
        base, left, right = (names.index(name) for name in MULTIPLIERS)
        values = {index: float(getattr(robot, names[index])) for index in (base, left, right)}
        limit = columns[base][0].undetermined
        signs = ({base: 1.0}, {left: -0.5, right: 0.5}, {left: 1.0, right: 1.0})
        for name, parts in zip(CALIBRATED, signs, strict=True):
            moves = {index: sign * values[index] for index, sign in parts.items()}
            found.append((name, moves, limit, True))
    for index, (number, run) in enumerate(columns):
        if calibrated and number.name in MULTIPLIERS:
            continue
        found.append((number.name, {index: 1.0}, number.undetermined, run < 0))
    matrix = np.zeros((len(columns), len(found)))
    for column, (_, moves, _, _) in enumerate(found):
        for index, move in moves.items():
            matrix[index, column] = move
    return Directions(
        tuple(name for name, *_ in found),
        matrix,
        np.array([limit for _, _, limit, _ in found]),
        [number for number, (*_, common) in enumerate(found) if common],
        (),
    )


def determined(design: Design, robot: Robot) -> Directions:
    """The directions that the data determine, and those of single runs."""
    every = every_direction(design.columns, robot)
    marks = design.flat()[1] @ every.matrix
    asked = [index for index in every.shared if design.sized or every.names[index] != SIZE]
    own = [
        index
        for index in range(len(every.names))
        if index not in every.shared and marks[:, index].any()
    ]
    beside = nuisance(marks[:, own])
    free = beside.residual(marks)
    shared = _plainest_first(asked, every.names, np.linalg.norm(free, axis=0))

    def known(tried: list[int]) -> bool:
        columns = [shared[number] for number in tried]
        spread = np.sqrt(np.diag(covariance_of(free[:, columns])))
        return bool(np.all(spread <= every.limits[columns]))

    kept = sorted(shared[index] for index in admitted(marks[:, shared], beside, known))
    chosen = [*kept, *own]
    return Directions(
        tuple(every.names[index] for index in chosen),
        every.matrix[:, chosen],
        every.limits[chosen],
        list(range(len(kept))),
        tuple(every.names[index] for index in every.shared if index not in kept),
    )


def _plainest_first(asked: Sequence[int], names: Sequence[str], seen: Floats) -> list[int]:
    """What is asked for, the calibration by how plainly it is seen and then the rest as it stands.

    A robot that veers on straight lines has unequal wheels; once they are, another base would turn
    the veer too, a hundred times less, and must not take their place. Of two that are seen as
    plainly as each other (base and size, by headings) the first is the first.
    """
    left = [index for index in asked if names[index] in CALIBRATED]
    order = []
    while left:
        most = max(seen[index] for index in left)
        order.append(next(index for index in left if seen[index] >= 0.5 * most))
        left.remove(order[-1])
    return [*order, *(index for index in asked if names[index] not in CALIBRATED)]


def put_back(
    model: Model, given: Model, held: Iterable[str], numbers: Sequence[FreeParameter]
) -> Model:
    """The model with what is held as it was given."""
    names = set(held)
    changes = {number.name: given.value(number) for number in numbers if number.name in names}
    if names & set(CALIBRATED):
        here, there = (_sizes(item.robot) for item in (model, given))
        base, ratio, size = (
            before if name in names else now
            for name, now, before in zip(CALIBRATED, here, there, strict=True)
        )
        changes |= dict(
            zip(
                MULTIPLIERS,
                (base, size * math.exp(-0.5 * ratio), size * math.exp(0.5 * ratio)),
                strict=True,
            )
        )
        if names >= set(CALIBRATED):  # to the last digit
            changes |= {name: float(getattr(given.robot, name)) for name in MULTIPLIERS}
    return Model(changed(model.robot, changes), model.own)


def _sizes(robot: Robot) -> tuple[float, float, float]:
    """Base, logarithm of right over left radius, their geometric mean."""
    base, left, right = (float(getattr(robot, name)) for name in MULTIPLIERS)
    return base, math.log(right / left), math.sqrt(left * right)
