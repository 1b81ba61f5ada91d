# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of UMBmark in words for users with a tape measure, and as JSON."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.squares import (
    OTHER_VEHICLES,
    Squares,
    e_max_of_scatter,
    e_max_syst,
)
from werrimbi_odom.inference.calibration.umbmark import Umbmark, ValueAndStd
from werrimbi_odom.inference.distributions import NORMAL_95
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.document import Paragraph, Part, Table, paragraphs
from werrimbi_odom.report.number_format import picked, scaled_with_std, two_digits


def found_in_words(squares: Squares, result: Umbmark, old: Robot) -> list[Part]:
    """Verdict, offsets, angles, correction factors, and doubts."""
    exact = (
        "What is written is exact; the paper's equations are of first order. A factor common to "
        "base and both radii does not show in squares: compare a long straight line with a tape."
    )
    return [
        *paragraphs(_verdict(squares, result)),
        Table(
            f"Ends of squares of {squares.side:g} m, measured minus odometry",
            ("", "squares", "x [mm]", "y [mm]", "one scatters by"),
            [_centre("clockwise", squares.cw), _centre("anticlockwise", squares.ccw)],
        ),
        _angles(result),
        _factors(result, old),
        *paragraphs([exact, *_doubts(squares, result)], apart=True),
    ]


def _verdict(squares: Squares, result: Umbmark) -> list[str]:
    base, ratio = result.base, result.ratio
    base_off, radii_off = _significant(base), _significant(ratio)
    size = f"E_max,syst is {_mm(result.e_max)} mm on squares of {squares.side:g} m"
    open_ = not (base_off or radii_off)
    if open_ and (result.disagreement_p < rules.SURE_WHEN_ASKED or _across(squares, result)):
        few = "" if _enough(squares) else " Or so few squares scatter more than they show."
        return [
            f"Base and radii do not explain where these squares ended: {size}, and x and y "
            f"disagree. Are cw and ccw exchanged, or is y positive to the right?{few}"
        ]
    if open_:
        tell = [two_digits(100.0 * NORMAL_95 * factor.std) for factor in (base, ratio)]
        return [
            f"These squares determine no correction: {size}, no more than the scatter of the "
            f"runs explains. They tell the base to {tell[0]} % and the ratio of the radii to "
            f"{tell[1]} % (95 %), and what is written differs by less: keep the robot file, or "
            "drive more squares."
        ]
    what = "Base and radii are" if base_off and radii_off else "The base is"
    lines = [f"{what if base_off else 'The radii are'} off: {size}."]
    if base_off:
        large = base.value > 1.0
        lines.append(
            f"- The wheels stand {_share(base)} {'farther apart' if large else 'closer together'} "
            f"than the robot file says: at each corner it turns too {'little' if large else 'far'}."
        )
    if radii_off:
        larger, bend = ("right", "left") if ratio.value > 1.0 else ("left", "right")
        lines.append(
            f"- The {larger} wheel is larger against the other than the file says, by "
            f"{_share(ratio)}: what should be straight bends to the {bend}."
        )
    return lines


def _enough(squares: Squares) -> bool:
    return min(len(squares.cw), len(squares.ccw)) >= rules.ADVISED_SQUARES


def _across(squares: Squares, result: Umbmark) -> bool:
    """Whether most of the offsets is none of base and radii, and more than the scatter leaves.

    Few squares prove that at no level: their test has hardly a degree of freedom.
    """
    explained = math.hypot(result.alpha.value, result.beta.value)
    most = 0.5 * math.hypot(*result.disagreement) > explained
    return most and result.e_max > rules.MORE_THAN_SCATTER * e_max_of_scatter(squares)


def _centre(sense: str, offsets: Floats) -> list[str]:
    x, y = offsets.mean(axis=0)
    spread_x, spread_y = offsets.std(axis=0, ddof=1)
    return [sense, str(len(offsets)), _mm(x), _mm(y), f"{_mm(spread_x)}, {_mm(spread_y)}"]


def _angles(result: Umbmark) -> Table:
    first = result.angles
    rows = [
        _angle("alpha: a corner falls short", result.alpha, first.alpha_by_x, first.alpha_by_y),
        _angle("beta: a leg bends to the left", result.beta, first.beta_by_x, first.beta_by_y),
    ]
    return Table("Angles", ("", "[degrees]", "[mrad]", "by x alone", "by y"), rows)


def _angle(says: str, estimate: ValueAndStd, by_x: float, by_y: float) -> list[str]:
    degrees, std = math.degrees(estimate.value), math.degrees(estimate.std)
    return [
        says,
        f"{degrees:.3f} ± {std:.3f}",
        f"{1e3 * estimate.value:.2f} ± {1e3 * estimate.std:.2f}",
        f"{1e3 * by_x:.2f}",
        f"{1e3 * by_y:.2f}",
    ]


