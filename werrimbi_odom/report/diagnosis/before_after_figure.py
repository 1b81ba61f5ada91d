# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The first candidate's own variable: what the error does along it before, and after."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.support import support_of
from werrimbi_odom.inference.diagnosis.variables import CONSTANT
from werrimbi_odom.inference.fitting.candidates import CALIBRATED
from werrimbi_odom.inference.fitting.design import Point
from werrimbi_odom.inference.fitting.knobs import CALIBRATION, Knob, Model
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.diagnosis.evidence_figures import amount_words, variable_words
from werrimbi_odom.report.diagnosis.response import Response, parts_of, response, unit_of
from werrimbi_odom.report.style import BLUE, GREY, ORANGE, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go

_FOR_CALIBRATION = {
    "track_width": ("heading", "turn", ("yaw_rate", "yaw_rate_size")),
    "unequal_wheel_radii": ("heading", "travel", ("speed", "distance")),
    "wheel_radius_scale": ("along", "travel", ("speed", "distance")),
}
"""Channel, amount and variable along which a wrong size is seen, as a line off zero."""


@dataclass(frozen=True)
class BeforeAfter:
    """What the figure shows."""

    effect: str | None
    """None: no effect of the library; what the error goes with, alone."""
    cell: Dependence
    before: Response
    after: Response | None
    turns: bool
    aligned: bool
    """Whether each run's angle was shifted by the phase that was found for it."""


def before_after(diagnosis: Diagnosis) -> BeforeAfter | None:
    """The error along the variable of what was found first; None where there is none to show.

    Set-up mistakes have none: see `set_up_figure`.
    """
    effect = diagnosis.effect or (diagnosis.rivals[0] if diagnosis.rivals else None)
    if any(finding.effect == effect for finding in diagnosis.set_up.findings):
        return None
    cell = _own_cell(diagnosis, effect)
    if cell is None or cell.form == "place":
        return None
    start = diagnosis.rounds[0].before
    point, knobs = start.point, (*CALIBRATION, *start.knobs)
    if effect in CALIBRATED:
        own = tuple({} for _ in point.model.own) if not start.knobs else point.model.own
        point = replace(point, model=Model(diagnosis.set_up.robot, own))
        knobs = start.knobs
    after = _after(diagnosis, effect) if effect is not None else None
    values, aligned = _values(diagnosis, cell, effect, after)
    turns = cell.form == "turns"
    edges = parts_of(*values, turns=turns)

    def at(where: Point, free: tuple[Knob, ...]) -> Response:
        return response(diagnosis.runs, where, diagnosis.kind, free, cell.amount, values, edges)

    return BeforeAfter(
        effect,
        cell,
        at(point, knobs),
        None if after is None else at(after, knobs),
        turns,
        aligned,
    )


def _own_cell(diagnosis: Diagnosis, effect: str | None) -> Dependence | None:
    """The cell of the evidence map that the effect is about; without one, the strongest cell."""
    cells = [cell for cell in diagnosis.depends_on if cell.variable.name != CONSTANT]
    by_worth = sorted(cells, key=lambda cell: 2 * cell.degrees - cell.gain)
    if not by_worth:
        return None
    if effect is None:
        return by_worth[0] if diagnosis.verdict == "unknown" else None
    if effect in _FOR_CALIBRATION:
        channel, per, names = _FOR_CALIBRATION[effect]
        for name in names:
            for cell in by_worth:
                if (cell.amount.channel, cell.amount.per, cell.variable.name) == (
                    channel,
                    per,
                    name,
                ):
                    return cell
        return None
    for this in diagnosis.rounds:
        for score in this.scores:
            if score.candidate.name != effect:
                continue
            drive = diagnosis.runs.drive(this.before.point.model.robot)
            support = support_of(score.candidate, drive)
            own = [
                cell
                for cell in by_worth
                if cell.channel in support.outputs
                and set(cell.variable.looks_at) & support.inputs
                and cell.form != "place"
            ]
            return own[0] if own else by_worth[0]
    return by_worth[0]


def _after(diagnosis: Diagnosis, effect: str) -> Point | None:
    """The fitted model that holds the effect."""
    if effect in diagnosis.final.names or effect in diagnosis.found:
        return diagnosis.final.point
    for this in diagnosis.rounds:
        for fit in this.tried:
            if fit.names[-1] == effect:
                return fit.point
    return None


def _values(
    diagnosis: Diagnosis, cell: Dependence, effect: str | None, after: Point | None
) -> tuple[tuple[Floats, Floats], bool]:
    """The variable at every step; angles from where the fitted phase of each run puts them."""
    variable = cell.variable
    if cell.form != "turns":
        return (variable.left, variable.right), False
    run = diagnosis.runs.run_of_step
    shift = np.zeros(run.size)
    aligned = False
    if variable.per_run and effect is not None and after is not None:
        for applied in after.model.robot.effects:
            if applied.name == effect and applied.effect.quadrature is not None:
                phase = applied.effect.quadrature[1]
                key, shared = f"{effect}.{phase}", applied.values[phase]
                own = [mine.get(key, shared) for mine in after.model.own]
                shift, aligned = np.array(own)[run], True
    if variable.per_run and not aligned:
        waves = np.atleast_2d(cell.coefficients)
        peaks = np.arctan2(waves[:, 1], waves[:, 0]) / variable.harmonic
        shift, aligned = -peaks[run], True
    angle = np.mod(variable.left + shift, 2.0 * np.pi)
    return (angle, angle), aligned


def before_after_figure(found: BeforeAfter) -> go.Figure:
    """Error along the variable with error bars, before (and after)."""
    import plotly.graph_objects as go

    unit, factor = unit_of(found.cell.amount)
    scale = float(np.degrees(1.0)) if found.turns else 1.0
    figure = go.Figure()
    words = f"with {found.effect}" if found.effect else ""
    for name, item, colour, symbol, dash in (
        (
            "before: calibrated alone" if found.effect not in CALIBRATED else "before: as given",
            found.before,
            ORANGE,
            "square",
            "dot",
        ),
        (f"after: {words}", found.after, BLUE, "circle", "solid"),
    ):
        if item is None:
            continue
        figure.add_scatter(
            x=scale * item.centre,
            y=factor * item.value,
            mode="lines+markers",
            name=name if found.effect else "what the error goes with",
            line={"color": colour, "width": 2, "dash": dash},
            marker={"color": colour, "symbol": symbol, "size": 9},
            error_y={
                "array": 2.0 * factor * item.std,
                "color": colour,
                "thickness": 1.5,
                "width": 5,
            },
            hovertemplate=(
                f"%{{x:.3g}}: %{{y:+.3g}} ± %{{error_y.array:.2g}} {unit}<extra>{name}</extra>"
            ),
        )
    figure.add_hline(y=0.0, line={"color": GREY, "width": 1})
    label = variable_words(found.cell.variable.name)
    if found.turns:
        label += ", from where the fit puts its zero [°]" if found.aligned else " [°]"
        figure.update_xaxes(dtick=45, range=[0, 360])
    elif found.cell.variable.unit:
        label += f" [{found.cell.variable.unit}]"
    figure.update_xaxes(title=label)
    figure.update_yaxes(title=f"{amount_words(found.cell.amount)}<br>[{unit}]")
    return plain(figure, height=430)
