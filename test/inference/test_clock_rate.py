# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A clock of a microcontroller, one or two per cent off, is no hand that holds the robot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import common, run_of
from test.inference.test_held_or_carried import held
from test.model.drives import ROBOT
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.model.effect import view_of

WIDER = replace(ROBOT, wheel_separation_multiplier=1.03)


def gaining(run: Run, rate: float) -> Run:
    """The run with a reference whose clock gains that much on the wheels' in a second."""
    assert run.reference is not None
    seen = replace(run.reference, time=run.reference.time * (1.0 + rate))
    return replace(run, reference=seen)


def by_headings(run: Run) -> Run:
    assert run.reference is not None
    nothing = np.full(run.reference.time.size, np.nan)
    seen = replace(run.reference, x=nothing, y=nothing, kind="incremental")
    return replace(run, reference=seen)


@pytest.mark.parametrize("rate", [-0.02, 0.01])
@pytest.mark.parametrize("seed", [1, 2])
def test_a_clock_that_is_off_is_no_hand(rate: float, seed: int) -> None:
    run = gaining(run_of(WIDER, seed, seconds=200), rate)
    assert with_no_driving(run, ROBOT).no_driving == ()
    assert with_no_driving(by_headings(run), ROBOT).no_driving == ()


def test_beside_such_a_clock_a_hand_is_found_by_either() -> None:
    run, begin, end = held(run_of(WIDER, 3, seconds=200), 140.0, 150.0)
    rate = 0.015
    (found,) = with_no_driving(gaining(run, rate), ROBOT).no_driving or ()
    assert found.why == "held"
    near = 0.5
    assert begin - near < found.begin < begin + near
    assert end * (1.0 + rate) - near < found.end < end * (1.0 + rate) + near


def test_the_rate_is_named_and_fitted_with_the_base() -> None:
    runs = [gaining(run_of(WIDER, seed, seconds=120), -0.015) for seed in (1, 2)]
    found = diagnose(runs, ROBOT, effects=common("reference_clock_drift"))
    assert set(found.found) == {"reference_clock_drift", "track_width"}
    for index in range(len(runs)):
        rate = view_of(found.model.of_run(index).effects).clock_drift
        assert rate == pytest.approx(1.0 - 1.0 / (1.0 - 0.015), abs=1e-4)
