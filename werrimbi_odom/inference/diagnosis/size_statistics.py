# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Statistics of base and radii in a fit: what each subset is worth, and how well each is known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import calibration_deviation, std_as_effect
from werrimbi_odom.inference.fitting.clusters import effective_freedom
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED, SIZE, every_direction
from werrimbi_odom.inference.fitting.whitened_innovations import Design
from werrimbi_odom.inference.linear import Nuisance, nuisance, score_test
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


class Rise(NamedTuple):
    """A subset of the calibration effects, and the rise of the cost when the others are reset."""

    kept: tuple[str, ...]
    rise: float
    fitted: bool
    """Whether the data determine all of them."""
    believed: bool
    """Whether the others stay within the uncertainty of a tape, and can be observed at all."""


def _sizes_in(design: Design, robot: Robot) -> tuple[Nuisance, Floats]:
    """Span of all but the multipliers, and the derivatives (n, 3) in the calibration effects."""
    ways = every_direction(design.columns, robot)
    _, flat = design.flat()
    names = design.names
    others = nuisance(flat[:, [name not in MULTIPLIERS for name in names]])
    return others, flat @ ways.matrix[:, [ways.names.index(name) for name in CALIBRATED]]


def freedom_of_sizes(runs: Concatenated, design: Design, robot: Robot) -> dict[str, float]:
    """Degrees of freedom in which the parts tell the scatter of each calibration effect."""
    others, marks = _sizes_in(design, robot)
    free = others.residual(marks)
    white, _ = design.flat()
    found = {}
    for index, name in enumerate(CALIBRATED):
        beside = nuisance(np.delete(free, index, axis=1))
        found[name] = effective_freedom(runs, white, beside.residual(free[:, index]))
    return found


def calibration_rises(
    design: Design, robot: Robot, given: Robot, held: Sequence[str]
) -> list[Rise]:
    """For each subset of the calibration effects, the rise of the cost when the others are reset.

    Everything else is fitted again, to first order. Effects in `held`, which the data do not
    determine beside the others, are not fitted, but may replace one that is (on a circle the base
    and the ratio of the radii are equivalent).
    """
    flat = design.flat()
    others, marks = _sizes_in(design, robot)
    free = others.residual(marks)
    with_held_as_given = others.residual(flat[0]) - free @ calibration_deviation(robot, given)
    found = []
    for chosen in map(list, _subsets(range(len(CALIBRATED)))):
        test = score_test(marks[:, chosen], free[:, chosen], with_held_as_given)
        kept = tuple(CALIBRATED[index] for index in chosen)
        sizes = zip(kept, np.zeros(len(kept)) if test is None else test.coefficients, strict=True)
        off = [abs(size) for name, size in sizes if name in held]
        believed = max(off, default=0.0) < rules.SIGNIFICANT * rules.CALIBRATION_KNOWN
        believed &= design.sized or SIZE not in kept
        found.append(Rise(kept, -test.gain if test else 0.0, not off, believed))
    least = min(each.rise for each in found if each.fitted)
    return [each._replace(rise=each.rise - least) for each in found]


def variance_inflation_of_sizes(
    design: Design, covariance: Floats, wide: Floats, robot: Robot
) -> dict[str, float]:
    """Factor by which the variance of each calibration effect is widened, for all three."""
    names = design.names
    where = [names.index(name) for name in MULTIPLIERS]
    inside = covariance[np.ix_(where, where)]
    wider = inside * np.outer(wide[where], wide[where])
    found = {}
    for name in CALIBRATED:
        usual, now = (std_as_effect(name, robot, each) for each in (inside, wider))
        found[name] = max((now / usual) ** 2, 1.0) if usual > 0.0 else 1.0
    return found


def _subsets(items: Sequence[int]) -> Iterator[tuple[int, ...]]:
    for size in range(len(items) + 1):
        yield from combinations(items, size)
