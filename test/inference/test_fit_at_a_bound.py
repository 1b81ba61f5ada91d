# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fit of a law that would have to be less than nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from test.inference.driven import runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, parameters_to_fit
from werrimbi_odom.inference.legs.cutting import match


def test_a_law_at_its_bound_leaves_all_else_as_well_fitted_as_without_it() -> None:
    """The others went along with a step that the bound cut off: 50 of them, and 12 s, for one."""
    right = find("right_backlash").using(travel=0.002)
    truth = replace(ROBOT, effects=(right,))
    runs = concatenated([match(run, ROBOT, 0.5) for run in runs_of(truth, [1], 60)])
    left = find("left_backlash")
    point = start_point(runs, replace(ROBOT, effects=(left.using(travel=0.002),)))
    numbers = (*CALIBRATION, *parameters_to_fit(left))
    stopped = fit_model(runs, point, numbers, rounds=2, find_jumps=False)
    assert [number.name for number in stopped.at_bound] == ["left_backlash.travel"]
    without = fit_model(runs, start_point(runs, ROBOT), rounds=2, find_jumps=False)
    assert stopped.minus_two_log_likelihood == pytest.approx(
        without.minus_two_log_likelihood, abs=0.1
    )
