# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A Dask cluster that is not there, runs other code, dies, or is lost on the way."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from test.command_line import ROOT
from test.fleet.conftest import broken
from test.fleet.test_process_pool import KILLS, nowhere
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Asked, DriveOptions
from werrimbi_odom.fleet import cluster as ours
from werrimbi_odom.fleet import worker_archive
from werrimbi_odom.fleet.cluster import on_cluster
from werrimbi_odom.fleet.robot_task import Task
from werrimbi_odom.fleet.worker_archive import (
    EFFECTS,
    PACKAGE,
    code_here,
    doubts,
    packed,
    refusal,
    row_of_parcel,
)
from werrimbi_odom.report.fleet import Row
from werrimbi_odom.report.phrases import drive_names

distributed = pytest.importorskip("distributed", reason="pip install werrimbi_odom[cluster]")
dask = pytest.importorskip("dask")


def refused(address: str, patience: float = 30.0) -> str:
    with pytest.raises(InputError) as error:
        list(on_cluster([nowhere("robot_1")], address, patience=patience))
    assert "\n" not in str(error.value)
    return str(error.value)


@pytest.fixture(scope="module")
def bare() -> Iterator[str]:
    """Address of a scheduler without workers."""
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(n_workers=0, processes=True, dashboard_address=None) as made,
    ):
        yield made.scheduler_address


@contextmanager
def worker(address: str, place: Path, path: Path) -> Iterator[None]:
    """A worker whose `werrimbi_odom` is another one: that of `path`."""
    program = [sys.executable, "-m", "distributed.cli.dask_worker", address]
    options = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--name", place.name]
    process = subprocess.Popen(
        [*program, *options, "--local-directory", str(place)],
        cwd=place,
        env={**os.environ, "PYTHONPATH": str(path)},
        stderr=subprocess.DEVNULL,
    )
    try:
        with distributed.Client(address, set_as_default=False) as client:
            client.wait_for_workers(1, timeout=120)
        yield
    finally:
        process.terminate()
        process.wait(60.0)
        with distributed.Client(address, set_as_default=False) as client:
            while client.nthreads():
                time.sleep(0.05)


def test_no_scheduler_and_no_worker_are_told_with_what_to_start(bare: str) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    told = refused(f"tcp://127.0.0.1:{port}", patience=1.0)
    assert "no Dask scheduler answers there" in told
    assert "`dask scheduler`" in told
    told = refused(bare, patience=1.0)
    assert "it has no worker" in told
    assert f"dask worker {bare} --nthreads 1" in told
    told = refused(f"tls://127.0.0.1:{port}", patience=1.0)
    assert "no Dask scheduler answers there" in told


def test_a_worker_with_other_code_is_refused(bare: str, tmp_path: Path) -> None:
    shutil.copytree(
        ROOT / PACKAGE,
        tmp_path / "other" / PACKAGE,
        ignore=shutil.ignore_patterns("__pycache__", "recordings"),
    )
    with (tmp_path / "other" / PACKAGE / "model" / "motion.py").open("a") as file:
        file.write("# another day\n")
    (tmp_path / "w").mkdir()
    with worker(bare, tmp_path / "w", tmp_path / "other"):
        told = refused(bare)
    assert "runs other code: werrimbi_odom " in told
    assert code_here()[PACKAGE] in told
    assert "install the same everywhere" in told


def test_a_worker_without_this_package_is_refused(bare: str, tmp_path: Path) -> None:
    (tmp_path / "old" / PACKAGE).mkdir(parents=True)
    # Without its numpy, say; a module that is merely not there an editable install would find.
    (tmp_path / "old" / PACKAGE / "__init__.py").write_text("raise ImportError('half of it')\n")
    (tmp_path / "w").mkdir()
    with worker(bare, tmp_path / "w", tmp_path / "old"):
        told = refused(bare)
        late = late_comer(bare)
    assert "cannot import werrimbi_odom (half of it)" in told
    assert "pip install 'werrimbi_odom[cluster]'" in told
    assert "a worker cannot import werrimbi_odom" in late


def late_comer(address: str) -> str:
    """What is said of a worker that joined after the check."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ours, "_check_code", lambda *anything: None)
        return refused(address)


def test_what_must_be_the_same_and_what_should() -> None:
    here = code_here()
    assert (refusal(here, here), doubts(here, here)) == ("", "")
    there = {**here, "numpy": "1.0", EFFECTS: "mine (my_robot 1.0)"}
    assert refusal(here, there).startswith("installed effects mine (my_robot 1.0), here ")
    assert doubts(here, there) == f"numpy 1.0, here {here['numpy']}"


def test_a_robot_that_kills_its_workers_is_a_row(bare: str, tmp_path: Path) -> None:
    (tmp_path / "kills.py").write_text(KILLS)
    tasks = [nowhere("killer", DriveOptions(effects=(tmp_path / "kills.py",)))]
    (tmp_path / "w").mkdir()
    with worker(bare, tmp_path / "w", ROOT):
        (row,) = on_cluster(tasks, bare)
    assert row.error == ours.DIED


@pytest.mark.evidence
def test_a_scheduler_that_is_lost_ends_it_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "sleeps.py").write_text("import time\ntime.sleep(600.0)\n")
    tasks = [
        nowhere("robot_1"),
        nowhere("sleeper", DriveOptions(effects=(tmp_path / "sleeps.py",))),
    ]
    made = distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None
    )
    try:
        coming = on_cluster(tasks, made.scheduler_address, patience=3.0)
        assert next(coming).robot == "robot_1"
    finally:
        made.close()
    with pytest.raises(InputError, match="the connection to it is lost"):
        next(coming)


def test_a_parcel_holds_what_is_read_and_nothing_else(tmp_path: Path) -> None:
    folder = broken(tmp_path / "robot_9")
    run = folder / "runs" / "day"
    (run / "video.mp4").write_bytes(os.urandom(100_000))
    data = packed(Task("robot_9", Asked(folder / "robot.yaml", (run,))))
    assert len(data) < 10_000
    row = row_of_parcel(data)
    assert row.error.startswith(f"{run / 'ticks.csv'}, line 1: ")


def test_drives_of_one_name_are_told_apart_as_on_this_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the folders that the user put them in."""
    folder = broken(tmp_path / "robot_9")
    runs = tuple(folder / of / "square" for of in ("monday", "tuesday"))
    for run in runs:
        shutil.copytree(folder / "runs" / "day", run)

    def named(task: Task) -> Row:
        return Row(task.name, 2, {"names": list(drive_names(task.asked.runs).values())})

    monkeypatch.setattr(worker_archive, "row_of", named)
    row = row_of_parcel(packed(Task("robot_9", Asked(folder / "robot.yaml", runs))))
    assert row.figures == {"names": ["monday/square", "tuesday/square"]}


def test_a_bag_beyond_all_measure_is_not_sent(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text("")
    with (tmp_path / "long.mcap").open("wb") as file:
        file.truncate(2**31)
    task = Task("robot_1", Asked(tmp_path / "robot.yaml", (tmp_path / "long.mcap",)))
    with pytest.raises(InputError, match="larger than 1024 MiB"):
        packed(task)


def test_without_dask_it_is_told_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    told = refused("tcp://127.0.0.1:1")
    assert "pip install 'werrimbi_odom[cluster]'" in told
