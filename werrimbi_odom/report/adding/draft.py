# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a draft, in words and figures."""

from __future__ import annotations

from typing import Any

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.drafting.draft import Draft
from werrimbi_odom.inference.drafting.formula import symbols_of
from werrimbi_odom.report.adding.as_json import json_of
from werrimbi_odom.report.adding.document import figures_of
from werrimbi_odom.report.adding.words import judged_on, value_told, words_of
from werrimbi_odom.report.document import Document, Paragraph, Shown
from werrimbi_odom.report.html_page import as_html
from werrimbi_odom.report.number_format import error_words, picked
from werrimbi_odom.report.phrases import leg_words


def draft_words(draft: Draft, tried: Added) -> list[Paragraph]:
    """The dependence, the error with the drafted law, and its source."""
    sides = tried.holdout.sides
    alone = tried.noise_alone(tried.holdout)
    judges = judged_on(tried)
    floor = f"noise alone: {error_words(alone, sides.unit)}; " if tried.explained else ""
    headline = "No effect of the library explains these drives."
    text = (
        f"{_what_it_goes_with(draft, judges)} With it, the error of {judges} is "
        f"{error_words(sides.after, sides.unit)} where it was "
        f"{error_words(sides.before, sides.unit)} ({floor}rms over legs of "
        f"{leg_words(sides.length, tried.holdout.after.leg)} m). Why it is so, the data cannot "
        "know: read the law, find the physics, give it its name."
    )
    law = draft.source.partition("\n\n\n")[2].rstrip()
    sizes = [
        f"{name} = {value_told(item)}"
        for name, item in tried.parameters.items()
        if item.value is not None and item.std is not None
    ]
    fitted = (
        [f"Fitted: {', '.join(sizes)}. In the file it is rounded, for fits to begin at."]
        if sizes
        else []
    )
    return [
        Paragraph(headline),
        Paragraph(text),
        *map(Paragraph, fitted),
        Paragraph(law, "code", apart=True),
    ]


def _what_it_goes_with(draft: Draft, judges: str) -> str:
    """The dependence and its law; for two variables also the gain over a law of one.

    `judges`: the name of what judged that.
    """
    claim, two = draft.claim, draft.of_two
    symbols = symbols_of(claim.amount, draft.law)
    law = f": {draft.law} (each second{'; ' * bool(symbols)}{symbols})" if draft.law else ""
    if two is None:
        return (
            f"Their {claim.channel} error goes with {claim.variable}, and a {draft.form} in it "
            f"explains them best among the simple laws{law}."
        )
    kind = "" if "sum" in draft.form else f", a {draft.form}"
    text = f"Their {claim.channel} error goes with {claim.variable}{kind}{law}."
    sides = two.held_out
    if sides is None:
        return text
    alone = "calibration alone leaves"
    if two.one is not None:
        alone = f"a law of {two.one.claim.variable} alone, the best of one variable, leaves"
    chance = max(sides.chance, 1e-300)
    return (
        f"{text} On {judges} {alone} {error_words(sides.after, sides.unit)} (chance "
        f"{chance:.0e}; the law was chosen from {two.terms_tried} terms on the others)."
    )


def draft_document(draft: Draft, tried: Added) -> Document:
    """The complete report, including that of `add` for the draft."""
    return Document(
        title=f"Drafted: {draft.name}",
        words=draft_words(draft, tried),
        draw=lambda: [
            *figures_of(tried),
            Shown(
                "added",
                "What adding it would do",
                "Its values, the error before and after, and what is left.",
                html=as_html(words_of(tried)),
                main=False,
            ),
        ],
    )


def draft_json(draft: Draft, tried: Added) -> dict[str, Any]:
    """JSON of `add` for the draft, and the origin of the draft."""
    claim = draft.claim
    return {
        **json_of(tried),
        "verdict": draft.diagnosis.verdict,
        "draft": {
            **picked(claim, "channel per:amount.per variable p_value"),
            "form": draft.form,
            "law": draft.law or None,
            "of_two": _json_of_two(draft),
            "tried": [
                {"effect": name, "form": form, "cost_beyond_best": cost}
                for name, form, cost in draft.tried
            ],
        },
    }


def _json_of_two(draft: Draft) -> dict[str, Any] | None:
    """JSON of a law of two variables, and of the law of one variable that it is compared with."""
    two = draft.of_two
    if two is None:
        return None
    one, sides = two.one, two.held_out
    return {
        **picked(two, "variables terms_tried"),
        "one": one and {"effect": one.name, "variable": one.claim.variable, "form": one.form},
        "held_out_with_one": sides and sides.after,
        "held_out_with_two": sides and sides.before,
        "chance": sides and sides.chance,
    }
