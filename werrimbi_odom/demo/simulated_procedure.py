# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Second act: the whole procedure on a robot in the physics engine, all by nodes over DDS.

The robot drives and its covariance is inconsistent. compare_node reports what is missing and writes
the new robot file, with which the robot drives again. All printed results are from messages of the
nodes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.demo.node_processes import Stage, save_and_tell
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.distributions import CHI2_95
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.style import BLUE, ORANGE, Figure, blank, plain

SEED = 149
"""Seed of the hidden effect, chosen such that one minute of driving identifies the effect."""
PACES = (2.0, 1.0, 0.5)
"""Real time factors: the first, and the others in case the nodes cannot keep up."""
NODES = ("odom_node", "compare_node", "drive_node")
NAMES = ("as its file said", "with what was found")
"""Names of the drives."""
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
"""One minute to both sides, slow and fast, with timeouts for a busy machine."""
LOOK: dict[str, object] = {
    "diagnose_every": 0.9,
    "reference_sigma_xy": 0.001,
    "reference_sigma_yaw": 0.002,
}
HONEST = "compare_node: honesty of the covariance"
STANDS = 5e-4
"""Path length [m] below which the robot counts as not started."""
CALL, TRIGGER = "ros2 service call ", "std_srvs/srv/Trigger"


def second_act(out: Path) -> None:
    """Drive, diagnose, add, drive again; print the results of the nodes.

    Robot files and the picture are written to `out`. InputError if a node fails; the message names
    it, and its own output is above.
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
    """Both drives; an empty list if the nodes could not keep up."""
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
    """A drive with a robot file, and the output of compare_node; None if it was stopped early."""
    print(f"\nIt drives with {file}, on its own odometry:")
    stage.forget()
    stage.start("odom_node", params_file=file)
    stage.start("compare_node", {"robot_file": file, "new_robot_file": new, **LOOK})
    stage.start("drive_node", DRIVE)
    stage.until(lambda: stage.ask("drive_node/check").success, "robot that could start")
    # drive_node may receive odometry before this node does; the figure needs it from the start.
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
    stage.until(lambda: bool(stage.diagnoses), "diagnosis", 600.0)
    words = stage.diagnoses[-1].partition("Check it:")[0].rstrip()
    print(f"\ncompare_node, of what was driven:\n{words}")
    return drive


class OdometryError(NamedTuple):
    """Error of odometry along a drive; n times of the reference."""

    way: Floats
    """Path length until then [m], shape (n,)."""
    error: Floats
    """Distance between odometry and measurement [m], shape (n,)."""
    promised: Floats
    """Half the longest axis of the 95 % ellipse of the covariance [m], shape (n,)."""


def drive_of(odometry: Sequence[Any], measured: Sequence[Any]) -> OdometryError:
    """Errors from the messages of a drive that began at rest (Odometry, PoseStamped)."""
    time, *path = np.array([_row(m.header.stamp, m.pose.pose) for m in odometry]).T
    seen = np.array([_row(m.header.stamp, m.pose) for m in measured])
    seen = seen[(seen[:, 0] >= time[0]) & (seen[:, 0] <= time[-1])]
    blocks = np.array([m.pose.covariance for m in odometry]).reshape(-1, 6, 6)[:, :2, :2]
    radius = np.sqrt(np.linalg.eigvalsh(blocks)[:, -1] * CHI2_95[2])
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
    """Error of odometry along the path, and its 95 % bound by the covariance."""
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
