# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the intervals that are stated hold the truth as often as they say.

Of the verbs diagnose, add and calibrate fit, on the engine's sets: it shares no code with the
model, so an interval misses where the law is not quite the engine's, too. An interval of 1.96
standard deviations holds the truth in 95 of 100 cases, and the truth's place in its own
distribution is then even from 0 to 1.
"""

from __future__ import annotations

import math
import tempfile
from collections import defaultdict
from collections.abc import Mapping, Sequence
from statistics import NormalDist, fmean, stdev

from test.hidden.follow import run_json
from test.hidden.followed_to_rest import at_the_truth
from test.hidden.intervals import between
from test.hidden.result_line import Judged
from test.hidden.resumable_jobs import Line
from test.hidden.set_judging import options_of
from test.hidden.sets import HiddenSet, make, runs_of
from test.hidden.table_layout import Table
from test.hidden.true_values import GIVES_WAY, multipliers_of, noises_of, values_of

WIDE = 1.96
"""Standard deviations."""

RANKS = 10

VERBS = ("diagnose", "add", "calibrate fit")

Scores = dict[tuple[str, str], list[float]]
"""By verb and parameter: (stated - true) / stated standard deviation."""


def tasks(sets: Sequence[HiddenSet], start: int, sessions: int) -> dict[str, HiddenSet]:
    """Sets that calibration alone explains, and some short sessions more."""
    those = [each for each in sets if each.group in ("clean", "calibration")]
    more = [HiddenSet("clean", (), start + 9000 + session, "short") for session in range(sessions)]
    return {each.name: each for each in (*those, *more)}


def work(what: HiddenSet) -> Line:
    """What `calibrate fit` states of a set."""
    folder = make(what)
    runs = [str(path) for path in runs_of(folder, "train")]
    with tempfile.TemporaryDirectory() as place:
        given = ["--robot", str(folder / "robot.yaml"), *runs, *options_of(what)]
        done, found = run_json(["calibrate", "fit", *given, "--out", f"{place}/out.yaml"])
    if done.code != 0:
        return {"set": what.name, "error": done.complained}
    said = found["parameters"]
    truth = {**multipliers_of(what.truth), **noises_of(what.truth)}
    return {
        "set": what.name,
        "scores": {
            name: (said[name]["value"] - true) / said[name]["std"]
            for name, true in truth.items()
            if name in said and said[name]["std"]
        },
    }


def scores(lines: Sequence[Judged], sets: Sequence[HiddenSet], fits: Mapping[str, Line]) -> Scores:
    """Of all that was stated; of additions the last, where they led to the truth.

    Of diagnoses the first, where what it found is what was hidden.
    """
    found: Scores = defaultdict(list)
    known = {each.name: each for each in sets}
    for line in lines:
        if line.name not in known:
            continue
        truth = known[line.name].truth
        if line.hidden and set(line.found) == set(line.hidden):
            for name, score in _against(truth, line.values):
                found["diagnose", name].append(score)
        if line.fits and at_the_truth(line):
            for name, score in _of_addition(line.fits[-1], truth):
                found["add", name].append(score)
    for each in fits.values():
        for name, score in each.get("scores", {}).items():
            found["calibrate fit", name].append(score)
    return found


def _of_addition(fit: Line, truth: Mapping[str, object]) -> list[tuple[str, float]]:
    alone = fit["effects"][0] if len(fit["effects"]) == 1 else None
    stated = {
        name if "." in name or alone is None else f"{alone}.{name}": pair
        for name, pair in fit["parameters"].items()
    }
    exotic = not any(name in ("track_width", "unequal_wheel_radii", "wheel_radius_scale")
                     for name in fit["effects"])  # fmt: skip
    stated |= fit["calibration"] if exotic else {}
    stated |= fit["noise"]
    return _against(truth, stated, {**multipliers_of(truth), **noises_of(truth, fit["effects"])})


def _against(
    truth: Mapping[str, object],
    stated: Mapping[str, Sequence[float]],
    more: Mapping[str, float] | None = None,
) -> list[tuple[str, float]]:
    """Of each parameter whose truth is known, here or by `more`: how far off it is stated."""
    hidden = truth["hidden"]
    assert isinstance(hidden, list)
    true = {
        f"{each['effect']}.{name}": value
        for each in hidden
        for name, value in values_of(each["effect"], each["parameters"]).items()
    } | dict(more or {})
    return [
        (name, (value - true[name]) / std)
        for name, (value, std) in stated.items()
        if name in true and name not in GIVES_WAY and std and math.isfinite(std)
    ]


def table(found: Scores) -> Table:
    """Each parameter of each verb."""
    rows = []
    for verb in VERBS:
        own = {name: values for (of, name), values in found.items() if of == verb}
        everything = [value for values in own.values() for value in values]
        if not everything:
            continue
        rows.append((verb, "all parameters", *_row(everything)))
        rows += [(verb, name, *_row(values)) for name, values in own.items()]
    words = (
        f"Intervals of ± {WIDE} stated standard deviations; of diagnoses the first of each set, of "
        "additions the last, where all that was found, or added, is what was hidden. *Off*: "
        "(stated - true) / stated standard deviation, mean and standard deviation over the sets; 0 "
        "and 1 where all is right."
    )
    columns = ("verb", "parameter", "intervals", "hold the truth", "95 % interval", "off")
    return Table("Intervals that hold the truth", columns, tuple(rows), words)


def _row(values: Sequence[float]) -> tuple[str, ...]:
    hold = sum(abs(value) <= WIDE for value in values)
    spread = f"{stdev(values):.2f}" if len(values) > 1 else ""
    return (
        str(len(values)),
        f"{hold} ({hold / len(values):.0%})",
        between(hold, len(values)),
        f"{fmean(values):+.2f}, {spread}",
    )


def ranks(found: Scores, verb: str) -> list[int]:
    """How many truths lie in each tenth of their stated distributions."""
    counts = [0] * RANKS
    for (of, _), values in found.items():
        for value in values if of == verb else ():
            counts[min(int(RANKS * NormalDist().cdf(-value)), RANKS - 1)] += 1
    return counts


def rank_table(found: Scores) -> Table:
    """The histograms, in numbers."""
    rows = []
    for verb in VERBS:
        counts = ranks(found, verb)
        if sum(counts):
            rows.append((verb, *map(str, counts)))
    columns = ("verb", *(f"{number / RANKS:.1f}" for number in range(RANKS)))
    words = (
        "How many true values lie in each tenth of the distribution that was stated; if all is "
        "right, all ten counts are alike but for chance."
    )
    return Table("Ranks of the truth", columns, tuple(rows), words)
