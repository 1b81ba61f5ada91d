# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Figure of an error over the variable that it goes with, before and after an effect is added."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.response_curve import BeforeAfter
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.report import style
from werrimbi_odom.report.diagnosis.dependence import error_of, label_of, unit_of
from werrimbi_odom.report.style import Figure


def before_after_figure(found: BeforeAfter) -> Figure:
    """Error over the variable with error bars, before (and after)."""
    unit, factor = unit_of(found.cell.amount)
    scale = float(np.degrees(1.0)) if found.turns else 1.0
    figure = style.blank()
    words = f"with {found.effect}" if found.effect else ""
    before = "calibrated alone" if found.effect not in CALIBRATED else "as given"
    for name, item, colour, symbol, dash in (
        (f"before: {before}", found.before, style.ORANGE, "square", "dot"),
        (f"after: {words}", found.after, style.BLUE, "circle", "solid"),
    ):
        if item is None:
            continue
        style.plot(
            figure,
            scale * item.centre,
            factor * item.value,
            name if found.effect else "what the error goes with",
            hover=f"%{{x:.3g}}: %{{y:+.3g}} ± %{{error_y.array:.2g}} {unit}<extra>{name}</extra>",
            line={"color": colour, "width": 2, "dash": dash},
            marker={"color": colour, "symbol": symbol, "size": 9},
            error_y=style.error_bars(2.0 * (factor * item.std), colour, 1.5),
        )
    label = labelled(found.cell)
    if found.turns and found.aligned:
        label = label.replace(" [°]", ", from where the fit puts its zero [°]")
    error = f"{error_of(found.cell.amount)}<br>[{unit}]"
    return style.over(figure, label, error, 430, turn=found.turns)


def labelled(cell: Dependence) -> str:
    """The variable with its unit."""
    unit = "°" if cell.form == "turns" else cell.variable.unit
    name = label_of(cell.variable.name)
    return f"{name} [{unit}]" if unit else name
