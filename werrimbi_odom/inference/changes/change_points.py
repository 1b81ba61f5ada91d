# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Selection of change points: forward selection, refinement of their drives, backward elimination.

Every group of parameters may take every shape at every drive. The change with the highest penalised
gain is selected, then the next beside it. In the end each is tested again beside all others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.changes.parameter_groups import NumberGroup
from werrimbi_odom.inference.changes.shapes import Kind, Rows, Shape, first_drives, gains, rows_of
from werrimbi_odom.inference.distributions import bonferroni, chi2_survival
from werrimbi_odom.inference.linear import Nuisance, nuisance, score_test
from werrimbi_odom.model.pose import Floats

_FEW = 5
"""Number of changes up to which all are refined after each new one; beyond it only at the end."""


@dataclass(frozen=True, slots=True)
class GroupChange:
    """A change of a group over the drives."""

    group: NumberGroup
    shape: Shape
    gain: float = 0.0
    """Fall of the squares by this change, beside all others."""
    degrees: int = 1
    p_value: float = 1.0
    """P-value, corrected for all changes tried (Bonferroni)."""
    span: tuple[int, int] = (0, 0)
    """First and last drive at which it may begin, by the likelihood."""


@dataclass(frozen=True)
class ChangePoints:
    """Course of the parameters over the drives, with their changes."""

    steps: tuple[GroupChange, ...]
    """In the order of the drives."""
    levels: Floats
    """Value of each parameter in each drive, without its scatter from drive to drive; (R, s)."""
    spread: Floats
    """Covariance of the levels, (R, s, s)."""
    tried: int
    """Number of changes tried."""


def find_changes(
    drives: DriveNumbers,
    groups: Sequence[NumberGroup],
    given: Floats,
    penalty: float,
    kinds: Sequence[Kind] = ("step", "alone"),
    most: int = rules.MOST_CHANGES,
) -> ChangePoints:
    """Find the changes.

    `drives`: in the order in which they were driven. `groups`: groups of parameters that may
    change. `given` (s,): values of the parameters, near which the levels stay in what the drives do
    not determine: by headings alone, the robot's scale. `penalty`: penalty of each free parameter;
    the drive of the change counts as one. `kinds`: shapes of changes to try. `most`: largest number
    of changes.
    """
    rows = rows_of(drives)
    tried = sum(len(first_drives(kind, drives.count)) for kind in kinds) * len(groups)
    steps: list[GroupChange] = []
    while len(steps) < most:
        best = _best(rows, groups, kinds, steps, penalty)
        if best is None or not _earned(best, penalty, tried):
            break
        steps.append(best)
        if len(steps) <= _FEW:
            steps = _refined(rows, groups, kinds, steps, penalty)
    steps = _wheel_by_wheel(_refined(rows, groups, kinds, steps, penalty), groups)
    return _eliminated(rows, steps, given, penalty, tried)


def only_these(
    drives: DriveNumbers,
    found: ChangePoints,
    kept: Sequence[GroupChange],
    given: Floats,
    penalty: float,
) -> ChangePoints:
    """Some of the changes that were found, without the others.

    A new search among the groups that are left would find the refused ones of the same group again.
    """
    return _eliminated(rows_of(drives), kept, given, penalty, found.tried)


def _eliminated(
    rows: Rows, steps: Sequence[GroupChange], given: Floats, penalty: float, tried: int
) -> ChangePoints:
    """Backward elimination, and the levels between the changes that remain."""
    while steps:
        steps = [_beside_others(rows, steps, number) for number in range(len(steps))]
        least = min(steps, key=lambda step: _worth(step, penalty))
        if _earned(least, penalty, tried):
            break
        steps = [step for step in steps if step is not least]
    told = sorted(
        (
            replace(step, p_value=_chance(step, tried), span=_span(rows, steps, number))
            for number, step in enumerate(steps)
        ),
        key=lambda step: (step.shape.first, -step.gain),
    )
    return ChangePoints(tuple(told), *levels_of(rows, told, given), tried)


def _wheel_by_wheel(
    steps: Sequence[GroupChange], groups: Sequence[NumberGroup]
) -> list[GroupChange]:
    """The same changes, with those of both wheels and of one told as one of each wheel.

    They are the same where they are at the same drive: both wheels 0.7 % smaller and the right one
    1.4 % larger is a left wheel that is smaller, and a right one that is larger.
    """
    wheels = {each.what: each for each in groups if each.what in ("left_wheel", "right_wheel")}
    there = {(step.group.what, step.shape) for step in steps}
    found = []
    for step in steps:
        other = [each for what, each in wheels.items() if (what, step.shape) not in there]
        one_of_two = step.group.what == "both_wheels" and len(wheels) == 2 and len(other) == 1
        found.append(replace(step, group=other[0]) if one_of_two else step)
    return found


