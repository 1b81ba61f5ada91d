# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The page is there before anything is compared; what cannot be opened is said and ends it."""

from __future__ import annotations

import asyncio
from pathlib import Path

import numpy as np
import pytest

from test.command_line import WERRIMBI, ran
from test.loops import awaited
from test.workbench.session import written
from werrimbi_odom.effects.lookup import all_effects
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.recordings import DriveOptions, Recordings
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.workbench.job import CancelledError, Job
from werrimbi_odom.workbench.loaded_input import opened
from werrimbi_odom.workbench.saving import Target
from werrimbi_odom.workbench.tab import Opening, Shared
from werrimbi_odom.workbench.task import Open

Day = tuple[RobotFile, list[Run], list[Run]]


@pytest.fixture(scope="module")
def day(tmp_path_factory: pytest.TempPathFactory) -> Day:
    robot, *drives = written(tmp_path_factory.mktemp("day"))
    source = read_robot_file(robot)
    train, holdout = ([read_run(path, source) for path in paths] for paths in drives)
    return source, train, holdout


def begun(source: RobotFile, runs: list[Run], holdout: list[Run]) -> Opening:
    job = Job(Open())
    job.start()
    given = Recordings(source, all_effects([]), tuple(runs), tuple(holdout), DriveOptions())
    return Opening(job, given, Target(Path("new.yaml")))


@pytest.fixture(scope="module")
def of_two_tabs(day: Day) -> tuple[Opening, Shared]:
    """An opening that two tabs waited for, of which one left, and what the other one got."""

    async def look() -> tuple[Opening, Shared]:
        opening = begun(*day)
        first, second = (asyncio.create_task(opening.result()) for _ in range(2))
        await asyncio.sleep(0.01)
        first.cancel()
        shared = await second
        assert shared is await opening.result()
        return opening, shared

    found: tuple[Opening, Shared] = awaited(look())
    return found


def test_the_page_gets_the_figures_that_were_worked_out_elsewhere(
    day: Day, of_two_tabs: tuple[Opening, Shared]
) -> None:
    """To the last digit those of this process, and the drives hold the very same arrays."""
    opening, shared = of_two_tabs
    assert opening.shared is shared, "one that leaves does not stop it"
    here = opened(opening.given)
    look = here.look(day[0].robot)
    for there, own in ((shared.look.train, look.train), (shared.look.holdout, look.holdout)):
        np.testing.assert_array_equal(there.legs.errors.error, own.legs.errors.error)
        assert there.main.all.figures == own.main.all.figures
    assert shared.look.verdict.good == look.verdict.good
    assert shared.look.train.runs[0].run.ticks is day[1][0].ticks
    assert shared.look.train.prepared is shared.opened.train
    assert shared.opened.judged_on == here.judged_on


def test_an_opening_that_is_stopped_says_so(day: Day) -> None:
    async def look() -> None:
        opening = begun(*day)
        opening.job.cancel()
        with pytest.raises(CancelledError):
            await opening.result()
        assert opening.shared is None

    awaited(look())


def test_drives_without_a_reference_are_refused_in_a_line(day: Day, tmp_path: Path) -> None:
    source, runs, _ = day
    bare = Run(runs[0].name, runs[0].path, runs[0].ticks, None)
    with pytest.raises(InputError):
        awaited(begun(source, [bare], [bare]).result())

    robot, train, _ = written(tmp_path)
    for run in train:
        (run / "reference.csv").unlink()
    end = ran([*WERRIMBI, "workbench", "--robot", robot, *train])
    assert end.returncode == 2
    assert len(end.stderr.splitlines()) == 1
    assert "reference" in end.stderr


def test_numbers_that_cannot_be_written_end_it_with_the_reason(tmp_path: Path) -> None:
    robot, train, _ = written(tmp_path)
    end = ran([*WERRIMBI, "workbench", "--robot", robot, *train, "--json", "/dev/full"])
    assert end.returncode == 2
    assert "/dev/full cannot be written" in end.stderr
