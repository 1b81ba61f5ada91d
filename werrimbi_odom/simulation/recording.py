# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recording of one drive: counters, a reference, and the ground truth for evaluation only.

`write_run` writes counters and reference (ticks.csv and reference.csv) without the truth.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from .engine import Floats, TruePath
from .sensors import Counts


@dataclass(frozen=True)
class Happened:
    """An abrupt event in a drive.

    `of` is its kind, `t_s` its time [s] in the recording's clock. The robot, or the output of a
    reference, moved along and sideways [m] and turned [rad]; for a reference along its x and y.
    """

    of: str
    t_s: float
    along_m: float
    sideways_m: float
    turn_rad: float


@dataclass(frozen=True)
class Recording:
    """One recorded drive; n rows of counters, m rows of reference, in one clock."""

    name: str
    """Name of the manoeuvre."""
    t_s: Floats
    """Times of the counter readings [s], shape (n,)."""
    left_ticks: Counts
    right_ticks: Counts
    """Cumulative signed counters with arbitrary start values, positive forwards, shape (n,)."""
    reference_t_s: Floats
    reference_x_m: Floats
    reference_y_m: Floats
    reference_yaw_rad: Floats
    """Measurements of the reference: the axle's midpoint in the reference's frame; yaw wrapped to
    (-pi, pi], as from a motion capture system, shape (m,)."""
    true_path: TruePath
    """Pose of the axle's midpoint in the world without measurement noise. Wheel noise is included,
    because it moves the robot."""
    channels: Mapping[str, Floats] = field(default_factory=dict)
    """Further measured columns of ticks.csv, shape (n,)."""
    happened: tuple[Happened, ...] = ()
    """Events; part of the truth, so not written with the drive."""

    @property
    def poses(self) -> Iterator[tuple[float, float, float, float]]:
        """Rows of the reference: t, x, y, yaw."""
        return zip(
            self.reference_t_s,
            self.reference_x_m,
            self.reference_y_m,
            self.reference_yaw_rad,
            strict=True,
        )


def write_run(recording: Recording, folder: str | Path) -> Path:
    """Write `recording` as a run folder without the truth, and return it; parents are created."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    names = "".join(f",{name}" for name in recording.channels)
    lines = [f"t_s,left_ticks,right_ticks{names}\n"]
    ticks = zip(
        recording.t_s,
        recording.left_ticks,
        recording.right_ticks,
        *recording.channels.values(),
        strict=True,
    )
    for t, left, right, *channels in ticks:
        extra = "".join(f",{value:.6g}" for value in channels)
        lines.append(f"{t:.6f},{left},{right}{extra}\n")
    (folder / "ticks.csv").write_text("".join(lines), encoding="utf-8")

    lines = ["t_s,x_m,y_m,yaw_rad\n"]
    lines += [f"{t:.6f},{x:.6f},{y:.6f},{yaw:.6f}\n" for t, x, y, yaw in recording.poses]
    (folder / "reference.csv").write_text("".join(lines), encoding="utf-8")
    return folder
