# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Squares that were measured by tape at begin and end are for UMBmark, and so it is told."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, square
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.diagnosis.reference_remarks import by_ruler

SAID = Robot(0.35, 0.05, 2000.0, 2000.0)


def taped(sense: float, seed: int, share: float) -> Run:
    """A square by its odometry, or part of one; the base is wider, the left wheel smaller."""
    random = np.random.default_rng(seed)
    true = WhiteNoiseRobot(0.357, 0.04975, 0.05, 4e-4, 4e-4)
    speed, rate = square(2.0, sense)
    left = true.left_radius / SAID.wheel_radius * (speed - 0.5 * SAID.wheel_separation * rate)
    right = true.right_radius / SAID.wheel_radius * (speed + 0.5 * SAID.wheel_separation * rate)
    part, rest = slice(0, int(share * speed.size)), np.zeros(50)
    driven = [
        np.concatenate([rest, each[part], rest])
        for each in (0.5 * (left + right), (right - left) / true.separation)
    ]
    run = drive(true, (driven[0], driven[1]), random, sigma_xy=2e-3, sigma_yaw=3e-3, every=1)
    assert run.reference is not None
    ends = run.reference.chosen(np.array([10, run.reference.time.size - 10]))
    return replace(run, name=f"square_{seed}", reference=ends)


@pytest.mark.parametrize(
    ("share", "senses", "named"), [(1.0, 2, True), (1.0, 1, False), (0.5, 2, False)]
)
def test_umbmark_is_named_for_squares_both_ways(share: float, senses: int, named: bool) -> None:
    """No manoeuvre tells the mean radius from the base there, and a tape does."""
    runs = [taped((-1.0) ** (seed % senses), seed, share) for seed in range(4)]
    laid = concatenated(match_for_fit(runs, SAID, 100.0))
    point = SimpleNamespace(model=Model(SAID, ({},) * len(runs)))
    told: Any = SimpleNamespace(
        rivals=("wheel_radius_scale", "track_width"),
        runs=laid,
        final=SimpleNamespace(point=point),
    )
    said = " ".join(by_ruler(told))
    assert "a line to and fro beside a tape does" in said
    assert ("calibrate umbmark" in said) is named
    told.rivals = ("track_width", "reference_yaw_offset")
    assert by_ruler(told)[0].endswith("a ruler may.")
