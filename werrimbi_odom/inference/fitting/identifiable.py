# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Identifiability: directions that the data determine, and directions that a fit must not move.

The three multipliers are parametrised as base, radius ratio and mean radius. A reference of
headings determines each radius over the base, two numbers. Then base and ratio are fitted and the
mean radius stays as given, as a tape measures it best. (An effect with a length of its own could
separate them, at the cost of that length: play over base is identifiable, play alone is not.) A
held direction is not reported with a standard deviation, not written to a file and not tested as an
alternative.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.files.references.course_alignment import ANGLES
from werrimbi_odom.inference.fitting.free_parameters import (
    MULTIPLIERS,
    FreeParameter,
    Model,
    changed,
)
from werrimbi_odom.inference.fitting.whitened_innovations import Design
from werrimbi_odom.inference.linear import admitted, covariance_of, nuisance
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

SIZE = "wheel_radius_scale"
CALIBRATED = ("track_width", "unequal_wheel_radii", SIZE)
"""Effects equivalent to the robot file's multipliers, in order of precedence."""

NOT_BY_COURSE = tuple(ANGLES)
"""Effects that nothing tells where headings were laid upon the direction of the path."""


@dataclass(frozen=True, slots=True)
class Directions:
    """Directions that a fit may move: q directions in the p columns of a design."""

    names: tuple[str, ...]
    """Name of each: a parameter, or one of `CALIBRATED`."""
    matrix: Floats
    """Step of the columns for a unit step along each direction, shape (p, q)."""
    limits: Floats
    """Standard deviation of each above which the data add nothing to prior knowledge, (q,)."""
    shared: list[int]
    """Indices of those that all runs share."""
    held: tuple[str, ...]
    """Shared directions that are not identifiable."""

    def that_move(self, flat: Floats) -> Directions:
        """Those along which anything moves in a whitened Jacobian (n, p); the others are held.

        A fit may end where a direction has no effect: a threshold above all speeds.
        """
        moves = np.asarray(np.any(flat @ self.matrix, axis=0))
        kept = np.flatnonzero(moves)
        return Directions(
            tuple(self.names[index] for index in kept),
            self.matrix[:, kept],
            self.limits[kept],
            [place for place, index in enumerate(kept) if index in self.shared],
            (*self.held, *(self.names[index] for index in self.shared if not moves[index])),
        )

    def covariance(self, flat: Floats) -> Floats:
        """Covariance of the columns' parameters (p, p) for a whitened Jacobian (n, p)."""
        inside = covariance_of(flat @ self.matrix)
        return np.asarray(self.matrix @ inside @ self.matrix.T)


def every_direction(columns: Sequence[tuple[FreeParameter, int]], robot: Robot) -> Directions:
    """All directions of a design's columns; per-run ones have no limit."""
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


def determined(design: Design, robot: Robot, held: Iterable[str] = ()) -> Directions:
    """Identifiable shared directions, and all per-run ones.

    Directions that were `held` come last, so that as a fit proceeds the same ones stay held.
    """
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
    shared = _by_sensitivity(asked, every.names, np.linalg.norm(free, axis=0))
    last = set(held)
    shared.sort(key=lambda index: every.names[index] in last)

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


def _by_sensitivity(asked: Sequence[int], names: Sequence[str], seen: Floats) -> list[int]:
    """Order of precedence: calibration directions by sensitivity, then the others as they are.

    A robot that veers on straight lines has unequal wheels. Once the ratio is fitted, another base
    could explain the veer too, with a hundredth of the sensitivity; it must not replace the ratio.
    Between directions of similar sensitivity (base and size, by headings) the first one wins.
    """
    left = [index for index in asked if names[index] in CALIBRATED]
    order = []
    while left:
        most = max(seen[index] for index in left)
        order.append(next(index for index in left if seen[index] >= 0.5 * most))
        left.remove(order[-1])
    return [*order, *(index for index in asked if names[index] not in CALIBRATED)]


def with_held_as_given(
    model: Model, given: Model, held: Iterable[str], numbers: Sequence[FreeParameter]
) -> Model:
    """Reset the held directions of a model to the given values."""
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
    model = Model(changed(model.robot, changes), model.own)
    return model.with_sizes_of(given.robot) if names >= set(CALIBRATED) else model  # exactly


def _sizes(robot: Robot) -> tuple[float, float, float]:
    """Base, log ratio of right to left radius, and geometric mean radius."""
    base, left, right = (float(getattr(robot, name)) for name in MULTIPLIERS)
    return base, math.log(right / left), math.sqrt(left * right)
