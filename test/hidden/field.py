# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Hidden sets as people record them: one set of bags, judged by each reference that they hold.

A set is made by `werrimbi simulate --like field`: a gyro with a scale of its own, a localiser that
wanders and jumps, stamps that jitter, and the robot held and carried in each drive.
"""

from __future__ import annotations

import math
import shutil
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from test.hidden.follow import run, run_json
from test.hidden.plan import EFFECTS, evenly
from test.hidden.resumable_jobs import Line, commit_now
from test.hidden.sets import HiddenSet, runs_of
from werrimbi_odom.effects import find
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Reference
from werrimbi_odom.simulation.hidden import find as hideable

LOCALISER = "/tf:map:base_link"
BESIDE = "beside"
"""Folder of a set with references that are no topic: positions alone, odometry as a table."""

WITHIN = 0.5
"""To this the beginning and the end of what was held or carried must be found [s]."""

TURNED = 0.5
"""Turn of a held robot's wheels [rad] from which on a gyro can see that it was held."""

OWN_SCALE = frozenset({"reference_scale", "track_width", "wheel_radius_scale"})
"""A gyro has a scale of its own, and headings alone cannot tell it from the base: it is no wrong
name where it is told as one of rivals."""

ON_THE_FLOOR = frozenset({"floor_slope", "anisotropic_floor"})
"""By scans nobody is asked for these, and an unknown says so: axes begin anew in each drive."""

NOT_IN_SCANS = frozenset({"reference_heading_delay", "reference_gyro_drift"})
"""A scan tells place and heading of one instant, and no gyro has a part in it: bags that hide these
hide nothing in their scans."""

IN_BAGS = tuple(name for name in EFFECTS if name != "reference_clock_drift")
"""Effects that bags can hide: one computer stamps all of a bag's messages."""

DELAYS = frozenset({"reference_delay", "reference_heading_delay"})
"""Of headings alone they are one."""

MEANS = {"radius_by_channel": "wheel_radius_scale"}
"""What an effect is on average. A bag without its channel shows that: with 5 kg in the mean and
0.079 % of the radii a kilogram both radii are 0.4 % smaller, and said to be 0.473 ± 0.051 %."""


@dataclass(frozen=True)
class Seen:
    """One way of judging a bag."""

    says: str
    topics: tuple[str, ...] = ()
    """None: positions alone, from beside the bag."""

    @property
    def has_positions(self) -> bool:
        """Whether it measures where the robot is."""
        return self.topics != ("/imu",)

    def options(self, folder: Path) -> list[str]:
        """Of the user's command."""
        if self.topics:
            return [word for topic in self.topics for word in ("--reference-topic", topic)]
        tables = [
            word
            for part in ("train", "holdout")
            for each in runs_of(folder, part)
            for word in ("--reference", str(folder / BESIDE / "positions" / part / each.name))
        ]
        return ["--reference-kind", "local_map", *tables]


SEEN = {
    "gyro": Seen("a gyro", ("/imu",)),
    "localiser": Seen("a localiser", (LOCALISER,)),
    "both": Seen("a gyro and a localiser", ("/imu", LOCALISER)),
    "positions": Seen("a localiser's positions alone"),
    "scans": Seen("a lidar's scans", ("/scan",)),
}


def sets(start: int, each: int, clean: int, effects: int) -> list[HiddenSet]:
    """So many sets of each of some effects, which take turns, and with nothing hidden."""
    found = [
        HiddenSet("field", (name,), start + 8000 + 20 * EFFECTS.index(name) + seed, "field")
        for seed in range(each)
        for name in evenly(IN_BAGS, effects, start)
    ]
    return found + [HiddenSet("field", (), start + 8500 + n, "field") for n in range(clean)]


