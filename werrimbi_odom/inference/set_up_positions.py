# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The search where positions alone were measured: the heading comes from the wheels.

The drives are cut into windows of some metres, each with a heading of its own at its start (closed
form, as in Procrustes' problem). What is left of a window tells whether the wheels turn the robot
as they should. The wheels' turning is searched over its whole range, then refined.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.set_up_explanation import (
    AS_ENTERED,
    Estimate,
    Setting,
    setting_of,
    wirings,
)
from werrimbi_odom.inference.set_up_findings import SetUpFinding, findings_of
from werrimbi_odom.inference.set_up_records import Complexes, Cuts, Record, cut, effective_track
from werrimbi_odom.inference.set_up_regression import swept
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

WINDOW = 12
"""Cuts in a window."""

MOST_WINDOWS = 60
"""Windows looked at while searching, spread over all drives."""

WIDE_MARGIN = 2.0
"""Another set-up must make the typical error this much smaller than the given one, refined."""


@dataclass(frozen=True, slots=True)
class Windows:
    """Windows of consecutive cuts, as cuts from each window's start; w windows."""

    cuts: Cuts
    """Of w * WINDOW stretches, the first one cut long, the last one a window."""
    floor: float
    """Error below which one fit is as good as another [m]."""

    def misfit(self, left: float, right: float, half_base: float | None = None) -> float:
        """Typical error of a window [m], its own heading fitted, and the scale where not given."""
        gone, _ = swept(self.cuts, left, right)
        gone, move = gone.reshape(-1, WINDOW), self.cuts.move.reshape(-1, WINDOW)
        scale = _scale(gone, move) if half_base is None else half_base
        facing = _facing(gone, move)
        off = np.abs(move - scale * facing[:, None] * gone)
        rms = np.sqrt(np.mean(off**2, axis=1))
        return float(np.exp(np.mean(np.log(rms + self.floor))))

    def half_base(self, left: float, right: float) -> float:
        """Half the base that fits best [m]."""
        gone, _ = swept(self.cuts, left, right)
        return _scale(gone.reshape(-1, WINDOW), self.cuts.move.reshape(-1, WINDOW))


def _facing(gone: Complexes, move: Complexes) -> Complexes:
    match = np.sum(gone.conj() * move, axis=1)
    return np.asarray(np.exp(1j * np.angle(match)))


def _scale(gone: Complexes, move: Complexes) -> float:
    """Median over windows, so that a jump of the reference does no harm."""
    match = np.abs(np.sum(gone.conj() * move, axis=1))
    size = np.sum(np.abs(gone) ** 2, axis=1)
    moved = size > 0.0
    return float(np.median(match[moved] / size[moved])) if moved.any() else 0.0


def windows_of(cuts: Cuts) -> Windows | None:
    """Windows spread over all drives; None where there is not one."""
    starts = np.arange(0, cuts.count - WINDOW + 1, WINDOW // 2)
    starts = starts[cuts.run[starts] == cuts.run[starts + WINDOW - 1]]
    if starts.size == 0:
        return None
    if starts.size > MOST_WINDOWS:
        starts = starts[np.linspace(0, starts.size - 1, MOST_WINDOWS).astype(int)]
    inside = starts[:, None] + np.arange(WINDOW)
    begin = np.repeat(cuts.begin[starts], WINDOW)
    move = np.cumsum(cuts.move[inside], axis=1).ravel()
    end = cuts.end[inside].ravel()
    floor = 0.01 * float(np.median(np.abs(cuts.move))) + 1e-12
    nothing = np.full(end.size, np.nan)
    stretches = Cuts(cuts.left, cuts.right, begin, end, nothing, nothing, move, end * 0)
    return Windows(_compact(stretches), floor)


def _compact(cuts: Cuts) -> Cuts:
    """Only the steps that some stretch needs."""
    needed = np.zeros(cuts.left.size + 1, dtype=np.intp)
    np.add.at(needed, cuts.begin, 1)
    last: NDArray[np.intp] = cuts.end.reshape(-1, WINDOW)[:, -1]
    first: NDArray[np.intp] = cuts.begin.reshape(-1, WINDOW)[:, -1]
    needed[:] = 0
    np.add.at(needed, first, 1)
    np.add.at(needed, last, -1)
    keep = np.cumsum(needed[:-1]) > 0
    place = np.concatenate([[0], np.cumsum(keep)])
    return Cuts(
        cuts.left[keep],
        cuts.right[keep],
        place[cuts.begin],
        place[cuts.end],
        cuts.duration,
        cuts.turn,
        cuts.move,
        cuts.run,
    )


def search_positions(
    records: Sequence[Record], robot: Robot
) -> tuple[list[SetUpFinding], Setting | None]:
    """What is wrong, and the sizes that were measured."""
    windows = windows_of(cut(records, robot, "positions", fewest=60))
    if windows is None:
        return [], None
    track = effective_track(robot)
    tried = sorted(
        (windows.misfit(left / track, right / track), left, right) for left, right in _grid()
    )
    best = min(_refined(windows, left / track, right / track) for _, left, right in tried[:6])
    given = _refined(windows, 1.0 / track, 1.0 / track)
    if given[0] < 1.05 * best[0]:
        best = given
    _, left, right = best
    estimate = Estimate(left, right, 2.0 * windows.half_base(left, right), None)
    if not estimate.base:
        return [], None
    ways = wirings(estimate)
    setting = setting_of(estimate, ways[0], track)

    def misfit(one: Setting) -> float:
        numbers = one.numbers(track)
        return windows.misfit(numbers[0], numbers[1], abs(numbers[2]))

    found = findings_of(setting, ways, misfit)
    if not found or misfit(AS_ENTERED) < WIDE_MARGIN * misfit(setting):
        return [], None
    return found, setting


def _grid() -> list[tuple[float, float]]:
    """Turning of both wheels over the robot file's, all signs, the whole range."""
    sizes = np.exp(np.arange(-31, 32) * 0.25)
    ratios = (1.0, 2.0, 0.5, 4.0, 0.25)
    signs = tuple(product((1.0, -1.0), repeat=2))
    return [
        (sign_left * size / math.sqrt(ratio), sign_right * size * math.sqrt(ratio))
        for size in sizes.tolist()
        for ratio in ratios
        for sign_left, sign_right in signs
    ]


def _refined(windows: Windows, left: float, right: float) -> tuple[float, float, float]:
    """Descend from a start by ever smaller steps of common size and ratio."""
    size, ratio, step = 0.0, 0.0, 0.15
    best = windows.misfit(left, right)
    while step > 0.002:
        tries: list[tuple[float, float, float]] = []
        for du, dv in ((step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)):
            factors = math.exp(size + du - 0.5 * (ratio + dv)), math.exp(
                size + du + 0.5 * (ratio + dv)
            )
            tries.append((windows.misfit(left * factors[0], right * factors[1]), du, dv))
        value, du, dv = min(tries)
        if value < best:
            best, size, ratio = value, size + du, ratio + dv
        else:
            step *= 0.5
    return best, left * math.exp(size - 0.5 * ratio), right * math.exp(size + 0.5 * ratio)


