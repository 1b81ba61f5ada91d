# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of adding an effect: the error before and after, and what is left."""

from __future__ import annotations

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.report.adding.figures import (
    error_falling_figure,
    held_out_legs_figure,
    steps_of,
)
from werrimbi_odom.report.adding.words import words_of
from werrimbi_odom.report.diagnosis.document import effect_card
from werrimbi_odom.report.diagnosis.evidence_figures import evidence_map_figure
from werrimbi_odom.report.document import Document, Shown
from werrimbi_odom.report.numbers import listed


def document_of(added: Added) -> Document:
    """Everything that is told."""
    return Document(
        title=f"Added: {listed([effect.name for effect in added.effects])}",
        words=words_of(added),
        draw=lambda: figures_of(added),
    )


def figures_of(added: Added) -> list[Shown]:
    """The error falling, and what is left."""
    shown = [
        Shown(
            "falling",
            "The error, step by step",
            "Blue is the error of drives that took no part in the fit. It should fall with the "
            "effect, and reach the dashed line where nothing but noise is left; while something "
            "is still missing there is no such line.",
            {"": error_falling_figure(steps_of(added), added.noise_alone(added.holdout))},
        ),
    ]
    if added.holdout.unit == "m":
        shown.append(
            Shown(
                "legs",
                "Errors of the held-out drives",
                "Each mark is a leg; with the effect the cloud should be smaller and about zero.",
                {"": held_out_legs_figure(added)},
            )
        )
    cards = "".join(effect_card(effect) for effect in added.effects)
    shown.append(
        Shown(
            "physics",
            "What was added",
            "The physics, what it does to the data, and how to check it on the robot.",
            html=f'<div class="cards">{cards}</div>',
            main=False,
        )
    )
    if added.remaining:
        shown.append(
            Shown(
                "remaining",
                "What the errors still go with",
                "Fields beyond chance are left to explain: `werrimbi diagnose` with the new robot "
                "file looks for what they are.".replace("`", ""),
                {"": evidence_map_figure(added.remaining)},
                main=False,
            )
        )
    return shown
