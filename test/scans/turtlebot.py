# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated TurtleBot3 with nothing but its lidar: what is found by /scan, and by the truth.

python -m test.scans.turtlebot        (a minute; writes the table of docs/scans.md)
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import werrimbi_odom as wo
from test.scans.table import DOCS, put_into_page
from werrimbi_odom import simulation as sim
from werrimbi_odom.simulation.lidar import Lidar, scanned
from werrimbi_odom.simulation.rooms import around

SCALE, RATIO = 0.9955, 1.0215
LEFT = 2.0 * 0.033 * SCALE / (1.0 + RATIO)
ROBOT = sim.TrueRobot(
    wheel_separation=1.05 * 0.16,
    left_wheel_radius=LEFT,
    right_wheel_radius=RATIO * LEFT,
    left_ticks_per_revolution=4096.0,
    right_ticks_per_revolution=4096.0,
    left_wheel_noise=2e-4,
    right_wheel_noise=2e-4,
    mass=1.0,
    nominal=sim.Nominal(0.16, 0.033),
)
LIDAR = Lidar(mount=sim.AxlePose(-0.032, 0.0, 0.03))
WRONG = (
    "unequal_wheel_radii",
    "reference_lever_arm",
    "track_width",
    "reference_yaw_offset",
    "wheel_radius_scale",
)
TRUE = {
    "unequal_wheel_radii.ratio": RATIO,
    "track_width.multiplier": 1.05,
    "wheel_radius_scale.multiplier": SCALE,
    "reference_lever_arm.x": -0.032,
    "reference_lever_arm.y": 0.0,
    "reference_yaw_offset.angle": 0.03,
}
WITHIN = dict(zip(TRUE, (0.001, 0.002, 0.001, 0.001, 0.001, 0.001), strict=True))
"""What twenty metres should give, and ten do."""


class Recorded(NamedTuple):
    """One drive, in two ways."""

    bag: Path
    """Wheels and scans, as anybody records them, and what a transform says of the lidar's place."""
    run: Path
    """Wheels, and where the lidar truly was, to 0.5 mm and 0.5 mrad."""


def recorded(
    manoeuvre: sim.Manoeuvre,
    seed: int,
    folder: Path,
    lidar: Lidar = LIDAR,
    entered: sim.AxlePose | None = None,
    robot: sim.TrueRobot = ROBOT,
    hidden: Sequence[sim.Peculiarity] = (),
) -> Recorded:
    """A drive of nobody's hands, in a room of its own; `entered`: what a transform says."""
    start = sim.AxlePose(0.0, 0.0, 0.0)
    path = sim.record(robot, manoeuvre, seed=seed, start=start, hidden=hidden).true_path
    at = np.arange(0.01, path.t_s[-1], 0.05)
    step = 2.0 * math.pi / 4096.0
    left, right = (
        np.floor(np.interp(at, path.t_s, angle) / step)
        for angle in (path.left_angle_rad, path.right_angle_rad)
    )
    nothing = np.column_stack([at, at, np.zeros(at.size)])
    sweeps = scanned(path, around(path.x_m, path.y_m, seed), lidar, seed)
    drive = sim.FieldDrive(
        folder.name,
        np.column_stack([at, at, step * left, step * right]),
        nothing,
        np.column_stack([at, at, np.zeros((at.size, 3))]),
        np.zeros((at.size, 3)),
        replace(lidar, mount=entered or lidar.mount),
        sweeps,
        sweeps.time + 1.0 / lidar.rate_hz,
    )
    run = folder.with_name(f"{folder.name}_true")
    run.mkdir()
    noise = 5e-4 * np.random.default_rng(seed).standard_normal(sweeps.truth.shape)
    middle = sweeps.time + 0.5 * (lidar.beams - 1) * lidar.beam_interval
    for name, head, columns in (
        ("ticks", "t_s,left_ticks,right_ticks", (at, left, right)),
        ("reference", "t_s,x_m,y_m,yaw_rad", (middle, *(sweeps.truth + noise).T)),
    ):
        table = np.column_stack(columns)
        np.savetxt(run / f"{name}.csv", table, "%.7g", ",", header=head, comments="")
    return Recorded(sim.write_field_bag(drive, robot, folder, mounting=entered is not None), run)


