# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How far verdicts stand off the numbers that decide them.

Each number is made smaller and larger, and some sets are diagnosed again: a verdict that then
changes stood near it. And of each verdict that was given: by how much what was named is surer than
it must be, what was not named less sure, and the second best model worse than the best.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from inspect import getsource
from itertools import pairwise
from pkgutil import walk_packages
from typing import cast

from test.hidden.plan import APART, CALIBRATION, evenly
from test.hidden.result_line import Judged, is_right, judgement
from test.hidden.resumable_jobs import Line
from test.hidden.set_judging import judged, options_of, read_set
from test.hidden.sets import HiddenSet
from test.hidden.table_layout import Table
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import ReferenceKind

WHERE = "werrimbi_odom.inference.rules"
"""Where the deciding numbers stand."""

JUDGING = tuple(f"werrimbi_odom.inference.{name}." for name in ("diagnosis", "fitting", "legs"))
"""Where a diagnosis of drives that are set up rightly reads them; others change none of it."""

_READ = re.compile(r"\brules\.([A-Z_\d]+)\b")
"""How they read a number."""

FACTORS = (0.7, 1.4)

GROUPS = ("effect", "clean", "pair", "outsider", "rivals", "other", "poorer")


def constants() -> dict[str, float]:
    """The deciding numbers by their names."""
    return {
        name: value
        for name, value in vars(import_module(WHERE)).items()
        if name.isupper() and isinstance(value, (int, float)) and not isinstance(value, bool)
    }


def judging() -> dict[str, float]:
    """Those that a diagnosis reads, and not the words, a comparison or a square of UMBmark."""
    _load()
    held = {
        name
        for key, module in sys.modules.items()
        if key.startswith(JUDGING)
        for name in _READ.findall(getsource(module))
    }
    return {name: value for name, value in constants().items() if name in held}


def times(value: float, factor: float) -> float:
    """A number smaller or larger; a whole one by at least one."""
    if isinstance(value, int):
        step = max(1, round(abs(value * factor - value)))
        return value + step if factor > 1.0 else max(value - step, 1)
    return value * factor


@contextmanager
def perturbed(name: str, value: float) -> Iterator[int]:
    """One number another one, in all modules that hold it; gives their count."""
    _load()
    before = constants()[name]
    holding = [
        module
        for key, module in list(sys.modules.items())
        if key.startswith("werrimbi_odom.") and vars(module).get(name) == before
    ]
    try:
        for module in holding:
            setattr(module, name, value)
        yield len(holding)
    finally:
        for module in holding:
            setattr(module, name, before)


def _load() -> None:
    """All that may hold a number: what is loaded later would keep the other one."""
    for place in ("inference", "report"):
        package = import_module(f"werrimbi_odom.{place}")
        for found in walk_packages(package.__path__, f"{package.__name__}."):
            import_module(found.name)


# ------------------------------------------------------------------ each number, smaller and larger


