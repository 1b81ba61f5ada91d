# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The page of an effect: its parsed docstring, for command line, docs and workbench."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from inspect import cleandoc
from typing import Any

from werrimbi_odom.model.effect import Effect, Parameter, Stage, Twin

SECTIONS = ("Formula", "Signature", "Ruler", "Twins", "Alike")
"""Keywords that begin a section of the docstring, at the start of a line."""

MEANING: Mapping[str, str] = {
    "Formula": "the law",
    "Signature": "what it does to the data",
    "Ruler": "how to check it on the robot",
    "Twins": "what no drive can tell from it",
    "Alike": "what some drives cannot tell from it",
}

STAGES: Mapping[Stage, str] = {
    "wiring": "how the counters are wired",
    "wheels": "on the travel of the wheels",
    "body": "on the motion of the body",
    "reference": "on what the reference shows; never on what the node publishes",
}


@dataclass(frozen=True)
class Page:
    """Parsed documentation of an effect."""

    physics: tuple[str, ...]
    """Paragraphs, each as one line; the first is the summary."""
    sections: Mapping[str, str]
    """Text of each section in the docstring, with its line breaks."""


def page_of(effect: Effect) -> Page:
    """Parse the docstring of an effect; its declared twins are added to those in it."""
    physics: list[str] = []
    sections: dict[str, list[str]] = {}
    current: list[str] | None = None
    for line in effect.doc.strip().splitlines():
        first, _, rest = line.partition(" ")
        if first in SECTIONS:
            current = sections.setdefault(first, [])
            current.append(rest.strip())
        elif current is not None and (line.startswith(" ") or not line):
            current.append(line)
        else:
            current = None
            physics.append(line)
    found = {name: cleandoc("\n".join(lines)) for name, lines in sections.items()}
    twins = [_of_twin(twin) for twin in effect.indistinguishable_from if twin.do]
    if twins:
        found["Twins"] = ".\n".join([*twins, *([found["Twins"]] if "Twins" in found else [])])
    return Page(
        tuple(" ".join(part.split()) for part in "\n".join(physics).split("\n\n") if part.strip()),
        {name: found[name] for name in SECTIONS if name in found},
    )


def _of_twin(twin: Twin) -> str:
    """Text on a twin, with line breaks as in a docstring."""
    over = "1 / " if twin.inverse else ""
    same = [f"{name} = {over}{_times(factor)}{own}" for name, (own, factor) in twin.values.items()]
    who = f"{twin.name} ({', '.join(same)})" if same else twin.name
    return textwrap.fill(f"{who}: {twin.told_apart_by}. So {twin.do}", 85)


def _times(factor: float) -> str:
    return {1.0: "", -1.0: "-"}.get(factor, f"{factor:g} * ")


def as_text(effect: Effect) -> str:
    """The page as plain text."""
    page = page_of(effect)
    lines = [f"{effect.name}: acts {STAGES[effect.stage]}", ""]
    for paragraph in page.physics:
        lines += [textwrap.fill(paragraph, 96), ""]
    for name, text in page.sections.items():
        lines += [f"{name} ({MEANING[name]})", textwrap.indent(text, "  "), ""]
    if effect.parameters:
        lines.append("Parameters")
        for name, item in effect.parameters.items():
            lines += [f"  {name}{_in_unit(item.unit)}: {item.says}", f"    {numbers(effect, name)}"]
    return "\n".join(lines).rstrip() + "\n"


def numbers(effect: Effect, name: str) -> str:
    """Null, typical value and bounds of a parameter, in words."""
    item = effect.parameters[name]
    low, high = item.bounds
    absent = absent_at(effect, name)
    words = f"typical {item.typical:g}, possible {low:g} to {high:g}{anew(item)}"
    return words if absent == "any" else f"absent at {absent}, {words}"


def absent_at(effect: Effect, name: str) -> str:
    """Value of a parameter without the effect; "any" if that depends on other parameters."""
    return f"{effect.parameters[name].null:g}" if effect.has_null(name) else "any"


def as_json(effect: Effect) -> dict[str, Any]:
    """The page as JSON."""
    page = page_of(effect)
    return {
        "effect": effect.name,
        "stage": effect.stage,
        "summary": effect.summary,
        "physics": " ".join(page.physics),
        **{name.lower(): page.sections.get(name) for name in SECTIONS},
        "twin_effects": [twin.name for twin in effect.indistinguishable_from],
        "channels": list(effect.channels),
        "one_of_channels": list(effect.one_of_channels),
        "parameters": {
            name: {
                "unit": item.unit,
                "null": item.null,
                "typical": item.typical,
                "bounds": list(item.bounds),
                "says": item.says,
                "per_run": item.per_run,
                "tries": list(item.tries),
            }
            for name, item in effect.parameters.items()
        },
    }


def anew(item: Parameter) -> str:
    """Remark on a per-run parameter; "" for others."""
    kept = " unless counters keep their zero" if item.unit == "rad" else ""
    return f", anew in each run{kept}" if item.per_run else ""


def _in_unit(unit: str) -> str:
    return f" [{unit}]" if unit else ""
