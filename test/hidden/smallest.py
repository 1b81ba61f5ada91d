# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How small an effect is named, beside how small one could be seen at all.

Each effect is hidden in a ladder of sizes about the smallest that any method could see in the same
drives. A logistic curve through what was named and what was not says at which size 95 of 100 are.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from statistics import median

import numpy as np
from scipy.optimize import minimize

from test.hidden.fisher import bound, detectable
from test.hidden.follow import follow
from test.hidden.plan import EFFECTS
from test.hidden.result_line import is_right, judgement
from test.hidden.resumable_jobs import Line
from test.hidden.set_judging import judged
from test.hidden.sets import HiddenSet, make
from test.hidden.table_layout import Table
from test.hidden.true_values import values_of
from werrimbi_odom.effects import find as in_library
from werrimbi_odom.simulation import hide
from werrimbi_odom.simulation.hidden import find

LADDER = (0.6, 0.9, 1.4, 2.1, 3.2, 4.8)
"""Sizes that are hidden, times the smallest that could be seen."""

POWER = 0.95
"""Share that is to be named."""

CHANCE = 1e-3
"""Of a false name, all effects counted: what the diagnosis allows itself."""

SETUP = "short"


def tasks(start: int, seeds: int) -> dict[str, tuple[str, int]]:
    """Each effect in some sessions, where its parameters are known to both sides.

    Not those that look at a channel: where nothing is hidden there is none.
    """
    return {
        f"{name} {start + 8000 + seed}": (name, start + 8000 + seed)
        for seed in range(seeds)
        for name in EFFECTS
        if values_of(name, asdict(hide(name, seed=0).peculiarity))
        and not in_library(name).lacks(())
    }


def work(task: tuple[str, int]) -> Line:
    """The ladder of one effect in one session."""
    name, seed = task
    entry = find(name)
    clean = HiddenSet("clean", (), seed, SETUP)
    little = hide(name, entry.null + entry.low, seed=seed).peculiarity
    sigma = bound(clean, name, asdict(little), entry.low)
    limit = detectable(sigma, len(EFFECTS), CHANCE, POWER)
    rungs = []
    for step in LADDER:
        wish = f"{name}={entry.null + step * limit!r}"
        line = judged(HiddenSet("effect", (wish,), seed, SETUP), floors=False)
        rungs.append((step * limit, is_right(line), judgement(line) == "wrong"))
    return {
        "effect": name,
        "limit": limit,
        "claimed": claimed(clean, name),
        "rungs": rungs,
    }


def claimed(clean: HiddenSet, name: str) -> float | None:
    """From which size on the tool says that it would have seen an effect in these drives."""
    first = follow(make(clean), most=0).first
    entry = find(name)
    for sight in first.get("could_have_been_seen", ()):
        if sight["effect"] != name or sight["seen_from"] is None:
            continue
        if name == "radius_drift":  # hidden per drive: of 20 m, or of a minute
            return float(sight["seen_from"]) * (20.0 if sight["unit"] == "1/m" else 60.0)
        return float(sight["seen_from"]) if (sight["unit"] or "1") == entry.unit else None
    return None


def named_from(sizes: Sequence[float], named: Sequence[bool], power: float = POWER) -> float | None:
    """Size at which a share is named, by a logistic curve in the logarithm of the size.

    The likelihood is weighed by the square root of the information's determinant (Jeffreys, Firth
    1993), so that there is a curve where all above a size were named and none below. None where
    nothing was named, or everything.
    """
    if not sizes or all(named) or not any(named):
        return None
    x, y = np.log(np.asarray(sizes)), np.asarray(named, dtype=float)
    middle = float(x.mean())
    design = np.stack([np.ones_like(x), x - middle], axis=-1)

    def misfit(values: np.ndarray) -> float:
        share = np.clip(1.0 / (1.0 + np.exp(-(design @ values))), 1e-12, 1.0 - 1e-12)
        information = design.T @ (design * (share * (1.0 - share))[:, None])
        likelihood = y @ np.log(share) + (1.0 - y) @ np.log(1.0 - share)
        return -float(likelihood + 0.5 * np.log(max(float(np.linalg.det(information)), 1e-300)))

    offset, slope = minimize(misfit, np.array([0.0, 1.0]), method="Nelder-Mead").x
    if slope <= 0.0:
        return None
    return math.exp(middle + (math.log(power / (1.0 - power)) - offset) / slope)


def ratios(results: Mapping[str, Line]) -> dict[str, float]:
    """By effect: the size from which on it is named, over the smallest that could be seen."""
    found = {}
    for name in EFFECTS:
        own = [each for each in results.values() if each["effect"] == name]
        steps = [size / each["limit"] for each in own for size, _, _ in each["rungs"]]
        ratio = named_from(steps, [named for each in own for _, named, _ in each["rungs"]])
        if ratio is not None:
            found[name] = ratio
    return found


def table(results: Mapping[str, Line]) -> Table:
    """Each effect."""
    found = ratios(results)
    rows = []
    for name in EFFECTS:
        own = [each for each in results.values() if each["effect"] == name]
        if not own:
            continue
        limit = median(each["limit"] for each in own)
        said = [each["claimed"] for each in own if each["claimed"]]
        entry = find(name)
        tries = [rung for each in own for rung in each["rungs"]]
        shown = ", ".join(
            f"{sum(each['rungs'][step][1] for each in own)}" for step in range(len(LADDER))
        )
        rows.append(
            (
                name,
                f"{limit:.2g} {entry.unit if entry.unit != '1' else ''}".strip(),
                f"{median(said):.2g}" if said else "",
                f"{found[name] * limit:.2g}" if name in found else _outside(own),
                f"{found[name]:.1f}" if name in found else "",
                f"{shown} of {len(own)}",
                str(sum(wrong for _, _, wrong in tries) or ""),
            )
        )
    words = (
        "In short sessions (four drives to learn from, two held out). *Could be seen*: the size "
        "that a test which knows the effect's shape and all noise finds in 95 of 100 cases, with a "
        f"false name of any of the {len(EFFECTS)} effects in one of {1 / CHANCE:g}: "
        f"{detectable(1.0, len(EFFECTS), CHANCE, POWER):.1f} times the bound of Cramér and Rao. "
        "*Named in 95 %*: by a logistic curve through the ladder "
        f"{', '.join(f'{step:g}' for step in LADDER)} times that size."
    )
    columns = (
        "effect",
        "could be seen",
        "the tool says",
        "named in 95 %",
        "ratio",
        "named at each size",
        "wrong names",
    )
    return Table("How small an effect is named", columns, tuple(rows), words)


def _outside(own: Sequence[Line]) -> str:
    """What the ladder says where it has no curve."""
    named = [done for each in own for _, done, _ in each["rungs"]]
    step = LADDER[0] if all(named) else LADDER[-1]
    word = "less than" if all(named) else "more than"
    return f"{word} {step * median(each['limit'] for each in own):.2g}" if named else ""
