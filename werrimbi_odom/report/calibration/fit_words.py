# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a calibration from arbitrary drives, in words, a table and JSON."""

from __future__ import annotations

from typing import Any

from werrimbi_odom.inference.calibration.any_driving import Calibration
from werrimbi_odom.inference.fitting.noise import LARGEST_NOISE
from werrimbi_odom.report.diagnosis.dependence import dependence_words
from werrimbi_odom.report.diagnosis.evidence_figures import ordered_cells
from werrimbi_odom.report.document import Paragraph, Part, Table, paragraphs
from werrimbi_odom.report.number_format import capital, counted, listed, picked, scaled_with_std
from werrimbi_odom.report.phrases import held_law_words

_MOST = 3  # dependences that are reported
_UNITS = {
    "left_wheel_noise": "m^0.5",
    "right_wheel_noise": "m^0.5",
    "reference_sigma_xy": "m",
    "reference_sigma_yaw": "rad",
    "reference_sigma_stamp": "s",
    "reference_walk_xy": "m/s^0.5",
    "reference_walk_yaw": "rad/s^0.5",
    "reference_reversion": "1/s",
}


def fit_in_words(result: Calibration) -> list[Part]:
    """Whether the model explains the drives, the values, and how reliable they are."""
    said = []
    if result.twin:
        said.append(_twin_words(result))
    elif held := [name for name in result.fit.held if name != "wheel_radius_scale"]:
        said.append(f"What these drives do not determine is left as it was: {listed(held)}.")
    if unwritten := [name for name in _UNITS if _strange(result, name)]:
        stays = "stays as it was" if len(unwritten) == 1 else "stay as they were"
        said.append(
            f"{capital(listed(unwritten))} {stays} in the robot file: a noise that no wheel has "
            "is not written."
        )
    if result.misfit and any(name.endswith("wheel_noise") for name in result.changes):
        said.append(
            "What is missing is part of the wheels' noise that is written, so that the covariance "
            "holds it: fit that noise again when a model explains the drives."
        )
    if left_out := _left_out(result):
        legs, were = counted(left_out, "leg"), "was" if left_out == 1 else "were"
        said.append(
            f"{legs} on which the reference jumped {were} left out."
            if result.trusted
            else f"{legs} {were} left out: either the reference jumped there, or what is missing "
            "shows most there."
        )
    if not result.trusted:
        said.append(
            "These values are the best of a model that does not fit, so they have no error bars. "
            "`werrimbi diagnose` says which physical effect explains the drives, or what is set up "
            "wrongly: how the reference is mounted, its axes, its clock."
            + (_absolute(result) if result.fit.point.options.reference_kind == "absolute" else "")
        )
    return [*_verdict(result), _values(result), *paragraphs(said, apart=True)]


def _absolute(result: Calibration) -> str:
    return (
        " If it names nothing, it may be the reference that wanders, as a camera does (give "
        f"--reference-kind local_map here too){held_law_words(result.robot)}."
    )


def _twin_words(result: Calibration) -> str:
    base, left, right = result.twin.values()
    return (
        "Headings, and drives that end where they began, hold two numbers, the right and the left "
        "radius over the base. The radii's mean is left as it was; their ratio and the base are "
        f"fitted. Or else the base is right as it was ({base:.6f}), and the radii are {left:.6f} "
        f"and {right:.6f}: these drives cannot tell. A taped distance can."
    )


def _strange(result: Calibration, name: str) -> bool:
    noise = result.noises.get(name)
    return (
        name.endswith("wheel_noise")
        and noise is not None
        and (noise.determined and name not in result.changes)
    )


def _verdict(result: Calibration) -> tuple[Paragraph, ...]:
    if result.trusted:
        return paragraphs(["The model explains these drives to their noise."])
    lines = ["Something else is missing: calibration does not explain these drives."]
    lines += [f"- {words}." for words in result.strange]
    strongest = ordered_cells(result.misfit)[:_MOST]
    lines += [f"- {capital(dependence_words(cell))}." for cell in strongest]
    return paragraphs(lines)


def _values(result: Calibration) -> Table:
    rows = []
    for name, item in result.multipliers.items():
        value = f"{item.value:.6f}"
        if item.std is not None:
            value += f" ± {item.std:.6f}"
        rows.append([name, f"{item.before:.6f}", value if item.determined else "not determined"])
    for name, noise in result.noises.items():
        unit = _UNITS[name]
        before = getattr(result.fit.robot, name, None)
        high = noise.interval[1]
        value = "not determined"
        if high < LARGEST_NOISE[name]:
            value += f" (below {high:.1e} {unit})"
        if noise.determined and result.trusted:
            value = scaled_with_std(noise.value, noise.std, unit)
        elif noise.determined:
            value = f"{noise.value:.2e} {unit}"
        rows.append([name, "" if before is None else f"{before:.2e}", value])
    return Table("Of greatest likelihood", ("parameter", "before", "after"), rows)


def fit_json(result: Calibration) -> dict[str, Any]:
    """Values, their correlation, and whether they are reliable."""
    parameters: dict[str, Any] = {
        name: picked(item, "value std determined") for name, item in result.multipliers.items()
    }
    for name, noise in result.noises.items():
        sure = noise.determined and result.trusted
        parameters[name] = {
            **picked(noise, "value determined"),
            "std": noise.std if sure else None,
            "interval_95": noise.interval if sure else None,
        }
    return {
        "parameters": parameters,
        "correlation": {
            "names": [number.name for number in result.fit.free],
            "matrix": result.correlation,
        },
        **picked(result, "numbers:fit.numbers not_determined:fit.held or_as_well:twin trusted"),
        "something_else_is_missing": [
            *result.strange,
            *(f"{item.channel} error goes with {item.name}" for item in result.misfit),
        ],
        "outliers": _left_out(result),
    }


def _left_out(result: Calibration) -> int:
    return sum(int(legs.sum()) for legs in result.excluded)
