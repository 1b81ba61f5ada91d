# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stated 95 % intervals of `calibrate fit` and `add` hold the truth in 95 % of cases.

Its rank among what is stated is even. Of umbmark and calibrate noise: their own evidence.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np
import pytest

from test.inference import simulated_cases
from test.inference.test_fit import NOMINAL, TRUTH, runs_of
from werrimbi_odom.effects import find
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.calibration.any_driving import calibrate
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
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


@pytest.mark.evidence
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


@pytest.mark.evidence
def test_intervals_hold_the_truth_of_a_few_additions() -> None:
    """Of 50 numbers or so chance leaves out more than 8 once in a thousand times."""
    found = [simulated_cases.deviations(seed) for seed in range(2000, 2008)]
    values = [value for case in found for value in case.values()]
    assert len(values) > 40
    assert sum(abs(value) > NORMAL_95 for value in values) <= 8
    assert max(abs(value) for value in values) < 4.5


@pytest.mark.parametrize(("seed", "name"), [(2065, "wheel_separation_multiplier"), (2004, "sense")])
def test_a_number_that_chance_freed_is_not_taken_for_certain(seed: int, name: str) -> None:
    """It is worth its price, so it is 2.5 of the deviations that it would have if it were sure."""
    drawn = simulated_cases.case(seed)
    nothing = {"wheel_separation_multiplier": 1.0, "sense": 0.0}[name]
    assert drawn.true[name] == nothing
    value, std = simulated_cases.stated(drawn)[name]
    assert abs(value - nothing) < NORMAL_95 * std


def test_the_wheels_noise_is_theirs_though_the_base_was_entered_in_millimetres() -> None:
    entered = replace(NOMINAL, wheel_separation=350.0)
    runs = runs_of(1, count=3, seconds=40.0)
    result = add_effects([find("track_width")], runs[:2], entered, holdout=runs[2:])
    for side in ("left", "right"):
        low, high = result.noises[f"{side}_wheel_noise"].interval
        assert low < TRUTH[f"{side}_wheel_noise"] < high


@pytest.mark.evidence
def test_95_percent_intervals_hold_in_93_to_97_percent_of_400_additions() -> None:
    """Ten effects; all numbers of a kind together, for each effect has its own in 40 cases."""
    from scipy.stats import norm

    found: dict[str, list[float]] = defaultdict(list)
    for seed in range(2000, 2400):
        for name, value in simulated_cases.deviations(seed).items():
            kind = "effects" if "." in name else "sizes" if name in MULTIPLIERS else "noise"
            for group in (name, kind):
                found[group].append(value)
    held = {}
    for name, values in sorted(found.items()):
        held[name] = float(np.mean(np.abs(values) < NORMAL_95))
        ranks = np.histogram(norm.cdf(np.negative(values)), bins=10, range=(0.0, 1.0))[0]
        print(f"{name:32s} {len(values):4d} intervals, {held[name]:.1%} hold; {ranks.tolist()}")
    for kind in ("effects", "sizes", "noise"):
        assert 0.93 <= held[kind] <= 0.97, kind
