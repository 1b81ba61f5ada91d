# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One hidden set given to the diagnosis, and what came of it against what is true.

The command line is given robot.yaml and the runs alone, and what it prints is followed to the end;
truth.json is opened after it has spoken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from test.hidden.floors import Floor
from test.hidden.follow import MOST, Followed, follow, run_json
from test.hidden.poorer import POORER
from test.hidden.result_line import IN_LIBRARY, Judged
from test.hidden.resumable_jobs import Line, commit_now
from test.hidden.right_laws import RIGHT_LAWS
from test.hidden.sets import HiddenSet, make, runs_of
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.simulation.hidden import find as hideable

DRIVEN_ON = 3
"""Most manoeuvres that a user drives for one verdict."""


def options_of(what: HiddenSet) -> list[str]:
    """What the user would pass with the drives."""
    kind = POORER[what.seen].kind if what.seen else "absolute"
    return [] if kind == "absolute" else ["--reference-kind", kind]


def judged(what: HiddenSet, *, floors: bool = True) -> Judged:
    """Diagnose a set and compare with the truth.

    Parameters
    ----------
    floors : bool
        Also follow what is printed, and fit the true model; else the verdict alone.
    """
    folder = make(what)
    outside = any(name not in IN_LIBRARY for name in what.names)
    most = MOST if floors else 0
    told = follow(folder, options_of(what), most=most, draft=floors and outside)
    said = _said(what, told)
    if not told.first:
        return said
    figures: dict[str, Any] = {}
    if floors and not what.entered:
        figures = _floors(what, floor_of(what))
    if what.group == "rivals" and said.next_manoeuvre is not None:
        figures["resolved"] = _resolved(what, said.next_manoeuvre, said.minutes)
    return replace(said, **figures)


def work(what: HiddenSet) -> Line:
    """All that is judged of a set, as a line of the file of results."""
    return judged(what).line()


def _said(what: HiddenSet, told: Followed) -> Judged:
    """What came of the commands."""
    first = told.first
    hidden = what.truth["hidden"]
    assert isinstance(hidden, list)
    line = Judged(
        name=what.name,
        group=what.group,
        setup=what.setup,
        seen=what.seen,
        hidden=what.names,
        strengths=tuple(float(each["strength"]) for each in hidden),
        entered=what.entered,
        commit=commit_now(),
        seconds=round(told.seconds, 2),
        verdict=first["verdict"] if first else told.ended,
        error=told.error,
        verdicts=tuple(told.verdicts),
        ended=told.ended,
    )
    if not first:
        return line
    factors = [finding["factor"] for finding in first["set_up"] if finding["factor"]]
    move = first["next_manoeuvre"]
    return replace(
        line,
        effect=first["effect"],
        found=tuple(each["effect"] for each in first["found"]),
        values={
            f"{each['effect']}.{name}": [item["value"], item["std"]]
            for each in first["found"]
            for name, item in each["parameters"].items()
        },
        rivals=tuple(first["rivals"]),
        factor=factors[0] if factors else None,
        depends_on=tuple((cell["channel"], cell["variable"]) for cell in first["depends_on"][:3]),
        changes=tuple(dict.fromkeys(each["group"] for each in first["changes"])),
        below_limit=first["verdict"] == "none" and below_limit(line, first),
        next_manoeuvre=None if move is None else move["name"],
        minutes=0.0 if move is None else move["minutes"],
        p_values=tuple((item["effect"], item["p_value"]) for item in first["ranking"]),
        before=first["holdout"]["before"],
        after=first["holdout"]["after"],
        steps=tuple(tuple(names) for names in told.added),
        rested=told.after,
        explains=told.explains,
        mean_is_right=told.mean_is_right,
        fits=tuple(_fit(fit) for fit in told.fits),
        added=_added(told),
        drafted=told.drafted,
    )


