# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a count says about a rate."""

from __future__ import annotations

from scipy.stats import beta

LEVEL = 0.95
"""Of all intervals."""


def clopper_pearson(hits: int, tries: int) -> tuple[float, float]:
    """Interval that holds the true rate in at least LEVEL of all cases.

    Source: C. J. Clopper and E. S. Pearson, The use of confidence or fiducial limits illustrated
    in the case of the binomial, Biometrika 26 (1934) 404-413.
    """
    if not 0 <= hits <= tries:
        raise ValueError(f"{hits} of {tries}")
    tail = (1.0 - LEVEL) / 2.0
    low = float(beta.ppf(tail, hits, tries - hits + 1)) if hits else 0.0
    high = float(beta.ppf(1.0 - tail, hits + 1, tries - hits)) if hits < tries else 1.0
    return low, high


def between(hits: int, tries: int) -> str:
    """The interval, in percent."""
    if not tries:
        return ""
    low, high = clopper_pearson(hits, tries)
    return f"{100.0 * low:.1f} to {100.0 * high:.1f} %"


def rate(hits: int, tries: int) -> str:
    """A count, with the interval of its rate; empty where nothing was tried."""
    return f"{hits} of {tries} ({between(hits, tries)})" if tries else ""
