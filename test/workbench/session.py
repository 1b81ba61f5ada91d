# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A small day with a robot whose right wheel is smaller than its file says, as files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from test.white_noise_robot import WhiteNoiseRobot, drive, square, wandering

HIDDEN = "unequal_wheel_radii"
RATIO = 0.0497 / 0.0503
TRUE = WhiteNoiseRobot(0.35, 0.0503, 0.0497, left_noise=5e-4, right_noise=5e-4)

ROBOT = """\
# As its maker believes it to be.
odom_node:
  ros__parameters:
    wheel_separation: 0.35       # m
    wheel_radius: 0.05           # m
    left_ticks_per_revolution: 2000.0
    right_ticks_per_revolution: 2000.0
    left_wheel_noise: 0.0005     # m^0.5
    right_wheel_noise: 0.0005
"""


def recorded(folder: Path, seed: int) -> Path:
    """One drive of some forty seconds."""
    random = np.random.default_rng(seed)
    lap, free = square(1.5, 1.0 if seed % 2 else -1.0), wandering(random, 20.0)
    commands = np.concatenate([lap[0], free[0]]), np.concatenate([lap[1], free[1]])
    seen = drive(TRUE, commands, random, every=5)
    run = folder / f"drive_{seed}"
    run.mkdir(parents=True)
    ticks = np.column_stack([seen.ticks.time, seen.ticks.left, seen.ticks.right])
    np.savetxt(
        run / "ticks.csv", ticks, delimiter=",", header="t_s,left_ticks,right_ticks", comments="",
        fmt=["%.4f", "%d", "%d"],
    )  # fmt: skip
    reference = seen.reference
    poses = np.column_stack([reference.time, reference.x, reference.y, reference.yaw])
    np.savetxt(
        run / "reference.csv", poses, delimiter=",", header="t_s,x_m,y_m,yaw_rad", comments="",
        fmt="%.6f",
    )  # fmt: skip
    return run


def written(folder: Path) -> tuple[Path, list[Path], list[Path]]:
    """Robot file, drives to fit, drives to judge on."""
    robot = folder / "robot.yaml"
    robot.write_text(ROBOT)
    train = [recorded(folder / "train", seed) for seed in (1, 2)]
    return robot, train, [recorded(folder / "holdout", 3)]
