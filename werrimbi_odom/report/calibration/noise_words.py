# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of the wheel noise from drives out and back, in words and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.out_and_back import NoiseFit, NoiseInterval, pivot_scatter
from werrimbi_odom.report.document import Part, Table, paragraphs
from werrimbi_odom.report.number_format import picked, scaled_with_std

PIVOT_TURNS = 10.0


def noise_in_words(fit: NoiseFit, distance: float, track: float, *, turn_round: bool) -> list[Part]:
    """The k of both wheels, and how reliable they are."""
    heads = ("wheel", "k [m^0.5]", "95 % interval", "ellipses matched")
    rows = [
        _wheel("left", fit.left, fit.by_moments[0]),
        _wheel("right", fit.right, fit.by_moments[1]),
    ]
    title = f"Noise of each wheel, of {fit.runs} runs of {distance:g} m out and back"
    sentences = [
        _misfit(fit),
        _split(fit, track, turn_round=turn_round),
        _mean(fit),
        "Written is the first column, of greatest likelihood. The last is the paper's way, "
        "ellipses laid over the data's: it scatters more, for it trusts all three plots alike.",
    ]
    if fit.runs < rules.ADVISED_RUNS:
        sentences.append(
            f"{rules.ADVISED_RUNS} runs would tell each k to about 13 %; here are {fit.runs}."
        )
    verdict = paragraphs([_verdict(fit)])
    return [*verdict, Table(title, heads, rows), *paragraphs(sentences, apart=True)]


def _wheel(side: str, estimate: NoiseInterval, matched: float) -> list[str]:
    interval = f"{_k(estimate.low)} to {_k(estimate.high)}"
    return [side, scaled_with_std(estimate.value, estimate.std), interval, _k(matched)]


def _split(fit: NoiseFit, track: float, *, turn_round: bool) -> str:
    """Whether the wheels' noises are separable; otherwise a drive that separates them."""
    known = (
        f"known to ± {_k(fit.difference_std)}, correlation of the two {fit.correlation:.2f}"
        if fit.difference_std < 2.0 * fit.left.value
        else "not known at all"
    )
    if fit.split_known:
        difference = fit.right.value - fit.left.value
        clear = abs(difference) > 2.0 * fit.difference_std
        verdict = "the wheels differ" if clear else "no difference between the wheels is proven"
        return f"k_R - k_L = {_k(difference)}, {known}: {verdict}."
    why = (
        "Coming back forwards hides it; backing to the mark would show it."
        if turn_round
        else "It shows in x alone, and there the reference is too noisy."
    )
    scatter = pivot_scatter(fit.right.value, track, PIVOT_TURNS)
    return (
        "These runs know the sum k_L² + k_R², but not which wheel has how much of it: k_R - k_L is "
        f"{known}. {why} Both are given the same k, and the intervals allow any share. A drive "
        f"that tells: {PIVOT_TURNS:g} turns about the standing left wheel, many times. Only the "
        "right wheel rolls, and the heading scatters by k_R sqrt(2 pi turns / base), "
        f"{1e3 * scatter:.1f} mrad if both are alike; then the same about the right wheel. Any "
        "driving with such turns in it will do for `werrimbi calibrate fit`."
    )


def _mean(fit: NoiseFit) -> str:
    x, y, yaw = 1e3 * fit.mean
    std_x, std_y, std_yaw = 1e3 * fit.mean_std
    said = (
        f"Mean of the runs (systematic, kept apart): x {x:.1f} ± {std_x:.1f} mm, "
        f"y {y:.1f} ± {std_y:.1f} mm, yaw {yaw:.1f} ± {std_yaw:.1f} mrad"
    )
    if fit.mean_p < rules.SURE_WHEN_ASKED:
        return f"{said}. That is more than scatter: calibrate base and radii first (umbmark)."
    return f"{said}; no more than scatter."


def _verdict(fit: NoiseFit) -> str:
    if fit.misfit_p < rules.SURE_WHEN_ASKED:
        return "Careful: what is assumed does not explain the scatter; do not trust these k."
    left, right = (scaled_with_std(each.value, each.std) for each in (fit.left, fit.right))
    if fit.split_known:
        return f"k_L is {left} m^0.5 and k_R {right}; the model explains the scatter."
    return f"k is {left} m^0.5, of both wheels alike; the model explains the scatter."


def _misfit(fit: NoiseFit) -> str:
    """Agreement of the model's covariance with that of the runs, and a remedy."""
    if fit.misfit_p >= rules.SURE_WHEN_ASKED:
        return f"Of runs by this model, {100.0 * fit.misfit_p:.2g} % match it worse than these do."
    ratio = np.sqrt(np.diag(fit.data) / np.diag(fit.model))
    names = [f"{name} {value:.1f}" for name, value in zip(("x", "y", "yaw"), ratio, strict=True)]
    said = f"Scatter of the runs over the model's: {', '.join(names)} (chance {fit.misfit_p:.1g}). "
    if fit.missing_reference is None:
        return said + "No noise of the reference explains it either: were some runs disturbed?"
    sigma_xy, sigma_yaw = fit.missing_reference
    return (
        f"{said}Noise of the reference would explain it: measure that noise, and if it is about "
        f"so, run again with --reference-sigma-xy {sigma_xy:.2g} "
        f"--reference-sigma-yaw {sigma_yaw:.2g}."
    )


def _k(value: float) -> str:
    return f"{value:.2e}"


def noise_json(fit: NoiseFit, distance: float, columns: Sequence[str]) -> dict[str, Any]:
    """Complete result; `columns` names the errors at the end of a run."""
    wheels = {"left_wheel_noise": fit.left, "right_wheel_noise": fit.right}
    missing = fit.missing_reference
    return {
        "parameters": {
            name: picked(each, "value std low_95:low high_95:high") for name, each in wheels.items()
        },
        "distance_m": distance,
        **picked(fit, "runs wheels_told_apart:split_known difference_std correlation"),
        "ellipse_matching": dict(zip(wheels, fit.by_moments, strict=True)),
        "systematic": {
            name: {"value": value, "std": std}
            for name, value, std in zip(columns, fit.mean, fit.mean_std, strict=True)
        },
        **picked(fit, "systematic_p:mean_p misfit_p"),
        "missing_reference": missing
        and dict(zip(("sigma_xy_m", "sigma_yaw_rad"), missing, strict=True)),
        "covariance": picked(fit, "runs:data model"),
    }