def below_limit(line: Judged, said: Line) -> bool:
    """Whether all that is hidden is smaller than what the diagnosis says that it sees."""
    seen_from = {each["effect"]: each["seen_from"] for each in said["could_have_been_seen"]}
    return all(
        name in seen_from
        and (seen_from[name] is None or abs(strength - hideable(name).null) < seen_from[name])
        for name, strength in zip(line.hidden, line.strengths, strict=True)
    )


def _added(told: Followed) -> float | None:
    """Held-out error once the first printed command was followed [m]."""
    if told.fits:
        after = told.fits[0]["holdout"]["after"]
        return None if after is None else float(after)
    return told.first["holdout"]["before"] if told.ended in ("refused", "crashed") else None


def _fit(fit: Line) -> Line:
    """Of an addition's JSON, the numbers with their standard deviations."""
    return {
        "effects": fit.get("effects") or [fit["effect"]],
        "parameters": {
            name: [item["value"], item["std"]] for name, item in fit["parameters"].items()
        },
        "calibration": {
            name: [item["value"], item["std"]] for name, item in fit["calibration"].items()
        },
        "noise": {
            name: [item["value"], item["std"]]
            for name, item in fit["noise"].items()
            if isinstance(item, dict) and item["determined"]
        },
    }


def _resolved(what: HiddenSet, name: str | None, minutes: float) -> tuple[str, ...]:
    """What is said once the robot has driven what was asked for, for as long as was asked.

    Where that leaves rivals, what is asked for next is driven too, up to `DRIVEN_ON` manoeuvres.
    """
    folder, asked = make(what), list[str]()
    said: Line = {}
    while name is not None and len(asked) < DRIVEN_ON:
        asked.append(f"{name}:{minutes:g}")
        try:
            driven = make(replace(what, setup="drive:" + "+".join(asked)))
        except KeyError:
            return (f"{name} cannot be driven",)
        runs = [str(path) for place in (folder, driven) for path in runs_of(place, "train")]
        told = _diagnosed(what, folder, runs)
        if isinstance(told, str):
            return (told,)
        said = told
        move = said["next_manoeuvre"] or {"name": None, "minutes": 0.0}
        name, minutes = move["name"], move["minutes"]
    return (said["verdict"], *(said["rivals"] or (each["effect"] for each in said["found"])))


def _diagnosed(what: HiddenSet, folder: Path, runs: Sequence[str]) -> Line | str:
    """Diagnosis of drives with a set's robot file; the complaint, if it was refused."""
    robot = ["--robot", str(folder / "robot.yaml")]
    done, said = run_json(["diagnose", *robot, *runs, *options_of(what)])
    return said if done.code == 0 else done.complained


def read_set(what: HiddenSet) -> tuple[RobotFile, list[Run], list[Run]]:
    """The robot file of a set, the drives to learn from, and those held out."""
    folder = make(what)
    file = read_robot_file(folder / "robot.yaml")
    train, holdout = (
        [read_run(path, file) for path in runs_of(folder, part)] for part in ("train", "holdout")
    )
    return file, train, holdout


def floor_of(what: HiddenSet) -> Floor:
    """For fits of true models to a set."""
    file, train, holdout = read_set(what)
    kind = POORER[what.seen].kind if what.seen else "absolute"
    return Floor(train, holdout, file.robot, kind, file.limits)


def _floors(what: HiddenSet, floor: Floor) -> dict[str, Any]:
    names = what.names
    if not names:
        return {"floor": floor.as_given()}
    outside = [name for name in names if name not in IN_LIBRARY]
    if outside:
        clean = HiddenSet("clean", (), what.seed, what.setup, what.seen)
        figures: dict[str, Any] = {"floor": floor_of(clean).as_given()}
        if set(outside) <= set(RIGHT_LAWS):
            figures["own_law"] = floor.of(names)
        return figures
    figures = {"floor": floor.of(names)}
    if len(names) > 1:
        figures["without"] = tuple(
            floor.of([other for other in names if other != name]) for name in names
        )
    return figures
