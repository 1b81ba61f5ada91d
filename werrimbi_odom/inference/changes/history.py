# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives over months: what each tells about the robot's parameters, and their course in time.

Each drive is fitted by itself, once, at its own point. Its result is kept as an information matrix,
and a year is put together from these. Parameters scatter from drive to drive by more than the noise
of a drive (warmth, load, another floor). That scatter is estimated from the median of successive
differences, which changes and trends do not move. The estimate of a single drive is shrunk towards
the level of the drives around it (partial pooling, empirical Bayes).

Sources: Efron and Morris, J. Am. Stat. Assoc. 68, 1973 (pooling).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.between_drives import ParameterChange, parameter_changes_of
from werrimbi_odom.inference.changes.change_points import ChangePoints, find_changes, only_these
from werrimbi_odom.inference.changes.drive_estimate import NULLS, DriveEstimate
from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.changes.logarithmic_sizes import out_of_logarithms
from werrimbi_odom.inference.changes.parameter_groups import (
    MOUNT,
    groups_of,
    numbers_of,
    tell_the_scale,
    value_at,
)
from werrimbi_odom.inference.changes.scatter import Values, beyond_scatter, scatter_of
from werrimbi_odom.inference.changes.shapes import Kind
from werrimbi_odom.inference.distributions import chi2_survival
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, FreeParameter
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

BASE_OVER_RADIUS = "base_over_mean_radius"
"""What turns tell of base and radii where nothing tells the robot's scale, as headings alone."""

RATIOS = ("unequal_wheel_radii", BASE_OVER_RADIUS)

KINDS: tuple[Kind, ...] = ("step", "alone", "trend")


@dataclass(frozen=True)
class Number:
    """Course of one parameter over R drives."""

    name: str
    unit: str
    given: float
    """Value in the robot file."""
    own: Floats
    """Estimate by each drive alone, (R,); NaN if the drive does not determine it."""
    own_std: Floats
    pooled: Floats
    """Estimate by each drive, pooled with the drives around it."""
    pooled_std: Floats
    level: Floats
    """Level between the changes."""
    level_std: Floats
    scatter: float
    """Standard deviation from drive to drive, beyond the noise of a drive."""


@dataclass(frozen=True)
class OffNow:
    """A calibration parameter that now differs from the robot file."""

    name: str
    value: float
    std: float
    given: float


@dataclass(frozen=True)
class Course:
    """Course of the parameters of a robot."""

    numbers: tuple[Number, ...]
    changes: tuple[ParameterChange, ...]
    off: tuple[OffNow, ...]
    """Parameters of the robot file that differ from the last drives."""


def course_of(estimates: Sequence[DriveEstimate], robot: Robot, time: Floats) -> Course:
    """Combine the drives into the course of the parameters.

    `estimates`: information of each drive, in order. `time` (R,): times of the drives, rising [s].
    """
    numbers = _numbers(estimates, robot)
    names = tuple(number.name for number in numbers)
    given = np.array([value_at(robot, name, NULLS) for name in names])
    drives = _laid(estimates, names, time)
    limits = np.array([number.undetermined for number in numbers])
    own = _alone(drives, given, limits)
    std = np.sqrt(np.einsum("rii->ri", own.spread))
    heard = std < 0.5 * limits
    scatter = np.array([scatter_of(own.value[on, n], std[on, n]) for n, on in enumerate(heard.T)])
    wide = drives.with_scatter(scatter)
    penalty = max(rules.PENALTY_FLOOR, math.log(max(sum(each.data for each in estimates), 2)))
    sized = tell_the_scale(drives.information, names, given)
    groups = groups_of(names, given, given.size, sized=sized)
    most = rules.MOST_CHANGES if len(estimates) >= rules.SCATTER_DRIVES else 1
    found = find_changes(wide, groups, given, penalty, KINDS, most)
    lasting = beyond_scatter(wide, found, own, scatter)
    if len(lasting) < len(found.steps):
        found = only_these(wide, found, lasting, given, penalty)
    pooled = _pooled(drives, found, scatter)
    own, pooled, levels = (
        out_of_logarithms(each, names, robot)
        for each in (own, pooled, Values(found.levels, found.spread))
    )
    found = replace(found, levels=levels.value, spread=levels.spread)
    values = Values(given[None], np.zeros((1, given.size, given.size)))
    whole = heard[:, [names.index(name) for name in MULTIPLIERS]].any(axis=0)
    shown = tuple(
        Number(name, unit, float(there[0][0]), *alone, *pooled, *level, size)
        for (name, unit, size), there, alone, pooled, level in zip(
            _titles(numbers, scatter, given),
            _shown(names, values),
            _silenced(_shown(names, own), [*limits, *limits[[1, 2, 0]]]),
            _shown(names, pooled),
            _shown(names, Values(found.levels, found.spread)),
            strict=True,
        )
        if np.isfinite(alone[0]).any() and not (name == BASE_OVER_RADIUS and whole.any())
    )
    return Course(
        shown,
        parameter_changes_of(
            found, numbers, names, [str(number) for number in range(len(estimates))]
        ),
        _off(shown, RATIOS if not whole.any() else MULTIPLIERS),
    )


