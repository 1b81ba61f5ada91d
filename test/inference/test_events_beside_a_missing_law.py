# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a law would explain is no dozen of accidents: no pose of a sound reference jumped."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose

TRUE = WhiteNoiseRobot(0.35, 0.05, 0.05, 4e-4, 4e-4)
NOISE_YAW = 1e-3
"""Of motion capture [rad]."""
EFFECTS = [find("unequal_wheel_radii"), find("wheel_radius_scale")]


def driven(seed: int, share: float) -> Run:
    """A drive whose left wheel rolls by `share` more along the heading at its start [s/m]."""
    random = np.random.default_rng(seed)
    seen = drive(TRUE, wandering(random, 50.0), random, sigma_xy=4e-4, sigma_yaw=NOISE_YAW, every=1)
    poses, ticks = seen.reference, seen.ticks
    assert poses is not None
    yaw = np.interp(ticks.time, poses.time, poses.yaw - poses.yaw[0])
    rolled = np.diff(ticks.left, prepend=ticks.left[0]) * TRUE.entered().left_tick
    ahead = np.abs(np.gradient(ticks.left, ticks.time)) * TRUE.entered().left_tick
    # Counted is what makes up, with the law, for the way that was driven.
    counted = rolled / (1.0 + share * ahead * np.cos(yaw)) / TRUE.entered().left_tick
    left = np.floor(ticks.left[0] + np.cumsum(counted))
    return replace(seen, name=f"{seed}", path=Path(f"{seed}"), ticks=replace(ticks, left=left))


@pytest.mark.evidence
def test_only_the_pose_that_was_wrong_jumped_beside_a_missing_law() -> None:
    """A wheel's noise stood for the law and for the reference's own: some sigma were a jump."""
    runs = [driven(seed, 0.06) for seed in (1, 2)]
    poses = runs[0].reference
    assert poses is not None
    yaw = poses.yaw.copy()
    yaw[1000] += 12.0 * NOISE_YAW
    runs[0] = replace(runs[0], reference=replace(poses, yaw=yaw))
    found = diagnose(runs, TRUE.entered(0.05), EFFECTS)
    wheels = found.final.point.variances
    assert float(wheels.left[0]) > 50.0 * TRUE.left_noise**2, "it does stand for it"
    [event] = found.happened.events
    assert (event.channel, event.stays) == ("reference", False)
    assert event.time == pytest.approx(float(poses.time[1000]), abs=0.06)
    assert event.size == pytest.approx(12.0 * NOISE_YAW, abs=4.0 * event.std)
