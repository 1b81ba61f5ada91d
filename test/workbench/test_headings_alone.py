# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives of which headings alone were measured: the page tells their errors in degrees."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import werrimbi_odom as wo
from test.workbench.session import HIDDEN, written
from werrimbi_odom.api.drives import recordings_of
from werrimbi_odom.files.run import Run
from werrimbi_odom.workbench.drawings import errors_told, floor_figure, gain_figure
from werrimbi_odom.workbench.loaded_input import error_of, opened
from werrimbi_odom.workbench.session import begun
from werrimbi_odom.workbench.tab import Shared, Tab, change_told, size_told
from werrimbi_odom.workbench.task import Add
from werrimbi_odom.workbench.worker_tasks import added


def test_the_error_that_falls_is_that_of_the_headings(tmp_path: Path) -> None:
    file, train, holdout = written(tmp_path)
    robot = wo.read_robot(file)

    def turning(path: Path) -> Run:
        run = wo.read_run(path, robot)
        assert run.reference is not None
        nothing = np.full(run.reference.time.size, np.nan)
        return replace(run, reference=replace(run.reference, x=nothing, y=nothing))

    given = recordings_of(robot, list(map(turning, train)), holdout=list(map(turning, holdout)))
    there = opened(given)
    look = there.look(robot.robot)
    assert look.unit == "rad"
    assert look.holdout_error == look.holdout.main.all.figures.rmse_yaw_rad
    tab = Tab(cast(Shared, SimpleNamespace()), begun(look), lambda focus: None)
    degrees = math.degrees(look.holdout_error)
    assert tab.error_told() == f"held-out error {degrees:.2f}°"
    step = added(Add((HIDDEN,), robot.robot), there, lambda share, words: None)
    assert step.look.holdout_error < 0.5 * look.holdout_error
    drawn: Any = gain_figure([*tab.session.steps, step])
    assert "[°]" in drawn.layout.yaxis.title.text
    assert drawn.data[1].y[0] == pytest.approx(degrees)
    told = errors_told(look.train, 0)
    assert list(told) == ["heading"]
    floor: Any = floor_figure(look.train)
    legs = np.concatenate([line.x for line in floor.data if line.mode == "lines"])
    assert np.isfinite(legs.astype(float)).sum() > look.train.legs.run.size  # drawn all the same
    texts = [words for line in floor.data for words in line.text or ()]
    assert len(texts) == look.train.legs.run.size
    assert all("heading" in words and "along" not in words for words in texts)


def test_without_anything_measured_it_is_said() -> None:
    nothing: Any = SimpleNamespace(rmse_position_m=math.nan, rmse_yaw_rad=math.nan)
    assert size_told(*error_of(nothing)) == "not measured"
    assert change_told(math.nan, 0.001) == change_told(0.001, math.nan) == ""
    assert change_told(0.0, 0.001) == ""
    assert change_told(0.004, 0.001) == "−75 %"
