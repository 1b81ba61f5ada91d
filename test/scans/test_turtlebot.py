# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a simulated TurtleBot3 is found by its lidar, as by its true motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.scans.turtlebot import LIDAR, TRUE, WITHIN, found, place_by_two_short_drives
from werrimbi_odom import simulation as sim


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


@pytest.mark.evidence
def test_of_short_drives_a_lidars_place_is_as_sure_as_is_said(tmp_path: Path) -> None:
    """40 robots, each by two drives of a metre and two spins in one sense."""
    mount = sim.AxlePose(-0.032, 0.01, 0.03)
    lidar = replace(LIDAR, mount=mount)
    place = {"reference_lever_arm.x": mount.x, "reference_lever_arm.y": mount.y}
    off = []
    for seed in range(40):
        folder = tmp_path / str(seed)
        folder.mkdir()
        told = place_by_two_short_drives(seed, lidar, folder)
        off.append([(told[name][0] - true) / told[name][1] for name, true in place.items()])
    assert np.sqrt(np.square(off).mean(axis=0)) == pytest.approx([1.0, 1.0], abs=0.3)
    # Of 40 chance leaves out more than six once in 300 times.
    assert (np.abs(off) > 1.96).sum(axis=0).max() <= 6