def tasks(
    sets: Sequence[HiddenSet], sizes: tuple[int, int], start: int
) -> dict[str, tuple[HiddenSet, str, float]]:
    """Some of the judged sets with each number perturbed: others for each number.

    `sizes`: how many sets, and of how many numbers one is taken; which, the seeds' start says.
    """
    wanted, every = sizes
    pool = [each for each in sets if each.group in GROUPS]
    return {
        f"{name} x{factor:g} {each.name}": (each, name, factor)
        for number, (name, value) in enumerate(judging().items())
        if (number + start // APART) % every == 0
        for each in evenly(pool, wanted, start + number * APART)
        for factor in FACTORS
        if times(value, factor) != value
    }


def work(task: tuple[HiddenSet, str, float]) -> Line:
    """What is said with one number another one."""
    what, name, factor = task
    with perturbed(name, times(constants()[name], factor)):
        line = judged(what, floors=False)
    return {
        "set": what.name,
        "constant": name,
        "value": constants()[name],
        "factor": factor,
        "right": right(line),
        "said": said(line),
    }


def right(line: Judged) -> bool:
    """Nothing wrong is said; what is too weak may be missed."""
    return is_right(line) or judgement(line) in ("ambiguous", "missed")


def said(line: Judged) -> str:
    """Verdict and names."""
    return f"{line.verdict} {', '.join(line.rivals or line.found)}".strip()


def table(lines: Sequence[Judged], results: Mapping[str, Line]) -> Table:
    """The matrix: verdicts that change, and that become wrong, with each number."""
    before = {line.name: line for line in lines}
    rows = []
    names = dict.fromkeys(each["constant"] for each in results.values())
    for name in names:
        own = [each for each in results.values() if each["constant"] == name]
        cells = []
        for factor in FACTORS:
            there = [each for each in own if each["factor"] == factor and each["set"] in before]
            changed = [each for each in there if each["said"] != said(before[each["set"]])]
            wrong = sum(right(before[each["set"]]) and not each["right"] for each in changed)
            mended = sum(each["right"] and not right(before[each["set"]]) for each in changed)
            cells.append(_cell(len(there), len(changed), wrong, mended))
        rows.append((name, f"{own[0]['value']:g}", *cells))
    words = (
        "Verdicts of some sets with each deciding number 0.7 and 1.4 times what it is (whole ones "
        "by at least one): how many change, and how many of those become wrong. A sample takes "
        "each third number, other code another third."
    )
    columns = ("number", "is", *(f"x {factor:g}" for factor in FACTORS))
    return Table("Margins: each number smaller and larger", columns, tuple(rows), words)


def _cell(count: int, changed: int, wrong: int, mended: int) -> str:
    if not count:
        return ""
    parts = [f"{changed} of {count} change" if changed else f"all {count} stay"]
    parts += [f"{wrong} become wrong"] if wrong else []
    parts += [f"{mended} become right"] if mended else []
    return ", ".join(parts)


# ------------------------------------------------------------------ how sure, and the second best


def gap(what: HiddenSet) -> Line:
    """By how much the best model of the first round costs less than the second best, and than none.

    In units of minus two log-likelihood, as the diagnosis weighs them.
    """
    from werrimbi_odom.inference.diagnosis.diagnosis import diagnose

    file, train, holdout = read_set(what)
    options = EvaluationOptions(limits=file.limits)
    if options_of(what):
        options = replace(options, reference_kind=cast(ReferenceKind, options_of(what)[1]))
    found = diagnose(train, file.robot, LIBRARY, options, holdout=holdout)
    first = found.rounds[0]
    fits = [fit for fit in first.tried if not fit.at_bound]
    if not fits:
        return {"set": what.name, "best": None}
    best = fits[0]
    twins = set(find(best.names[-1]).twins)
    rest = [fit for fit in fits[1:] if fit.names[-1] not in twins]
    return {
        "set": what.name,
        "best": best.names[-1],
        "second": rest[0].names[-1] if rest else None,
        "gap": (rest[0].total - best.total) / best.scatter if rest else None,
        "gain": (first.before.total - best.total) / best.scatter,
    }


def sureness(lines: Sequence[Judged]) -> tuple[list[float], list[float]]:
    """Minus log10 of p-values: of what is hidden, and of the likeliest effect where none is."""
    true, false = [], []
    for line in lines:
        if line.entered or line.group in ("rivals", "mistake"):
            continue
        alike = {name for hidden in line.hidden for name in _alike(hidden)}
        own = [p for name, p in line.p_values if name in alike and p is not None]
        rest = [p for name, p in line.p_values if name not in CALIBRATION and p is not None]
        true += [_marks(min(own))] if own else []
        if set(line.hidden) <= set(CALIBRATION) and rest:
            false.append(_marks(min(rest)))
    return true, false


def _alike(name: str) -> set[str]:
    try:
        return {name, *find(name).twins}
    except Exception:  # outside the library
        return {name}


def _marks(p_value: float) -> float:
    return -math.log10(max(p_value, 1e-300))


BINS = (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 20.0, 50.0, 301.0)
GAPS = (0.0, 3.0, 5.0, 7.0, 10.0, 14.0, 20.0, 50.0, 100.0, 1000.0, math.inf)


def tables(lines: Sequence[Judged], gaps: Mapping[str, Line]) -> list[Table]:
    """Histograms, as tables."""
    true, false = sureness(lines)
    p_rows = [
        (f"1e-{high:g} to 1e-{low:g}", _count(true, low, high), _count(false, low, high))
        for low, high in pairwise(BINS)
    ]
    known = {line.name: line for line in lines}
    sides: dict[str, list[float]] = {"named, rightly": [], "ambiguous": [], "wrong": []}
    for each in gaps.values():
        line = known.get(each["set"])
        if line is None or each.get("gap") is None or line.verdict not in ("named", "ambiguous"):
            continue
        side = "named, rightly" if line.verdict == "named" else "ambiguous"
        sides["wrong" if judgement(line) == "wrong" else side].append(each["gap"])
    g_rows = [
        (f"{low:g} to {high:g}", *(_count(values, low, high) for values in sides.values()))
        for low, high in pairwise(GAPS)
    ]
    return [
        Table(
            "Margins: how sure",
            ("p-value", "of what is hidden (sets)", "of the likeliest where none is (sets)"),
            tuple(p_rows) if true or false else (),
            "The chance (p-value) that the diagnosis states for what is hidden and, where nothing "
            "is hidden but calibration, for the likeliest effect. It takes an effect if the chance "
            "is below the limit `SURE`.",
        ),
        Table(
            "Margins: the second best",
            ("cost of the second best over the best", *sides),
            tuple(g_rows) if any(sides.values()) else (),
            "Minus two log-likelihood and price; twins are left out. Below its RIVAL the diagnosis "
            "says ambiguous.",
        ),
    ]


def _count(values: Sequence[float], low: float, high: float) -> str:
    number = sum(low <= value < high for value in values)
    return str(number) if number else ""
