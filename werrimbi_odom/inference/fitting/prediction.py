# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Predicted relative pose and its noise for every leg, as seen by the reference."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import START_YAW, Model
from werrimbi_odom.inference.fitting.leg_noise import DrivenPath, noise_of_legs
from werrimbi_odom.inference.legs.count_interpolation import summed
from werrimbi_odom.inference.legs.matched_run import MatchedRun
from werrimbi_odom.model.driven_motion import acts
from werrimbi_odom.model.effect import view_of, wiring_of
from werrimbi_odom.model.effects_over_run import driven_from_measured
from werrimbi_odom.model.measured_poses import MeasuredPoses
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, wheels_to_body
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.recorded_propagation import followed
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Prediction:
    """Predicted legs, each in the frame of the reference at its own start.

    Arrays have shape (m, 3) for (x, y, yaw) [m, m, rad], or (m, 3, 3).
    """

    relative: Floats
    """Relative pose of each leg's end, for the point and axis that the reference measures."""
    per_left: Floats
    """Covariance of the relative pose for a left wheel noise k_L² of 1 m."""
    per_right: Floats
    """Covariance of the relative pose for a right wheel noise k_R² of 1 m."""
    length: Floats
    """Path length of each leg, shape (m,), [m]."""
    along: Floats
    """Signed travel of each leg, shape (m,), [m]."""
    turn: Floats
    """Heading change of each leg, shape (m,), [rad]."""


def tell_lengths(apart: Floats, way: Floats | float) -> bool:
    """Whether drives tell a radius: whether they ended elsewhere than where they began (`CLOSED`).

    `apart`, `way`: distances between measured places, and driven from one to the next [m].
    """
    return float(np.sum(apart)) > rules.CLOSED * float(np.sum(way))


def measures_lengths(runs: Concatenated, prediction: Prediction) -> bool:
    """Whether the reference measured lengths that a radius could be told by.

    Headings alone are none, nor are the ends of drives that came back to where they began.
    """
    apart = np.hypot(*(runs.finish - runs.start)[:, :2].T)
    known = np.isfinite(apart) & ~runs.gap
    return tell_lengths(apart[known], prediction.length[known])


def predict(robot: Robot, run: MatchedRun, start_yaw: float | None = None) -> Prediction:
    """Predict the legs of one run.

    `robot`: the robot, with its effects. `run`: the run, cut into legs. `start_yaw`: heading at the
    first reference pose where not measured [rad].
    """
    own = {} if start_yaw is None else {START_YAW: start_yaw}
    return predict_all(Model(robot, (own,)), concatenated([run]))


def predicted_legs(model: Model, runs: Concatenated, looked_at: Robot | None = None) -> Floats:
    """Relative pose of every leg as seen by the reference, shape (m, 3) [m, m, rad].

    `model`: the model. `runs`: the runs of the legs. `looked_at`: Robot whose travel is the input
    of the effects, where that is cached and close enough.
    """
    view = extrinsics_of(model, runs)
    runs = runs.seen_through(view)
    robot = model.laid_out(runs.steps)
    path = _path(robot, runs, view, model.start_yaws, looked_at)
    return _shown(path, runs, view, model)


def predicted_on_path(model: Model, runs: Concatenated) -> Floats:
    """As `predicted_legs`, by a path that is kept: for a model whose noise is asked for next."""
    view = extrinsics_of(model, runs)
    runs = runs.seen_through(view)
    return _shown(path_of(model, runs), runs, view, model)


def turns_over(before: Floats, after: Floats) -> bool:
    """Whether a leg turns by a whole turn more or less than before, relative poses (m, 3).

    No correction of a model does that, as legs are short; an effect's formula does, far from where
    it holds.
    """
    return bool(np.any(~(np.abs(after[:, 2] - before[:, 2]) < math.tau)))


def predict_all(model: Model, runs: Concatenated) -> Prediction:
    """Relative poses of all legs, with their covariance for unit noise of each wheel."""
    return runs.cache.of_model(model, "prediction", lambda: _predicted(model, runs))


def _predicted(model: Model, runs: Concatenated) -> Prediction:
    view = extrinsics_of(model, runs)
    runs = runs.seen_through(view)
    path = path_of(model, runs)
    return Prediction(
        _shown(path, runs, view, model),
        *noise_of_legs(path, runs, model.robot.track, view),
        runs.per_leg(np.abs(path.motion.along)),
        runs.per_leg(path.motion.along),
        path.yaw[runs.end] - path.yaw[runs.begin],
    )


def right_handed(poses: Floats, view: View) -> Floats:
    """Measured poses (m, 3) with the reference's frame made right-handed."""
    return poses * np.array([1.0, -1.0, -1.0]) if view.mirrored else poses


def path_of(model: Model, runs: Concatenated) -> DrivenPath:
    """Path of the model over the steps of all runs, without a reference delay; cached."""
    return runs.cache.of_steps(model, "path", lambda: _path_of(model, runs))


def _path_of(model: Model, runs: Concatenated) -> DrivenPath:
    robot = model.laid_out(runs.steps)
    return _path(robot, runs, extrinsics_of(model, runs), model.start_yaws)


def extrinsics_of(model: Model, runs: Concatenated) -> View:
    """Extrinsics of the reference; per-run values are arrays over the legs.

    Per-run values can be the wander of the heading, and what its clock does.
    """
    return view_of(model.laid_out(runs.legs).effects)


def headings_of(
    path: DrivenPath, runs: Concatenated, view: View, start_yaws: Sequence[float | None]
) -> Floats:
    """Heading at the start of each step, in the reference's frame, shape (n,) [rad].

    Every leg starts from the measured heading if there is one, as its prediction does; otherwise
    the path is followed from the run's start.
    """
    yaw, leg = _measured_headings(runs, view, start_yaws)
    return np.asarray(yaw[leg] + path.yaw[:-1] - path.yaw[runs.begin][leg])


