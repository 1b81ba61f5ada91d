# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a published recording is turned into: counters, measurements, and how they are written."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Read = Callable[[str], bytes]  # a file of the repository, by its path there


@dataclass(frozen=True, kw_only=True)
class Drive:
    """One run folder.

    Attributes
    ----------
    counts
        Counters of the left and the right wheel, n x 2.
    pose
        (x, y, yaw) as measured [m, m, rad], m x 3; NaN where it was not.
    decimals
        Decimals of times, of positions, and of headings.
    channels
        Further columns of ticks.csv, as text.
    """

    name: str
    t: Floats
    counts: NDArray[np.int64]
    t_pose: Floats
    pose: Floats
    decimals: tuple[int, int, int]
    channels: Mapping[str, Sequence[str]] = field(default_factory=dict)


def write(drive: Drive, folder: Path) -> None:
    """Write ticks.csv and reference.csv."""
    folder.mkdir(parents=True, exist_ok=True)
    time, place, heading = drive.decimals
    ticks = [",".join(["t_s", "left_ticks", "right_ticks", *drive.channels])]
    for t, (left, right), *more in zip(
        drive.t, drive.counts, *drive.channels.values(), strict=True
    ):
        ticks.append(",".join([f"{t:.{time}f}", f"{left}", f"{right}", *more]))
    reference = ["t_s,x_m,y_m,yaw_rad"]
    for t, (x, y, yaw) in zip(drive.t_pose, drive.pose, strict=True):
        cells = [_cell(x, place), _cell(y, place), _cell(yaw, heading)]
        reference.append(",".join([f"{t:.{time}f}", *cells]))
    (folder / "ticks.csv").write_text("\n".join(ticks) + "\n", encoding="utf-8")
    (folder / "reference.csv").write_text("\n".join(reference) + "\n", encoding="utf-8")


def _cell(value: float, decimals: int) -> str:
    return "" if math.isnan(value) else f"{value:.{decimals}f}"


def yaw_alone(yaw: Floats) -> Floats:
    """Poses of which the heading alone was measured, n x 3."""
    return np.column_stack([np.full((len(yaw), 2), np.nan), yaw])


def integrated(t: Floats, rate: Floats) -> Floats:
    """The integral of a rate from the first time on, by trapezia."""
    return np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(t))])
