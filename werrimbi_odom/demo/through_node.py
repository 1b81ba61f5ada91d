# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""First act: recorded ticks through the real `odom_node` over DDS, and the error at the end.

The included recording is of a robot in a physics engine; its reference is the ground truth.

The node runs as its own process, as on a robot. The ticks are sent as JointState messages faster
than real time. All printed results are from messages that the node publishes.
"""

from __future__ import annotations

import math
import os
import shlex
import subprocess
import sys
import time as clock
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.demo.node_processes import end, private_domain, save_and_tell
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.references.start_pose import driven, start_pose
from werrimbi_odom.files.robot_files.parameters import TICKS
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.model.pose import Pose, wrap
from werrimbi_odom.report.path_figure import PathDrawing, path_figure

if TYPE_CHECKING:
    from rich.table import Table

    from werrimbi_odom.ros.player import Answers

EXPLAINED = 3.4
"""Deviation [σ] that noise explains: 99 % quantile of chi with three degrees of freedom."""

TOPICS = ("joint_states", "set_pose", "odom", "~/pieces")

RECORDING = Path(__file__).parents[1] / "recordings" / "square"


@dataclass(frozen=True, slots=True)
class Ending:
    """End of the drive: pose by the node, and measured pose (if any)."""

    pose: Pose
    covariance: np.ndarray
    """Covariance of (x, y, yaw), odometry frame, shape (3, 3)."""
    measured: Pose | None
    """NaN for coordinates that were not measured."""

    @property
    def sigmas(self) -> np.ndarray:
        """Standard deviations of x, y [m] and heading [rad]."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    @property
    def error(self) -> np.ndarray:
        """Odometry minus measured: x, y [m] and heading [rad]; NaN if not measured."""
        if self.measured is None:
            return np.full(3, np.nan)
        difference: np.ndarray = np.subtract(self.pose, self.measured)
        difference[2] = wrap(float(difference[2]))
        return difference

    @property
    def deviation(self) -> float | None:
        """Mahalanobis distance of the error in the measured coordinates."""
        difference = self.error
        known = np.flatnonzero(np.isfinite(difference))
        if known.size == 0:
            return None
        part = difference[known]
        block = self.covariance[np.ix_(known, known)]
        return float(np.sqrt(part @ np.linalg.pinv(block, hermitian=True) @ part))


def first_act(robot_path: Path, run_path: Path, out: Path) -> None:
    """Play a run to a new node, print the results, draw the path."""
    robot_file = read_robot_file(robot_path)
    run = read_run(run_path, robot_file)
    start = start_pose(run, robot_file)
    began = clock.monotonic()
    answers = _through_the_node(robot_file, run, start)
    seconds = clock.monotonic() - began
    if not answers.time:
        raise InputError("the node answered nothing; its own words are above")
    ending = Ending(
        Pose(answers.x[-1], answers.y[-1], answers.yaw[-1]),
        answers.covariance[-1],
        measured_at(run.reference, answers.time[-1]) if run.reference else None,
    )
    _print(robot_file, run, start, answers, ending, seconds)
    if ending.deviation is not None and ending.deviation > EXPLAINED:
        words = ["werrimbi", "diagnose", "--robot", str(robot_path), str(run_path)]
        print(f"Next:\n    {shlex.join(words)}")
    _draw(run, start, answers, ending, out)


def measured_at(reference: Reference, time: float) -> Pose:
    """Pose of the reference, interpolated at a time; the last one after its end."""

    def at(values: np.ndarray) -> float:
        known = np.isfinite(values)
        if not known.any():
            return math.nan
        return float(np.interp(time, reference.time[known], values[known]))

    known = np.isfinite(reference.yaw)
    unwrapped = np.full_like(reference.yaw, np.nan)
    unwrapped[known] = np.unwrap(reference.yaw[known])
    return Pose(at(reference.x), at(reference.y), at(unwrapped))


def ros_arguments(robot_file: RobotFile, private: str) -> list[str]:
    """Arguments of a node that reads the robot file, and gets counts on topics below `private`."""
    values = {"input_type": "joint_state", "position_unit": "ticks"}
    values |= {name: str(robot_file.values[name]) for name in TICKS}  # also those of radians
    words = ["--ros-args", "--params-file", str(robot_file.path)]
    for name, value in values.items():
        words += ["-p", f"{name}:={value}"]
    *above, own = [part for part in "/".join(robot_file.place).split("/") if part]
    names = {topic: f"{private}/{topic.removeprefix('~/')}" for topic in TOPICS}
    names |= {"__node": own, "__ns": "/" + "/".join(above)}
    for name, value in names.items():
        words += ["-r", f"{name}:={value}"] if "*" not in value else []
    return words


@contextmanager
def _node(robot_file: RobotFile, private: str) -> Iterator[subprocess.Popen[bytes]]:
    module = [sys.executable, "-m", "werrimbi_odom.ros.odom_node"]
    node = subprocess.Popen([*module, *ros_arguments(robot_file, private)])
    try:
        yield node
    finally:
        end(node)


