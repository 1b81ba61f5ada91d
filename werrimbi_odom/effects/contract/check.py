# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Check of an effect, with the properties of texts, views and mistakes."""

from __future__ import annotations

import re

import numpy as np

from werrimbi_odom.effects.contract.demands import corners, demand, in_words
from werrimbi_odom.effects.contract.sample_drive import Rehearsal
from werrimbi_odom.effects.contract.wheel_and_body_laws import LAWS
from werrimbi_odom.effects.effect_docstring import SECTIONS, page_of
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.wiring import Wiring

_NEEDED = ("Formula", "Signature", "Ruler")
_UNIT = re.compile(r"(1|[a-zA-Z%]+(\^-?\d+(\.\d+)?)?)([*/][a-zA-Z]+(\^-?\d+(\.\d+)?)?)*")


def check_effect(effect: Effect) -> None:
    """Test an effect for all laws; returns nothing if it keeps them.

    Raises
    ------
    AssertionError
        For the first broken law; the message says which, where, and a remedy.
    """
    _has_words(effect)
    if effect.stage == "wiring":
        _is_a_mistake(effect, Wiring())
    elif effect.stage == "reference":
        if effect.is_mistake:
            _is_a_mistake(effect, View())
        else:
            _views(effect)
    else:
        drive = Rehearsal.of((*effect.channels, *effect.one_of_channels))
        for law in LAWS:
            law(effect, drive)


def _has_words(effect: Effect) -> None:
    law = "words and units are there"
    demand(
        re.fullmatch(r"[a-z][a-z0-9_]*", effect.name) is not None,
        effect,
        law,
        "the name must be of small letters, digits and underscores",
    )
    page = page_of(effect)
    demand(
        bool(page.physics) and page.physics[0].endswith("."),
        effect,
        law,
        "the docstring must begin with a sentence that says what it is, ending with a full stop",
    )
    for section in _NEEDED:
        demand(
            section in page.sections,
            effect,
            law,
            f"the docstring needs a line that begins with {section} (of {', '.join(SECTIONS)})",
        )
    if effect.twins:
        demand("Twins" in page.sections, effect, law, "it names twins; say what separates them")
    sizes = [item for item in effect.parameters.values() if not item.tries]
    for name, item in effect.parameters.items():
        where = f"parameter {name}"
        demand(
            not (item.tries and item.per_run) or len(sizes) == 1,
            effect,
            law,
            f"{where}: a place that each drive has anew (tries and per_run) goes with one size, "
            f"and there are {len(sizes)}",
        )
        demand(bool(item.says.strip()), effect, law, f"{where} must say what it is")
        demand(
            item.unit == "" or _UNIT.fullmatch(item.unit) is not None,
            effect,
            law,
            f"{where}: {item.unit!r} is no unit (like m, rad, 1/s, s^2/m; empty for a pure number)",
        )
        low, high = item.bounds
        inside = all(low <= value <= high for value in (item.null, item.typical, *item.tries))
        demand(
            bool(np.isfinite([low, high]).all()) and low < high and inside,
            effect,
            law,
            f"{where}: null, typical and tries must lie within its bounds, and those be finite",
        )
        demand(
            item.scale > 0.0,
            effect,
            law,
            f"{where}: typical must differ from null; it is the scale of derivatives",
        )


def _views(effect: Effect) -> None:
    start = View(0.1, -0.2, 0.3, 0.04, 0.05)
    demand(
        effect.apply(start, **effect.nulls) == start,
        effect,
        "at its null values it is the exact identity",
        f"it makes {effect.apply(start, **effect.nulls)} of {start}",
    )
    for values in corners(effect):
        seen = effect.apply(start, **values)
        demand(
            isinstance(seen, View) and bool(np.isfinite(np.array(seen, dtype=float)).all()),
            effect,
            "it is finite at the bounds",
            f"with {in_words(values)} it gives {seen}",
        )
    for name, item in effect.parameters.items():
        moved = effect.apply(start, **{**effect.nulls, name: item.typical})
        demand(moved != start, effect, "its parameters have derivatives", f"{name} does nothing")


def _is_a_mistake(effect: Effect, right: View | Wiring) -> None:
    law = "a mistake made twice is none"
    once = effect.apply(right)
    demand(once != right, effect, law, "made once, it changes nothing")
    demand(effect.apply(once) == right, effect, law, "made twice, something stays changed")
