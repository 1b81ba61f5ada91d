# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An antenna beside the middle, late by a fifth of a second, does not make a driver hold a robot.

In a turn about the antenna it hardly moves, so how it goes with the wheels must be known well.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.model.drives import ROBOT
from werrimbi_odom.files.run import NoDriving, Reference, Run, Ticks
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.legs.held_or_carried import HELD
from werrimbi_odom.inference.legs.usable_run import with_no_driving

RATE = 20
NOISE = 6e-3


def along_lines_and_arcs(seed: int, aside: float, late: float, held: float | None = None) -> Run:
    """Lines of five seconds and tight arcs, one of them about the antenna; held for six seconds."""
    random = np.random.default_rng(seed)
    speed, turning = random.uniform(0.3, 0.6, 50), np.zeros(50)
    arcs = np.flatnonzero(random.random(50) < 0.2)
    turning[arcs] = random.choice([-1.0, 1.0], arcs.size) * random.uniform(0.7, 1.2, arcs.size)
    speed[arcs] = random.uniform(0.05, 0.25, arcs.size)
    turning[25], speed[25] = np.sign(aside) * 0.6, abs(aside) * 0.6
    lasts = np.where(turning == 0.0, 5 * RATE, 5 * RATE // 2)
    speed, turning = (
        np.convolve(np.repeat(each, lasts), np.full(10, 0.1), "same") for each in (speed, turning)
    )
    time = np.arange(speed.size) / RATE
    left, right = (
        np.floor(np.cumsum(speed + side * turning * ROBOT.track / 2.0) / RATE / ROBOT.left_tick)
        for side in (-1.0, 1.0)
    )
    goes = np.ones(time.size) if held is None else (time < held) | (time > held + 6.0)
    yaw = np.cumsum(goes * turning) / RATE
    place = np.cumsum(goes * speed * np.exp(1j * yaw)) / RATE + 1j * aside * np.exp(1j * yaw)
    seen = (place + NOISE * (random.normal(size=(2, time.size)).T @ (1.0, 1j)))[::2]
    nothing = np.full(seen.size, np.nan)
    reference = Reference(time[::2] + late, seen.real, seen.imag, nothing)
    return Run("yard", Path("yard"), Ticks(time, left, right), reference)


@pytest.mark.parametrize("aside", [0.15, -0.15])
@pytest.mark.parametrize("late", [0.0, 0.1, 0.2])
@pytest.mark.parametrize("seed", [0, *map(in_evidence, (1, 2, 3))])
def test_nobody_holds_a_robot_that_turns_about_its_antenna(
    seed: int, late: float, aside: float
) -> None:
    assert with_no_driving(along_lines_and_arcs(seed, aside, late), ROBOT).no_driving == ()


@pytest.mark.parametrize("seed", range(4))
def test_who_holds_a_robot_with_a_late_antenna_is_found(seed: int) -> None:
    run = with_no_driving(along_lines_and_arcs(seed, 0.15, 0.2, held=101.0), ROBOT)
    assert run.no_driving is not None
    (found,) = (part for part in run.no_driving if part.why == "held" and "wall" in part.words)
    assert found.begin == pytest.approx(101.0, abs=0.5)
    assert found.end == pytest.approx(107.0, abs=0.5)


def test_what_is_left_out_of_a_drive_does_not_make_the_noise_of_the_rest_jump() -> None:
    """Most of a drive without headings is left out if it was held: then nothing scattered."""
    run = along_lines_and_arcs(1, 0.15, 0.2)
    end = float(run.ticks.time[-1])
    left_out = (NoDriving(0.0, 0.6 * end, "held", HELD),)
    for kept in (run, replace(run, no_driving=left_out)):
        assert not [part for part in prepare([kept], ROBOT).left_out if part.why == "reference"]
    seen = run.reference
    assert seen is not None
    leap = replace(seen, x=seen.x + np.where(seen.time > 0.8 * end, 0.5, 0.0))
    jumped = replace(run, reference=leap, no_driving=left_out)
    (found,) = (part for part in prepare([jumped], ROBOT).left_out if part.why == "reference")
    assert found.begin < 0.8 * end < found.end
