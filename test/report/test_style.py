# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The layout of a figure for a page: on all of its axes, beside what the figure set itself."""

from __future__ import annotations

import pytest

pytest.importorskip("plotly")

from plotly.subplots import make_subplots

from werrimbi_odom.report import style


def test_every_axis_is_laid_out_and_what_was_set_stays() -> None:
    figure = make_subplots(rows=2, cols=1, subplot_titles=["above", "below"])
    figure.update_layout(margin={"r": 90, "pad": 3}, barmode="stack")
    figure.update_xaxes(title="time [s]", gridcolor="#123456", row=2, col=1)
    layout = style.plain(figure, height=300, legend=False).layout
    for axis in (layout.xaxis, layout.xaxis2, layout.yaxis, layout.yaxis2):
        assert (axis.gridcolor, axis.ticks, axis.automargin) == (style.FAINT, "outside", True)
        assert axis.domain is not None, "where it is, as given"
    assert layout.xaxis2.title.text == "time [s]"
    assert (layout.margin.r, layout.margin.l, layout.margin.pad) == (20, 70, 3)
    assert (layout.barmode, layout.height, layout.showlegend) == ("stack", 300, False)
    assert [(note.text, note.font.color) for note in layout.annotations] == [
        ("above", style.INK),
        ("below", style.INK),
    ]


@pytest.mark.parametrize("turn", [True, False])
def test_a_line_at_zero_lies_beside_other_lines(turn: bool) -> None:
    figure = style.blank()
    style.plot(figure, [0.0, 90.0], [1.0, -1.0], "wave", line={"color": style.BLUE})
    figure.add_hline(y=0.5)
    layout = style.over(figure, "angle [°]", "error [mm]", 360, turn=turn).layout
    assert [(line.y0, line.y1, line.xref) for line in layout.shapes] == [
        (0.5, 0.5, "x domain"),
        (0.0, 0.0, "x domain"),
    ]
    assert (layout.xaxis.title.text, layout.yaxis.title.text) == ("angle [°]", "error [mm]")
    assert layout.xaxis.range == ((0, 360) if turn else None)