def _numbers(estimates: Sequence[DriveEstimate], robot: Robot) -> tuple[FreeParameter, ...]:
    """Parameters that any drive knows of."""
    known = {name for each in estimates for name in each.names}
    held = {applied.name for applied in robot.effects}
    mounts = [find(name) for name in MOUNT if name not in held]
    return tuple(number for number in numbers_of(robot, mounts) if number.name in known)


def _laid(estimates: Sequence[DriveEstimate], names: Sequence[str], time: Floats) -> DriveNumbers:
    """All drives on the same parameters, with no information about those a drive does not have."""
    information = np.zeros((len(estimates), len(names), len(names)))
    weighted = np.zeros((len(estimates), len(names)))
    for index, each in enumerate(estimates):
        there = [number for number, name in enumerate(names) if name in each.names]
        own = [each.names.index(names[number]) for number in there]
        information[np.ix_([index], there, there)] = each.information[np.ix_(own, own)]
        weighted[index, there] = each.weighted[own]
    return DriveNumbers(tuple(names), information, weighted, time)


def _alone(drives: DriveNumbers, given: Floats, limits: Floats) -> Values:
    """Estimate by each drive alone, with a weak prior at the given values."""
    before = np.diag(limits**-2.0)
    spread = np.asarray(np.linalg.inv(drives.information + before))
    values = np.asarray((spread @ (drives.weighted + before @ given)[..., None])[..., 0])
    return Values(values, spread)


def _silenced(
    shown: Sequence[tuple[Floats, Floats]], limits: Sequence[float]
) -> list[tuple[Floats, Floats]]:
    """Values that are NaN where a drive tells less than the prior."""
    heard = [std < 0.5 * limit for (_, std), limit in zip(shown, limits, strict=True)]
    return [
        (np.where(told, value, np.nan), np.where(told, std, np.nan))
        for (value, std), told in zip(shown, heard, strict=True)
    ]


def _pooled(drives: DriveNumbers, found: ChangePoints, scatter: Floats) -> Values:
    """Estimate of each drive, shrunk towards the level by their relative information."""
    wide = np.diag(scatter**2)
    shrunk = np.linalg.inv(np.eye(scatter.size) + wide @ drives.information)
    level = found.levels[..., None]
    news = drives.weighted[..., None] - drives.information @ level
    own = shrunk @ wide
    return Values((level + own @ news)[..., 0], own + found.spread)


def _titles(
    numbers: Sequence[FreeParameter], scatter: Floats, given: Floats
) -> list[tuple[str, str, float]]:
    """Names, units and scatter of all that is shown."""
    found = [
        (number.name, number.unit, float(size))
        for number, size in zip(numbers, scatter, strict=True)
    ]
    base, left, right = (float(scatter[part] / given[part]) for part in (0, 1, 2))
    both, mean = math.hypot(left, right), 0.5 * float(given[1] + given[2])
    return [
        *found,
        ("unequal_wheel_radii", "", both),
        ("wheel_radius_scale", "", 0.5 * both * mean),
        (BASE_OVER_RADIUS, "", math.hypot(base, 0.5 * both) * float(given[0]) / mean),
    ]


def _shown(names: Sequence[str], values: Values) -> list[tuple[Floats, Floats]]:
    """Values and standard deviations: parameters, the radii's ratio and mean, base over mean."""
    std = np.sqrt(np.maximum(np.einsum("rii->ri", values.spread), 0.0))
    found = [(values.value[:, number], std[:, number]) for number in range(len(names))]
    where = [names.index(name) for name in MULTIPLIERS]
    base, left, right = (values.value[:, number] for number in where)
    spread = values.spread[:, where][:, :, where]
    ratio, mean, none = right / left, 0.5 * (left + right), np.zeros_like(left)
    half = -0.5 * base / mean**2
    for value, slopes in (
        (ratio, np.stack([none, -ratio / left, 1.0 / left], axis=-1)),
        (mean, np.stack([none, none + 0.5, none + 0.5], axis=-1)),
        (base / mean, np.stack([1.0 / mean, half, half], axis=-1)),
    ):
        variance = np.einsum("ri,rij,rj->r", slopes, spread, slopes)
        found.append((value, np.sqrt(np.maximum(variance, 0.0))))
    return found


def _off(numbers: Sequence[Number], names: Sequence[str]) -> tuple[OffNow, ...]:
    """Those of the sizes that differ significantly, and noticeably, from the last drives."""
    off = []
    for number in numbers:
        if number.name not in names:
            continue
        value, std = float(number.level[-1]), float(number.level_std[-1])
        away = value - number.given
        chance = len(MULTIPLIERS) * chi2_survival(away**2 / max(std**2, 1e-30), 1)
        if chance < rules.SURE and abs(away / number.given) > rules.CALIBRATE_AGAIN:
            off.append(OffNow(number.name, value, std, number.given))
    return tuple(off)
