# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A small fleet from the physics engine: two robots of a wrong base, a right one, a broken one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

BASES = {"robot_2": 1.03, "robot_10": 1.025, "robot_11": 1.0}
"""Multipliers of the track width that are hidden."""


def physics() -> Any:
    """The simulation, asked for here: where a conftest skips at its head, pytest 7 runs nothing."""
    pytest.importorskip("mujoco", reason="the fleet is simulated (pip install mujoco)")
    from werrimbi_odom import simulation

    return simulation


def drive(folder: Path, multiplier: float = 1.0) -> Path:
    """A robot's folder, as `werrimbi simulate` makes it, of short drives."""
    sim = physics()
    drives = {
        "train/square": sim.square(0.8),
        "train/free": sim.free(25.0, seed=1, speed=0.5, yaw_rate=1.5),
        "holdout/free": sim.free(20.0, seed=3, speed=0.5, yaw_rate=1.5),
    }
    robot = sim.TrueRobot(left_wheel_noise=4e-4, right_wheel_noise=5.8e-4)
    odd = [] if multiplier == 1.0 else [sim.hide("track_width", multiplier, seed=1).peculiarity]
    folder.mkdir(parents=True)
    sim.write_robot_file(robot, folder / "robot.yaml")
    for seed, (name, manoeuvre) in enumerate(drives.items()):
        run = sim.record(robot, manoeuvre, seed=seed, hidden=odd, ticks_rate_hz=20.0)
        sim.write_run(run, folder / name)
    return folder


def broken(folder: Path) -> Path:
    """A robot whose only run cannot be read."""
    sim = physics()
    (folder / "runs" / "day").mkdir(parents=True)
    sim.write_robot_file(sim.TrueRobot(), folder / "robot.yaml")
    (folder / "runs" / "day" / "ticks.csv").write_text("t_s,left_ticks\n0.0,1\n")
    return folder


@pytest.fixture(scope="session")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the fleet lies, in the folder `fleet`."""
    home = tmp_path_factory.mktemp("home")
    for name, multiplier in BASES.items():
        drive(home / "fleet" / name, multiplier)
    broken(home / "fleet" / "robot_9")
    (home / "fleet" / "notes").mkdir()
    (home / "fleet" / "notes" / "read_me.txt").write_text("no robot\n")
    return home


@pytest.fixture(scope="session")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Two workers that are processes elsewhere: relative paths lead nowhere there."""
    distributed = pytest.importorskip("distributed", reason="pip install werrimbi_odom[cluster]")
    import dask

    elsewhere = tmp_path_factory.mktemp("elsewhere")
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(
            processes=True,
            n_workers=2,
            threads_per_worker=1,
            dashboard_address=None,
            local_directory=str(elsewhere),
        ) as made,
    ):
        with distributed.Client(made, set_as_default=False) as client:
            client.run(os.chdir, str(elsewhere))
        yield made
