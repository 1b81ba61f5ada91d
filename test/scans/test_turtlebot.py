# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a simulated TurtleBot3 is found by its lidar, as by its true motion."""

from __future__ import annotations

from pathlib import Path

import pytest

from test.scans.turtlebot import TRUE, WITHIN, found


@pytest.mark.evidence
def test_what_is_wrong_with_a_turtlebot_is_found_by_its_lidar(tmp_path: Path) -> None:
    by_scans, by_truth = found(tmp_path)
    for name, true in TRUE.items():
        value, std = (by_scans["parameters"][name][key] for key in ("value", "std"))
        assert abs(value - true) < WITHIN[name], name
        if name != "reference_lever_arm.y":  # nothing there, and nothing put there
            assert abs(value - true) < 2.0 * std, name
    assert by_scans["holdout"]["nees"] == pytest.approx(1.0, abs=0.3)
    assert by_scans["holdout"]["after"] < 3.5e-3
    assert by_scans["holdout"]["before"] > 0.025
    assert by_truth["holdout"]["after"] < 2e-3
