# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The round closed without a hand: hidden, left open by plain driving, driven on, named.

What `diagnose` proposes is driven by the code of drive_node; in the engine, without ROS.

    python -m test.driving.closing SEED COUNT [PLAIN]     # a line for each case, and the table

Of all plain drives, or of one: a circle leaves the most open.
"""

from __future__ import annotations

import itertools
import json
import math
import random
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import werrimbi_odom as wo
from test.driving.in_engine import LIMITS, InEngine
from werrimbi_odom.driving.manoeuvres import BEFORE, proposed
from werrimbi_odom.driving.plan import ManoeuvrePlan, Move
from werrimbi_odom.effects import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Run
from werrimbi_odom.simulation import CATALOGUE, LiveRobot, TrueRobot, hide, write_robot_file

ROUND = (Move(2.0, 0.0, 0.6), Move(0.25 * math.pi, 0.5 * math.pi, 0.6)) * 4

PLAIN = {
    each.name: each
    for each in (
        ManoeuvrePlan("circle", "a circle to the left", (BEFORE, *(Move(6.0, 6.0),) * 4)),
        ManoeuvrePlan("rounds", "rounds to the left, with round corners", (BEFORE, *ROUND * 4)),
        ManoeuvrePlan(
            "line", "to and fro at one pace", (BEFORE, *(Move(4.0, 0.0), Move(-4.0, 0.0)) * 3)
        ),
    )
}
"""What robots do all day, some minutes of it."""
KINDS = [
    each.name
    for each in CATALOGUE
    if each.kind == "effect"
    and not find(each.name).one_of_channels
    and hide(each.name, seed=1).peculiarity.live
]
"""All but what follows a temperature or a payload, which nobody records here, and what is made in a
whole record."""
MEASURED = ("poses", "positions")
"""By a reference with a heading, and by one without."""
MOST = 3
"""Drives that are proposed, one after the other, before it is given up."""


@dataclass(frozen=True)
class Closed:
    """One case."""

    effect: str
    strength: float
    plain: str
    measured: str
    seed: int
    verdicts: tuple[str, ...]
    """Of the plain drive, and after each proposal."""
    driven: tuple[str, ...]
    """What was proposed."""
    names: tuple[str, ...]
    """What the last verdict names."""
    by_hand: str = ""
    """What is proposed in the end, where that is no drive."""

    @property
    def open_at_first(self) -> bool:
        """Whether plain driving told what it is."""
        return self.verdicts[0] == "ambiguous"

    @property
    def no_drive(self) -> bool:
        """Left open in the end for want of a drive that tells in reasonable time."""
        return self.verdicts[-1] == "ambiguous" and not self.twins and len(self.driven) < MOST

    @property
    def right(self) -> bool:
        """Named, and first of all what is hidden: of a radius that drifts, its size since too."""
        return self.verdicts[-1] == "named" and self.names[0] == self.effect

    @property
    def twins(self) -> bool:
        """Left open because no drive can tell, with the right one among them."""
        twins = {self.effect, *find(self.effect).twins}
        return (
            self.verdicts[-1] == "ambiguous"
            and self.effect in self.names
            and (set(self.names) <= twins)
        )


def closed(effect: str, plain: str, measured: str, seed: int) -> Closed:
    """Hide, drive, diagnose, drive what is proposed, and so on."""
    hidden = hide(effect, None, seed=seed)
    robot = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
    live = LiveRobot(robot, seed=seed, hidden=[hidden.peculiarity])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.yaml"
        write_robot_file(hidden.peculiarity.written(robot), path)
        file, told = wo.read_robot(path), Path(folder) / "diagnosis.json"
        there = InEngine(live, file)
        runs = [_driven(there, PLAIN[plain], measured)]
        driven: list[str] = []
        verdicts: list[str] = []
        by_hand = ""
        while True:
            said = wo.diagnose(file, runs).to_dict()
            verdicts.append(said["verdict"])
            if said["verdict"] != "ambiguous" or len(driven) == MOST:
                break
            told.write_text(json.dumps(said), encoding="utf-8")
            try:
                plan = proposed(told, LIMITS)
            except InputError as error:
                by_hand = str(error)
                break
            driven.append(plan.name)
            runs.append(_driven(there, plan, measured))
    names = said["rivals"] or [each["effect"] for each in said["found"]]
    case = effect, hidden.strength, plain, measured, seed
    return Closed(*case, tuple(verdicts), tuple(driven), tuple(names), by_hand)


def _driven(there: InEngine, plan: ManoeuvrePlan, measured: str) -> Run:
    run, driver = there.drive(plan)
    assert driver.state == "done", driver.words
    assert run.reference is not None
    if measured == "poses":
        return run
    nowhere = np.full(run.reference.time.size, np.nan)
    return replace(run, reference=replace(run.reference, yaw=nowhere))


def cases(seed: int, plain: Sequence[str] = tuple(PLAIN)) -> Iterator[Closed]:
    """All kinds, all plain drives, whatever was measured; in an order that is drawn."""
    kinds = list(itertools.product(KINDS, plain, MEASURED))
    random.Random(seed).shuffle(kinds)
    return (closed(*kind, seed) for kind in kinds)


def table(found: Sequence[Closed]) -> str:
    """Of the cases that were open: what was driven, and what came of it."""
    rows: dict[str, list[Closed]] = defaultdict(list)
    for each in found:
        if each.open_at_first:
            rows[each.effect].append(each)
    lines = [
        "| hidden | left open | named then, right | beside its twin | no drive tells | driven |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for effect, those in sorted(rows.items()):
        names = sorted({name for each in those for name in each.driven})
        lines.append(f"| `{effect}` | {_counts(those)} | {', '.join(names)} |")
    lines.append(f"| all | {_counts([each for those in rows.values() for each in those])} | |")
    return "\n".join(lines)


def _counts(those: Sequence[Closed]) -> str:
    ends = ([each.right, each.twins, each.no_drive] for each in those)
    return " | ".join(map(str, (len(those), *map(sum, zip(*ends, strict=True)))))


def main() -> None:
    """Judge as many cases of a seed as are asked for, and print."""
    seed, count = map(int, sys.argv[1:3])
    found = []
    for each in itertools.islice(cases(seed, sys.argv[3:] or tuple(PLAIN)), count):
        found.append(each)
        print(each, flush=True)
    print(table(found))


if __name__ == "__main__":
    main()
