# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ways of wheels of which only speeds were recorded.

A driver publishes either the speed of that moment (measured, filtered or commanded), or the way
since its last reading over the time since. Where stamps jitter the two tell themselves apart: the
speed of an interval that seems short is too large by as much, and only that speed times that
interval is the way. Trapezia would take half of it times the next interval, which is not short, and
all ways would be too long, by three quarters of the relative variance of the intervals.
"""

from __future__ import annotations

import numpy as np

from werrimbi_odom.files.run import integrated
from werrimbi_odom.model.pose import Floats

_OF_INTERVAL = 0.5
"""Share of the jitter of the intervals that the speeds follow, from which on they are those of the
intervals behind them: 1 if they are, 0 if they are of the moment; the middle errs least."""
_SURE = 3.0
"""Standard deviations by which that share must differ from zero."""
_FEWEST = 10
"""Fewest differences that tell that standard deviation."""
_JITTER = 0.01
"""Relative jitter of the intervals (rms) up to which nobody need know: trapezia then add less than
1e-4 to a way, and wheels are hardly known better."""
_APART = 4
"""Messages from one second difference of the stamps to the next: so many have no stamp in common,
and their errors are independent."""
_USUAL = (0.5, 1.5)
"""Intervals that are taken for jitter, in medians: beyond, messages were lost or repeated."""
BEHIND = (
    "the speeds are smaller by as much as the interval before their stamp is longer: each is the "
    "way since the last message over the time since, and is taken for that interval"
)


def ways_of(time: Floats, rates: Floats) -> tuple[Floats, list[str]]:
    """Integral over time, (n, k), of rates that one driver publishes together; and words for it.

    By trapezia, or, if the rates are the means of the intervals behind them, by these. Stamps that
    do not increase add nothing.
    """
    lasted = np.diff(np.maximum.accumulate(time))[:, None]
    if not _of_intervals(lasted[:, 0], rates):
        return integrated(time, rates), []
    steps = rates[1:] * lasted
    return np.concatenate([np.zeros((1, rates.shape[1])), np.cumsum(steps, axis=0)]), [BEHIND]


def _of_intervals(lasted: Floats, rates: Floats) -> bool:
    """Whether rates (n, k) are the way of the intervals behind them, (n - 1,), over their length.

    By least squares of how a rate differs from the mean of its two neighbours, on how its interval
    differs from theirs: an even acceleration is in neither.
    """
    if lasted.size < 3:
        return False
    usual = float(np.median(lasted))
    least, most = (share * usual for share in _USUAL)
    even = (lasted > least) & (lasted < most)
    rows = np.arange(1, lasted.size - 1, _APART)
    rows = rows[even[rows - 1] & even[rows] & even[rows + 1]]
    size = np.sqrt(np.mean(np.square(rates), axis=0))
    moving = rates[1:, size > 0.0] / size[size > 0.0]  # of each interval
    around = 0.5 * (moving[rows - 1] + moving[rows + 1])
    shorter = 0.5 * (lasted[rows - 1] + lasted[rows + 1]) / lasted[rows] - 1.0
    expected = around * shorter[:, None]
    power = float(np.sum(expected**2))
    # (independent intervals have 1.5 times their own variance in their differences from neighbours)
    if rows.size < _FEWEST or np.mean(shorter**2) < 1.5 * _JITTER**2 or power == 0.0:
        return False
    differs = moving[rows] - around
    share = float(np.sum(expected * differs)) / power
    left = np.sum(expected * (differs - share * expected), axis=1)
    std = float(np.sqrt(np.sum(left**2))) / power  # whatever the errors' size at each speed
    return share > max(_OF_INTERVAL, _SURE * std)