def _through_the_node(robot_file: RobotFile, run: Run, start: Pose) -> Answers:
    import rclpy

    from werrimbi_odom.ros.player import Player

    private = f"/demo_{os.getpid()}"
    values = robot_file.values
    with ExitStack() as stack:
        private_domain(stack)
        with _node(robot_file, private) as node:
            rclpy.init()
            player = Player(private)
            try:
                if not player.wait_for_node(20.0, lambda: node.poll() is None):
                    raise InputError("odom_node did not start; its own words are above")
                return player.play(
                    run.ticks.time,
                    np.asarray(run.ticks.left, dtype=np.float64),
                    np.asarray(run.ticks.right, dtype=np.float64),
                    left_names=values["left_wheel_names"],  # type: ignore[arg-type]
                    right_names=values["right_wheel_names"],  # type: ignore[arg-type]
                    start=start,
                    frame=str(values["odom_frame_id"]),
                )
            finally:
                player.destroy_node()
                rclpy.try_shutdown()


def _print(
    robot_file: RobotFile, run: Run, start: Pose, answers: Answers, ending: Ending, seconds: float
) -> None:
    from rich.console import Console
    from rich.table import Table

    offline = driven(run, robot_file, start)
    lasted = float(run.ticks.time[-1] - run.ticks.time[0])
    distance = float(np.sum(np.hypot(np.diff(answers.x), np.diff(answers.y))))
    apart = math.hypot(offline.x[-1] - ending.pose.x, offline.y[-1] - ending.pose.y)
    kinds = ", ".join(f"{count} {kind}s" for kind, count in answers.counts_by_kind().items())
    table = Table(title=f"{run.name} through odom_node over DDS", show_header=False)
    table.add_row("ticks played", f"{run.ticks.rows} messages: {lasted:.0f} s in {seconds:.1f} s")
    table.add_row("odometry received", f"{len(answers.time)} messages")
    table.add_row("path", f"{distance:.2f} m")
    table.add_row("pieces", kinds)
    table.add_row(
        "ticks accounted for",
        f"all: {1e6 * apart:.3f} µm from offline"
        if apart < 1e-8
        else f"NOT all: {1e3 * apart:.3f} mm from offline",
    )
    console = Console()
    console.print(table)
    engine = run.path.resolve() == RECORDING.resolve()
    console.print(_final_pose(ending, "true" if engine else "measured"))
    console.print(_in_words(ending, "the truth" if engine else "what was measured"), markup=False)
    if engine:
        console.print(
            "The recording is of a robot in a physics engine (docs/simulation.md), so the truth is "
            "known."
        )


def _final_pose(ending: Ending, known: str) -> Table:
    from rich.table import Table

    table = Table(title="final pose")
    for heading in ("", "odometry", known, "error", "1σ", "error in σ"):
        table.add_column(heading, justify="right" if heading else "left")
    measured = ending.measured or Pose(math.nan, math.nan, math.nan)
    degrees = 180.0 / math.pi
    rows = (("x (m)", 1.0, 3), ("y (m)", 1.0, 3), ("heading (deg)", degrees, 2))
    for index, (name, scale, digits) in enumerate(rows):
        error, sigma = float(ending.error[index]), float(ending.sigmas[index])
        values = [ending.pose[index], measured[index]]
        if index == 2:
            values = [wrap(value) for value in values]
        numbers = [*values, error, sigma]
        cells = ["not measured" if math.isnan(n) else f"{scale * n:.{digits}f}" for n in numbers]
        ratio = f"{error / sigma:+.1f}" if sigma > 0.0 and math.isfinite(error) else ""
        table.add_row(name, *cells, ratio)
    return table


def _in_words(ending: Ending, known: str) -> str:
    deviation = ending.deviation
    if deviation is None:
        return "Nothing was measured, so nothing can be said about the error."
    if deviation <= EXPLAINED:
        return (
            f"The end lies {deviation:.1f} σ from {known}, all directions together: "
            "the covariance promised just that."
        )
    return (
        f"The end lies {deviation:.1f} σ from {known}, all directions together: far more than "
        "noise explains. The robot file is not calibrated, or a physical effect is missing."
    )


def _draw(run: Run, start: Pose, answers: Answers, ending: Ending, out: Path) -> None:
    reference = run.reference
    deviation = ending.deviation
    drawing = PathDrawing(
        np.array([start.x, *answers.x]),
        np.array([start.y, *answers.y]),
        np.array([np.zeros((2, 2)), *(block[:2, :2] for block in answers.covariance)]),
        None if reference is None else reference.x,
        None if reference is None else reference.y,
        title=f"{run.name}: odometry of odom_node with its 95 % ellipses",
        subtitle="" if deviation is None else f"end {deviation:.1f} σ from what was measured",
        magnified=1.0 if deviation is not None and deviation > EXPLAINED else None,
    )
    figure = path_figure(drawing)
    save_and_tell(figure, out / "path")
