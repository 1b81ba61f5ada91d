# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stated 95 % intervals hold the truth in 95 % of calibrations, and its rank is uniform."""

from __future__ import annotations

import numpy as np
import pytest

from test.inference.test_fit import NOMINAL, TRUTH, runs_of
from werrimbi_odom.inference.calibration.any_driving import calibrate
from werrimbi_odom.inference.fitting.knobs import MULTIPLIERS
from werrimbi_odom.inference.legs.cutting import match

NORMAL_95 = 1.959963984540054


def deviations(seed: int) -> dict[str, float]:
    """(estimate - truth) in units of what is stated, for two drives of 40 s.

    Noises in their logarithm, as their intervals are. What is told without an interval is left out.
    """
    runs = [match(run, NOMINAL, 0.25) for run in runs_of(seed, count=2, seconds=40.0)]
    result = calibrate(runs, NOMINAL)
    found = {}
    for name in MULTIPLIERS:
        item = result.multipliers[name]
        if item.std is not None:
            found[name] = (item.value - TRUTH[name]) / item.std
    for name, noise in result.noises.items():
        if noise.determined:
            low, high = noise.interval
            middle, half = 0.5 * np.log(low * high), 0.5 * np.log(high / low)
            found[name] = float((middle - np.log(TRUTH[name])) / half * NORMAL_95)
    return found


def test_intervals_hold_the_truth_of_a_few_calibrations() -> None:
    """Of 70 numbers or so chance leaves out more than 10 once in 1,300 times."""
    values = [value for seed in range(10) for value in deviations(5000 + seed).values()]
    assert len(values) > 60
    outside = sum(abs(value) > NORMAL_95 for value in values)
    assert outside <= 10
    assert max(abs(value) for value in values) < 4.5


@pytest.mark.evidence
def test_95_percent_intervals_hold_in_93_to_97_percent_of_400_calibrations() -> None:
    """Simulation-based calibration: Talts and others, arXiv:1804.06788 (2018)."""
    from scipy.stats import norm

    found = [deviations(5000 + seed) for seed in range(400)]
    outside = []
    for name in TRUTH:
        values = np.array([case[name] for case in found if name in case])
        inside = float(np.mean(np.abs(values) < NORMAL_95))
        ranks = np.histogram(norm.cdf(-values), bins=10, range=(0.0, 1.0))[0]
        print(f"{name:32s} {values.size:4d} intervals, {inside:.1%} hold; ranks {ranks.tolist()}")
        if not 0.93 <= inside <= 0.97:
            outside.append(name)
    assert not outside