def _factors(result: Umbmark, old: Robot) -> Table:
    paper, multipliers = result.paper, result.multipliers(old)
    rows = [
        [
            full,
            f"{getattr(old, full):.6f}",
            f"{found.value:.6f} ± {found.std:.6f}",
            f"{by_paper:.6f}",
            f"{multipliers[full].value:.6f}",
        ]
        for full, found, by_paper in (
            ("wheel_separation_multiplier", result.base, paper.base),
            ("left_wheel_radius_multiplier", result.left, paper.left),
            ("right_wheel_radius_multiplier", result.right, paper.right),
        )
    ]
    return Table("Corrections C_B, C_L, C_R", ("", "old", "correction", "by paper", "new"), rows)


def _doubts(squares: Squares, result: Umbmark) -> list[str]:
    lines = []
    if result.disagreement_p < rules.SURE_WHEN_ASKED:
        of_alpha, of_beta = result.disagreement
        lines.append(
            f"Careful: x and y disagree (by {_mrad(of_alpha)} about alpha and {_mrad(of_beta)} "
            f"about beta; chance {result.disagreement_p:.1g}). Something besides base and radii "
            "moved the robot: a slip, play in a gear, a start askew."
        )
    if not _enough(squares):
        lines.append(
            f"{rules.ADVISED_SQUARES} squares in each sense are usual; with fewer the ± above "
            "grows quickly."
        )
    return lines


def gained_in_words(
    result: Umbmark, squares: Squares, later: Squares | None, again: Squares | None
) -> list[Part]:
    """E_max,syst after the calibration, and of other vehicles (paper, Table 2)."""
    parts = []
    if later is not None:
        after = e_max_syst(later)
        times = f" ({result.e_max / after:.1f} times smaller)" if after > 0.0 else ""
        parts.append(
            f"E_max,syst after the calibration: {_mm(after)} mm, before: {_mm(result.e_max)} mm"
            f"{times}."
            if after < result.e_max
            else f"E_max,syst after the calibration: {_mm(after)} mm, no better than before "
            f"({_mm(result.e_max)} mm): these squares do not confirm it."
        )
        parts.append(
            "Scatter alone would leave a perfect calibration with about "
            f"{_mm(e_max_of_scatter(later))} mm."
        )
    elif again is not None:
        parts.append(
            f"E_max,syst of the same runs with the new factors: {_mm(e_max_syst(again))} mm; "
            f"scatter alone leaves about {_mm(e_max_of_scatter(again))} mm."
        )
    if later is None:
        parts.append(
            "To see what it gained, drive squares with the new file, and run this again with "
            "`--after RESULTS2.csv`."
        )
    shown, when = (squares, "before") if later is None else (later, "after")
    rows = [[name, f"{1e3 * value:.0f} mm"] for name, value in OTHER_VEHICLES]
    size = 1e3 * e_max_syst(shown)
    rows.append(
        [f"this robot, {when}, {squares.side:g} m", f"{size:.{1 if size < 10.0 else 0}f} mm"]
    )
    others = Table("Others on squares of 4 m", ("", "E_max,syst"), rows)
    return [Paragraph(" ".join(parts), apart=True), others]


def _significant(factor: ValueAndStd) -> bool:
    return abs(factor.value - 1.0) > NORMAL_95 * factor.std


def _share(factor: ValueAndStd) -> str:
    """Difference of a factor from 1 in percent."""
    return f"{scaled_with_std(100.0 * abs(factor.value - 1.0), 100.0 * factor.std)} %"


def _mm(length: float) -> str:
    return f"{1e3 * length:.1f}"


def _mrad(angle: float) -> str:
    return f"{1e3 * angle:.2f} mrad"


def umbmark_json(
    squares: Squares, result: Umbmark, old: Robot, later: Squares | None, again: Squares | None
) -> dict[str, Any]:
    """Complete result; `later` and `again` as in `gained_in_words`."""

    def centres(of: Squares) -> dict[str, Any]:
        return {"cw": of.cw.mean(axis=0), "ccw": of.ccw.mean(axis=0)}

    angles = "alpha_rad:alpha alpha_by_x_rad:alpha_by_x alpha_by_y_rad:alpha_by_y"
    return {
        "parameters": {name: asdict(each) for name, each in result.multipliers(old).items()},
        "e_max_syst_m": {
            "before": result.e_max,
            "after": later and e_max_syst(later),
            "same_runs_corrected": again and e_max_syst(again),
        },
        "e_max_of_scatter_m": {
            "before": e_max_of_scatter(squares),
            "after": later and e_max_of_scatter(later),
        },
        "centre_of_gravity": centres(squares),
        "centre_of_gravity_after": later and centres(later),
        "side_m": squares.side,
        "runs": {"cw": len(squares.cw), "ccw": len(squares.ccw)},
        "alpha_rad": asdict(result.alpha),
        "beta_rad": asdict(result.beta),
        "E_d": asdict(result.ratio),
        "C_B": asdict(result.base),
        "C_L": asdict(result.left),
        "C_R": asdict(result.right),
        "first_order": {
            **picked(result.angles, angles),
            **picked(result.angles, angles.replace("alpha", "beta")),
            **picked(result.paper, "E_d:ratio C_B:base C_L:left C_R:right"),
        },
        "disagreement_p": result.disagreement_p,
    }
