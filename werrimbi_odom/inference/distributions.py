# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tail probabilities and quantiles of the test statistics, and Bonferroni's correction.

These use scipy.special. scipy.stats wraps the same functions but takes half a second to import, a
tenth of the time budget for an hour of driving.
"""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.model.pose import Floats

MEDIAN_TO_SIGMA = 1.4826
"""Standard deviation of a normal variable over its median absolute deviation."""

NORMAL_95 = 1.959963984540054
"""Half width of the 95 % interval of a standard normal variable."""

CHI2_95 = np.array([np.inf, 3.841458820694124, 5.991464547107979, 7.814727903251179])
"""95 % quantiles of chi-squared, by degrees of freedom."""


def bonferroni(tests: int, chance: float) -> float:
    """Bonferroni bound: probability that noise alone is as extreme in any of several tests."""
    return min(1.0, tests * chance)


def upper_part(value: float, share: float) -> float:
    """Standard deviation to report for a log-normal scale parameter with log-deviation `share`.

    This is the upper half of the 95 % interval, over 1.96. An estimate that is small by chance
    would otherwise be reported with a small deviation as well.
    """
    return value * math.expm1(NORMAL_95 * share) / NORMAL_95


def chi2_survival(value: float, degrees: float) -> float:
    """Survival function of the chi-squared distribution."""
    from scipy.special import chdtrc

    return float(chdtrc(degrees, max(value, 0.0)))


def chi2_median(degrees: Floats) -> Floats:
    """Medians of chi-squared distributions."""
    from scipy.special import chdtri

    return np.asarray(chdtri(degrees, 0.5))


def binomial_survival(count: int, of: int, share: float) -> float:
    """Probability of at least `count` successes in `of` trials of success probability `share`."""
    from scipy.special import bdtrc

    return 1.0 if count <= 0 else float(bdtrc(count - 1, of, min(share, 1.0)))


def student_survival(value: float, degrees: float) -> float:
    """Survival function of Student's t distribution."""
    from scipy.special import stdtr

    return float(stdtr(degrees, -value))


def fisher_survival(value: float, above: float, below: float) -> float:
    """Survival function of the F distribution.

    `value`: value of the statistic. `above`, `below`: degrees of freedom of the numerator and the
    denominator. They are infinite for a known variance; with an infinite denominator the statistic
    is chi-squared.
    """
    from scipy.special import fdtrc

    if math.isinf(below):
        return chi2_survival(above * value, above)
    return float(fdtrc(above, below, max(value, 0.0)))


def noncentrality(degrees: float, significance: float, power: float) -> float:
    """Noncentrality at which a chi-squared test of given significance has the given power.

    `degrees`: degrees of freedom. `significance`: probability that the central variable exceeds the
    threshold. `power`: probability that the noncentral variable exceeds the threshold.
    """
    from scipy.special import chdtri, chndtrinc

    return float(chndtrinc(chdtri(degrees, significance), degrees, 1.0 - power))


def student_quantile(share: float, degrees: float) -> float:
    """Quantile of Student's t distribution."""
    from scipy.special import stdtrit

    return float(stdtrit(degrees, share))