def _measured_headings(
    runs: Concatenated, view: View, start_yaws: Sequence[float | None]
) -> tuple[Floats, NDArray[np.intp]]:
    """Heading at each leg's start (m,), 0 if not measured; and the leg of each step's `anchors`."""
    measured = right_handed(runs.start, view)[:, 2] - view.yaw
    if np.any(view.wander):
        measured = measured - view.drifted(_since_start(runs, runs.begin))
    for index, given in enumerate(start_yaws):
        if given is not None:
            measured[runs.legs[index]] = given - view.yaw
    return np.nan_to_num(measured), anchors(runs, np.isfinite(measured))


def anchors(runs: Concatenated, known: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Leg from whose start each step's pose is followed, shape (n,).

    It is the latest leg of the run with a `known` start (m,), or the run's first leg if none is.
    """
    return runs.cache.known(("anchors", known.tobytes()), lambda: _anchors(runs, known))


def _anchors(runs: Concatenated, known: NDArray[np.bool_]) -> NDArray[np.intp]:
    first, run = runs.legs[:-1], runs.run_of_step
    leg = np.searchsorted(runs.begin, np.arange(run.size), side="right") - 1
    latest = np.where(known, np.arange(runs.count), first[runs.run_of_leg])
    return np.maximum.accumulate(latest)[np.clip(leg, first[run], None)]


def _path(
    robot: Robot,
    runs: Concatenated,
    view: View,
    start_yaws: Sequence[float | None],
    looked_at: Robot | None = None,
) -> DrivenPath:
    raw = runs.raw(robot)
    if not acts(robot):
        return _from_motion(raw, wheels_to_body(raw, robot.track))
    drive = runs.drive(looked_at or robot)

    def measured() -> MeasuredPoses:
        return _measured_poses(runs, view, start_yaws)

    return _from_motion(*driven_from_measured(robot, raw, drive, measured))


def _measured_poses(
    runs: Concatenated, view: View, start_yaws: Sequence[float | None]
) -> MeasuredPoses:
    """Poses in the reference's frame, from which those of the steps are followed.

    Every leg starts from the measured pose if there is one; otherwise the path is followed from the
    last measured one, or from zero.
    """
    yaw, leg = _measured_headings(runs, view, start_yaws)
    start = right_handed(runs.start, view)[:, :2]
    at = anchors(runs, np.isfinite(start[:, 0]) & np.isfinite(start[:, 1]))
    x, y = np.nan_to_num(start).T / view.scale
    place = x + 1j * y
    begin = np.minimum(runs.begin, runs.step_count - 1)
    arm = complex(view.ahead, view.left)
    return MeasuredPoses(yaw[leg], begin[leg], place[at], begin[at], arm)


def _from_motion(travel: WheelTravel[Floats], motion: BodyMotion[Floats]) -> DrivenPath:
    return DrivenPath(motion, travel, *followed(motion))


def _shown(path: DrivenPath, runs: Concatenated, view: View, model: Model) -> Floats:
    """Relative poses of the legs, for the reference's lever arm, axis and stamps."""
    begin, end = runs.begin, runs.end
    turn = path.yaw[end] - path.yaw[begin]
    moved = np.exp(-1j * path.yaw[begin]) * (path.position[end] - path.position[begin])
    point = complex(view.ahead, view.left)
    first: float | Floats = view.yaw
    last: float | Floats = view.yaw
    if view.heading_delay != 0.0:
        late = _headings_late(path, runs, model.robot, view.heading_delay)
        first, last = first + late[0], last + late[1]
    if np.any(view.wander):
        first = first + view.drifted(_since_start(runs, begin))
        last = last + view.drifted(_since_start(runs, end))
    if point:
        moved = moved + (np.exp(1j * turn) - 1.0) * point
    shown = np.exp(-1j * first) * moved
    turned = turn + last - first
    if runs.headings_alone:
        turned = view.scale * turned
    else:
        shown = view.scale * shown
    drift = model.drifts[runs.run_of_leg] * runs.duration
    return np.stack([shown.real, shown.imag, turned + drift], axis=-1)


def _since_start(runs: Concatenated, nodes: NDArray[np.intp]) -> Floats:
    """Time since the start of the drive at each leg's node, shape (m,) [s]."""
    found = np.empty(runs.count)
    for index, run in enumerate(runs.runs):
        own = slice(runs.legs[index], runs.legs[index + 1])
        found[own] = run.time[nodes[own] - runs.steps[index]] - run.counters.time[0]
    return found


def _headings_late(path: DrivenPath, runs: Concatenated, robot: Robot, delay: float) -> Floats:
    """Difference of a heading delayed by `delay` [s] to the true one, at each leg's start and end.

    Shape (2, m) [rad]. Between the nodes it follows the counts, as poses do that are late as a
    whole. A straight line from node to node would round less than they do, and seem the better
    model for that alone.
    """
    wiring = wiring_of(robot.effects)

    def counted(left: Floats, right: Floats) -> Floats:
        left, right = wiring.wheels(left, right)
        return wheels_to_body(
            WheelTravel(left * robot.left_tick, right * robot.right_tick), robot.track
        ).turn

    found = []
    for index, run in enumerate(runs.runs):
        yaw = path.yaw[runs.steps[index] : runs.steps[index + 1] + 1]
        asked = run.time[run.ends] - delay
        beside = np.interp(asked, run.time, yaw - counted(summed(run.left), summed(run.right)))
        behind = counted(*run.counters.at(asked).T) + beside - yaw[run.ends]
        found.append(np.stack([behind[:-1], behind[1:]]))
    return np.concatenate(found, axis=1)
