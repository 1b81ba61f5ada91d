# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The page is there before anything is compared; what cannot be opened is said and ends it."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from test.loops import awaited
from test.workbench.conftest import ROOT
from test.workbench.session import written
from werrimbi_odom.effects.lookup import all_effects
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.recordings import DriveOptions, Recordings
from werrimbi_odom.files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.workbench.job import CancelledError, Job, Open
from werrimbi_odom.workbench.loaded_input import opened
from werrimbi_odom.workbench.saving import Target
from werrimbi_odom.workbench.tab import Opening


@pytest.fixture(scope="module")
def day(tmp_path_factory: pytest.TempPathFactory) -> tuple[RobotFile, list[Run], list[Run]]:
    robot, train, holdout = written(tmp_path_factory.mktemp("day"))
    source = read_robot_file(robot)
    return (
        source,
        [read_run(path, source) for path in train],
        [read_run(path, source) for path in holdout],
    )


def begun(source: RobotFile, runs: list[Run], holdout: list[Run]) -> Opening:
    job = Job(Open())
    job.start()
    given = Recordings(source, all_effects([]), tuple(runs), tuple(holdout), DriveOptions())
    return Opening(job, given, Target(Path("new.yaml")))


def test_the_page_gets_the_figures_that_were_worked_out_elsewhere(
    day: tuple[RobotFile, list[Run], list[Run]],
) -> None:
    """To the last digit those of this process, and the drives hold the very same arrays."""
    opening = begun(*day)
    shared = awaited(opening.result())
    assert opening.shared is shared
    here = opened(opening.given)
    look = here.look(day[0].robot)
    for there, own in ((shared.look.train, look.train), (shared.look.holdout, look.holdout)):
        np.testing.assert_array_equal(there.legs.errors.error, own.legs.errors.error)
        assert there.main.all.figures == own.main.all.figures
    assert shared.look.verdict.good == look.verdict.good
    assert shared.look.train.runs[0].run.ticks is day[1][0].ticks
    assert shared.look.train.prepared is shared.opened.train
    assert shared.opened.judged_on == here.judged_on


def test_all_tabs_wait_for_one_opening_and_one_that_leaves_does_not_stop_it(
    day: tuple[RobotFile, list[Run], list[Run]],
) -> None:
    async def look() -> None:
        opening = begun(*day)
        first, second = (asyncio.create_task(opening.result()) for _ in range(2))
        await asyncio.sleep(0.01)
        first.cancel()
        assert await second is await opening.result()

    awaited(look())


def test_an_opening_that_is_stopped_says_so(day: tuple[RobotFile, list[Run], list[Run]]) -> None:
    async def look() -> None:
        opening = begun(*day)
        opening.job.cancel()
        with pytest.raises(CancelledError):
            await opening.result()
        assert opening.shared is None

    awaited(look())


def test_drives_without_a_reference_are_refused_in_a_line(
    day: tuple[RobotFile, list[Run], list[Run]], tmp_path: Path
) -> None:
    source, runs, _ = day
    bare = Run(runs[0].name, runs[0].path, runs[0].ticks, None)
    with pytest.raises(InputError):
        awaited(begun(source, [bare], [bare]).result())

    robot, train, _ = written(tmp_path)
    for run in train:
        (run / "reference.csv").unlink()
    end = subprocess.run(
        [sys.executable, "-m", "werrimbi_odom.cli.main", "workbench",
         "--robot", str(robot), *map(str, train)],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert end.returncode == 2
    assert len(end.stderr.splitlines()) == 1
    assert "reference" in end.stderr
