# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How each published recording is read. Nothing is corrected, smoothed or left out."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from test.recorded_robots.runs import Drive, Floats, Read, integrated, yaw_alone

COUNTS_A_TURN = 1_000_000  # for robots that publish speeds of wheels, and no counters
SIDES = ("left", "right")
MARGIN = 0.020  # s, of the reference before and after a piece of a drive


def optitrack(read: Read, drives: tuple[str, ...]) -> Iterator[Drive]:
    """Rows of time, pose by motion capture, and counts since the last row, right then left."""
    for name in drives:
        kind, session, number = name.split("_")
        path = f"data/diff/{kind}/{session}/{session}_run-{number}.csv"
        rows = np.genfromtxt(io.BytesIO(read(path)), delimiter=",", encoding="utf-8-sig")
        t, pose = rows[:, 0], rows[:, 1:4]
        pose[:, 2] = np.unwrap(pose[:, 2])
        counts = np.cumsum(rows[:, [5, 4]].astype(np.int64), axis=0)
        yield Drive(name=name, t=t, counts=counts, t_pose=t, pose=pose, decimals=(3, 5, 5))


def khepera(read: Read, log: str) -> Iterator[Drive]:
    """Tuples of duration, wheels' speeds [rad/s] and the scan matcher's step, put end to end."""
    for part in range(3):
        lines = read(f"reference-output/{log}_{part}.tuple").decode().splitlines()
        rows = [json.loads(line) for line in lines if line.strip()]
        lasted = np.array([row["T"] for row in rows])
        angle = np.array([[row["phi_l"], row["phi_r"]] for row in rows]) * lasted[:, None]
        t = np.concatenate([[0.0], np.cumsum(lasted)])
        turned = np.concatenate([[[0.0, 0.0]], np.cumsum(angle, axis=0)])
        yield Drive(
            name=f"part_{part}",
            t=t,
            counts=_counted(turned / (2 * np.pi)),
            t_pose=t,
            pose=_composed(np.array([row["sm"] for row in rows])),
            decimals=(6, 7, 8),
        )


def labyrinth(read: Read) -> Iterator[Drive]:
    """Speeds of right and left wheel [m/s], each held over the interval that it ends."""
    given = _rows(read("datasets/Indoor_UWB/Indoor_UWB_Input.txt"), "odom2diff")
    truth = _rows(read("datasets/Indoor_UWB/Indoor_UWB_GT.txt"), "point2")
    t, right, left = given[:, 0], given[:, 1], given[:, 2]
    step = np.diff(t, prepend=t[0])
    travel = np.cumsum(np.column_stack([left, right]) * step[:, None], axis=0)
    pose = np.column_stack([truth[:, 1:3], np.full(len(truth), np.nan)])
    yield Drive(
        name="drive",
        t=t,
        counts=_counted(travel / (2 * np.pi * 0.016)),  # the wheel radius of its robot file [m]
        t_pose=truth[:, 0],
        pose=pose,
        decimals=(6, 6, 6),
    )


def lego(read: Read) -> Iterator[Drive]:
    """Counters of both motors, and positions by a camera above, as they were written [ms, mm]."""
    motors = _rows(read("Unit_D/robot4_motors.txt"), "M", 6)
    camera = _rows(read("Unit_D/robot4_reference.txt"), "P")
    nowhere = np.full(len(camera), np.nan)
    yield Drive(
        name="drive",
        t=1e-3 * motors[:, 0],
        counts=motors[:, [1, 5]].astype(np.int64),
        t_pose=1e-3 * camera[:, 0],
        pose=np.column_stack([1e-3 * camera[:, 1:3], nowhere]),
        decimals=(3, 3, 3),
    )


