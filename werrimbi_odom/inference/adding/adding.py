# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One more effect in the model: fitted with all calibration, judged on drives held out.

An effect is taken when it lowers the held-out error beyond what calibration alone does, surely
differs from null, and does not run against what physics allows. Else the reason is told, and only
the user's own will puts it in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.inference.adding.added import Added, Side
from werrimbi_odom.inference.adding.objection import objection
from werrimbi_odom.inference.adding.start import (
    Drives,
    Start,
    drives_of,
    knobs_held,
    mistake_put_in,
    start_of_held,
    starts,
    with_set_up,
)
from werrimbi_odom.inference.adding.values import (
    parameters_of,
    to_write,
    weakest,
    without_phases_stuck,
)
from werrimbi_odom.inference.calibration.any_driving import MISFIT_P, STRANGE_NOISE
from werrimbi_odom.inference.comparison.judged_legs import (
    Legs,
    Prepared,
    consistency_by_length,
    in_runs,
    judged_legs,
)
from werrimbi_odom.inference.diagnosis.diagnosis import chance
from werrimbi_odom.inference.diagnosis.evidence import Dependence, dependences
from werrimbi_odom.inference.diagnosis.holdout import Judge, judge_of
from werrimbi_odom.inference.diagnosis.selection import Fitted
from werrimbi_odom.inference.fitting.candidates import CALIBRATED
from werrimbi_odom.inference.fitting.costs import Costs
from werrimbi_odom.inference.fitting.knobs import (
    CALIBRATION,
    MULTIPLIERS,
    NUISANCES,
    Model,
    changed,
)
from werrimbi_odom.inference.fitting.noise import NoiseEstimate, noise_estimates, with_noise
from werrimbi_odom.inference.fitting.together import together
from werrimbi_odom.inference.set_up.mistakes import look_for_mistakes
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.encoder import EncoderLimits
from werrimbi_odom.model.robot import Robot


def add_effect(
    effect: Effect,
    runs: Sequence[Run],
    robot: Robot,
    kind: ReferenceKind = "absolute",
    *,
    given: Robot | None = None,
    holdout: Sequence[Run] = (),
    leg: float = 1.0,
    limits: EncoderLimits | None = None,
    sigma_xy: float | None = None,
    sigma_yaw: float | None = None,
    show: Callable[[float, str], None] = lambda share, words: None,
) -> Added:
    """Fit an effect together with all calibration, and judge it.

    Parameters
    ----------
    given : Robot, optional
        By whose travel legs are cut, and whose errors are those before; `robot` where there is none
        other that the fit begins with.
    holdout
        Runs to judge on alone. None given: some of `runs` are put aside for it.
    leg : float
        Length of the legs that are judged [m].
    show
        Told the share done, and what is being done.

    Raises
    ------
    InputError
        When a run cannot be used, a channel that the effect looks at was not measured, or the
        drives do not show at all what it looks at.
    """
    _refuse_unmeasured(effect, [*runs, *holdout])
    held = any(item.name == effect.name for item in robot.effects)
    if held and effect.is_mistake:
        raise InputError(
            f"the robot file lists {effect.name} already; a mistake put right twice is made again"
        )
    show(0.0, "set-up")
    set_up = look_for_mistakes([*runs, *holdout], robot, kind, limits)
    judge = judge_of(runs, holdout, given or robot, kind, leg, limits, sigma_xy, sigma_yaw)
    begun, also = with_set_up(effect, robot, set_up)
    sigma = (sigma_xy or _stated(judge, "xy_told"), sigma_yaw or _stated(judge, "yaw_told"))
    show(0.15, "calibration")
    drives = drives_of(judge.train, begun, kind, limits, sigma)
    base, fit = _fits(effect, drives, begun, robot, also, show)
    parameters = parameters_of(effect, fit, robot)
    show(0.75, "judging")
    train, kept = _judged(judge, base, fit)
    noises, remaining, honest = _noise(drives, fit, sigma)
    model = fit.point.model
    per_run = tuple(sorted(set(model.own[0]) - set(NUISANCES))) if model.own else ()
    p_value = 0.0 if effect.name in CALIBRATED or also else chance(fit, base, 1)
    against = objection(effect, parameters, kept, p_value, held, set_up, also)
    written = fit
    if not holdout:
        show(0.9, "all runs")
        written = _on_all(judge, drives, fit, robot, runs, limits)
    final = to_write(written.point.model, robot)
    final = with_noise(final, noises) if honest else _with_noise_of(final, robot)
    names = [knob.name for knob, _ in written.design.columns]
    return Added(
        effect,
        parameters_of(effect, written, robot) if written is not fit else parameters,
        tuple(name for name in also if name != effect.name),
        robot,
        final,
        {
            name: float(np.sqrt(written.covariance[names.index(name), names.index(name)]))
            for name in MULTIPLIERS
        },
        train,
        kept,
        () if holdout else tuple(run.name for run in judge.kept_back),
        written is not fit,
        noises,
        honest,
        remaining,
        set_up,
        per_run,
        p_value,
        against,
        judge.left_out,
        consistency_by_length(judge.holdout, judge.at_home(_noisy(fit)).model),
    )


def _refuse_unmeasured(effect: Effect, runs: Sequence[Run]) -> None:
    for run in runs:
        for channel in effect.channels:
            if channel not in run.ticks.channels:
                raise InputError(
                    f"{effect.name} looks at the measured channel {channel}, a column of "
                    f"ticks.csv, and {run.name} has none"
                )


def _stated(judge: Judge, told: str) -> float | None:
    """The reference's noise where all records state it."""
    name = {"xy_told": "sigma_xy", "yaw_told": "sigma_yaw"}[told]
    noises = [noise for _, noise in judge.train.noises]
    if any(getattr(noise, told) not in ("stated", "given") for noise in noises):
        return None
    return max(float(getattr(noise, name)) for noise in noises)


