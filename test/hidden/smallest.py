# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How small an effect is named, beside how small one could be seen at all.

In each session the size from which on an effect is named is closed in upon: the drives and their
noise stay, the effect grows. How these sizes scatter from session to session says from which size
on 95 of 100 are named.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import cache
from statistics import NormalDist, median
from typing import Any

import numpy as np

from test.hidden.fisher import bound, detectable
from test.hidden.follow import follow
from test.hidden.plan import EFFECTS, evenly
from test.hidden.result_line import is_right, judgement
from test.hidden.resumable_jobs import Line
from test.hidden.set_judging import judged
from test.hidden.sets import HiddenSet, make
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

SETUP = "short"

LEGS = (1.0, 0.1)
"""Lengths of the legs that are judged [m]: what is the default, and what sees smaller effects."""


Task = tuple[str, int, float]
"""An effect, a session's seed, the legs' length [m]."""


def tasks(start: int, sessions: Sequence[float]) -> dict[str, Task]:
    """Each effect in some sessions for each length of legs; half a session: of half the effects.

    Where its parameters are known to both sides; not those that look at a channel: where nothing is
    hidden there is none.
    """
    known = [
        name
        for name in EFFECTS
        if values_of(name, asdict(hide(name, seed=0).peculiarity))
        and not in_library(name).lacks(())
    ]
    return {
        f"{name} {start + 8000 + session} {leg:g}": (name, start + 8000 + session, leg)
        for leg, count in zip(LEGS, sessions, strict=True)
        for session in range(math.ceil(count))
        for name in evenly(known, round((count - session) * len(known)), start)
    }


def work(task: Task) -> Line:
    """From which size on one effect is named in one session."""
    name, seed, leg = task
    options = ("--leg", f"{leg:g}")
    entry = find(name)
    clean = HiddenSet("clean", (), seed, SETUP)
    little = hide(name, entry.null + entry.low, seed=seed).peculiarity
    sigma = bound(clean, name, asdict(little), entry.low)
    limit = detectable(sigma, len(EFFECTS), CHANCE, POWER)
    wrong = []

    def is_named(step: float) -> bool:
        wish = f"{name}={entry.null + step * limit!r}"
        line = judged(HiddenSet("effect", (wish,), seed, SETUP), floors=False, options=options)
        wrong.append(judgement(line) == "wrong")
        return is_right(line)

    step = first_named(is_named)
    return {
        "effect": name,
        "leg": leg,
        "limit": limit,
        "claimed": claimed(clean, name, options),
        "named_from": step,
        "judged": len(wrong),
        "wrong": sum(wrong),
    }


def first_named(is_named: Callable[[float], bool]) -> float | None:
    """Size, over the smallest that could be seen, from which on an effect is named.

    By bisection of the ladder: between the largest that is not and the smallest that is. None where
    not even the ladder's largest is.
    """
    below, above = -1, len(LADDER)
    while above - below > 1:
        middle = (below + above) // 2
        below, above = (below, middle) if is_named(LADDER[middle]) else (middle, above)
    return None if above == len(LADDER) else LADDER[above] / math.sqrt(STEP)


@cache
def said_of(clean: HiddenSet, options: tuple[str, ...]) -> Mapping[str, Any]:
    """What a diagnosis says of drives, which all effects ask of them."""
    return follow(make(clean), options, most=0).first


def claimed(clean: HiddenSet, name: str, options: tuple[str, ...]) -> float | None:
    """From which size on the tool says that it would have seen an effect in these drives."""
    entry = find(name)
    for sight in said_of(clean, options).get("could_have_been_seen", ()):
        if sight["effect"] != name or sight["seen_from"] is None:
            continue
        if name == "radius_drift":  # hidden per drive: of 20 m, or of a minute
            return float(sight["seen_from"]) * (20.0 if sight["unit"] == "1/m" else 60.0)
        return float(sight["seen_from"]) if (sight["unit"] or "1") == entry.unit else None
    return None


Key = tuple[str, float]
"""An effect, the legs' length [m]."""


def scatter(groups: Mapping[Key, Sequence[float]]) -> float:
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


def ratios(results: Mapping[str, Line]) -> dict[Key, tuple[float, float]]:
    """By effect and legs: the size that is named in 95 %, over the smallest that could be seen.

    With the factor by which it may be wrong: one standard error of the mean over the sessions.
    Effects are left out that some session does not name at the ladder's largest size.
    """
    groups = {
        key: [each["named_from"] for each in own]
        for key, own in _groups(results).items()
        if all(each["named_from"] for each in own)
    }
    spread = scatter(groups)
    if math.isnan(spread):
        return {}
    quantile = NormalDist().inv_cdf(POWER)
    return {
        key: (
            math.exp(float(np.log(sizes).mean()) + quantile * spread),
            math.exp(spread / math.sqrt(len(sizes))),
        )
        for key, sizes in groups.items()
    }


def _groups(results: Mapping[str, Line]) -> dict[Key, list[Line]]:
    """Sessions by effect, in the vocabulary's order, and legs."""
    found: dict[Key, list[Line]] = {(name, leg): [] for name in EFFECTS for leg in LEGS}
    for each in results.values():
        found[each["effect"], each["leg"]].append(each)
    return {key: lines for key, lines in found.items() if lines}


def table(results: Mapping[str, Line]) -> Table:
    """Each effect."""
    found, groups = ratios(results), _groups(results)
    rows = []
    for name in dict.fromkeys(name for name, _ in groups):
        by_leg = [groups.get((name, leg), []) for leg in LEGS]
        own = [each for lines in by_leg for each in lines]
        limit = median(each["limit"] for each in own)
        unit = find(name).unit
        cells = []
        for leg, lines in zip(LEGS, by_leg, strict=True):
            said = [each["claimed"] for each in lines if each["claimed"]]
            cells += [
                f"{median(said):.2g}" if said else "",
                ", ".join(_step(each["named_from"]) for each in lines),
                _ratio(*found[name, leg]) if (name, leg) in found else "",
            ]
        wrong, all_judged = (sum(each[what] for each in own) for what in ("wrong", "judged"))
        shown = f"{limit:.2g} {unit if unit != '1' else ''}".strip()
        rows.append((name, shown, *cells, f"{wrong} of {all_judged}"))
    words = (
        "In short sessions (four drives to learn from, two held out). *Could be seen*: the size "
        "that a test which knows the effect's shape and all noise finds in 95 of 100 cases, with a "
        f"false name of any of the {len(EFFECTS)} effects in one of {1 / CHANCE:g}: "
        f"{detectable(1.0, len(EFFECTS), CHANCE, POWER):.1f} times the bound of Cramér and Rao. "
        "*Named from*: in each session, over that size, by closing in on it in steps of "
        f"{STEP:g}. *Ratio*: the size that is named in 95 of 100 sessions, over what could be "
        "seen, from how the sessions scatter (pooled over all effects, in the logarithm), with one "
        "standard error. *Wrong*: names, of all sets judged on the way. A leg is judged by the "
        "poses at its ends: with short ones more poses of the reference are used."
    )
    columns = (
        "effect",
        "could be seen",
        *(
            f"{column}{legs}"
            for legs in (f", legs of {leg:g} m" for leg in LEGS)
            for column in ("the tool says", "named from", "ratio")
        ),
        "wrong",
    )
    return Table("How small an effect is named", columns, tuple(rows), words)


def _step(size: float | None) -> str:
    return f"{size:.2f}" if size else f"> {LADDER[-1]:.1f}"


def _ratio(ratio: float, error: float) -> str:
    return f"{ratio:.2f} ({ratio / error:.2f} to {ratio * error:.2f})"
