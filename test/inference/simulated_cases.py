# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robots drawn by chance, each with an effect and noise of its wheels, driven by the model itself.

What simulation-based calibration asks for: data that the model truly makes, so that whatever does
not hold is the fault of what is stated, not of a law (Talts and others, arXiv:1804.06788).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from test.white_noise_robot import wandering
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.adding.fits import fits_of
from werrimbi_odom.inference.adding.fitted_parameters import parameters_of, std_of
from werrimbi_odom.inference.adding.start_values import FitDrives
from werrimbi_odom.inference.diagnosis.calibration_selection import sizes_needed, with_sizes
from werrimbi_odom.inference.diagnosis.either_sign import variances_by_sign
from werrimbi_odom.inference.diagnosis.uncertainty import (
    as_written,
    noises_of,
    with_spread,
)
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, changed
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.effect import Effect, view_of
from werrimbi_odom.model.reference_measurement import shown
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

GIVEN = Robot(0.35, 0.05, 2000.0, 2000.0)
NOISE_XY, NOISE_YAW = 1e-3, 2e-3

SIZES = {
    "lateral_slip": {"creep": 0.02},
    "sideways_drift": {"angle": 0.02},
    "castor_kick": {"angle": 0.02, "length": 0.04},
    "longitudinal_slip": {"coefficient": 0.02},
    "turn_dependent_track": {"sharpness": 0.01},
    "left_backlash": {"travel": 2e-3},
    "radius_drift": {"per_metre": 2e-4},
    "reference_lever_arm": {"x": 0.02, "y": -0.02},
    "reference_delay": {"delay": 0.03},
    "encoder_skew": {"delay": 0.02},
}
"""Of each effect what a robot may have, in the middle."""


@dataclass(frozen=True)
class Case:
    """A robot, an effect that its file lacks, and drives of it."""

    effect: Effect
    truth: Robot
    runs: tuple[Run, ...]

    @property
    def true(self) -> dict[str, float]:
        """All that `add` may state."""
        (applied,) = self.truth.effects
        names = (*MULTIPLIERS, "left_wheel_noise", "right_wheel_noise")
        return {
            **{name: float(value) for name, value in applied.values.items()},
            **{name: float(getattr(self.truth, name)) for name in names},
            "reference_sigma_xy": NOISE_XY,
            "reference_sigma_yaw": NOISE_YAW,
        }


def case(seed: int, *, drives: int = 2, seconds: float = 40.0) -> Case:
    """Effects in turn; of sizes none is off, or one, or all; sizes and noise by chance."""
    random = np.random.default_rng(seed)
    name = list(SIZES)[seed % len(SIZES)]
    values = {key: value * random.lognormal(0.0, 0.3) for key, value in SIZES[name].items()}
    off = random.random(3) < random.choice([0.0, 0.3, 1.0])
    sizes = {key: float(1.0 + 0.01 * random.standard_normal() * moved)
             for key, moved in zip(MULTIPLIERS, off, strict=True)}  # fmt: skip
    effect = find(name)
    left, right = 1e-3 * 2.0 ** random.uniform(-1.0, 1.0, 2)
    truth = replace(
        changed(GIVEN, sizes),
        left_wheel_noise=float(left),
        right_wheel_noise=float(right),
        effects=(effect.using(**values),),
    )
    made = (_driven(truth, random, seconds, number) for number in range(drives))
    return Case(effect, truth, tuple(made))


def _driven(truth: Robot, random: np.random.Generator, seconds: float, number: int) -> Run:
    """The reference sees the noise of the wheels, the counters do not."""
    rate = 50.0
    speed, turning = wandering(random, seconds, rate)
    time = np.arange(speed.size + 1) / rate
    seen, gone = [], []
    for side, sign in (("left", -1.0), ("right", 1.0)):
        step = (speed + sign * 0.5 * truth.track * turning) / rate
        tick = getattr(truth, f"{side}_tick")
        turned = random.uniform(-1e3, 1e3) + np.append(0.0, np.cumsum(step)) / tick
        noise = getattr(truth, f"{side}_wheel_noise") * np.sqrt(np.abs(step))
        erred = np.append(0.0, np.cumsum(noise * random.standard_normal(step.size))) / tick
        seen.append(np.floor(turned))
        gone.append(turned + erred)
    path = shown(trajectory(truth, time, *gone), view_of(truth.effects))
    at = slice(None, None, 3)
    rows = time[at].size
    errors = [random.normal(0.0, sigma, rows) for sigma in (NOISE_XY, NOISE_XY, NOISE_YAW)]
    reference = Reference(
        time[at],
        path.x[at] + errors[0],
        path.y[at] + errors[1],
        path.yaw[at] + errors[2],
    )
    return Run(f"run_{number}", Path(f"run_{number}"), Ticks(time, *seen), reference)


def stated(case: Case) -> dict[str, tuple[float, float]]:
    """What `add` states of a case: values with standard deviations.

    All of `add` but the search for set-up mistakes before it, and the judgement after.
    """
    runs = concatenated(match_for_fit(case.runs, GIVEN, leg=1.0))
    nothing = tuple(np.zeros(run.legs, dtype=np.bool_) for run in runs.runs)
    drives = FitDrives(runs, nothing, EvaluationOptions())
    fits = fits_of([case.effect], drives, GIVEN, GIVEN, (), lambda share, words: None)
    fit = fits.all
    sizes = sizes_needed(fit, GIVEN, ())
    fit = with_sizes(runs, fit, GIVEN, sizes)
    noises = noises_of(runs, as_written(runs, fit, GIVEN))
    by_sign = variances_by_sign(runs, fits.either.values(), GIVEN, ())
    known = with_spread([case.effect], runs, fit, GIVEN, (), sizes, noises, by_sign)
    robot = fit.point.model.robot
    found = {name: (float(getattr(robot, name)), std_of(known, name)) for name in MULTIPLIERS}
    found |= {
        name: (item.value, item.std)
        for name, item in parameters_of(case.effect, known, GIVEN).items()
        if item.remark == "fitted" and item.value is not None and item.std is not None
    }
    found |= {name: (item.value, item.std) for name, item in noises.items() if item.determined}
    return {name: pair for name, pair in found.items() if pair[1] > 0.0}


def deviations(seed: int) -> dict[str, float]:
    """(stated - true) / stated standard deviation, by effect and parameter."""
    drawn = case(seed)
    own = {f"{drawn.effect.name}.{name}" for name in drawn.effect.parameters}
    return {
        f"{drawn.effect.name}.{name}" if f"{drawn.effect.name}.{name}" in own else name: (
            (value - drawn.true[name]) / std
        )
        for name, (value, std) in stated(drawn).items()
    }
