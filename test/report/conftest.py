# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot whose left wheel is eccentric, driven and measured: made by kinematics alone."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.comparison.compare import Comparison, compare
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory
from werrimbi_odom.report.adding.document import document_of as of_added
from werrimbi_odom.report.calibration.document import calibration_document, leg_figure
from werrimbi_odom.report.comparison.document import document_of as of_comparison
from werrimbi_odom.report.diagnosis.document import document_of as of_diagnosis
from werrimbi_odom.report.document import Document, Paragraph, Table
from werrimbi_odom.report.save import find_browser, save_report

sys.path.insert(0, str(Path(__file__).parent))

from browser import Visit, visit

PLAIN = Robot(
    wheel_separation=0.35,
    wheel_radius=0.05,
    left_ticks_per_revolution=2000.0,
    right_ticks_per_revolution=2000.0,
    left_wheel_noise=4e-4,
    right_wheel_noise=4e-4,
)
AMPLITUDE = 0.002
"""Of the left wheel's axle [m]."""

RATE = 20.0
"""Messages in a second."""


def eccentric_run(name: str, seed: int, minutes: float = 1.0) -> Run:
    """A drive of lines and curves, forwards, with measured poses of 1 mm and 1 mrad."""
    noise = np.random.default_rng(seed)
    time = np.arange(0.0, 60.0 * minutes, 1.0 / RATE)
    speed = 0.3 + 0.1 * np.sin(2.0 * np.pi * time / 17.0 + seed)
    turning = 0.8 * np.sin(2.0 * np.pi * time / 11.0) * (np.sin(2.0 * np.pi * time / 40.0) > 0.0)
    counts, rolled = [], []
    for side in (-1.0, 1.0):
        steps = (speed + side * 0.5 * PLAIN.track * turning) / RATE
        slips = noise.normal(0.0, PLAIN.left_wheel_noise * np.sqrt(np.abs(steps)))
        counts.append(np.round(np.cumsum(steps) / PLAIN.left_tick).astype(np.int64))
        rolled.append(np.cumsum(steps + slips) / PLAIN.left_tick)
    effect = find("eccentric_left_wheel").using(amplitude=AMPLITUDE, phase=0.3 * seed)
    path = trajectory(replace(PLAIN, effects=(effect,)), time, *rolled)
    row = path.expanded(time.size)
    seen = slice(None, None, 2)
    pose = [
        (values[row] + noise.normal(0.0, 1e-3, time.size))[seen]
        for values in (path.x, path.y, path.yaw)
    ]
    return Run(name, Path(name), Ticks(time, *counts, {}), Reference(time[seen], *pose))


@pytest.fixture(scope="session")
def runs() -> tuple[Run, ...]:
    """Three drives; the name of one would be HTML if nobody minded."""
    return tuple(
        eccentric_run(name, seed)
        for seed, name in enumerate(("first", "second", "<b>third</b> & last"), start=1)
    )


@pytest.fixture(scope="session")
def comparison(runs: tuple[Run, ...]) -> Comparison:
    return compare(runs, PLAIN)


@pytest.fixture(scope="session")
def diagnosis(runs: tuple[Run, ...]) -> Diagnosis:
    effects = tuple(
        find(name)
        for name in ("track_width", "eccentric_left_wheel", "eccentric_right_wheel", "lateral_slip")
    )
    return diagnose(runs[:2], PLAIN, effects, holdout=runs[2:])


@pytest.fixture(scope="session")
def added(runs: tuple[Run, ...]) -> Added:
    return add_effects([find("eccentric_left_wheel")], runs[:2], PLAIN, holdout=runs[2:])


@pytest.fixture(scope="session")
def page(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Callable[[str], Path]:
    """The page of a verb: each is made once, by the first test that looks at it."""
    folder = tmp_path_factory.mktemp("pages")
    documents: dict[str, Callable[[], Document]] = {
        "compare": lambda: of_comparison(request.getfixturevalue("comparison")),
        "diagnose": lambda: of_diagnosis(
            AdvisedDiagnosis(request.getfixturevalue("diagnosis"), None, ())
        ),
        "add": lambda: of_added(request.getfixturevalue("added")),
        "fit": of_a_fit,
    }

    def made(verb: str) -> Path:
        path = folder / f"{verb}.html"
        if not path.exists():
            save_report(documents[verb](), path)
        return path

    return made


def of_a_fit() -> Document:
    errors = np.random.default_rng(1).normal(0.0, 0.01, (3000, 2))
    table = Table("Found", ["parameter", "before", "after"], [["k", "1", "1.01"]])
    words = [Paragraph("All is well."), table]
    figure, numbers = leg_figure(errors, 0.5 * errors), {"wheel_separation_multiplier": (1.0, 1.01)}
    return calibration_document("Fit", words, "Legs", "See.", lambda: figure, numbers)


@pytest.fixture(scope="session")
def look() -> Callable[..., Visit]:
    """Visits a page in Chromium; where there is none, the test is skipped."""
    browser = find_browser()
    if browser is None:
        pytest.skip("no Chrome or Chromium is installed")
    pytest.importorskip("choreographer", reason="choreographer (kaleido's) drives the browser")
    return lambda path, *scripts, **more: visit(path, scripts, browser=browser, **more)