def _fits(
    effect: Effect,
    drives: Drives,
    begun: Robot,
    given: Robot,
    also: tuple[str, ...],
    show: Callable[[float, str], None],
) -> tuple[Fitted, Fitted]:
    """The model with everything fitted but the effect, and the best one with it."""
    if effect.name in CALIBRATED:
        start = start_of_held(drives, begun, also)
        fit = drives.fit(start.point, also, start.knobs, given)
        return fit, fit
    others = tuple(item for item in begun.effects if item.name not in (effect.name, *also))
    bare = replace(begun if not also else given, effects=others)
    start = start_of_held(drives, bare, ())
    base = drives.fit(start.point, (), start.knobs, given)
    show(0.35, effect.name)
    if also:
        start = start_of_held(drives, begun, also)
        options: tuple[Start, ...] = (replace(start, knobs=knobs_held(begun, start.knobs, effect)),)
    elif effect.is_mistake:
        options = (start_of_held(drives, mistake_put_in(bare, effect), (effect.name,)),)
    else:
        options = starts(drives, base, effect, start.knobs)
    if not options:
        raise InputError(
            f"these drives do not show {effect.name} at all: what it looks at never happens in "
            "them, or is the same to them as calibration"
        )
    fits = [_well(drives, option, given) for option in options]
    best = min(fits, key=lambda fit: fit.total)
    show(0.65, effect.name)
    return base, _pruned(effect, drives, best, given)


def _well(drives: Drives, start: Start, given: Robot) -> Fitted:
    """A fit from a start, phases led past half a turn where they ran against it."""
    fit = drives.fit(start.point, start.names, start.knobs, given)
    turned = without_phases_stuck(fit.point.model, fit.knobs)
    if turned is None:
        return fit
    again = drives.fit(replace(fit.point, model=turned), start.names, start.knobs, given)
    return min(fit, again, key=lambda each: each.cost)


def _pruned(effect: Effect, drives: Drives, fit: Fitted, given: Robot) -> Fitted:
    """The fit without parameters that the data do not show, one after the other."""
    while (name := weakest(effect, parameters_of(effect, fit, given))) is not None:
        key = f"{effect.name}.{name}"
        model = fit.point.model
        at_null = changed(model.robot, {key: effect.parameters[name].null})
        knobs = tuple(knob for knob in fit.knobs if knob.name != key)
        point = replace(fit.point, model=Model(at_null, model.own))
        fit = drives.fit(point, fit.names, knobs, given)
    return fit


def _judged(judge: Judge, base: Fitted, fit: Fitted) -> tuple[Side, Side]:
    """The legs of both sides; what each run has of its own is learnt in that run alone."""
    plain = Model(judge.given, judge.nothing_of_own)
    train = Side(
        _legs(judge.train, in_runs(judge.train, plain)),
        _legs(judge.train, base.point.model),
        _legs(judge.train, _noisy(fit)),
    )
    kept = Side(
        *(
            _legs(judge.holdout, judge.at_home(model).model)
            for model in (plain, base.point.model, _noisy(fit))
        )
    )
    return train, kept


def _noisy(fit: Fitted) -> Model:
    """The fitted model with the wheels' noise that was fitted with it."""
    model, variances = fit.point.model, fit.point.variances
    robot = replace(
        model.robot,
        left_wheel_noise=float(np.sqrt(variances.left[0])),
        right_wheel_noise=float(np.sqrt(variances.right[0])),
    )
    return Model(robot, model.own)


def _legs(prepared: Prepared, model: Model) -> Legs:
    return judged_legs(prepared, model.without_nuisances(), prepared.leg)


def _noise(
    drives: Drives, fit: Fitted, sigma: tuple[float | None, float | None]
) -> tuple[dict[str, NoiseEstimate], tuple[Dependence, ...], bool]:
    """Noise of the wheels, what the errors still depend on, and whether the noise is noise."""
    held = (sigma[0] is not None, sigma[1] is not None)
    costs = Costs(drives.laid, fit.point, drives.kind)
    noises = noise_estimates(costs, fit.point.variances, held)
    found = dependences(drives.laid, fit.point, drives.kind, (*CALIBRATION, *fit.knobs))
    remaining = tuple(cell for cell in found if cell.p_value < MISFIT_P)
    wheels = [noises[name] for name in ("left_wheel_noise", "right_wheel_noise")]
    sane = all(not item.determined or item.value < STRANGE_NOISE for item in wheels)
    return noises, remaining, not remaining and sane


def _with_noise_of(robot: Robot, given: Robot) -> Robot:
    return replace(
        robot, left_wheel_noise=given.left_wheel_noise, right_wheel_noise=given.right_wheel_noise
    )


def _on_all(
    judge: Judge,
    drives: Drives,
    fit: Fitted,
    given: Robot,
    runs: Sequence[Run],
    limits: EncoderLimits | None,
) -> Fitted:
    """The same model fitted on all runs, those put aside among them."""
    if len(runs) < 2:
        return fit  # of a single run the last part was put aside; the rest is what there is
    both = [
        drives,
        drives_of(judge.holdout, fit.point.model.robot, judge.kind, limits, drives.sigma),
    ]
    laid = tuple(run for part in both for run in part.laid.runs)
    jumped = tuple(legs for part in both for legs in part.jumped)
    every = replace(drives, laid=together(laid), jumped=jumped)
    home = judge.at_home(fit.point.model)
    own = (*fit.point.model.own, *home.model.own)
    point = replace(fit.point, model=Model(fit.point.model.robot, own), excluded=jumped)
    return every.fit(point, fit.names, fit.knobs, given)