def short(seed: int) -> sim.Manoeuvre:
    """A metre and a quarter, and two slow spins, both clockwise, as a real one was driven."""
    rng = np.random.default_rng([seed, 5])
    knots = [(0.0, 0.0, 0.0)]
    for rests, speed, turning in (
        (3.0, 0.0, 0.0),
        (rng.uniform(5.0, 7.0), 0.19, 0.0),
        (rng.uniform(4.0, 7.0), 0.0, -0.21),
        (rng.uniform(0.5, 1.5), 0.19, 0.0),
        (rng.uniform(3.0, 5.0), 0.0, -0.21),
        (1.0, 0.0, 0.0),
    ):
        begins = knots[-1][0] + 0.3
        knots += [(begins, speed, turning), (begins + rests, speed, turning)]
    return sim.Manoeuvre("short", tuple(knots))


def place_by_two_short_drives(
    seed: int, lidar: Lidar, folder: Path
) -> dict[str, tuple[float, float]]:
    """Values and standard deviations that `add` states, by their names; the delay is none."""
    robot = wo.read_robot(sim.write_robot_file(ROBOT, folder / "robot.yaml"))
    drives = [
        recorded(short(number), number, folder / f"drive_{number}", lidar).bag
        for number in (2 * seed, 2 * seed + 1)
    ]
    told = wo.add(
        "reference_lever_arm,reference_yaw_offset,reference_delay,wheel_radius_scale",
        robot,
        drives,
        force=True,
        leg=0.25,
        ticks_topic="/joint_states",
        reference_topic="/scan",
    )
    every = told.to_dict()["parameters"]
    return {name: (each["value"], each["std"] or math.nan) for name, each in every.items()}


def found(folder: Path, driven: int = 3, seed: int = 10) -> tuple[dict[str, Any], dict[str, Any]]:
    """What `add` makes of all that is wrong, by scans and by the truth: 10 m, and 10 m held out.

    `driven`, `seed`: of the first drive's manoeuvre, and of its wheels, room and lidar.
    """
    robot = wo.read_robot(sim.write_robot_file(ROBOT, folder / "robot.yaml"))
    drives = [
        recorded(
            sim.free(80.0, seed=driven + n, speed=0.25, yaw_rate=0.8),
            seed + n,
            folder / f"drive_{n}",
        )
        for n in range(2)
    ]
    (fitted, true), (apart, true_apart) = drives
    every = ",".join(WRONG)
    by_scans = wo.add(
        every,
        robot,
        [fitted],
        holdout=[apart],
        force=True,
        ticks_topic="/joint_states",
        reference_topic="/scan",
    )
    by_truth = wo.add(every, robot, [true], holdout=[true_apart], force=True)
    return by_scans.to_dict(), by_truth.to_dict()


SHOWN = {
    "track_width.multiplier": ("wheel base", 1.0, 4),
    "unequal_wheel_radii.ratio": ("right radius over left", 1.0, 5),
    "wheel_radius_scale.multiplier": ("both radii", 1.0, 4),
    "reference_lever_arm.x": ("lidar ahead, mm", 1e3, 1),
    "reference_lever_arm.y": ("lidar to the left, mm", 1e3, 1),
    "reference_yaw_offset.angle": ("lidar askew, mrad", 1e3, 1),
}
"""By parameter: its words, the unit, and digits."""
HEAD = "| | true | found by scans | by its true motion (0.5 mm, 0.5 mrad) |"


def table(folder: Path) -> list[str]:
    """The lines of the docs."""
    both = found(folder)
    lines = [HEAD, "| --- | --- | --- | --- |"]
    for name, (says, unit, digits) in SHOWN.items():
        cells = [_cell(each["parameters"][name], unit, digits) for each in both]
        lines.append(f"| {says} | {unit * TRUE[name]:g} | {' | '.join(cells)} |")
    errors = [
        f"{1e3 * each['holdout']['before']:.1f} mm, then {1e3 * each['holdout']['after']:.1f} mm"
        for each in both
    ]
    return [*lines, f"| error of held-out legs of 1 m | | {' | '.join(errors)} |"]


def _cell(told: dict[str, float | None], unit: float, digits: int) -> str:
    value, std = (unit * (told[key] or 0.0) for key in ("value", "std"))
    return f"{value:.{digits}f} ± {std:.{digits}f}" if std else f"{value:g}, as given"


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        lines = table(Path(place))
    print("\n".join(lines))
    put_into_page(DOCS, lines)