def kobuki(read: Read, bag: str, bias: float, cuts: tuple[int, ...]) -> Iterator[Drive]:
    """A bag as CSV, cut at rows of its counters; the heading is the integral of the raw gyro.

    Parameters
    ----------
    bias
        What the gyro shows at rest [rad/s]: its mean where both counters stand for some 0.3 s on
        either side.
    cuts
        Rows of the counters at which one piece ends and the next begins.
    """
    prefix = f"CatFaultDetection/bags/{bag}/bagfile-_mobile_base_sensors_"
    core = list(csv.DictReader(io.StringIO(read(f"{prefix}core.csv").decode())))
    gyro = list(csv.DictReader(io.StringIO(read(f"{prefix}imu_data_raw.csv").decode())))
    stamps = np.array([int(row["field.header.stamp"]) * 1e-9 for row in core])
    turned = np.array([int(row["field.header.stamp"]) * 1e-9 for row in gyro])
    rate = np.array([float(row["field.angular_velocity.z"]) for row in gyro]) - bias
    order = np.argsort(turned, kind="stable")  # the driver's stamps step back now and then
    turned, rate = turned[order], rate[order]
    for part, (first, last) in enumerate(zip((0, *cuts), (*cuts, len(core) - 1), strict=True)):
        rows = core[first : last + 1]
        t = stamps[first : last + 1] - stamps[first]
        t_pose = turned - stamps[first]
        within = (t_pose >= -MARGIN) & (t_pose <= t[-1] + MARGIN)
        yield Drive(
            name=f"part_{part}",
            t=t,
            counts=np.array(
                [[int(row[f"field.{side}_encoder"]) for side in SIDES] for row in rows]
            ),
            t_pose=t_pose[within],
            pose=yaw_alone(integrated(t_pose[within], rate[within])),
            decimals=(6, 6, 6),
            channels={
                "left_pwm": [row["field.left_pwm"] for row in rows],
                "right_pwm": [row["field.right_pwm"] for row in rows],
                "left_current_a": [f"{int(row['field.current0']) / 100:g}" for row in rows],
                "right_current_a": [f"{int(row['field.current1']) / 100:g}" for row in rows],
            },
        )


def upenn_gyro(read: Read, biases: dict[int, float]) -> Iterator[Drive]:
    """The heading is the integral of the gyro, its bias at rest [rad/s] taken off."""
    for number, bias in biases.items():
        t, counts, begin = _upenn_counts(read, number)
        with np.load(io.BytesIO(read(f"data/Imu{number}.npz"))) as file:
            t_pose = file["time_stamps"] - begin
            rate = file["angular_velocity"][2] - bias
        yield Drive(
            name=f"drive_{number}",
            t=t,
            counts=counts,
            t_pose=t_pose,
            pose=yaw_alone(integrated(t_pose, rate)),
            decimals=(6, 6, 6),
        )


def upenn_icp(read: Read, first_scan: dict[int, float]) -> Iterator[Drive]:
    """A student's scan matcher, whose times are from the first scan [s after the first count]."""
    for number, later in first_scan.items():
        t, counts, _ = _upenn_counts(read, number)
        with np.load(io.BytesIO(read(f"data/Odometry{number}_icp.npz"))) as file:
            t_pose, pose = file["stamps"] + later, file["poses"]
        pose[:, 2] = np.unwrap(pose[:, 2])
        yield Drive(
            name=f"drive_{number}",
            t=t,
            counts=counts,
            t_pose=t_pose,
            pose=pose,
            decimals=(6, 6, 6),
        )


def _upenn_counts(read: Read, number: int) -> tuple[Floats, NDArray[np.int64], float]:
    """Both wheels of a side summed: rows are front right, front left, rear right, rear left."""
    with np.load(io.BytesIO(read(f"data/Encoders{number}.npz"))) as file:
        stamps, each = file["time_stamps"], file["counts"].astype(np.int64)
    counts = np.cumsum(np.column_stack([each[1] + each[3], each[0] + each[2]]), axis=0)
    return stamps - stamps[0], counts, float(stamps[0])


def _rows(text: bytes, kind: str, columns: int = 3) -> Floats:
    lines = [line.split() for line in text.decode().splitlines()]
    kept = [line[1 : 1 + columns] for line in lines if line[:1] == [kind]]
    return np.array([[float(word) for word in line] for line in kept])


def _counted(turns: Floats) -> NDArray[np.int64]:
    return np.round(turns * COUNTS_A_TURN).astype(np.int64)


def _composed(steps: Floats) -> Floats:
    """Poses from steps of a scan matcher, each in the frame of the pose before."""
    yaw = np.concatenate([[0.0], np.cumsum(steps[:, 2])])
    cos, sin = np.cos(yaw[:-1]), np.sin(yaw[:-1])
    moves = np.column_stack(
        [cos * steps[:, 0] - sin * steps[:, 1], sin * steps[:, 0] + cos * steps[:, 1]]
    )
    return np.column_stack([np.concatenate([[[0.0, 0.0]], np.cumsum(moves, axis=0)]), yaw])
