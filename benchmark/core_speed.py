# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Speed of the numeric core: closed form over pieces against plain propagation tick by tick.

Ratios are between figures of the same run on the same machine; the plain one is measured on a slice
and scaled, as it grows in proportion to the ticks.

    python benchmark/core_speed.py
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

from rich.console import Console
from rich.table import Table

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from test.model.drives import ROBOT, Ticks, random_drive, square
from test.plain_twin import plain_run
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.trajectory import trajectory

SLICE = 20_000
"""Ticks on which the slow ones are measured."""


def seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Shortest of a few runs: what the machine can do when left alone."""
    best = float("inf")
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return best


def first(ticks: Ticks, count: int) -> Ticks:
    """The first ticks of a record."""
    return Ticks(*(part[:count] for part in ticks))


def streamed(ticks: Ticks) -> None:
    """The record through the odometer, message by message."""
    odometer = Odometer(ROBOT)
    for reading in zip(*(part.tolist() for part in ticks), strict=True):
        odometer.update(*reading)


def main() -> None:
    """Print the tables."""
    console = Console()
    drives = {
        "squares, 100 Hz": square(rate=100.0, laps=240),
        "wandering, 50 Hz": random_drive(0, duration=20_000.0),
    }
    table = Table(title="A million ticks, poses and covariances at every one")
    for heading in (
        "drive",
        "pieces",
        "trajectory",
        "odometer",
        "plain numpy",
        "plain / trajectory",
    ):
        table.add_column(heading, justify="left" if heading == "drive" else "right")
    for name, drive in drives.items():
        ticks = first(drive, 1_000_000)
        part = first(ticks, SLICE)
        scale = ticks.time.size / SLICE
        whole = seconds(lambda ticks=ticks: trajectory(ROBOT, *ticks))  # type: ignore[misc]
        live = seconds(lambda part=part: streamed(part)) * scale  # type: ignore[misc]
        plain = (
            seconds(lambda part=part: plain_run(ROBOT, part.left, part.right), 1) * scale  # type: ignore[misc]
        )
        pieces = len(trajectory(ROBOT, *ticks).pieces)
        table.add_row(
            name,
            f"{pieces:,}",
            f"{whole:.2f} s",
            f"{live:.1f} s",
            f"{plain:.1f} s",
            f"{plain / whole:.0f} ×",
        )
    console.print(table)
    growth = Table(title="Growth with the length of the record (squares)")
    for heading in ("ticks", "trajectory", "per tick", "odometer, per message"):
        growth.add_column(heading, justify="right")
    whole_drive = drives["squares, 100 Hz"]
    for count in (1_000, 10_000, 100_000, 1_000_000):
        ticks = first(whole_drive, count)
        offline = seconds(lambda ticks=ticks: trajectory(ROBOT, *ticks))  # type: ignore[misc]
        part = Ticks(*(values[-SLICE:] for values in ticks))
        live = seconds(lambda part=part: streamed(part), 1) / part.time.size  # type: ignore[misc]
        growth.add_row(
            f"{count:,}",
            f"{1e3 * offline:.1f} ms",
            f"{1e9 * offline / count:.0f} ns",
            f"{1e6 * live:.1f} µs",
        )
    console.print(growth)


if __name__ == "__main__":
    main()