def levels_of(rows: Rows, steps: Sequence[GroupChange], given: Floats) -> tuple[Floats, Floats]:
    """Parameters in each drive (R, s) and their covariance (R, s, s), with these changes.

    `given` (s,): as of `find_changes`.
    """
    columns = _columns(rows, steps)
    size = np.sqrt(np.sum(columns**2, axis=0))
    unit = np.where(size > 0.0, size, 1.0)
    inverse = np.linalg.pinv((columns / unit).T @ (columns / unit), rcond=1e-12, hermitian=True)
    inverse = inverse / np.outer(unit, unit)
    near = np.zeros(unit.size)
    near[: given.size] = given
    found = near + inverse @ (columns.T @ (rows.seen.ravel() - columns @ near))
    count, width = rows.seen.shape
    moves = np.concatenate(
        [
            np.repeat(np.eye(width)[None], count, axis=0),
            *(step.shape.over(rows.time)[:, None, None] * step.group.directions for step in steps),
        ],
        axis=-1,
    )
    return np.asarray(moves @ found), np.asarray(moves @ inverse @ moves.swapaxes(-1, -2))


def _best(
    rows: Rows,
    groups: Sequence[NumberGroup],
    kinds: Sequence[Kind],
    steps: Sequence[GroupChange],
    penalty: float,
) -> GroupChange | None:
    beside = _beside(rows, steps)
    rest = beside.residual(rows.seen.ravel())
    found: list[GroupChange] = []
    for group in groups:
        for kind in kinds:
            each = gains(rows, beside, rest, group.directions, kind)
            if not each.gain.size:
                continue
            worth = each.gain - penalty * each.degrees - _doubt(kind)
            index = int(np.argmax(worth))
            if each.degrees[index] > 0:
                shape = Shape(kind, each.first[index])
                found.append(
                    GroupChange(group, shape, float(each.gain[index]), int(each.degrees[index]))
                )
    return max(found, key=lambda step: _worth(step, penalty), default=None)


def _worth(step: GroupChange, penalty: float) -> float:
    return step.gain - penalty * step.degrees - _doubt(step.shape.kind)


def _doubt(kind: Kind) -> float:
    """Extra penalty of a trend: with few drives a trend and a step look alike."""
    return rules.RIVAL if kind == "trend" else 0.0


def _refined(
    rows: Rows,
    groups: Sequence[NumberGroup],
    kinds: Sequence[Kind],
    steps: list[GroupChange],
    penalty: float,
) -> list[GroupChange]:
    """Search each change again beside the others: the first was found without them."""
    if len(steps) < 2:
        return steps
    for number in range(len(steps)):
        others = [step for index, step in enumerate(steps) if index != number]
        best = _best(rows, groups, kinds, others, penalty)
        own = _beside_others(rows, steps, number)
        if best is not None and _worth(best, penalty) > _worth(own, penalty):
            steps[number] = best
    return steps


def _beside_others(rows: Rows, steps: Sequence[GroupChange], number: int) -> GroupChange:
    step = steps[number]
    beside = _beside(rows, [each for index, each in enumerate(steps) if index != number])
    column = rows.column(step.shape, step.group.directions)
    rest = beside.residual(rows.seen.ravel())
    test = score_test(column, beside.residual(column), rest)
    return replace(step, gain=test.gain, degrees=test.degrees) if test else replace(step, gain=0.0)


def _span(rows: Rows, steps: Sequence[GroupChange], number: int) -> tuple[int, int]:
    """Drives at which the likelihood of a change is nearly as high as at the best."""
    step = steps[number]
    beside = _beside(rows, [each for index, each in enumerate(steps) if index != number])
    rest = beside.residual(rows.seen.ravel())
    each = gains(rows, beside, rest, step.group.directions, step.shape.kind)
    if step.shape.kind == "alone" or step.shape.first not in each.first:
        return step.shape.first, step.shape.first
    place = step.shape.first - each.first.start
    near = each.gain >= each.gain[place] - rules.WHICH_DRIVE
    low = high = place
    while low > 0 and near[low - 1]:
        low -= 1
    while high + 1 < near.size and near[high + 1]:
        high += 1
    return each.first[low], each.first[high]


def _earned(step: GroupChange, penalty: float, tried: int) -> bool:
    return _worth(step, penalty) > penalty and _chance(step, tried) < rules.SURE


def _chance(step: GroupChange, tried: int) -> float:
    return bonferroni(tried, chi2_survival(step.gain, step.degrees))


def _beside(rows: Rows, steps: Sequence[GroupChange]) -> Nuisance:
    return nuisance(_columns(rows, steps))


def _columns(rows: Rows, steps: Sequence[GroupChange]) -> Floats:
    taken = [rows.column(step.shape, step.group.directions) for step in steps]
    return np.concatenate([rows.constant, *taken], axis=-1)
