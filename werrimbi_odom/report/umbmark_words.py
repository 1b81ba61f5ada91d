# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What UMBmark found, in plain words for someone with a tape measure."""

from __future__ import annotations

import math
import textwrap

from werrimbi_odom.inference.calibration.squares import (
    ADVISED_RUNS,
    OTHER_VEHICLES,
    Squares,
    e_max_of_scatter,
    e_max_syst,
)
from werrimbi_odom.inference.calibration.umbmark import NORMAL_95, Estimate, Umbmark
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

DOUBTFUL_P = 0.01
WIDTH = 100

_SIGNS = {
    "wheel_separation_multiplier": "C_B",
    "left_wheel_radius_multiplier": "C_L",
    "right_wheel_radius_multiplier": "C_R",
}


def found_in_words(squares: Squares, result: Umbmark, old: Robot) -> str:
    """Offsets, angles, factors, and what to make of them."""
    lines = [
        f"{len(squares.cw)} clockwise and {len(squares.ccw)} anticlockwise squares of "
        f"{squares.side:g} m: where they ended, measured minus odometry",
        _centre("clockwise", squares.cw),
        _centre("anticlockwise", squares.ccw),
        f"  E_max,syst     {_mm(result.e_max)} mm",
        "",
        _angle("a corner falls short of 90 degrees by", "alpha", result.alpha),
        _angle("a leg bends to the left by", "beta", result.beta),
        f"  (to first order alpha {_mrad(result.angles.alpha_by_x)} by x, "
        f"{_mrad(result.angles.alpha_by_y)} by y; beta {_mrad(result.angles.beta_by_x)} by x, "
        f"{_mrad(result.angles.beta_by_y)} by y)",
        "",
        f"{'':31}{'old':>10}{'correction':>25}{'paper':>12}{'new':>12}",
    ]
    paper = {"C_B": result.paper.base, "C_L": result.paper.left, "C_R": result.paper.right}
    found = {"C_B": result.base, "C_L": result.left, "C_R": result.right}
    for name, new in result.multipliers(old).items():
        sign = _SIGNS[name]
        correction = f"{sign} {found[sign].value:.6f} ± {found[sign].std:.6f}"
        lines.append(
            f"{name:31}{getattr(old, name):10.6f}{correction:>25}{paper[sign]:12.6f}"
            f"{new.value:12.6f}"
        )
    lines.append(
        _filled(
            "The column paper has its own equations, of first order; what is written is exact. A "
            "factor common to both radii does not show in squares: compare a long straight line "
            "with a tape."
        )
    )
    lines += [_filled(doubt) for doubt in _doubts(squares, result)]
    return "\n".join(lines)


def _doubts(squares: Squares, result: Umbmark) -> list[str]:
    lines = []
    if not (_significant(result.base, 1.0) or _significant(result.ratio, 1.0)):
        lines.append(
            "These corrections are no larger than the scatter of the runs explains: base and "
            "radii were right, as far as these squares can tell."
        )
    if result.disagreement_p < DOUBTFUL_P:
        of_alpha, of_beta = result.disagreement
        lines.append(
            f"Careful: x and y disagree (by {_mrad(of_alpha)} about alpha and {_mrad(of_beta)} "
            f"about beta; chance {result.disagreement_p:.1g}). Something besides base and radii "
            "moved the robot: a slip, play in a gear, a start askew."
        )
    if min(len(squares.cw), len(squares.ccw)) < ADVISED_RUNS:
        lines.append(
            f"{ADVISED_RUNS} squares in each sense are usual; with fewer the ± above grows quickly."
        )
    return lines


def gained_in_words(
    result: Umbmark, squares: Squares, later: Squares | None, again: Squares | None
) -> str:
    """E_max,syst after the calibration, and the comparison with other vehicles."""
    lines = [""]
    if later is not None:
        after = e_max_syst(later)
        lines.append(
            f"E_max,syst after the calibration: {_mm(after)} mm, before: {_mm(result.e_max)} mm "
            f"({result.e_max / after:.1f} times smaller)"
            if after < result.e_max
            else f"E_max,syst after the calibration: {_mm(after)} mm, no better than before "
            f"({_mm(result.e_max)} mm): these squares do not confirm it"
        )
        lines.append(
            f"  scatter alone would leave a perfect calibration with about "
            f"{_mm(e_max_of_scatter(later))} mm"
        )
    elif again is not None:
        lines.append(
            f"E_max,syst of the same runs with the new factors: {_mm(e_max_syst(again))} mm; "
            f"scatter alone leaves about {_mm(e_max_of_scatter(again))} mm"
        )
    if later is None:
        lines.append("To see what it gained, drive squares with the new file: --after RESULTS2.csv")
    lines.append("\nE_max,syst of others, on squares of 4 m (paper, Table 2):")
    lines += [f"  {name:34}{1e3 * value:5.0f} mm" for name, value in OTHER_VEHICLES]
    shown, when = (squares, "before") if later is None else (later, "after")
    own, size = f"this robot, {when}, {squares.side:g} m", 1e3 * e_max_syst(shown)
    lines.append(f"  {own:34}{size:5.{1 if size < 10.0 else 0}f} mm")
    return "\n".join(lines)


def _significant(estimate: Estimate, null: float) -> bool:
    return abs(estimate.value - null) > NORMAL_95 * estimate.std


def _centre(sense: str, offsets: Floats) -> str:
    x, y = offsets.mean(axis=0)
    spread_x, spread_y = offsets.std(axis=0, ddof=1)
    return (
        f"  {sense:14} x {_mm(x):>7} mm   y {_mm(y):>7} mm   "
        f"(one run scatters by {_mm(spread_x)} and {_mm(spread_y)} mm)"
    )


def _angle(says: str, sign: str, estimate: Estimate) -> str:
    degrees, std = math.degrees(estimate.value), math.degrees(estimate.std)
    return (
        f"{says:38} {degrees:7.3f} ± {std:.3f} degrees  "
        f"({sign} {_mrad(estimate.value)} ± {_mrad(estimate.std)})"
    )


def _filled(text: str) -> str:
    return textwrap.fill(text, WIDTH)


def _mm(length: float) -> str:
    return f"{1e3 * length:.1f}"


def _mrad(angle: float) -> str:
    return f"{1e3 * angle:.2f} mrad"
