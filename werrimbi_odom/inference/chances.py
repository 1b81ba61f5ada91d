# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Chances that nothing but noise goes as far, in one test or in any of many.

By scipy.special: scipy.stats has the same functions of it, and takes half a second to import, which
is a tenth of the time in which an hour of driving is to be seen.
"""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.model.pose import Floats

MEDIAN_TO_SIGMA = 1.4826
"""Standard deviation of a normal scatter over the median of its sizes."""

NORMAL_95 = 1.959963984540054
"""Standard deviations to either side that hold 95 % of a normal scatter."""


def in_any_of(tests: int, chance: float) -> float:
    """Chance that noise alone goes as far in any of several tests (Bonferroni's bound)."""
    return min(1.0, tests * chance)


def upper_part(value: float, share: float) -> float:
    """Standard deviation to state of a scale whose logarithm is normal, with deviation `share`.

    The upper part of its 95 % interval, over 1.96: what comes out small by chance would else be
    stated with a small deviation too.
    """
    return value * math.expm1(NORMAL_95 * share) / NORMAL_95


def chi2_above(value: float, degrees: float) -> float:
    """Chance that a chi-squared variable is above a value."""
    from scipy.special import chdtrc

    return float(chdtrc(degrees, max(value, 0.0)))


def chi2_median(degrees: Floats) -> Floats:
    """Medians of chi-squared variables."""
    from scipy.special import chdtri

    return np.asarray(chdtri(degrees, 0.5))


def binomial_above(count: int, of: int, share: float) -> float:
    """Chance that of some tries, each with the chance `share`, at least `count` succeed."""
    from scipy.special import bdtrc

    return 1.0 if count <= 0 else float(bdtrc(count - 1, of, min(share, 1.0)))


def student_above(value: float, degrees: float) -> float:
    """Chance that a variable of Student's t is above a value."""
    from scipy.special import stdtr

    return float(stdtr(degrees, -value))


def fisher_above(value: float, above: float, below: float) -> float:
    """Chance that a variable of Fisher's F is above a value.

    Parameters
    ----------
    above, below
        Degrees of freedom of its numerator and denominator; of one that is known they are
        infinite, and the variable is chi-squared.
    """
    from scipy.special import fdtrc

    if math.isinf(below):
        return chi2_above(above * value, above)
    return float(fdtrc(above, below, max(value, 0.0)))


def noncentrality(degrees: float, significance: float, power: float) -> float:
    """Of the chi-squared variable that exceeds a test's threshold in a share `power` of cases.

    Parameters
    ----------
    significance
        Share of cases in which the central variable exceeds that threshold.
    """
    from scipy.special import chdtri, chndtrinc

    return float(chndtrinc(chdtri(degrees, significance), degrees, 1.0 - power))


def student_quantile(share: float, degrees: float) -> float:
    """Value below which a share of a variable of Student's t lies."""
    from scipy.special import stdtrit

    return float(stdtrit(degrees, share))
