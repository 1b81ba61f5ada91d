# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One hidden set given to the diagnosis, and what came of it against what is true.

The diagnosis is given robot.yaml and the runs alone; truth.json is opened after it has spoken.
"""

from __future__ import annotations

import json
import subprocess
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from test.hidden.floors import Floor
from test.hidden.poorer import POORER
from test.hidden.right_laws import RIGHT_LAWS
from test.hidden.sets import ROOT, HiddenSet, make, runs_of
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.reading import read_run
from werrimbi_odom.files.robot_file import read_robot_file
from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference.adding.adding import add_effect
from werrimbi_odom.inference.adding.drafting import draft_effect
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.manoeuvres.proposal import next_manoeuvre
from werrimbi_odom.model.effect import Effect


@dataclass(frozen=True)
class Judged:
    """What was said of a set, and what was true; a line of the file of results."""

    name: str
    group: str
    setup: str
    seen: str
    hidden: tuple[str, ...]
    strengths: tuple[float, ...]
    entered: tuple[tuple[str, float], ...]
    commit: str
    seconds: float
    verdict: str
    effect: str | None = None
    found: tuple[str, ...] = ()
    rivals: tuple[str, ...] = ()
    factor: str | None = None
    depends_on: tuple[tuple[str, str], ...] = ()
    next_manoeuvre: str | None = None
    before: float | None = None
    """Held-out position error with the robot file as it was given [m]."""
    after: float | None = None
    """With what was found put in [m]."""
    added: float | None = None
    """With the effect that was named first put in by `werrimbi add`, alone [m]."""
    floor: float | None = None
    """With the truth put in [m]."""
    without: tuple[float, ...] = ()
    """Of several hidden effects: held-out error with the truth less each of them [m]."""
    own_law: float | None = None
    """Of an outsider: with its right law, written by hand [m]."""
    drafted: float | None = None
    """Of an outsider: with the draft [m]."""
    resolved: tuple[str, ...] = ()
    """Of rivals by construction: verdict and names once the next manoeuvre was driven too."""
    error: str = ""

    @property
    def raised(self) -> float:
        """Factor by which what was hidden raised the held-out error."""
        if not self.before or not self.floor:
            return float("nan")
        return self.before / self.floor


@dataclass(frozen=True)
class Told:
    """A diagnosis, and what it was given."""

    diagnosis: Diagnosis
    floor: Floor
    seconds: float

    def added(self, effect: Effect) -> float | None:
        """Held-out error once an effect is added [m]; None where it cannot be."""
        judge = self.floor.judge
        try:
            more = add_effect(
                effect,
                judge.fitted_on,
                judge.given,
                judge.kind,
                holdout=judge.kept_back,
                limits=self.floor.limits,
            )
        except InputError:
            return None
        return more.holdout.sides.after


def kind_of(seen: str) -> ReferenceKind:
    """What the user would pass as --reference-kind."""
    return POORER[seen].kind if seen else "absolute"


def told(folder: Path, kind: ReferenceKind = "absolute") -> Told:
    """The diagnosis of a set: it sees the robot file and the runs."""
    file = read_robot_file(folder / "robot.yaml")
    train, holdout = (
        [read_run(path, file) for path in runs_of(folder, part)] for part in ("train", "holdout")
    )
    begin = time.perf_counter()
    found = diagnose(train, file.robot, LIBRARY, kind, holdout=holdout, limits=file.limits)
    seconds = time.perf_counter() - begin
    return Told(found, Floor(train, holdout, file.robot, kind, file.limits), seconds)


def judged(what: HiddenSet, *, floors: bool = True) -> Judged:
    """Diagnose a set and compare with the truth.

    Parameters
    ----------
    floors : bool
        Also fit the true model; not for sets whose rule needs verdicts alone.
    """
    folder = make(what)
    commit = commit_now()
    try:
        said = told(folder, kind_of(what.seen))
    except InputError as error:
        return _line(what, commit, 0.0, verdict="refused", error=str(error))
    except Exception as error:  # a crash is a finding, and must not end an hour's work
        return _line(what, commit, 0.0, verdict="crashed", error=f"{type(error).__name__}: {error}")
    found = said.diagnosis
    figures: dict[str, Any] = {}
    if floors and not what.entered:
        figures = _floors(what, said)
        if found.effect in _LIBRARY:
            figures["added"] = said.added(find(found.effect))
    manoeuvre = next_manoeuvre(found)
    if what.group == "rivals" and manoeuvre is not None:
        figures["resolved"] = _resolved(what, manoeuvre.name)
    factors = [finding.factor for finding in found.set_up.findings if finding.factor]
    return _line(
        what,
        commit,
        said.seconds,
        verdict=found.verdict,
        effect=found.effect,
        found=found.found,
        rivals=found.rivals,
        factor=factors[0] if factors else None,
        depends_on=tuple((cell.channel, cell.name) for cell in found.depends_on[:3]),
        next_manoeuvre=None if manoeuvre is None else manoeuvre.name,
        before=found.holdout.before,
        after=found.holdout.after,
        **figures,
    )


def _resolved(what: HiddenSet, name: str) -> tuple[str, ...]:
    """What is said once the robot has driven what was asked for, three times."""
    try:
        driven = make(replace(what, setup=f"drive:{name}"))
    except KeyError:
        return (f"{name} cannot be driven",)
    folder = make(what)
    file = read_robot_file(folder / "robot.yaml")
    runs = [read_run(path, file) for place in (folder, driven) for path in runs_of(place, "train")]
    found = diagnose(runs, file.robot, LIBRARY, kind_of(what.seen), limits=file.limits)
    return (found.verdict, *(found.rivals or found.found))


def _floors(what: HiddenSet, said: Told) -> dict[str, Any]:
    names, floor = what.names, said.floor
    if not names:
        return {"floor": floor.as_given()}
    outside = [name for name in names if name not in _LIBRARY]
    if outside:
        figures: dict[str, Any] = {"floor": _nothing_hidden(what)}
        if set(outside) <= set(RIGHT_LAWS):
            figures["own_law"] = floor.of(names)
        if said.diagnosis.verdict == "unknown":
            figures["drafted"] = _drafted(said)
        return figures
    figures = {"floor": floor.of(names)}
    if len(names) > 1:
        figures["without"] = tuple(
            floor.of([other for other in names if other != name]) for name in names
        )
    return figures


_LIBRARY = frozenset(effect.name for effect in LIBRARY)


def _nothing_hidden(what: HiddenSet) -> float:
    """Held-out error of the same robot without what was hidden in it."""
    clean = HiddenSet("clean", (), int(what.seed), what.setup, what.seen)
    folder = make(clean)
    file = read_robot_file(folder / "robot.yaml")
    train, holdout = (
        [read_run(path, file) for path in runs_of(folder, part)] for part in ("train", "holdout")
    )
    floor = Floor(train, holdout, file.robot, kind_of(what.seen), file.limits)
    return floor.as_given()


def _drafted(said: Told) -> float | None:
    """Held-out error with the effect that `werrimbi draft` writes, added as any other [m]."""
    try:
        return said.added(draft_effect(said.diagnosis).effect)
    except InputError:
        return None


def _line(what: HiddenSet, commit: str, seconds: float, **said: Any) -> Judged:
    hidden = what.truth["hidden"]
    assert isinstance(hidden, list)
    return Judged(
        what.name,
        what.group,
        what.setup,
        what.seen,
        what.names,
        tuple(float(each["strength"]) for each in hidden),
        what.entered,
        commit,
        round(seconds, 2),
        **said,
    )


# ------------------------------------------------------------------ right or wrong


CONFUSED = "wrong"


def judgement(line: Judged) -> str:
    """named, ambiguous, missed or wrong: what the diagnosis made of what was hidden.

    ambiguous is right for twins, and honest where the hidden effect is among the rivals; unknown,
    for an effect of the library, is wrong.
    """
    if line.verdict in ("refused", "crashed"):
        return CONFUSED
    if not line.hidden and not line.entered:
        return "named" if line.verdict == "none" else CONFUSED
    if line.group == "outsider" or any(name not in _LIBRARY for name in line.hidden):
        return _of_outsider(line)
    if line.verdict == "none":
        return "missed"
    expected = expected_names(line)
    if line.verdict == "ambiguous":
        return "ambiguous" if expected & set(line.rivals) else CONFUSED
    if line.verdict == "named" and line.effect in expected:
        twins = {twin for name in expected for twin in find(name).twins}
        return CONFUSED if twins and not twins & expected else "named"
    return CONFUSED


def _of_outsider(line: Judged) -> str:
    if line.verdict == "unknown":
        return "named"
    return "missed" if line.verdict == "none" else CONFUSED


def expected_names(line: Judged) -> set[str]:
    """Names that are right."""
    if line.entered:
        keys = {key for key, _ in line.entered}
        return {
            "track_width" if key == "wheel_separation" else "wheel_radius_scale" for key in keys
        }
    return set(line.hidden)


def is_right(line: Judged) -> bool:
    """Named first; of twins, both."""
    how = judgement(line)
    if how == "named":
        return True
    if how != "ambiguous" or len(line.hidden) != 1:
        return False
    (name,) = line.hidden
    twins = set(find(name).twins)
    return bool(twins) and name in line.rivals and bool(twins & set(line.rivals))


# ------------------------------------------------------------------ the file of results


def commit_now() -> str:
    """Of the checkout, with a + where it was changed since."""
    words = ["git", "-C", str(ROOT), "describe", "--always", "--dirty=+", "--abbrev=10"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def append(line: Judged, file: Path) -> None:
    """Keep a result."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("a", encoding="utf-8") as out:
        out.write(json.dumps(asdict(line)) + "\n")


def results(file: Path) -> Iterator[Judged]:
    """All results that were kept; a last line that was cut off is left out."""
    if not file.exists():
        return
    for text in file.read_text(encoding="utf-8").splitlines():
        try:
            values = json.loads(text)
        except json.JSONDecodeError:
            continue
        for name in ("hidden", "strengths", "found", "rivals", "without", "resolved"):
            values[name] = tuple(values.get(name, ()))
        values["entered"] = tuple(tuple(pair) for pair in values["entered"])
        values["depends_on"] = tuple(tuple(pair) for pair in values["depends_on"])
        yield Judged(**values)
