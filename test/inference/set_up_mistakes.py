# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up mistakes put into records that are right, or into the robot file."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.robot import Robot

FACTORS = {
    "2": 2.0,
    "1/2": 0.5,
    "4": 4.0,
    "1/4": 0.25,
    "pi": math.pi,
    "1/pi": 1.0 / math.pi,
    "180/pi": 180.0 / math.pi,
    "pi/180": math.pi / 180.0,
    "1000": 1000.0,
    "1/1000": 0.001,
}


@dataclass(frozen=True)
class Mistake:
    """What is done wrong, and the names under which it may be found."""

    names: tuple[str, ...]
    factor: str | None = None
    ticks: Callable[[Ticks], Ticks] = lambda ticks: ticks
    reference: Callable[[Reference], Reference] = lambda reference: reference
    robot: Callable[[Robot], Robot] = lambda robot: robot

    def made(self, runs: Sequence[Run], robot: Robot) -> tuple[list[Run], Robot]:
        tampered = [
            replace(run, ticks=self.ticks(run.ticks), reference=self.reference(run.reference))
            for run in runs
            if run.reference is not None
        ]
        return tampered, self.robot(robot)


def exchanged(ticks: Ticks) -> Ticks:
    return replace(ticks, left=ticks.right, right=ticks.left)


def scaled(**factors: float) -> Callable[[Robot], Robot]:
    """A robot file whose entries are divided by factors: true over entered."""
    return lambda robot: replace(
        robot, **{name: getattr(robot, name) / factor for name, factor in factors.items()}
    )


def mounted(angle: float, point: complex = 0j) -> Callable[[Reference], Reference]:
    def mount(reference: Reference) -> Reference:
        swing = point * np.exp(1j * reference.yaw)
        yaw = np.angle(np.exp(1j * (reference.yaw + angle)))
        return replace(reference, x=reference.x + swing.real, y=reference.y + swing.imag, yaw=yaw)

    return mount


SWAPPED = ("wheels_swapped", "reference_mirrored")
WIRING = {
    "swapped": Mistake(SWAPPED, ticks=exchanged),
    "mirrored": Mistake(SWAPPED, reference=lambda r: replace(r, y=-r.y, yaw=-r.yaw)),
    "left reversed": Mistake(("left_wheel_reversed",), ticks=lambda t: replace(t, left=-t.left)),
    "right reversed": Mistake(
        ("right_wheel_reversed",), ticks=lambda t: replace(t, right=-t.right)
    ),
    "both reversed": Mistake(
        ("left_wheel_reversed", "right_wheel_reversed"),
        ticks=lambda t: replace(t, left=-t.left, right=-t.right),
    ),
}
SIZES = {
    f"{what} {name}": Mistake((effect,), name, robot=scaled(**{entry: value}))
    for name, value in FACTORS.items()
    for what, entry, effect in (
        ("radius", "wheel_radius", "wheel_radius_scale"),
        ("base", "wheel_separation", "track_width"),
    )
}
SIZES["file in millimetres"] = Mistake(
    ("wheel_radius_scale", "track_width"),
    "1/1000",
    robot=scaled(wheel_radius=1e-3, wheel_separation=1e-3),
)
SIZES["lines for counts"] = Mistake(
    ("wheel_radius_scale",),
    "1/4",
    robot=scaled(left_ticks_per_revolution=4.0, right_ticks_per_revolution=4.0),
)
ONE_SIDE = {
    f"{side} counts {1.0 / share:g} times": Mistake(
        ("unequal_wheel_radii",), robot=scaled(**{f"{side}_ticks_per_revolution": share})
    )
    for side in ("left", "right")
    for share in (0.25, 0.5, 2.0, 4.0)
}
REFERENCE = {
    f"mount {degrees}": Mistake(("reference_yaw_offset",), reference=mounted(math.radians(degrees)))
    for degrees in (40, 90, 180, -90, -135)
}
REFERENCE["lever arm"] = Mistake(("reference_lever_arm",), reference=mounted(0.0, 0.7 + 0.3j))
REFERENCE["degrees"] = Mistake(
    ("reference_yaw_in_degrees",),
    reference=lambda r: replace(r, yaw=np.degrees(np.angle(np.exp(1j * r.yaw)))),
)
REFERENCE["millimetres"] = Mistake(
    ("wheel_radius_scale", "track_width"),
    "1000",
    reference=lambda r: replace(r, x=1e3 * r.x, y=1e3 * r.y),
)
DELAYS = {
    f"clock {late} s late": Mistake(
        ("reference_delay",), reference=lambda r, late=late: replace(r, time=r.time + late)
    )
    for late in (0.6, 2.0, -1.5, 4.0)
}


def without_yaw(run: Run) -> Run:
    assert run.reference is not None
    return replace(run, reference=replace(run.reference, yaw=np.nan * run.reference.yaw))


def gyro(run: Run) -> Run:
    """Yaw alone, with a constant bias of 0.01 rad/s."""
    reference = run.reference
    assert reference is not None
    nothing = np.nan * reference.x
    crept = reference.yaw + 0.01 * (reference.time - reference.time[0])
    return replace(run, reference=replace(reference, x=nothing, y=nothing, yaw=crept))


def at_rows(run: Run, rows: np.ndarray) -> Run:
    reference = run.reference
    assert reference is not None
    return replace(
        run,
        reference=Reference(
            reference.time[rows], reference.x[rows], reference.y[rows], reference.yaw[rows]
        ),
    )


def once_a_second(run: Run) -> Run:
    assert run.reference is not None
    period = float(np.median(np.diff(run.reference.time)))
    return at_rows(run, np.arange(0, run.reference.time.size, max(1, round(1.0 / period))))


def two_poses(run: Run) -> Run:
    assert run.reference is not None
    time = run.reference.time
    inside = np.flatnonzero((time >= run.ticks.time[0]) & (time <= run.ticks.time[-1]))
    return at_rows(run, inside[[0, -1]])
