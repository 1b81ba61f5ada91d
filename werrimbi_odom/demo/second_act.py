# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Second act: the round on a robot in the physics engine, all by nodes that talk over DDS.

The robot drives, its covariance turns out not to be honest, compare_node says what is missing and
writes the new robot file, and with that the robot drives again. All that is printed comes from the
nodes' messages.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.demo.stage import Stage, save_and_tell
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.path_figure import CHI2_95_OF_2
from werrimbi_odom.report.style import BLUE, ORANGE, Figure, blank, plain

SEED = 149
"""Of what is hidden: chosen as one that a minute's driving tells from all others."""
PACES = (2.0, 1.0, 0.5)
"""Simulated seconds in a second: the first, and where the nodes cannot keep up, the others."""
NODES = ("odom_node", "compare_node", "drive_node")
NAMES = ("as its file said", "with what was found")
"""Of the drives."""
DRIVE: dict[str, object] = {
    "manoeuvre": "figure_eight",
    "size": 0.5,
    "area_radius": 4.0,
    "max_vel_x": 0.6,
    "max_vel_theta": 1.4,
    "acc_lim_x": 1.0,
    "acc_lim_theta": 3.0,
    "odom_timeout": 2.0,
    "max_deviation": 0.5,
}
"""A minute of it, to both sides, slow and fast; patient with a busy machine."""
LOOK: dict[str, object] = {
    "diagnose_every": 0.9,
    "reference_sigma_xy": 0.001,
    "reference_sigma_yaw": 0.002,
}
HONEST = "compare_node: honesty of the covariance"
STANDS = 5e-4
"""Way [m] within which the robot has not yet begun."""
CALL, TRIGGER = "ros2 service call ", "std_srvs/srv/Trigger"


def second_act(out: Path) -> None:
    """Drive, tell, add, drive again; print what the nodes say.

    Parameters
    ----------
    out
        Folder for the robot files and the picture.

    Raises
    ------
    InputError
        When a node does not do its part; the message says which, and its own words are above.
    """
    print("\nSecond act: why is the odometry wrong?\n")
    print("A robot in a physics engine, with an effect hidden in it. Which one is told at the end.")
    file, better = out / "robot.yaml", out / "better.yaml"
    out.mkdir(parents=True, exist_ok=True)
    drives: list[OdometryError] = []
    for pace in PACES:
        drives = _round(pace, file, better)
        if drives:
            break
        print("\nThis machine is busy with other things. Again, more slowly:")
    else:
        raise InputError("this machine is too busy with other things to drive a robot on it")
    save_and_tell(error_figure(dict(zip(NAMES, drives, strict=True))), out / "error")
    print("\nThe same on your own robot: docs/driving.md. Why odometry errs, by hand and in full:")
    print(f"    werrimbi simulate --out drives --hide random --seed {SEED}")


def _round(pace: float, file: Path, better: Path) -> list[OdometryError]:
    """Both drives, or none where the nodes could not keep up with the robot's time."""
    for path in (file, better):
        path.unlink(missing_ok=True)
    with Stage() as stage:
        robot = {"hide": "random", "seed": SEED, "real_time_factor": pace, "publish_clock": True}
        stage.start("simulated_robot", {**robot, "imu_rate": 1.0, "robot_file": file})
        stage.until(file.exists, "robot")
        first = _driven(stage, file, better)
        if first is None:
            return []
        answer = stage.ask("compare_node/write_robot_file")
        if not answer.success:
            raise InputError(answer.message)
        print(f"\n$ {CALL}/compare_node/write_robot_file {TRIGGER}\n{answer.message}.")
        for node in NODES:
            stage.end(node)
        second = _driven(stage, better, better.with_name("still_better.yaml"))
        if second is None:
            return []
        print(f"\nWhat was hidden: {stage.ask('simulated_robot/truth').message}.")
    return [first, second]


