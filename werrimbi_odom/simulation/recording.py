# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What one drive leaves behind: counters, a reference, and, for judging alone, the truth.

Written to a folder (ticks.csv and reference.csv), the truth is left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .engine import TruePath

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True)
class Happened:
    """Something that happened at an instant of a drive, and is no law of the robot.

    `of` says what it was, `t_s` when [s], on the recording's clock; the robot, or what a reference
    told, moved along and sideways [m] and turned [rad]; for a reference that is along its x and y.
    """

    of: str
    t_s: float
    along_m: float
    sideways_m: float
    turn_rad: float


@dataclass(frozen=True)
class Recording:
    """One recorded drive; n rows of counters, m rows of reference, on the same clock.

    Parameters
    ----------
    name : str
        The manoeuvre's.
    t_s : ndarray, shape (n,)
        When the counters were read [s].
    left_ticks, right_ticks : ndarray of int64, shape (n,)
        Cumulative signed counters, started anywhere, positive forwards.
    reference_t_s, reference_x_m, reference_y_m, reference_yaw_rad : ndarray, shape (m,)
        What the reference measured: the axle's midpoint in the reference's frame; yaw wrapped to
        (-pi, pi], as a motion capture system gives it.
    true_path : TruePath
        The axle's midpoint in the world, free of measuring noise (wheel noise moved the robot, so
        it is in it).
    channels : mapping of str to ndarray of shape (n,)
        Further measured columns of ticks.csv.
    happened : tuple of Happened
        At single instants; the truth, which is not written with the drive.
    """

    name: str
    t_s: Floats
    left_ticks: Counts
    right_ticks: Counts
    reference_t_s: Floats
    reference_x_m: Floats
    reference_y_m: Floats
    reference_yaw_rad: Floats
    true_path: TruePath
    channels: Mapping[str, Floats] = field(default_factory=dict)
    happened: tuple[Happened, ...] = ()

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
    """Write `recording` as a run folder, made with its parents; the truth is left out.

    Parameters
    ----------
    recording : Recording
    folder : path

    Returns
    -------
    Path of the folder
    """
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
