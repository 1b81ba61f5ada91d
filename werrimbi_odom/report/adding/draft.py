# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A draft in words and figures."""

from __future__ import annotations

from typing import Any

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.drafting import Draft
from werrimbi_odom.report.adding.document import figures_of
from werrimbi_odom.report.adding.words import json_of, words_of
from werrimbi_odom.report.document import Document, Paragraph, Shown
from werrimbi_odom.report.numbers import error_words
from werrimbi_odom.report.page import as_html


def draft_words(draft: Draft, tried: Added) -> list[Paragraph]:
    """What was drafted, what the error is with it, and the law."""
    cell, sides = draft.dependence, tried.holdout.sides
    alone = tried.noise_alone(tried.holdout)
    floor = f"noise alone: {error_words(alone, sides.unit)}; " if tried.explained else ""
    headline = "No effect of the library explains these drives."
    text = (
        f"Their {cell.channel} error goes with {cell.name}, and a {draft.form} in it explains them "
        f"best among the simple laws. With it, the error of the held-out drives is "
        f"{error_words(sides.after, sides.unit)} where it was "
        f"{error_words(sides.before, sides.unit)} ({floor}rms over legs of "
        f"{tried.holdout.after.leg:g} m). Why it is so, the data cannot know: read the law, find "
        "the physics, give it its name."
    )
    law = draft.source.partition("\n\n\n")[2].rstrip()
    return [Paragraph(headline), Paragraph(text), Paragraph(law, "code", apart=True)]


def draft_document(draft: Draft, tried: Added) -> Document:
    """Everything that is told; a page has what `add` tells of it too."""
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
    """The figures of `add` for the draft, and what it was made of."""
    cell = draft.dependence
    return {
        **json_of(tried),
        "verdict": draft.diagnosis.verdict,
        "draft": {
            "channel": cell.channel,
            "per": cell.amount.per,
            "variable": cell.name,
            "p_value": cell.p_value,
            "form": draft.form,
            "tried": [
                {"effect": name, "form": form, "cost_beyond_best": cost}
                for name, form, cost in draft.tried
            ],
        },
    }
