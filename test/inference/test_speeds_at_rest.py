# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels that go on at one speed wherever the reference stands are told, and nothing else is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import ROBOT_FILE, write_run
from test.files.conftest import Messages
from test.white_noise_robot import RATE, WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.comparison.reference_checks import remarks_on
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark
from werrimbi_odom.report.phrases import remark_words, remarks_json

TRUE = WhiteNoiseRobot(0.35, 0.05, 0.05, 4e-4, 4e-4)
ROBOT = TRUE.entered(0.05)
RESTS = ((0.0, 10.0), (60.0, 75.0), (110.0, 120.0))
OFFSET = -0.022


def rested(seed: int, creep: float = 0.0, rests: Sequence[tuple[float, float]] = RESTS) -> Run:
    """A drive that pauses, or creeps in its pauses [m/s]."""
    random = np.random.default_rng(seed)
    speed, rate = wandering(random, 120.0)
    for begin, end in rests:
        inside = slice(int(begin * RATE), int(end * RATE))
        speed[inside], rate[inside] = creep, 0.0
    return drive(TRUE, (speed, rate), random)


def faster(run: Run, by: float, rests: Sequence[tuple[float, float]] = ((0.0, 120.0),)) -> Run:
    """Wheels whose speeds are recorded with an offset [m/s], in some stretches."""
    time = run.ticks.time
    inside = np.any([(time >= begin) & (time < end) for begin, end in rests], axis=0)
    more = np.cumsum(np.diff(time, prepend=time[0]) * by * inside) / ROBOT.left_tick
    ticks = replace(run.ticks, left=run.ticks.left + more, right=run.ticks.right + more)
    return replace(run, ticks=ticks)


def told(*runs: Run) -> ReferenceRemark | None:
    found = remarks_on(prepare(runs, ROBOT, EvaluationOptions()))
    return next((each for each in found if each.what == "at_rest"), None)


@pytest.mark.parametrize("offset", [OFFSET, 0.01, 0.05])
def test_speeds_with_an_offset_are_told_with_its_size(offset: float) -> None:
    """Robots of UTIAS: v is -22 mm/s while they stand; radii were 1.22 and 0.985, by the speed."""
    found = told(faster(rested(1), offset))
    assert found is not None
    assert (found.size, found.usual) == pytest.approx((offset, offset), abs=5e-4)
    assert len(found.stretches) == len(RESTS)
    (as_json,) = remarks_json([found])
    assert as_json["unit"] == "m/s"
    assert f"left wheel goes on at {1e3 * found.size:.1f} mm/s" in remark_words(found)


def stuck(run: Run) -> Run:
    """Poses that repeat the last one in each pause."""
    seen = run.reference
    assert seen is not None
    rows = np.arange(seen.time.size)
    for begin, end in RESTS:
        inside = (seen.time >= begin) & (seen.time < end)
        rows[inside] = rows[inside][0]
    still = Reference(seen.time, seen.x[rows], seen.y[rows], seen.yaw[rows])
    return replace(run, reference=still)


@pytest.mark.parametrize(
    "run",
    [
        rested(1),
        rested(1, creep=0.02),
        stuck(rested(1, creep=0.02)),
        faster(rested(1), 0.05, RESTS[:2]),
        faster(rested(1, rests=RESTS[1:2]), 0.05, RESTS[1:2]),
    ],
    ids=["sound", "creeps", "creeps, reference stuck", "held twice of thrice", "held once"],
)
def test_nothing_else_is_taken_for_it(run: Run) -> None:
    assert told(run) is None


def test_info_tells_it_of_a_folder_and_of_speeds_in_a_bag(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(ROBOT_FILE)
    run = faster(rested(2), OFFSET)
    write_run(tmp_path / "folder", run)
    ros, sent = Messages(), []
    speeds = [np.gradient(own * ROBOT.left_tick, run.ticks.time) / 0.05 for own in _smooth(run)]
    for at, left, right in zip(run.ticks.time, *speeds, strict=True):
        stamp = round(1e9 * (100.0 + at))
        kind, message = ros.joints(stamp, ["left_wheel_joint", "right_wheel_joint"], [])
        message.velocity = np.array([left, right])
        sent.append(("/joint_states", stamp, (kind, message)))
    seen = run.reference
    assert seen is not None
    for at, x, y, yaw in zip(seen.time, seen.x, seen.y, seen.yaw, strict=True):
        stamp = round(1e9 * (100.0 + at))
        sent.append(("/tracker/pose", stamp, ros.pose(stamp, x, y, yaw)))
    ros.write(tmp_path / "bag", sorted(sent, key=lambda each: each[1]))
    for name in ("folder", "bag"):
        found = wo.info(tmp_path / name, robot=file)
        assert "where the reference stands still" in " ".join(found.summary().split())
        at_rest = found.to_dict()["runs"][0]["speeds_at_rest_m_per_s"]
        assert at_rest["left"] == pytest.approx(OFFSET, abs=5e-4)


def _smooth(run: Run) -> list[np.ndarray]:
    """Counts without their steps."""
    even = np.ones(25) / 25.0
    return [
        np.convolve(np.pad(each.astype(float), 12, mode="edge"), even, "valid")
        for each in (run.ticks.left, run.ticks.right)
    ]