def _driven(stage: Stage, file: Path, new: Path) -> OdometryError | None:
    """A drive with a robot file, and what compare_node says of it; None where it was broken off."""
    print(f"\nIt drives with {file}, on its own odometry:")
    stage.forget()
    stage.start("odom_node", params_file=file)
    stage.start("compare_node", {"robot_file": file, "new_robot_file": new, **LOOK})
    stage.start("drive_node", DRIVE)
    stage.until(lambda: stage.ask("drive_node/check").success, "robot that could start")
    # Drivers may hear the odometry before we do: the picture needs it from where the robot stands.
    stage.until(lambda: bool(stage.odometry and stage.measured), "odometry and reference")
    print(f"$ {CALL}/drive_node/start {TRIGGER}")
    print(f"{stage.ask('drive_node/start').message}.")
    stage.until(
        lambda: stage.told("drive_node: drive").startswith(("done", "stopped")), "end", 240.0
    )
    if not stage.told("drive_node: drive").startswith("done"):
        return None
    drive = drive_of(stage.odometry, stage.measured)
    print(f"\ncompare_node, live: {stage.told(HONEST)}.")
    stage.until(lambda: bool(stage.diagnoses), "diagnosis", 120.0)
    words = stage.diagnoses[-1].partition("Check it:")[0].rstrip()
    print(f"\ncompare_node, of what was driven:\n{words}")
    return drive


class OdometryError(NamedTuple):
    """Where odometry went against the truth; n instants of the reference."""

    way: Floats
    """Driven until then [m], (n,)."""
    error: Floats
    """Distance between odometry and what was measured [m], (n,)."""
    promised: Floats
    """Radius [m] that the covariance says holds 95 % of such distances, its longest axis; (n,)."""


def drive_of(odometry: Sequence[Any], measured: Sequence[Any]) -> OdometryError:
    """Messages of a drive that began at rest (nav_msgs/Odometry, geometry_msgs/PoseStamped)."""
    time, *path = np.array([_row(m.header.stamp, m.pose.pose) for m in odometry]).T
    seen = np.array([_row(m.header.stamp, m.pose) for m in measured])
    seen = seen[(seen[:, 0] >= time[0]) & (seen[:, 0] <= time[-1])]
    blocks = np.array([m.pose.covariance for m in odometry]).reshape(-1, 6, 6)[:, :2, :2]
    radius = np.sqrt(np.linalg.eigvalsh(blocks)[:, -1] * CHI2_95_OF_2)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(path[0]), np.diff(path[1])))])
    way, x, y, promised = (np.interp(seen[:, 0], time, one) for one in (way, *path[:2], radius))
    stands = way < STANDS
    yaw = float(np.angle(np.mean(np.exp(1j * seen[stands, 3]))))
    moved = seen[:, 1:3] - seen[stands, 1:3].mean(axis=0)
    turned = (moved[:, 0] + 1j * moved[:, 1]) * np.exp(-1j * yaw)
    return OdometryError(way, np.abs(turned - (x + 1j * y)), promised)


def _row(stamp: Any, pose: Any) -> tuple[float, float, float, float]:
    turn = pose.orientation
    seconds = stamp.sec + 1e-9 * stamp.nanosec
    return seconds, pose.position.x, pose.position.y, 2.0 * math.atan2(turn.z, turn.w)


def error_figure(drives: Mapping[str, OdometryError]) -> Figure:
    """How far odometry was off along its way, and how far it said that it might be."""
    figure = blank()
    for (name, drive), colour in zip(drives.items(), (ORANGE, BLUE), strict=True):
        for said, values, dash in (
            (name, drive.error, "solid"),
            (f"{name}: 95 % are within, it says", drive.promised, "dash"),
        ):
            line = {"color": colour, "dash": dash}
            figure.add_scatter(x=drive.way, y=100.0 * values, mode="lines", name=said, line=line)
    figure.update_xaxes(title="driven [m]", rangemode="tozero")
    figure.update_yaxes(title="odometry is off by [cm]", rangemode="tozero")
    plain(figure, height=600)
    heading = {"text": "The odometry of one robot, before and after", "x": 0.02, "y": 0.97}
    return figure.update_layout(title=heading, width=1000, margin_t=130)
