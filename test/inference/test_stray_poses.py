# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Single wrong poses of a reference are the end of no leg, and so neither noise nor a law."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from test.inference.driven import reference_of
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.comparison.prepared_runs import for_fit, prepare
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.matched_run import MatchedRun
from werrimbi_odom.inference.legs.stray_poses import stray_poses

MACHINE = WhiteNoiseRobot()
NOISE_XY = 2e-3


@pytest.fixture(scope="module")
def run() -> Run:
    random = np.random.default_rng(5)
    return drive(MACHINE, wandering(random, 60.0), random, every=1, sigma_xy=NOISE_XY)


def marked(seen: Reference) -> list[int]:
    found = stray_poses(seen, np.zeros(seen.time.size - 1, dtype=np.bool_))
    return np.flatnonzero(found).tolist()


def moved(seen: Reference, rows: Any, by: float) -> Reference:
    x = seen.x.copy()
    x[rows] += by
    return replace(seen, x=x)


@pytest.mark.parametrize("rows", [[700], [700, 701], [700, 702], [700, 1400]])
@pytest.mark.parametrize("by", [0.1, -1.0])
def test_wrong_poses_between_right_ones_are_marked(run: Run, rows: list[int], by: float) -> None:
    assert set(rows) <= set(marked(moved(reference_of(run), rows, by)))
    assert len(marked(moved(reference_of(run), rows, by))) <= len(rows) + 1


def test_noise_a_place_that_is_lost_and_what_a_robot_can_do_are_not(run: Run) -> None:
    """A push to and fro by 0.1 m within 0.4 s has 6 m/s^2: it may be the robot."""
    seen = reference_of(run)
    assert marked(seen) == []
    assert marked(moved(seen, slice(700, None), 0.5)) == []
    assert marked(moved(seen, slice(700, 720), 0.5)) == []
    slow = seen.chosen(np.arange(seen.time.size) % 10 == 0)
    assert marked(moved(slow, [70], 0.1)) == []


def test_a_pose_beside_a_gap_is_not_judged_by_the_pose_beyond(run: Run) -> None:
    seen = moved(reference_of(run), [700], 0.5)
    gap = np.zeros(seen.time.size - 1, dtype=np.bool_)
    gap[700] = True
    assert not stray_poses(seen, gap).any()


def test_wrong_poses_where_legs_would_end_are_no_noise_of_the_others(run: Run) -> None:
    """A fit took them for noise of all poses, of 30 mm where there were 2."""
    robot = MACHINE.entered()

    def cut(run: Run) -> list[MatchedRun]:
        return for_fit(prepare([run], robot, EvaluationOptions()), robot)

    ends = cut(run)[0].rows[5:-5:10]
    strayed = replace(run, reference=moved(reference_of(run), ends, 0.3))
    fit = fit_calibration(concatenated(cut(strayed)), robot)
    assert np.sqrt(fit.point.variances.xy[0]) == pytest.approx(NOISE_XY, rel=0.15)
