# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How often `diagnose` tells a wheel that changed between two sessions, and one that did not.

    python -m test.hidden.changes [--sets N] [--seed SEED] [--change SHARE] [--workers N]

Each set is two sessions of five drives of about a minute with the engine's robot, each drive
another manoeuvre. In every other set one wheel, drawn, is larger or smaller by that share in the
second session; in the others nothing changed. All effects of the library are candidates. Found: a
change of this wheel is told; its drive: from the first of the second session on; beside: anything
else is told to have changed.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from test.hidden.machines import OWN
from werrimbi_odom.api.one_blas_thread import with_one_blas_thread
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.inference.changes.between_drives import ParameterChange, changes_between
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.simulation import TrueRobot, drives, record, write_robot_file, write_run

DRIVES = 5
"""Of a session."""


class Told(NamedTuple):
    """Of one set: the wheel that changed, if any; whether it and its drive were told; others."""

    wheel: str | None
    found: bool
    its_drive: bool
    beside: tuple[str, ...]


def told_of(seed: int, share: float) -> Told:
    """One set; of an even seed, one in which nothing changed."""
    chance = np.random.default_rng([seed, 17])
    side = str(chance.choice(["left", "right"]))
    factor = 1.0 + share * float(chance.choice([-1.0, 1.0]))
    moved = seed % 2 == 1
    changes = _changes(seed, _with(OWN, side, factor) if moved else OWN, chance)
    mine = [each for each in changes if moved and each.what == f"{side}_wheel_radius_multiplier"]
    return Told(
        f"{side}_wheel" if moved else None,
        bool(mine),
        any(each.from_run == _named(DRIVES) for each in mine),
        tuple(f"{each.what} from {each.from_run}" for each in changes if each not in mine[:1]),
    )


def _with(robot: TrueRobot, side: str, factor: float) -> TrueRobot:
    name = f"{side}_wheel_radius"
    return replace(robot, **{name: getattr(robot, name) * factor})


def _named(number: int) -> str:
    return f"drive_{number}"


def _changes(
    seed: int, later: TrueRobot, chance: np.random.Generator
) -> tuple[ParameterChange, ...]:
    """What is told of a robot that is another one in the second session."""
    manoeuvres = [*drives(seed).values()]
    order = chance.permutation(len(manoeuvres))[: 2 * DRIVES]
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        file = read_robot_file(write_robot_file(OWN, place / "robot.yaml"))
        runs = []
        for number, which in enumerate(order):
            robot = OWN if number < DRIVES else later
            made = record(robot, manoeuvres[which], seed=1000 * seed + number)
            runs.append(read_run(write_run(made, place / _named(number)), file))
        found = with_one_blas_thread(diagnose)(runs, file.robot, LIBRARY)
    return changes_between(found, LIBRARY)


def all_told(sets: int, seed: int, share: float, workers: int) -> Iterator[Told]:
    """Of sets from a seed on."""
    seeds = range(seed, seed + sets)
    if workers == 1:
        yield from map(partial(told_of, share=share), seeds)
        return
    with ProcessPoolExecutor(workers) as pool:
        yield from pool.map(partial(told_of, share=share), seeds)


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(prog="python -m test.hidden.changes", description=__doc__)
    parser.add_argument("--sets", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--change", type=float, default=0.003)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    given = parser.parse_args()
    changed = found = placed = same = quiet = 0
    for told in all_told(given.sets, given.seed, given.change, given.workers):
        changed += told.wheel is not None
        found += told.found
        placed += told.its_drive
        same += told.wheel is None
        quiet += told.wheel is None and not told.beside
        print(
            f"a wheel changed by {100.0 * given.change:g} %: told {found} of {changed}, its drive "
            f"{placed}; nothing changed: nothing told {quiet} of {same}"
            + "".join(f"; told beside: {each}" for each in told.beside),
            flush=True,
        )


if __name__ == "__main__":
    main()
