# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How small an effect is seen, and named, beside how small one could be at all.

In each session the size from which on an effect is seen, and that from which on it is named, are
closed in upon: the drives and their noise stay, the effect grows. How these sizes scatter from
session to session says from which size on 95 of 100 are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import cache
from statistics import NormalDist, median, median_high
from typing import Any, Literal

import numpy as np

from test.hidden.fisher import LITTLE, bounds, detectable, tellable, unknown_numbers
from test.hidden.follow import follow
from test.hidden.plan import EFFECTS
from test.hidden.result_line import Judged, is_right, judgement
from test.hidden.resumable_jobs import Line
from test.hidden.set_judging import judged
from test.hidden.sets import HiddenSet, make, runs_of
from test.hidden.table_layout import Table
from test.hidden.true_values import values_of
from werrimbi_odom.effects import find as in_library
from werrimbi_odom.simulation import hide
from werrimbi_odom.simulation.hidden import find

STEP = 1.25
"""From one size to the next."""

LADDER = tuple(0.5 * STEP**rung for rung in range(11))
"""Sizes that may be hidden, times the smallest that could be seen."""

POWER = 0.95
"""Share that is to be named."""

CHANCE = 1e-3
"""Of a false name, all effects counted: what the diagnosis allows itself."""

FEW = 2
"""Sessions that are told one by one."""

SETUP = "short"

Task = tuple[str, int]
"""An effect, a session's seed."""

Said = Literal["seen", "named"]


def known_effects() -> list[str]:
    """Effects whose parameters are known to both sides.

    Not those that look at a channel: where nothing is hidden there is none.
    """
    return [
        name
        for name in EFFECTS
        if values_of(name, asdict(hide(name, seed=0).peculiarity))
        and not in_library(name).lacks(())
    ]


def tasks(start: int, sessions: int) -> dict[str, Task]:
    """Each effect in some sessions."""
    return {
        f"{name} {start + 8000 + session}": (name, start + 8000 + session)
        for session in range(sessions)
        for name in known_effects()
    }


def rivals_of(name: str, drives: int) -> list[str]:
    """Effects that could be named in its place: no twins, and none with more free numbers.

    Of a law and a wider one, which does all that and more, the simpler is named.
    """
    twins, numbers = in_library(name).twins, unknown_numbers(name, drives)
    return [
        other
        for other in known_effects()
        if other != name and other not in twins and unknown_numbers(other, drives) <= numbers
    ]


def work(task: Task) -> Line:
    """From which sizes on one effect is seen and named in one session."""
    name, seed = task
    entry = find(name)
    clean = HiddenSet("clean", (), seed, SETUP)
    size = LITTLE * entry.low
    little = hide(name, entry.null + size, seed=seed).peculiarity
    drives = len(runs_of(make(clean), "train"))
    found = bounds(clean, name, asdict(little), size, rivals_of(name, drives))
    limit = detectable(found.alone, len(EFFECTS), CHANCE, POWER, unknown_numbers(name, drives))
    nearest = max(found.beside, key=lambda rival: found.beside[rival])
    apart = tellable(found.beside[nearest], CHANCE, POWER)

    lines: dict[float, Judged] = {}

    def judged_at(step: float) -> Judged:
        if step not in lines:
            wish = f"{name}={entry.null + step * limit!r}"
            lines[step] = judged(HiddenSet("effect", (wish,), seed, SETUP), floors=False)
        return lines[step]

    named_from = first_that_is(lambda step: is_right(judged_at(step)))
    seen_from = first_that_is(lambda step: judgement(judged_at(step)) in ("named", "ambiguous"))
    return {
        "effect": name,
        "limit": limit,
        "claimed": claimed(clean, name),
        "seen_from": seen_from,
        "limit_named": max(limit, apart),
        "nearest": nearest if apart > limit else "",
        "named_from": named_from,
        "judged": len(lines),
        "wrong": sum(judgement(line) == "wrong" for line in lines.values()),
    }


def first_that_is(is_so: Callable[[float], bool]) -> float | None:
    """Size, over the smallest that could be seen, from which on something is said of an effect.

    By bisection of the ladder: between the largest of which it is not and the smallest of which it
    is. None where it is not even of the ladder's largest.
    """
    below, above = -1, len(LADDER)
    while above - below > 1:
        middle = (below + above) // 2
        below, above = (below, middle) if is_so(LADDER[middle]) else (middle, above)
    return None if above == len(LADDER) else LADDER[above] / math.sqrt(STEP)


@cache
def said_of(clean: HiddenSet) -> Mapping[str, Any]:
    """What a diagnosis says of drives, which all effects ask of them."""
    return follow(make(clean), most=0).first


def claimed(clean: HiddenSet, name: str) -> float | None:
    """From which size on the tool says that it would have seen an effect in these drives."""
    entry = find(name)
    for sight in said_of(clean).get("could_have_been_seen", ()):
        if sight["effect"] != name or sight["seen_from"] is None:
            continue
        if name.endswith("tread_bump"):  # hidden by its thickness, told for a sixth of a turn
            height = values_of(name, asdict(hide(name, 1.0, seed=clean.seed).peculiarity))["height"]
            return float(sight["seen_from"]) / height
        if name == "radius_drift":  # hidden per drive: of 20 m, or of a minute
            return float(sight["seen_from"]) * (20.0 if sight["unit"] == "1/m" else 60.0)
        return float(sight["seen_from"]) if (sight["unit"] or "1") == entry.unit else None
    return None


