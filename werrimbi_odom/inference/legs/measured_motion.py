# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the reference saw of the motion that the wheels tell, window by window."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.legs.agreement import Agreement
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class MeasuredMotion:
    """One quantity measured by the reference, compared with the wheels; k windows."""

    agreement: Agreement
    beyond: Floats
    """Deviation of the measurement over its threshold; (k,)."""
    edge: NDArray[np.bool_]
    """Windows that are outliers if next to one above the threshold, (k,)."""
    speaks: NDArray[np.bool_]
    """Windows in which wheels and robot clearly move together, (k,)."""
    enough: float
    """Least total turn [rad] or path [m] that a stretch must put in doubt."""

    @property
    def time(self) -> Floats:
        """Midpoints of the windows [s]."""
        return self.agreement.windows.time

    def at(self, values: Floats, time: Floats) -> Floats:
        """Interpolate values of the windows at some times."""
        known = np.isfinite(values)
        return np.interp(time, self.time[known], values[known])


def judged_motion(
    found: Agreement, slowest: float, enough: float, *, turns: bool
) -> MeasuredMotion:
    """Flag windows whose deviation neither driving nor clock jitter explains.

    `slowest`: turn or path per window below which nothing counts as moving.
    """
    found = _standing(found)
    windows, expected, gross = found.windows, found.expected, found.gross
    reach = 2 * max(1, round(rules.NO_DRIVING_LATE / windows.step)) + 1
    low, high = minimum_filter1d(expected, reach), maximum_filter1d(expected, reach)
    off = np.maximum(np.maximum(low - windows.measured, windows.measured - high), 0.0)
    rolls = windows.rolled > windows.still
    keeps = rolls & (gross > 0.0) & (found.off <= rules.NO_DRIVING_EDGE * gross)
    noise = float(np.median(found.off[keeps]))
    rough = rules.NO_DRIVING_ROUGH * float(np.median(found.off[keeps] / gross[keeps]))
    # How roughly wheels follow their law says nothing of a robot whose wheels stand. (And what is
    # measured at rest may all be of one carry.)
    gentle = keeps & (gross <= np.quantile(gross[keeps], rules.NO_DRIVING_GENTLE))
    # Of windows that roll slowly only those with little noise keep to the law. Poses at rest tell
    # the least.
    scatter = np.where(rolls, noise, min(noise, float(np.median(found.off[gentle]))))
    scatter = np.maximum(scatter, windows.noise)
    least = np.maximum(rules.NO_DRIVING_NOISE * scatter, slowest)
    beyond = off / np.maximum(
        max(rules.NO_DRIVING_OFF, rough) * maximum_filter1d(gross, reach), least
    )
    if turns:  # a gentle path is already most of what both wheels could do
        beyond = np.where(_stopped(found, low, high, least), np.maximum(beyond, 1.01), beyond)
    # Noise must not lengthen a stretch. At rest, position noise acts in two coordinates, in motion
    # in one along the path (medians, by sigma); and it seldom halves a true displacement.
    at_rest = 1.0 if turns else np.sqrt(2.0 * np.log(2.0)) * MEDIAN_TO_SIGMA
    halved = np.abs(windows.measured) < 0.5 * np.abs(expected)
    unsure = least * np.where(halved, 0.5, np.where(np.abs(expected) > least, 1.0, at_rest))
    edge = found.off > np.maximum(rules.NO_DRIVING_EDGE * gross, unsure)
    moves = np.abs(expected) > np.maximum(rules.NO_DRIVING_EDGE * gross, least)
    return MeasuredMotion(found, beyond, edge, moves & keeps, enough)


def _standing(found: Agreement) -> Agreement:
    """Set the prediction to zero, or to what the wheels' creep gives, where wheels stand.

    A law fitted to straight driving predicts arbitrary turns, and a driver that integrates speeds
    lets the wheels creep at rest. But a robot may also spin that slowly.
    """
    windows = found.windows
    expected, gross = (
        np.where(windows.rolled > windows.still, each, 0.0)
        for each in (found.expected, found.gross)
    )
    creeps = found.off < np.abs(windows.measured)
    return replace(found, expected=np.where(creeps, found.expected, expected), gross=gross)


def _stopped(found: Agreement, low: Floats, high: Floats, least: Floats) -> NDArray[np.bool_]:
    """Windows in a row in which the robot should clearly move and does not; (k,).

    `low`, `high` (k,): range of the prediction over a window and its neighbours. `least` (k,):
    threshold for clear motion.
    """
    windows = found.windows
    expected = np.where(low * high > 0.0, np.minimum(np.abs(low), np.abs(high)), 0.0)
    still = np.abs(windows.measured) < rules.NO_DRIVING_STOPPED * expected
    rows = np.zeros(still.size, dtype=np.bool_)
    for first, last in runs_of(still & (expected > least)):
        if (last + 1 - first) * windows.step >= rules.NO_DRIVING_STOPPED_FOR:
            rows[first : last + 1] = True
    return rows


def runs_of(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last index of each run of True values."""
    steps = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    return list(
        zip(
            np.flatnonzero(steps > 0).tolist(),
            (np.flatnonzero(steps < 0) - 1).tolist(),
            strict=True,
        )
    )
