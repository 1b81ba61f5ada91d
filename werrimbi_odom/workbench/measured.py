# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The measured paths, as they stand on the page before anything is compared.

A drawing that needs no program: plotly.js takes a while to begin, and comes while this is looked
at.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Run
from werrimbi_odom.report.decimate import FEWEST, along_path

WIDTH, HEIGHT, EDGE = 720.0, 400.0, 24.0

_POINTS = 3000
"""Of all paths, that are drawn."""


def measured_drawing(runs: Sequence[Run]) -> str | None:
    """The paths from above (SVG) with a bar for the scale; None where no position was measured."""
    paths = [places for run in runs if (places := _places(run)).size]
    if not paths:
        return None
    every = np.concatenate(paths)
    low = complex(every.real.min(), every.imag.min())
    size = complex(every.real.max(), every.imag.max()) - low
    scale = min(
        (WIDTH - 2 * EDGE) / max(size.real, 1e-9), (HEIGHT - 3 * EDGE) / max(size.imag, 1e-9), 1e6
    )
    left = 0.5 * (WIDTH - scale * size.real)
    most = max(FEWEST, _POINTS // len(paths))
    lines = "".join(
        f"M{' '.join(f'{x:.1f} {y:.1f}' for x, y in _drawn(places, most, low, scale, left))}"
        for places in paths
    )
    bar = _round(0.25 * WIDTH / scale)
    end = EDGE + bar * scale
    return (
        f'<svg class="measured" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" '
        'aria-label="The measured paths from above" fill="none" stroke-linejoin="round" '
        f'font-size="14"><path d="{lines}" stroke="var(--grey)" stroke-width="1.5"/>'
        f'<path d="M{EDGE:g} {HEIGHT - 10:g}H{end:.1f}" stroke="currentColor" stroke-width="3"/>'
        f'<text x="{end + 8:.1f}" y="{HEIGHT - 5:g}" fill="currentColor">{bar:g} m</text></svg>'
    )


def _places(run: Run) -> NDArray[np.complex128]:
    if run.reference is None:
        return np.empty(0, dtype=np.complex128)
    places = run.reference.x + 1j * run.reference.y
    return np.asarray(places[np.isfinite(places)], dtype=np.complex128)


def _drawn(
    places: NDArray[np.complex128], most: int, low: complex, scale: float, left: float
) -> list[tuple[float, float]]:
    at = scale * (places[along_path(places, most)] - low)
    y = HEIGHT - 2 * EDGE - at.imag
    return list(zip((left + at.real).tolist(), y.tolist(), strict=True))


def _round(length: float) -> float:
    """1, 2 or 5 times a power of ten, not longer."""
    ten = 10.0 ** math.floor(math.log10(length))
    return next(step * ten for step in (5.0, 2.0, 1.0) if step * ten <= length * (1.0 + 1e-9))
