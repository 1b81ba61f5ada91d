# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The path on the floor with its 95 % ellipses, and the measured path."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.distributions import CHI2_95
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report import style
from werrimbi_odom.report.style import Figure


@dataclass(frozen=True, slots=True)
class PathDrawing:
    """Data to draw: positions [m], their covariances [m²] and, if measured, the reference."""

    x: Floats
    y: Floats
    covariance: Floats
    """Shape (n, 2, 2)."""
    reference_x: Floats | None = None
    reference_y: Floats | None = None
    title: str = ""
    subtitle: str = ""
    magnified: float | None = None
    """Scale factor of the drawn ellipses; None to choose one that makes them visible."""


def ellipse(
    x: float, y: float, covariance: Floats, *, magnified: float = 1.0, points: int = 73
) -> tuple[Floats, Floats]:
    """Outline of the 95 % ellipse about a point [m]."""
    variances, axes = np.linalg.eigh(covariance)
    radii = magnified * np.sqrt(np.maximum(variances, 0.0) * CHI2_95[2])
    angle = np.linspace(0.0, 2.0 * np.pi, points)
    outline = axes @ (radii[:, None] * np.stack([np.cos(angle), np.sin(angle)]))
    return x + outline[0], y + outline[1]


def spread_along_path(x: Floats, y: Floats, count: int) -> NDArray[np.intp]:
    """Indices of `count` points at equal distances along a path, including the last one."""
    travelled = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    wanted = np.linspace(0.0, travelled[-1], count + 1)[1:]
    return np.unique(np.minimum(np.searchsorted(travelled, wanted), x.size - 1))


def magnification(drawing: PathDrawing) -> float:
    """Scale factor that makes ellipses visible: 1, 2, 5, 10, 20 or 50."""
    extent = max(float(np.ptp(drawing.x)), float(np.ptp(drawing.y)))
    largest = np.sqrt(np.max(np.linalg.eigvalsh(drawing.covariance), initial=0.0) * CHI2_95[2])
    if not largest > 0.0:
        return 1.0
    wanted = 0.1 * extent / largest
    return max((size for size in (1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if size <= wanted), default=1.0)


def path_figure(drawing: PathDrawing) -> Figure:
    """The interactive figure; equal scales on both axes."""
    figure = style.blank()
    magnified = drawing.magnified or magnification(drawing)
    name = "95 % ellipse" if magnified == 1.0 else f"95 % ellipse, drawn {magnified:g} × larger"
    measured = np.empty(0, dtype=np.complex128)
    if drawing.reference_x is not None and drawing.reference_y is not None:
        measured = drawing.reference_x + 1j * drawing.reference_y
    known = measured[np.isfinite(measured)]
    if known.size:
        some, look = measured[style.along_path(measured)], {"color": style.GREY, "width": 5}
        way = some.real, some.imag
        style.plot(figure, *way, "measured", hover=f"measured{_PLACE}", line=look, opacity=0.55)
    for order, index in enumerate(spread_along_path(drawing.x, drawing.y, 16)):
        x, y, shape = drawing.x[index], drawing.y[index], drawing.covariance[index]
        style.plot(
            figure,
            *ellipse(float(x), float(y), shape, magnified=magnified),
            name,
            group="ellipse",
            shown=order == 0,
            line={"color": style.ORANGE, "width": 1.2},
            fill="toself",
            fillcolor="rgba(213, 94, 0, 0.16)",
        )
    look = {"color": style.BLUE, "width": 2}
    style.plot(figure, drawing.x, drawing.y, "odometry", hover=f"odometry{_PLACE}", line=look)
    marks = [
        (complex(drawing.x[0], drawing.y[0]), "start", "circle", style.GREEN),
        (complex(drawing.x[-1], drawing.y[-1]), "end", "square", style.BLUE),
    ]
    if known.size:
        marks.append((complex(known[-1]), "measured end", "x", "black"))
    for at, mark, symbol, colour in marks:
        look = {"symbol": symbol, "size": 11, "color": colour, "line": {"width": 1}}
        add_mark(figure, at, mark, look)
    figure.update_xaxes(title="x [m]", zeroline=False)
    figure.update_yaxes(title="y [m]", zeroline=False)
    return style.styled(figure, drawing.title, drawing.subtitle, width=1000, height=860)


_PLACE = "<br>x %{x:.3f} m<br>y %{y:.3f} m"


def add_path(
    figure: Figure,
    path: NDArray[np.complex128],
    name: str,
    line: Mapping[str, Any],
    *,
    said: str,
    **more: Any,
) -> None:
    """Add a path (x + iy) on the floor, with `said` and the position as hover text."""
    style.plot(figure, *style.places(path), name, hover=said + _PLACE, line=line, **more)


def add_mark(
    figure: Figure, at: complex, name: str, marker: Mapping[str, Any], **more: Any
) -> None:
    """Add a mark at one point (x + iy), such as a start or an end."""
    x, y = [float(at.real)], [float(at.imag)]
    style.plot(figure, x, y, name, hover=name + _PLACE, marker=marker, **more)
