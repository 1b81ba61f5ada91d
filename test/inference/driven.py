# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives whose truth is a robot model: its ticks by a wandering command, its path as reference."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from test.model.drives import ROBOT, read
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Reference, ReferenceKind, Run, Ticks
from werrimbi_odom.inference.calibration.recorded_square import SquareRecording
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

if TYPE_CHECKING:
    from werrimbi_odom.simulation import Recording

NOISE_XY, NOISE_YAW = 1e-3, 2e-3

COARSE = replace(ROBOT, left_ticks_per_revolution=20.0, right_ticks_per_revolution=20.0)
"""With an encoder disc of few slots."""

COMMON = tuple(
    find(name)
    for name in (
        *("track_width", "unequal_wheel_radii", "wheel_radius_scale", "lateral_slip"),
        *("castor_kick", "left_backlash", "turn_dependent_track", "load_transfer"),
        *("reference_delay", "reference_lever_arm", "reference_yaw_offset"),
    )
)
"""Effects for tests that ask something else than which of the library it is: that takes twice as
long."""


def common(*names: str) -> tuple[Effect, ...]:
    """`COMMON`, and those that the test is about."""
    return (*COMMON, *map(find, names))


def runs_of(truth: Robot, seeds: Sequence[int], seconds: int = 90) -> list[Run]:
    """A minute or two for each seed, 20 Hz, a reference of a millimetre."""
    return [run_of(truth, seed, seconds) for seed in seeds]


def run_of(
    truth: Robot,
    seed: int,
    seconds: int = 90,
    channels: Mapping[str, np.ndarray] | None = None,
) -> Run:
    """One drive: stretches of a second or more at a speed and a yaw rate, stops and spins too."""
    random = np.random.default_rng(seed)
    rate, each = 20, 30
    count = seconds * rate // each
    speed = random.uniform(-0.3, 0.6, count) * (random.random(count) > 0.2)
    turning = random.uniform(-1.2, 1.2, count) * (random.random(count) > 0.3)
    smooth = np.ones(8) / 8.0
    driven = [np.convolve(np.repeat(part, each), smooth, "same") for part in (speed, turning)]
    return run_by(truth, *driven, seed=random, name=f"run_{seed}", channels=channels)


def of_coarse_counts(seed: int) -> Run:
    """The drive of `run_of`, counted by the encoder of `COARSE`."""
    run = run_of(ROBOT, seed)
    share = COARSE.left_ticks_per_revolution / ROBOT.left_ticks_per_revolution
    left, right = (np.floor(share * side) for side in (run.ticks.left, run.ticks.right))
    return replace(run, ticks=replace(run.ticks, left=left, right=right))


def run_by(
    truth: Robot,
    speed: np.ndarray,
    turning: np.ndarray,
    seed: int | np.random.Generator = 0,
    name: str = "run",
    channels: Mapping[str, np.ndarray] | None = None,
) -> Run:
    """A drive by its speeds [m/s] and yaw rates [rad/s], 20 of each a second."""
    random = np.random.default_rng(seed)
    ticks = read(ROBOT, 20.0, speed, turning)
    path = trajectory(truth, *ticks, channels=channels)
    shown = slice(None, None, 4)
    count = path.x[shown].size
    noisy = [random.normal(0.0, sigma, count) for sigma in (NOISE_XY, NOISE_XY, NOISE_YAW)]
    reference = Reference(
        path.time[shown],
        path.x[shown] + noisy[0],
        path.y[shown] + noisy[1],
        path.yaw[shown] + noisy[2],
    )
    record = Ticks(
        ticks.time, ticks.left.astype(float), ticks.right.astype(float), dict(channels or {})
    )
    return Run(name, Path(name), record, reference)


def parts(run: Run, which: str) -> Run:
    """With positions or headings alone."""
    reference = run.reference
    assert reference is not None
    nothing = np.full(reference.time.shape, np.nan)
    lacking = {"poses": {}, "positions": {"yaw": nothing}, "yaw": {"x": nothing, "y": nothing}}
    return replace(run, reference=replace(reference, **lacking[which]))


def swapped(run: Run) -> Run:
    """Left and right counter exchanged."""
    return replace(run, ticks=replace(run.ticks, left=run.ticks.right, right=run.ticks.left))


def reference_of(run: Run) -> Reference:
    """Its reference, which it has."""
    assert run.reference is not None
    return run.reference


def of_headings(time: Floats, yaw: Floats, kind: ReferenceKind | None = None) -> Reference:
    """What a gyro shows."""
    nothing = np.full(time.size, np.nan)
    return Reference(time, nothing, nothing, yaw, kind=kind)


def record_of(name: str, drive: Recording) -> SquareRecording:
    """A drive of the engine, as a recorded square is read."""
    return SquareRecording(
        name,
        drive.t_s,
        drive.left_ticks,
        drive.right_ticks,
        drive.reference_t_s,
        drive.reference_x_m,
        drive.reference_y_m,
        drive.reference_yaw_rad,
    )
