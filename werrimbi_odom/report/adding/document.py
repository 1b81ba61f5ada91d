# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of adding an effect: the error before and after, and what remains."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report import style
from werrimbi_odom.report.adding.words import judged_on, words_of
from werrimbi_odom.report.diagnosis.document import effect_card
from werrimbi_odom.report.diagnosis.evidence_figures import evidence_map_figure
from werrimbi_odom.report.document import Document, Shown
from werrimbi_odom.report.number_format import listed
from werrimbi_odom.report.style import Figure


def document_of(added: Added) -> Document:
    """The complete report."""
    return Document(
        title=f"Added: {listed([effect.name for effect in added.effects])}",
        words=words_of(added),
        draw=lambda: figures_of(added),
    )


def figures_of(added: Added) -> list[Shown]:
    """Figures of the errors, the effects, and the remaining dependences."""
    shown = [
        Shown(
            "falling",
            "The error, step by step",
            "Blue is the error of drives that took no part in the fit. It should fall with the "
            "effect, and reach the dashed line where nothing but noise is left; while something "
            "is still missing there is no such line.",
            {"": error_falling_figure(steps_of(added), added.noise_alone(added.holdout))},
        )
    ]
    if added.holdout.unit == "m":
        shown.append(
            Shown(
                "legs",
                f"Errors of {judged_on(added)}",
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
                "Fields beyond chance are left to explain: werrimbi diagnose with the new robot "
                "file looks for what they are.",
                {"": evidence_map_figure(added.remaining)},
                main=False,
            )
        )
    return shown


@dataclass(frozen=True, slots=True)
class ErrorOfModel:
    """Leg errors of one of the compared models."""

    name: str
    """Last change of the model: as given, calibrated, + an effect."""
    train: float
    """Root mean square error on the drives of the fit."""
    holdout: float
    """Root mean square error on the held-out drives."""
    unit: str = "m"
    """m for positions; rad for headings, if only these were measured."""


def steps_of(added: Added) -> list[ErrorOfModel]:
    """Errors of the model as given, calibrated, and with the effects."""
    names = [("as given", "before"), (f"+ {added.name.replace(',', ', ')}", "after")]
    if not added.is_calibration:
        names.insert(1, ("calibrated", "calibrated"))
    return [
        ErrorOfModel(name, added.train.error(which), added.holdout.error(which), added.holdout.unit)
        for name, which in names
    ]


def error_falling_figure(steps: Sequence[ErrorOfModel], floor: float) -> Figure:
    """Bars of the errors in each step, and a line at the error by noise alone.

    `floor` is that error, of positions on the held-out drives [m]; NaN to omit the line.
    """
    figure = style.blank()
    largest = max(
        (value for step in steps for value in (step.train, step.holdout) if np.isfinite(value)),
        default=1.0,
    )
    unit, factor = ("m", 1.0) if largest > 0.1 else ("mm", 1e3)
    of_headings = bool(steps) and steps[0].unit == "rad"
    if of_headings:
        unit, factor = "°", np.degrees(1.0)
    names = [style.escaped(step.name) for step in steps]
    for name, values, ink, look in (
        (
            "drives of the fit",
            [factor * step.train for step in steps],
            style.INK,
            {"color": style.paled(style.GREY, 0.25), "line": {"color": style.GREY, "width": 1.5}},
        ),
        (
            "held-out drives",
            [factor * step.holdout for step in steps],
            style.PAPER,
            {"color": style.BLUE},
        ),
    ):
        figure.add_bar(
            x=names,
            y=values,
            name=name,
            marker=look,
            text=[f"{value:.2f}" if np.isfinite(value) else "" for value in values],
            # At the foot of the bars, because the line may cross their heads.
            textposition="inside",
            insidetextanchor="start",
            textangle=0,
            textfont={"size": 15, "color": ink},
            hovertemplate=f"%{{x}}, {name}<br>%{{y:.3g}} {unit}<extra></extra>",
        )
    if np.isfinite(floor):
        line = {"color": style.GREEN, "width": 2.5, "dash": "dash"}
        figure.add_hline(y=factor * floor, line=line)
        words = f"floor: what noise alone leaves, {factor * floor:.2f} {unit}"
        style.plot(figure, [None], [None], words, hover=None, line=line)
    figure.update_yaxes(title=f"error of a leg, rms [{unit}]", range=[0.0, 1.16 * factor * largest])
    figure.update_xaxes(showgrid=False)
    style.plain(figure, height=420)
    return figure.update_layout(barmode="group", bargap=0.35)


def held_out_legs_figure(added: Added) -> Figure:
    """Along and sideways errors of the held-out legs, as given and with the effect."""
    clouds = [
        (name, legs.errors.error[~legs.outlier], colour, symbol)
        for name, legs, colour, symbol in (
            ("as given", added.holdout.before, style.ORANGE, "x"),
            (f"with {added.name.replace(',', ', ')}", added.holdout.after, style.BLUE, "circle"),
        )
    ]
    return clouds_of_legs(clouds, digits=2, height=560)


def clouds_of_legs(
    clouds: Iterable[tuple[str, Floats, str, str]], *, digits: int, height: int
) -> Figure:
    """Scatter plot of leg errors for several models, with their medians; equal scales.

    Clouds are (name, errors, colour, symbol), with errors along and sideways [m], shape (m, 2) or
    more columns, NaN if not measured. `digits`: decimals of millimetres.
    """
    figure = style.blank()
    for name, errors, colour, symbol in clouds:
        known = 1e3 * errors[np.isfinite(errors[:, :2]).all(axis=1)]
        if known.size == 0:
            continue
        size = np.hypot(known[:, 0], known[:, 1])
        drawn = known[style.spread_and_extremes(size, style.MARKS // 2)]
        style.plot(
            figure,
            style.small(drawn[:, 0]),
            style.small(drawn[:, 1]),
            f"{name}: median {np.median(size):.{digits}f} mm",
            marker={"color": style.paled(colour, 0.75), "symbol": symbol, "size": 8},
            hover=f"{style.escaped(name)}<br>along %{{x:.{digits}f}} mm"
            f"<br>sideways %{{y:.{digits}f}} mm",
        )
    return style.from_above(figure, height, "error along [mm]", "error sideways [mm]")
