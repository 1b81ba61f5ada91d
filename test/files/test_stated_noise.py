# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A stated noise is taken unless the poses of a robot at rest contradict it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.references.stated_noise import without_wrong_noise
from werrimbi_odom.files.run import Reference, Run, Ticks

TIME = np.arange(0.0, 20.0, 0.05)
WAY = np.clip(TIME - 5.0, 0.0, 10.0) * 0.3


def a_run(stated_xy: float, stated_yaw: float) -> Run:
    """Poses that err by 2 mm and 3 mrad, of a robot that stands for 5 s before and after a line."""
    x, y, yaw = np.random.default_rng(0).normal(0.0, [[2e-3], [2e-3], [3e-3]], (3, TIME.size))
    counts = np.rint(WAY / 1e-4)
    sigmas = [np.full(TIME.size, each) for each in (stated_xy, stated_yaw)]
    seen = Reference(TIME, WAY + x, y, yaw, *sigmas)
    return Run("stated", Path("stated"), Ticks(TIME, counts, counts), seen)


@pytest.mark.parametrize("factor", [0.5, 1.0, 10.0])
def test_a_noise_that_is_about_right_or_larger_is_taken(factor: float) -> None:
    """A surveyor states what may be wrong in all: more than what differs from row to row."""
    run = a_run(factor * 2e-3, factor * 3e-3)
    assert without_wrong_noise(run) is run


def test_a_noise_that_is_ten_times_too_small_is_not() -> None:
    """White poses were said to wander as a localiser's."""
    seen = without_wrong_noise(a_run(2e-4, 3e-3))
    assert seen.reference is not None
    assert seen.reference.sigma_xy is None
    assert seen.reference.sigma_yaw is not None
    assert "positions scatter by 1.9 mm" in seen.damage[0]