def make(what: HiddenSet, *, beside: bool = True) -> Path:
    """The folder of a set, made if it is not there yet, with what is no topic or without."""
    if what.path.exists():
        return what.path
    what.path.parent.mkdir(parents=True, exist_ok=True)
    place = Path(tempfile.mkdtemp(prefix=".new.", dir=what.path.parent))
    try:
        folder = place / "set"
        words = ["simulate", "--like", "field", "--seed", str(what.seed), "--out", str(folder)]
        done = run([*words, *(word for name in what.effects for word in ("--hide", name))])
        assert done.code == 0, done.complained
        file = read_robot_file(folder / "robot.yaml")
        for part in ("train", "holdout") if beside else ():
            for bag in runs_of(folder, part):
                _beside(bag, file, folder / BESIDE, part)
        folder.rename(what.path)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    return what.path


def _beside(bag: Path, file: RobotFile, place: Path, part: str) -> None:
    """The localiser's positions, and the robot's own odometry as if somebody had measured it."""
    for name, topic in (("positions", LOCALISER), ("odometry", "/odom")):
        reference = read_run(bag, file, reference_topic=topic, force=True).reference
        assert reference is not None
        _write(reference, place / name / part / bag.name, headings=name == "odometry")


def _write(reference: Reference, folder: Path, *, headings: bool) -> None:
    folder.mkdir(parents=True)
    columns = (reference.time, reference.x, reference.y, reference.yaw)
    lines = [
        f"{t:.6f},{x:.6f},{y:.6f},{f'{yaw:.6f}' if headings else ''}\n"
        for t, x, y, yaw in zip(*columns, strict=True)
    ]
    text = "t_s,x_m,y_m,yaw_rad\n" + "".join(lines)
    (folder / "reference.csv").write_text(text, encoding="utf-8")


def work(what: HiddenSet) -> Line:
    """All references of a set, and what is made from the wheels, as a line of results."""
    folder = make(what)
    return _judged(what, folder, SEEN) | {"circles": circles(folder)}


def by_scans(what: HiddenSet) -> Line:
    """A set judged by its lidar, and by nothing else.

    One drive is held out: they report, and have no part in a verdict; matching takes its time.
    """
    return _judged(what, make(what, beside=False), ["scans"], apart=1)


def _judged(what: HiddenSet, folder: Path, names: Iterable[str], apart: int | None = None) -> Line:
    truth = what.truth
    (strength,) = (each["strength"] for each in truth["hidden"]) if what.effects else (None,)  # type: ignore[attr-defined]
    return {
        "hidden": what.names,
        "strength": strength,
        "commit": commit_now(),
        "said": {name: _said(folder, truth["field"], name, apart) for name in names},  # type: ignore[arg-type]
    }


def _said(folder: Path, field: Mapping[str, Any], name: str, apart: int | None = None) -> Line:
    """The diagnosis by one reference, some drives held out (None: all that there are)."""
    train, holdout = (list(map(str, runs_of(folder, part))) for part in ("train", "holdout"))
    holdout = holdout[:apart]
    words = ["diagnose", "--robot", str(folder / "robot.yaml"), *train, "--holdout", *holdout]
    done, said = run_json([*words, *SEEN[name].options(folder)])
    if done.code != 0:
        return {"verdict": "refused", "error": done.complained, "seconds": done.seconds}
    judged = {name: true for name, true in field.items() if str(folder / name) in train + holdout}
    return {
        "verdict": said["verdict"],
        "found": [each["effect"] for each in said["found"]],
        "rivals": said["rivals"],
        "rivals_of_others": said["rivals_of_others"],
        "seen_from": {
            each["effect"]: each["seen_from"]
            for each in reversed(said["could_have_been_seen"])
            if math.isfinite(each["seen_from"] or math.inf)
        },
        "stretches": stretches(folder, judged, said["left_out"], SEEN[name]),
        "seconds": round(done.seconds, 1),
    }


