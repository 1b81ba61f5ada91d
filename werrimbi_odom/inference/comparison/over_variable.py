# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Binned errors over a variable, and errors of one wheel over its own angle.

A leg of a metre spans several turns of a wheel and shows nothing within a turn, so wheel errors are
taken from the shortest reference intervals.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats

_BINS = 12


_FEWEST = 5  # least number of legs in a bin


def binned(
    values: Floats, error: Floats, *, periodic: bool
) -> tuple[Floats, Floats, Floats, NDArray[np.intp]]:
    """Centre, mean, standard error and number of rows of bins with equal numbers of rows.

    `values`, `error`: variable, and error of each row. `periodic`: use bins of equal width over a
    whole turn in degrees instead.
    """
    parts = max(2, min(_BINS, values.size // (2 * _FEWEST)))
    edges = (
        np.linspace(-180.0, 180.0, _BINS + 1)
        if periodic
        else np.unique(np.quantile(values, np.linspace(0.0, 1.0, parts + 1)))
        if values.size
        else np.zeros(0)
    )
    found = []
    for low, high in pairwise(edges.tolist()):
        mine = (values >= low) & ((values < high) | (high == edges[-1]))
        count = int(mine.sum())
        if count < _FEWEST:
            continue
        part = error[mine]
        found.append(
            (float(values[mine].mean()), float(part.mean()), float(part.std(ddof=1)), count)
        )
    table = np.array(found).reshape(-1, 4)
    return (
        table[:, 0],
        table[:, 1],
        table[:, 2] / np.sqrt(np.maximum(table[:, 3], 1.0)),
        table[:, 3].astype(np.intp),
    )


_PARTS = 16
_FEW = 8  # least number of intervals in a part of a turn


FINE = np.linspace(0.0, 360.0, 91)


def wheel_errors(comparison: Comparison, index: int, side: int) -> tuple[Floats, Floats, Floats]:
    """Wheel angle [rad], error [m] and travel [m] in each reference interval of a run.

    `comparison`: the comparison. `index`: index of the run. `side`: -1 for the left wheel, +1 for
    the right one.
    """
    group = next(item for item in comparison.prepared.groups if index in item.index)
    own = group.index.index(index)
    every, path = group.every, comparison.paths[index]
    robot = comparison.model.of_run(index)
    travel, drive = every.raw(robot), every.drive(robot)
    legs = slice(every.legs[own], every.legs[own + 1])
    begin, end = every.begin[legs], every.end[legs]
    angle = drive.left_angle if side < 0 else drive.right_angle
    rolled = travel.left if side < 0 else travel.right
    sums = np.concatenate([[0.0], np.cumsum(rolled)])
    last = np.maximum(end, begin + 1) - 1
    middle = 0.5 * (angle.start[begin] + angle.end[last])
    # From the point and the axes of the reference to those of the robot.
    view, turned = view_of(robot.effects), path.intervals[:, 2]
    along = np.cos(view.yaw) * path.intervals[:, 0] - np.sin(view.yaw) * path.intervals[:, 1]
    error = along + (view.left + side * 0.5 * robot.track) * turned
    return middle, error, sums[end] - sums[begin]


def over_a_turn(angle: Floats, error: Floats, travel: Floats) -> tuple[Floats, Floats, Floats]:
    """Centres [°], error per travel and its standard error [mm/m] in equal parts of a turn."""
    known = np.isfinite(error) & (np.abs(travel) > 0.0)
    part = np.floor(np.mod(angle, 2.0 * np.pi) / (2.0 * np.pi) * _PARTS).astype(int) % _PARTS
    mean, spread = np.full(_PARTS, np.nan), np.full(_PARTS, np.nan)
    for number in range(_PARTS):
        mine = known & (part == number)
        weight = travel[mine]
        total = float(np.sum(weight**2))
        if mine.sum() < _FEW or total <= 0.0:
            continue
        slope = float(np.sum(weight * error[mine]) / total)
        left = error[mine] - slope * weight
        mean[number] = 1e3 * slope
        spread[number] = 1e3 * float(np.sqrt(np.sum((weight * left) ** 2)) / total)
    return (np.arange(_PARTS) + 0.5) * 360.0 / _PARTS, mean, spread


def once_a_turn(centre: Floats, mean: Floats, spread: Floats) -> tuple[float, float, Floats]:
    """Amplitude, its standard error, and values of the least-squares wave of one cycle per turn.

    A constant is fitted with it and removed, as it is calibration.
    """
    known = np.isfinite(mean) & (spread > 0.0)
    terms = _terms(centre[known]) / spread[known, None]
    inverse = np.linalg.pinv(terms.T @ terms, hermitian=True)
    values = inverse @ (terms.T @ (mean[known] / spread[known]))
    std = float(np.sqrt(0.5 * (inverse[1, 1] + inverse[2, 2])))
    return float(np.hypot(values[1], values[2])), std, _terms(FINE) @ values


def _terms(degrees: Floats) -> Floats:
    angle = np.radians(degrees)
    return np.stack([np.ones_like(angle), np.cos(angle), np.sin(angle)], axis=-1)