def scatter(groups: Mapping[str, Sequence[float]]) -> float:
    """Standard deviation, from session to session, of the logarithm of the size named.

    One for all effects: each has few sessions, and what scatters, the noise of a session's drives,
    is of the same size in the unit of its own bound. NaN where no effect has two sessions.
    """
    squares, degrees = 0.0, 0
    for sizes in groups.values():
        logs = np.log(sizes)
        squares += float(((logs - logs.mean()) ** 2).sum())
        degrees += logs.size - 1
    return math.sqrt(squares / degrees) if degrees else math.nan


def ratios(results: Mapping[str, Line], said: Said) -> dict[str, tuple[float, float]]:
    """By effect: the size that is seen, or named, in 95 %, over the smallest that could be.

    With the factor by which it may be wrong: one standard error of the mean over the sessions.
    Effects are left out of which some session does not say so at the ladder's largest size.
    """
    groups = {
        name: [over_limit(each, said) for each in own]
        for name, own in _groups(results).items()
        if all(each[f"{said}_from"] for each in own)
    }
    spread = scatter(groups)
    if math.isnan(spread):
        return {}
    quantile = NormalDist().inv_cdf(POWER)
    return {
        name: (
            math.exp(float(np.log(sizes).mean()) + quantile * spread),
            math.exp(spread / math.sqrt(len(sizes))),
        )
        for name, sizes in groups.items()
    }


def over_limit(line: Line, said: Said) -> float:
    """Size from which on an effect is seen or named in a session, over the smallest that could."""
    size = float(line[f"{said}_from"])
    return size * float(line["limit"] / line["limit_named"]) if said == "named" else size


def _groups(results: Mapping[str, Line]) -> dict[str, list[Line]]:
    """Sessions by effect, in the vocabulary's order."""
    found: dict[str, list[Line]] = {name: [] for name in EFFECTS}
    for each in results.values():
        found[each["effect"]].append(each)
    return {name: lines for name, lines in found.items() if lines}


def table(results: Mapping[str, Line]) -> Table:
    """Each effect."""
    seen, named, rows = ratios(results, "seen"), ratios(results, "named"), []
    for name, own in _groups(results).items():
        unit = find(name).unit
        said = [each["claimed"] for each in own if each["claimed"]]
        nearest = dict.fromkeys(each["nearest"] for each in own if each["nearest"])
        wrong, all_judged = (sum(each[what] for each in own) for what in ("wrong", "judged"))
        rows.append(
            (
                name,
                _size(median(each["limit"] for each in own), unit),
                f"{median(said):.2g}" if said else "",
                _steps([each["seen_from"] for each in own]),
                _ratio(*seen[name]) if name in seen else "",
                _size(median(each["limit_named"] for each in own), unit),
                ", ".join(nearest),
                _steps([each["named_from"] for each in own]),
                _ratio(*named[name]) if name in named else "",
                f"{wrong} of {all_judged}",
            )
        )
    words = (
        "In short sessions (four drives to learn from, two held out). *Could be seen*: the size "
        "that a likelihood ratio test which knows all noise finds in 95 of 100 cases, with a "
        f"false name of any of the {len(EFFECTS)} effects in one of {1 / CHANCE:g}: "
        f"{detectable(1.0, len(EFFECTS), CHANCE, POWER):.1f} times the bound of Cramér and Rao "
        f"where the size alone is fitted, {detectable(1.0, len(EFFECTS), CHANCE, POWER, 5):.1f} "
        "times where an angle is in each of four drives. *Could be named*: the size from which on "
        "it could also be told from each effect of no more free numbers that is fitted in its "
        f"place, with the wrong one told in one of {1 / CHANCE:g}: "
        f"{tellable(1.0, CHANCE, POWER):.1f} times the bound where what that effect can do is "
        "unknown, too; *beside* names the nearest, where that is more than to be seen. *Seen "
        "from* and *named from*: in each session, over the size that could be seen, by closing in "
        f"on it in steps of {STEP:g}, of more than {FEW} sessions the middle one, and the least "
        "and the most of them; seen is what is named or among the rivals of an ambiguous "
        "verdict, named what is alone, or with its twins. *Ratio*: the size that is seen, or "
        "named, in 95 of 100 sessions, over what could be, from how the sessions scatter (pooled "
        "over all effects, in the logarithm), with one standard error. *Wrong*: another "
        "name, or *unknown*, of all sets judged on the way."
    )
    columns = (
        *("effect", "could be seen", "the tool says", "seen from", "ratio"),
        *("could be named", "beside", "named from", "ratio", "wrong"),
    )
    return Table("How small an effect is named", columns, tuple(rows), words)


def _size(size: float, unit: str) -> str:
    return f"{size:.2g} {unit if unit != '1' else ''}".strip()


def _steps(sizes: Sequence[float | None]) -> str:
    """Of each session; of more than a few, the middle one, and the least and the most."""
    steps = [math.inf if size is None else size for size in sizes]
    if len(steps) <= FEW:
        return ", ".join(map(_step, steps))
    return f"{_step(median_high(steps))} ({_step(min(steps))} to {_step(max(steps))})"


def _step(size: float) -> str:
    return f"{size:.2f}" if size < math.inf else f"> {LADDER[-1]:.1f}"


def _ratio(ratio: float, error: float) -> str:
    return f"{ratio:.2f} ({ratio / error:.2f} to {ratio * error:.2f})"
