# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis in tables of at most 80 columns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import Value, values_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.step_jacobians import CHANNELS
from werrimbi_odom.inference.manoeuvres.detection_limits import DetectionLimit
from werrimbi_odom.report.diagnosis.dependence import short_words
from werrimbi_odom.report.document import Part, Table, paragraphs
from werrimbi_odom.report.number_format import error_words, in_unit, p_words, with_std

_RANKED = 8
_MAPPED = 10


def tables_of(diagnosis: Diagnosis, sights: Sequence[DetectionLimit] = ()) -> list[Part]:
    """Parameters, ranking, evidence map, and detection limits."""
    parts = [*_parameters(diagnosis), _ranking(diagnosis), *_map(diagnosis)]
    known = diagnosis.verdict == "none" and diagnosis.runs.tells_noise
    return [*parts, *_sights(sights)] if known else parts


def _parameters(diagnosis: Diagnosis) -> list[Part]:
    names = list(dict.fromkeys([*diagnosis.found, *diagnosis.rivals, *diagnosis.outdated]))
    rows = [
        [
            f"{name}.{parameter}",
            *(
                _told(item)
                if item.reported
                else ("each drive its own" if item.per_run else "not determined", item.unit)
            ),
        ]
        for name in names
        for parameter, item in values_of(diagnosis, name).items()
    ]
    title = "Fitted values (± one standard deviation)"
    return [Table(title, ("parameter", "value", "unit"), rows)] if rows else []


def _told(item: Value) -> tuple[str, str]:
    values = [(item.value, item.std), *([] if item.or_else is None else [item.or_else])]
    texts, units = zip(*(in_unit(*each, item.unit) for each in values), strict=True)
    if len(set(units)) > 1:
        texts, units = tuple(with_std(*each) for each in values), (item.unit,)
    return " or ".join(texts), units[0]


def _ranking(diagnosis: Diagnosis) -> Table:
    ranked = diagnosis.ranking[:_RANKED]
    rows = [
        [item.effect, p_words(item.p_value), *_fall(item.train), *_fall(item.holdout)]
        for item in ranked
    ]
    heads = ("effect", "chance", "train", "with it", "held out", "with it")
    if not any(row[2] for row in rows):
        return Table("Effects, best first", heads[:2], [row[:2] for row in rows])
    of = "heading" if diagnosis.holdout.unit == "rad" else "position"
    title = f"Effects, best first (chance without a cause; {of} error without it, with it)"
    return Table(title, heads, rows)


def _fall(sides: Sides | None) -> tuple[str, str]:
    if sides is None:
        return "", ""
    return error_words(sides.before, sides.unit), error_words(sides.after, sides.unit)


def _map(diagnosis: Diagnosis) -> Sequence[Part]:
    """Explained chi-squared of each error channel by each variable."""
    title = "What the errors go with, base and radii alone put in"
    cells = list(diagnosis.depends_on)
    sure = list(dict.fromkeys(short_words(cell) for cell in cells if cell.p_value < rules.SURE))
    if not sure:
        return paragraphs([f"{title}: nothing."], apart=True)
    rows = [
        [name, *(_strength(cells, channel, name) for channel in CHANNELS)]
        for name in sure[:_MAPPED]
    ]
    rest = f"and {len(sure) - _MAPPED} more" if len(sure) > _MAPPED else ""
    title = f"{title} (explained χ²; . is none)"
    return [Table(title, ("goes with", *CHANNELS), rows, rest=rest)]


def _strength(cells: Iterable[Dependence], channel: str, name: str) -> str:
    best = max(
        (cell.gain - cell.degrees for cell in cells
         if cell.channel == channel and short_words(cell) == name and cell.p_value < rules.SURE),
        default=0.0,
    )  # fmt: skip
    return f"{best:.0f}" if best > 0.0 else "."


def _sights(sights: Sequence[DetectionLimit]) -> list[Part]:
    def size(value: float, unit: str) -> str:
        return f"{value:.2g} {unit}".rstrip() if value < 1e3 else "never"

    rows = [
        [
            *(each.effect, each.parameter, size(each.minimum_detectable, each.unit)),
            size(each.typical, each.unit),
        ]
        for each in sights
    ]
    heads = ("effect", "parameter", "seen from", "usual")
    title = "From which size on an effect would have been seen"
    return [Table(title, heads, rows)] if rows else []
