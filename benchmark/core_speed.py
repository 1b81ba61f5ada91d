# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Speed of the numeric core: closed form over pieces against plain propagation tick by tick.

All are timed by turns in one run, in processor time, so their ratio holds whatever else the machine
does. What goes tick by tick is timed on a slice and scaled: it grows in proportion to the ticks.
Recorded runs go along machine code where numba is installed, and along arrays where it is not; the
quick odometer is the odometer with machine code.

    python benchmark/core_speed.py [--most TICKS]
"""

from __future__ import annotations

import argparse
import importlib.util
import math
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from unittest.mock import patch

import numpy as np
from rich.console import Console
from rich.table import Table

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from benchmark.per_tick import per_tick
from test.model.drives import ROBOT, Ticks, random_drive, square
from test.plain_twin import plain_run
from werrimbi_odom.model import compiled
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.quick_odometer import QuickOdometer
from werrimbi_odom.model.trajectory import trajectory

RECORDING = Path(__file__).resolve().parents[1] / "werrimbi_odom" / "recordings" / "square"
MILLION = 1_000_000
SLICE = 10_000
"""Ticks on which is timed what goes tick by tick."""
ROUNDS = 4


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--most", type=int, default=MILLION, help="ticks that growth goes to")
    most = parser.parse_args().most
    console = Console(width=150)
    drives = {
        "squares at 50 Hz": square(rate=50.0, laps=480),
        "squares at 200 Hz": square(rate=200.0, laps=120),
        "the recorded square, again and again": recorded(),
        "wandering without rest": random_drive(0, duration=20_000.0),
        "wheels at random": at_random(MILLION),
    }
    first_call = loading()
    if first_call is not None:
        console.print(f"machine code: {first_call:.2f} s of CPU for its first call in a process")
    console.print(race({name: first(drive, MILLION) for name, drive in drives.items()}))
    console.print(growth(square(rate=50.0, laps=480 * max(most // MILLION, 1)), most))


def race(drives: dict[str, Ticks]) -> Table:
    """All ways to odometry on the same ticks."""
    table = titled("A million ticks: pose and covariance at each, CPU time (and of plain Python)")
    for heading in (
        "drive",
        "pieces",
        "numba",
        "arrays",
        "odometer",
        "asked for all",
        "quick odometer",
        "asked for all",
        "plain numpy",
        "plain Python",
    ):
        table.add_column(heading, justify="left" if heading == "drive" else "right")
    for name, ticks in drives.items():
        part, scale = first(ticks, SLICE), ticks.time.size / SLICE
        agree(part)
        counts = part.left.tolist(), part.right.tolist()
        machine, arrays, live, asked, quick, quick_asked, plain, floats = shortest(
            partial(trajectory, ROBOT, *ticks),
            partial(in_arrays, ticks),
            partial(streamed, part, Odometer),
            partial(streamed, part, Odometer, ask=True),
            partial(streamed, part, QuickOdometer),
            partial(streamed, part, QuickOdometer, ask=True),
            partial(plain_run, ROBOT, part.left, part.right),
            partial(per_tick, ROBOT, *counts),
        )
        per_tick_each = (live, asked, quick, quick_asked, plain)
        times = [machine, arrays, *(scale * each for each in per_tick_each)]
        table.add_row(
            name,
            f"{len(trajectory(ROBOT, *ticks).pieces):,}",
            *(f"{each:.2f} s ({each / (floats * scale):.2f})" for each in times),
            f"{floats * scale:.2f} s",
        )
    return table


def in_arrays(ticks: Ticks) -> None:
    """A recorded run as it goes where numba is not installed."""
    with patch.object(compiled, "WORTH_COMPILING", math.inf):
        trajectory(ROBOT, *ticks)


def loading() -> float | None:
    """CPU time [s] of the first run along machine code in a process; None without numba."""
    if importlib.util.find_spec("numba") is None:
        return None
    begin = time.process_time()
    trajectory(ROBOT, *at_random(compiled.WORTH_COMPILING + 1))
    return time.process_time() - begin


def at_random(count: int) -> Ticks:
    """Every step another, as no robot drives: a piece lasts one or two of them."""
    left, right = np.cumsum(np.random.default_rng(0).integers(-20, 60, (2, count)), axis=1)
    return Ticks(np.arange(count) / 50.0, left, right)


def agree(ticks: Ticks) -> None:
    """All ways must have computed the same, or their times mean nothing."""
    state = per_tick(ROBOT, ticks.left.tolist(), ticks.right.tolist())
    path = trajectory(ROBOT, *ticks)
    assert np.allclose((state.x, state.y), (path.x[-1], path.y[-1]), atol=1e-6)
    ours = path.covariance.matrix()[-1]
    assert np.allclose(state.covariance.matrix(), ours, rtol=0.02, atol=1e-3 * ours.max())


def growth(ticks: Ticks, most: int) -> Table:
    """Cost of a tick as the record grows; the odometer goes through all of it once."""
    table = titled("Cost of a tick as the record grows (squares at 50 Hz)")
    for heading in ("ticks", "trajectory", "of it per tick", "odometer, per message there"):
        table.add_column(heading, justify="right")
    odometer, fed = Odometer(ROBOT), 0
    for count in (10**power for power in range(3, 8) if 10**power <= most):
        (whole,) = shortest(partial(trajectory, ROBOT, *first(ticks, count)))
        for message in messages(ticks, fed, count - 1_000):
            odometer.update(*message)
        last = []
        for message in messages(ticks, count - 1_000, count):
            begin = time.perf_counter()
            odometer.update(*message)
            last.append(time.perf_counter() - begin)
        fed = count
        table.add_row(
            f"{count:,}",
            f"{1e3 * whole:.1f} ms",
            f"{1e9 * whole / count:.0f} ns",
            f"{1e6 * float(np.median(last)):.1f} µs",
        )
    return table


def shortest(*works: Callable[[], object]) -> list[float]:
    """Shortest CPU time of each [s], taken by turns: what the machine can do when left alone."""
    best = [float("inf")] * len(works)
    for _ in range(ROUNDS):
        for at, work in enumerate(works):
            begin = time.process_time()
            work()
            best[at] = min(best[at], time.process_time() - begin)
    return best


def first(ticks: Ticks, count: int) -> Ticks:
    """The first ticks of a record."""
    return Ticks(*(part[:count] for part in ticks))


def recorded() -> Ticks:
    """The square that ships with the package, driven until there are a million ticks."""
    table = np.loadtxt(RECORDING / "ticks.csv", delimiter=",", skiprows=1, usecols=(0, 1, 2))
    steps = np.diff(table.T, axis=1)
    laps = np.cumsum(np.tile(steps, MILLION // steps.shape[1] + 1), axis=1)
    return Ticks(laps[0], np.rint(laps[1]).astype(np.int64), np.rint(laps[2]).astype(np.int64))


def messages(ticks: Ticks, begin: int, end: int) -> Iterator[tuple[float, int, int]]:
    """Some of the ticks as messages, without a list of all of them."""
    for at in range(begin, end, SLICE):
        some = (part[at : min(at + SLICE, end)].tolist() for part in ticks)
        yield from zip(*some, strict=True)


def streamed(ticks: Ticks, kind: type[Odometer], ask: bool = False) -> None:
    """The record through an odometer; `ask`ed for all that the node publishes."""
    odometer = kind(ROBOT)
    for message in zip(*(part.tolist() for part in ticks), strict=True):
        estimate = odometer.update(*message)
        if ask and estimate is not None:
            _ = estimate.pose, estimate.covariance, estimate.twist, estimate.twist_covariance


def titled(title: str) -> Table:
    return Table(title=title, title_justify="left")


if __name__ == "__main__":
    main()