def stretches(
    folder: Path, field: Mapping[str, Any], left_out: Sequence[Line], seen: Seen
) -> dict[str, list[list[Any]]]:
    """What was held and carried, where the reference can see it: the run, when, whether found."""
    file = read_robot_file(folder / "robot.yaml")
    found: dict[str, list[list[Any]]] = {"held": [], "carried": []}
    for name, true in field.items():
        told = [each for each in left_out if each["run"].endswith(name)]
        for why, there in found.items():
            for begin, end in true[why]:
                sees = why == "carried" or seen.has_positions
                if not sees and abs(_turned(folder / name, file, begin, end)) < TURNED:
                    continue
                hit = any(
                    each["why"] == why
                    and abs(each["from_s"] - begin) <= WITHIN
                    and abs(each["to_s"] - end) <= WITHIN
                    for each in told
                )
                there.append([name, begin, hit])
    return found


def _turned(bag: Path, file: RobotFile, begin: float, end: float) -> float:
    """What the wheels say that the robot turned [rad]."""
    ticks = read_run(bag, file, reference_topic="/imu").ticks
    robot = file.robot
    rolled = [
        float(np.diff(np.interp([begin, end], ticks.time, counts))[0]) * tick
        for counts, tick in ((ticks.left, robot.left_tick), (ticks.right, robot.right_tick))
    ]
    return (rolled[1] - rolled[0]) / robot.track


def circles(folder: Path) -> dict[str, bool]:
    """Whether a reference that is made from the wheels is refused, by its way of being one."""
    bag = runs_of(folder, "train")[0]
    table = folder / BESIDE / "odometry" / "train" / bag.name
    ways = {
        "/odom": ["--reference-topic", "/odom"],
        "/tf:odom:base_link": ["--reference-topic", "/tf:odom:base_link"],
        "a table": ["--reference", str(table)],
    }
    words = ["compare", "--robot", str(folder / "robot.yaml"), str(bag)]
    done = {name: run([*words, *options]) for name, options in ways.items()}
    return {
        name: each.code == 2 and "--force takes it all the same" in each.complained
        for name, each in done.items()
    }


def expected(hidden: Sequence[str], name: str) -> set[str]:
    """Names that are right of a set by one reference: what is hidden, and what is one with it."""
    found = {*hidden, *(MEANS[each] for each in hidden if each in MEANS)}
    for each in hidden:
        twins = find(each).indistinguishable_from
        found |= {twin.name for twin in twins if name == "gyro" or not twin.of_headings}
        if name == "gyro" and each in DELAYS:
            found |= DELAYS
    return found


def how(hidden: Sequence[str], name: str, said: Line) -> str:
    """named, ambiguous, missed (too small, or not) or wrong: what one diagnosis is worth."""
    if name == "scans" and said["verdict"] == "unknown" and set(hidden) & ON_THE_FLOOR:
        return "missed"
    if said["verdict"] == "unknown" and any(find(each).lacks(()) for each in hidden):
        return "missed"  # it goes with a channel that these bags do not hold
    if said["verdict"] in ("refused", "unknown"):
        return "wrong"
    right = expected(hidden, name)
    one_of = [{name, *near} for name, near in said.get("rivals_of_others", {}).items()]
    one_of += [set(said["rivals"])] if said["rivals"] else []
    sure = set(said["found"]).difference(*one_of)
    own = OWN_SCALE if name == "gyro" else set()
    if sure - right or any(not each & (right | own) for each in one_of):
        return "wrong"
    if not hidden or sure & right:
        return "named"
    return "ambiguous" if any(each & right for each in one_of) else "missed"


def could_be_seen(hidden: str, strength: float, name: str, said: Line) -> bool:
    """Whether the diagnosis itself says that an effect of this size would have been seen."""
    if name == "scans" and hidden in NOT_IN_SCANS:
        return False
    seen_from = said["seen_from"].get(hidden)
    return seen_from is not None and abs(strength - hideable(hidden).null) >= seen_from
