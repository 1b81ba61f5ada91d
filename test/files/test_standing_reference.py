# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that stands still while the wheels drive is said to do so, and nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.files.recorded import ROBOT, driven
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.files.run_checks import refuse_unjudgeable
from werrimbi_odom.files.tables.standing_reference import stands_still

STANDS = "the reference stands still"


def standing(run: Run, noise: float, *, headings: bool = True) -> Run:
    """A localiser that is stuck, or a tracker of something that stands."""
    assert run.reference is not None
    random, count = np.random.default_rng(1), run.reference.time.size
    x, y, yaw = (at + random.normal(0.0, noise, count) for at in (1.3, -0.2, 0.7))
    reference = Reference(run.reference.time, x, y, yaw if headings else np.full(count, np.nan))
    return replace(run, reference=reference)


@pytest.mark.parametrize("noise", [0.0, 0.001])
@pytest.mark.parametrize("headings", [True, False])
def test_one_pose_while_the_wheels_drive(noise: float, headings: bool) -> None:
    run = standing(driven(1), noise, headings=headings)
    with pytest.raises(InputError, match=f": {STANDS} ") as told:
        refuse_unjudgeable(replace(run, of_bag=True), ROBOT)
    assert str(told.value).endswith("leave the drive out"), "no column is to be converted"
    assert ("one pose" in str(told.value)) == (noise == 0.0)


def test_in_the_words_of_every_verb_alike() -> None:
    """The drive is refused where all of them read it, and `info` tells it as what is wrong."""
    run = standing(driven(1), 0.0)
    assert run.reference is not None
    told = stands_still(run.ticks, run.reference, ROBOT)
    assert told.startswith(STANDS)
    counts = run.ticks.left
    still = Ticks(run.ticks.time, np.full_like(counts, 5), np.full_like(counts, 5))
    assert not stands_still(still, run.reference, ROBOT), "nothing was driven"


def test_a_robot_that_is_put_back_on_its_mark_after_each_lap() -> None:
    """It stands where it is measured, and each pose is real."""
    lap = np.concatenate([np.zeros(5), np.arange(0.0, 3000.0, 30.0), np.full(5, 3000.0)])
    counts = np.concatenate([lap + 3000.0 * number for number in range(25)])
    time = 0.02 * np.arange(counts.size)
    marks = 0.02 * (lap.size * np.arange(25) + 2)
    reference = Reference(marks, np.zeros(25), np.zeros(25), np.zeros(25))
    assert not stands_still(Ticks(time, counts, counts), reference, ROBOT)


def test_a_turn_on_the_spot_that_positions_alone_see() -> None:
    time = 0.02 * np.arange(2000)
    counts = np.rint(2.0 * np.arange(2000.0))
    random, away = np.random.default_rng(2), np.full(2000, np.nan)
    x, y = random.normal(0.0, 0.001, (2, 2000))
    ticks = Ticks(time, -counts, counts)
    assert not stands_still(ticks, Reference(time, x, y, away), ROBOT)
