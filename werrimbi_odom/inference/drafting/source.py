# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The source of an effect file: short, readable, and clear about what the data cannot show."""

from __future__ import annotations

import textwrap

from werrimbi_odom.effects import shapes
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.drafting.column_names import identifier_of, quoted
from werrimbi_odom.inference.drafting.law_forms import INDENT, Form, Seen

_ERROR = {
    "left": "the left wheel's travel",
    "right": "the right wheel's travel",
    "along": "the travel of both wheels",
    "sideways": "the sideways motion",
    "heading": "the heading",
}
_PER = {
    "travel": "travel",
    "path": "path (travel without sign)",
    "turn": "turning",
    "duration": "time",
}
_BASE = {
    "travel": "motion.along",
    "path": "abs(motion.along)",
    "turn": "motion.turn",
    "duration": "drive.duration",
}
_TWICE = "with it small and with it large"
_CHECK = {
    "left": f"drive a taped line twice, {_TWICE}: the robot bends",
    "right": f"drive a taped line twice, {_TWICE}: the robot bends",
    "along": f"drive a taped line twice, {_TWICE}: the lengths differ",
    "sideways": f"drive along a chalk line, {_TWICE}: mark where it ends",
    "heading": f"drive along a chalk line, {_TWICE}: mark how it ends turned",
}


def name_of(amount: Amount, variable: str) -> str:
    """Name of a draft, until the user chooses a better one."""
    return f"{amount.channel}_by_{identifier_of(variable)}"


def source_of(name: str, amount: Amount, seen: Seen, form: Form, drives: int, strength: str) -> str:
    """Write the effect file."""
    on_wheels = amount.channel in ("left", "right", "along") and amount.per in ("travel", "path")
    kind = "wheel" if on_wheels else "body"
    moved = "WheelTravel" if on_wheels else "BodyMotion"
    first = "travel" if on_wheels else "motion"
    given = ", ".join(f"{item.name}: float" for item in form.parameters)
    body = [f"@{kind}_effect("]
    if form.quadrature:
        body.append(f'{INDENT}quadrature=("{form.quadrature[0]}", "{form.quadrature[1]}"),')
    if seen.channels:
        names = ", ".join(map(quoted, seen.channels))
        body.append(f"{INDENT}channels=({names}{',' * (len(seen.channels) == 1)}),")
    body += [item.source() for item in form.parameters]
    body += [")", f"def {name}("]
    body += [f"{INDENT}{first}: {moved}[Number], drive: Drive[Number], {given}"]
    body += [f") -> {moved}[Number]:"]
    body.append(textwrap.indent(_doc(amount, seen, form, drives, strength), INDENT))
    law = _law(amount, seen, form, on_wheels)
    body += [INDENT + line for line in law]
    head = _head(name, "\n".join(law), kind, moved)
    # Two empty lines after the imports: what follows is the law, as reports show it.
    return "\n".join([head, "", "", *form.constants, *(["", ""] * bool(form.constants)), *body, ""])


def _head(name: str, law: str, kind: str, moved: str) -> str:
    used = [shape for shape in shapes.__all__ if f"{shape}(" in law]
    imports = [f"from werrimbi_odom.effects.shapes import {', '.join(used)}"] if used else []
    spans = "Drive, Span" if "Span(" in law else "Drive"
    return "\n".join(
        [
            f'"""{name}: a draft of `werrimbi draft`. Read it, rename it, make it yours."""',
            "",
            "from __future__ import annotations",
            "",
            *imports,
            f"from werrimbi_odom.model.drive import {spans}",
            f"from werrimbi_odom.model.effect import Parameter, {kind}_effect",
            f"from werrimbi_odom.model.motion import {', '.join(sorted({moved, 'Number'}))}",
        ]
    )


def _doc(amount: Amount, seen: Seen, form: Form, drives: int, strength: str) -> str:
    error, per = _ERROR[amount.channel], _PER[amount.per]
    what = "a spot of the floor" if form.kind == "spot" else seen.name
    several = " and " in what
    first = f"{error[:1].upper()}{error[1:]} is off by a share that goes with {what}."
    why = (
        f"That is what {'one drive shows' if drives == 1 else f'{drives} drives show'} "
        f"({strength}): a {form.kind}, of the {per}. "
        "Why it is so, the data cannot say: find the physics, then give this effect its name "
        "and its law."
    )
    # The along channel changes both wheels alike, where it goes with their travel.
    along = "along" if amount.per in ("turn", "duration") else "left and right"
    target = {"left": "left", "right": "right", "along": along, "sideways": "sideways"}
    side = target.get(amount.channel, "turn")
    base = {"travel": "travel", "path": "|travel|", "turn": "turn", "duration": "duration"}
    formula = f"{side} += share * {base[amount.per]};  {form.formula}"
    say = "say" if several else "says"
    how = "with them small and with them large" if several else _TWICE
    how = "forwards and backwards" if what == "direction" else how
    ruler = (
        "drive a taped line across the spot and beside it: the lengths differ; then look at it"
        if form.kind == "spot"
        else f"{what}: {_CHECK[amount.channel].replace(_TWICE, how)}"
    )
    parts = [
        first,
        "",
        textwrap.fill(why, 96),
        "",
        _section("Formula", formula),
        _section("Signature", f"{error} is off where {what} {say} so, by the same share each time"),
        _section("Ruler", ruler),
    ]
    text = "\n".join(parts)
    return f'"""{text}\n"""'


def _section(word: str, text: str) -> str:
    return textwrap.fill(text, 96, initial_indent=f"{word:11}", subsequent_indent=" " * 11)


def _law(amount: Amount, seen: Seen, form: Form, on_wheels: bool) -> list[str]:
    lines: list[str] = []
    sides = {"left": ["left"], "right": ["right"]}.get(amount.channel, ["left", "right"])
    same = not seen.per_wheel and form.kind != "spot"
    if not on_wheels or same:
        lines += _share("share", seen, form, sides[0])
        names = dict.fromkeys(sides, "share")
    else:
        names = {}
        for side in sides:
            variable = f"of_{side}"
            lines += _share(variable, seen, form, side)
            names[side] = variable
    if not on_wheels:
        field = {"along": "along", "sideways": "sideways", "heading": "turn"}[amount.channel]
        lines.append(
            f"return motion._replace({field}=motion.{field} + share * {_BASE[amount.per]})"
        )
        return lines
    terms = {}
    for side in sides:
        travel = f"travel.{side}" if amount.per == "travel" else f"abs(travel.{side})"
        terms[side] = f"travel.{side} + {names[side]} * {travel}"
    if len(sides) == 1:
        lines.append(f"return travel._replace({sides[0]}={terms[sides[0]]})")
    else:
        lines.append(f"return WheelTravel({terms['left']}, {terms['right']})")
    return lines


def _share(variable: str, seen: Seen, form: Form, side: str) -> list[str]:
    """Lines that compute a share; a span that is used twice, or is long, gets a name."""
    if not form.needs_span:
        return [f"{variable} = {form.expression(side)}"]
    seen_as = "seen" if variable == "share" else f"{side}_seen"
    span = form.span or seen.span(side)
    lines = [f"{seen_as} = {span}"]
    if form.harmonic:
        times = "" if form.harmonic == 1 else f"{form.harmonic} * "
        lines.append(f"wave = Span({times}{seen_as}.start + phase, {times}{seen_as}.end + phase)")
    lines.append(f"{variable} = {form.expression(side).replace(span, seen_as)}")
    return lines
