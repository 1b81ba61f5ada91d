# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How often events are told where nothing happened, and found where something did.

    python -m test.hidden.events [--sets N] [--seed SEED] [--times K]

Each set is two drives of the engine's robot, with wheel noise and a reference of 1 mm and 2 mrad.
First as they are; then one thing is done to each of them at an instant drawn: a push, a bump or a
kick of the heading, of so many times the reference's noise, to either side. Found: told within
0.2 s, in its own channel, and nothing else beside.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Literal, NamedTuple, get_args

import numpy as np

from test.hidden.machines import OWN
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.events.events import Event, EventSide, events_among
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.simulation import ReferenceSensor, free, record, write_robot_file, write_run

Kind = Literal["along", "sideways", "heading"]

SECONDS = 45.0
NEAR = 0.2
"""Of its true time an event must be told [s]."""


class Done(NamedTuple):
    """What was done to a drive, at an instant [s]: so far ahead, to the left [m], turned [rad]."""

    kind: Kind
    time: float
    size: float


class Told(NamedTuple):
    """Of one set: events where nothing happened; what was done, whether found; false ones."""

    quiet: int
    found: tuple[tuple[Done, bool], ...]
    beside: int


def told_of(seed: int, times: float) -> Told:
    """One set."""
    chance = np.random.default_rng([seed, 5])
    runs, robot = _driven(seed)
    quiet = len(_events(runs, robot))
    done = [_drawn(run, times, chance) for run in runs]
    events = _events([_changed(*each) for each in zip(runs, done, strict=True)], robot)
    left = list(events)
    found = []
    for run, what in zip(runs, done, strict=True):
        mine = [event for event in left if event.run == run.path and _is(event, what)]
        found.append((what, bool(mine)))
        left = [event for event in left if event not in mine[:1]]
    return Told(quiet, tuple(found), len(left))


def _driven(seed: int) -> tuple[list[Run], Robot]:
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        write_robot_file(OWN, place / "robot.yaml")
        file = read_robot_file(place / "robot.yaml")
        runs = []
        for number, speed in enumerate((0.4, 0.7)):
            drive = free(SECONDS, seed=10 * seed + number, speed=speed, yaw_rate=2.5 * speed)
            made = record(OWN, drive, seed=1000 * seed + number)
            runs.append(read_run(write_run(made, place / f"run_{number}"), file))
        return runs, file.robot


def _events(runs: list[Run], robot: Robot) -> tuple[Event, ...]:
    matched = match_for_fit(runs, robot, 1.0, None)
    point = fit_calibration(concatenated(matched), robot).point
    side = EventSide(matched, tuple(run.path for run in runs), point, held_out=False)
    return events_among([side], "absolute").events


def _drawn(run: Run, times: float, chance: np.random.Generator) -> Done:
    kind: Kind = chance.choice(get_args(Kind))
    sensor = ReferenceSensor()
    noise = sensor.sigma_yaw if kind == "heading" else sensor.sigma_xy
    first, last = run.ticks.time[[0, -1]]
    size = times * noise * float(chance.choice([-1.0, 1.0]))
    return Done(kind, float(chance.uniform(first + 3.0, last - 3.0)), size)


def _changed(run: Run, done: Done) -> Run:
    """As if the robot had been moved at that instant, and driven on as it did."""
    seen = run.reference
    assert seen is not None
    after = seen.time >= done.time
    row = int(np.argmax(after))
    place = seen.x + 1j * seen.y
    turn = done.size if done.kind == "heading" else 0.0
    ways = {"along": 1.0, "sideways": 1.0j, "heading": 0.0}
    way = done.size * ways[done.kind] * np.exp(1j * seen.yaw[row])
    moved = place[row] + np.exp(1j * turn) * (place - place[row]) + way
    place = np.where(after, moved, place)
    yaw = np.where(after, seen.yaw + turn, seen.yaw)
    return replace(run, reference=replace(seen, x=place.real, y=place.imag, yaw=yaw))


def _is(event: Event, done: Done) -> bool:
    return event.channel == done.kind and abs(event.time - done.time) <= NEAR


def all_told(sets: int, seed: int, times: float) -> Iterator[Told]:
    """Of sets from a seed on."""
    for number in range(sets):
        yield told_of(seed + number, times)


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(prog="python -m test.hidden.events", description=__doc__)
    parser.add_argument("--sets", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--times", type=float, default=5.0)
    given = parser.parse_args()
    quiet = beside = 0
    of, found = Counter[str](), Counter[str]()
    for sets, told in enumerate(all_told(given.sets, given.seed, given.times), start=1):
        quiet += told.quiet == 0
        beside += told.beside
        for done, is_found in told.found:
            of[done.kind] += 1
            found[done.kind] += is_found
        parts = ", ".join(f"{kind} {found[kind]} of {of[kind]}" for kind in get_args(Kind))
        share = sum(found.values()) / sum(of.values())
        print(
            f"{sets} sets: nothing told of {quiet} ({math.floor(1000 * quiet / sets) / 10} %); "
            f"found {100 * share:.1f} % ({parts}); {beside} told beside",
            flush=True,
        )


if __name__ == "__main__":
    main()
