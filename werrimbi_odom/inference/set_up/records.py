# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs cut up for the set-up search, independently of the robot file's scale.

A cut is half a turn of the faster wheel, whatever its length: the file's metres may be off by 1000,
and so may the reference's. What the robot file says of the reference (mirror, mounting, clock) is
undone first, so that findings are what is still wrong.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import sizes_of
from werrimbi_odom.inference.comparison.residuals import Measure
from werrimbi_odom.inference.legs.aligned_run import usable_rows
from werrimbi_odom.inference.legs.count_interpolation import summed
from werrimbi_odom.inference.legs.cutting import leg_ends
from werrimbi_odom.inference.legs.gaps import gaps_in, touched
from werrimbi_odom.inference.legs.monotone_cubic import between_messages
from werrimbi_odom.inference.set_up.corrected_robot import mount_of
from werrimbi_odom.model.driven_motion import features
from werrimbi_odom.model.effect import after_stage, view_of, wiring_of
from werrimbi_odom.model.effects_over_run import PLACE, watched
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.encoder_recorded import wheel_steps
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import channel_spans

Complexes = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class SetUpRecord:
    """One run: wheel travel by the robot file, and measurements; n steps, m rows."""

    time: Floats
    """Stamps of the messages, shape (n + 1,) [s]."""
    left: Floats
    """Cumulative travel of the file's left wheel, shape (n + 1,) [m]."""
    right: Floats
    seen: Floats
    """Time of each reference row on the ticks' clock, shape (m,) [s]."""
    place: Complexes
    """Measured x + iy, shape (m,); NaN where not measured [m]."""
    yaw: Floats
    """Measured heading, shape (m,); NaN where not measured [rad]."""
    not_driven: tuple[tuple[float, float], ...] = ()
    """Stretches in which the robot was held or carried: begin and end [s]."""
    taken_out: tuple[tuple[float, float], ...] = ()
    """Stretches without rows of the reference, on purpose, on the clock of `seen` [s]."""

    def delayed(self, delay: float) -> SetUpRecord:
        """Shift the reference, which is later by `delay` [s] than assumed."""
        gone = tuple((begin - delay, end - delay) for begin, end in self.taken_out)
        return replace(self, seen=self.seen - delay, taken_out=gone)

    def in_degrees(self) -> SetUpRecord:
        """Convert the recorded yaw from degrees."""
        return replace(self, yaw=np.radians(self.yaw))


@dataclass(frozen=True, slots=True)
class Cuts:
    """All runs on common nodes, concatenated; k cuts.

    Nodes are all messages and the ends of cuts; a run begins with a step of zero travel.
    """

    left: Floats
    """Travel in each step [m], shape (n,)."""
    right: Floats
    begin: NDArray[np.intp]
    """Number of steps before the cut's first, shape (k,)."""
    end: NDArray[np.intp]
    duration: Floats
    """Duration of each cut [s]."""
    turn: Floats
    """Measured heading change, wrapped per row [rad]; NaN where not measured."""
    move: Complexes
    """Measured displacement, in the frame of the measured heading at the cut's start if there is
    one, else of the reference [m]."""
    stretch: NDArray[np.intp]
    """Index of the stretch of each cut: a run, or the part between its gaps."""

    @property
    def count(self) -> int:
        """Number of cuts."""
        return self.begin.size

    def summed(self, steps: Floats) -> Floats:
        """Sum the steps over each cut."""
        total = np.concatenate([[0.0], np.cumsum(steps)])
        return np.asarray(total[self.end] - total[self.begin])


def record_of(run: Run, robot: Robot, limits: EncoderLimits | None) -> SetUpRecord | None:
    """Usable part of a run; None without reference or travel, or where a clock was set back."""
    reference, ticks = run.reference, run.ticks
    if reference is None:
        return None
    # A speed limit in metres is of no use while the scale is in doubt.
    lenient = replace(limits or EncoderLimits(), max_wheel_speed=0.0)
    steps = wheel_steps(robot, ticks.time, ticks.left, ticks.right, lenient)
    if steps.first_row < 0 or steps.time.size < 2:
        return None
    rows = np.concatenate([[steps.first_row], steps.row])
    time = np.asarray(ticks.time, dtype=np.float64)[rows]
    forward = np.diff(time) > 0.0
    if not forward.all():
        return None
    wheels = wiring_of(robot.effects).wheels
    left, right = wheels(steps.left / robot.left_tick, steps.right / robot.right_tick)
    raw = WheelTravel(left * robot.left_tick, right * robot.right_tick)
    of_wheels = [applied for applied in robot.effects if applied.effect.stage == "wheels"]
    if of_wheels:
        first = (float(ticks.left[steps.first_row]), float(ticks.right[steps.first_row]))
        channels = channel_spans(steps, ticks.channels)
        drive = features(robot, np.diff(time), raw, wheels(*first), channels)
        for applied in of_wheels:
            seen = watched(drive)
            after = after_stage("wheels", (applied,), raw, seen)
            # An effect that depends on position cannot be undone while the position is unknown.
            raw = raw if seen.asked & PLACE else after
    view = view_of(robot.effects)
    sign = -1.0 if view.mirrored else 1.0
    ways, turns = (view.scale, 1.0) if reference.has_position.any() else (1.0, view.scale)
    known = (np.isfinite(reference.x) & np.isfinite(reference.y)) | np.isfinite(reference.yaw)
    stamps = np.asarray(reference.time, dtype=np.float64)
    latest = np.maximum.accumulate(np.where(known, stamps, -math.inf))
    known &= np.concatenate([[True], stamps[1:] > latest[:-1]])

    def seen_at(stamp: Any) -> Any:
        return stamp - view.late(stamp - time[0])

    return SetUpRecord(
        time,
        summed(raw.left),
        summed(raw.right),
        seen_at(stamps[known]),
        ((reference.x + 1j * sign * np.asarray(reference.y)) / np.complex128(ways))[known],
        sign * np.asarray(reference.yaw)[known] / turns,
        tuple((part.begin, part.end) for part in run.no_driving or ()),
        tuple((seen_at(begin), seen_at(end)) for begin, end in run.taken_out),
    )


def measured_by(records: Sequence[SetUpRecord]) -> Measure | None:
    """What the reference measures: poses if enough rows have both."""
    place = sum(int(np.isfinite(each.place).sum()) for each in records)
    yaw = sum(int(np.isfinite(each.yaw).sum()) for each in records)
    both = sum(int((np.isfinite(each.place) & np.isfinite(each.yaw)).sum()) for each in records)
    if both >= rules.POSE_ROWS_OF_SET_UP * max(place, yaw) and both > 1:
        return "pose"
    if place > 1 and place >= yaw:
        return "position"
    return "heading" if yaw > 1 else None


def ratio_of_ticks(robot: Robot) -> float:
    """Travel of a count of the right wheel by the robot file over that of the left."""
    sizes = sizes_of(robot)
    left, right = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
    return (sizes.right / right) / (sizes.left / left)


def cut(
    records: Sequence[SetUpRecord], robot: Robot, measured: Measure, *, fewest: int = rules.CUTS
) -> Cuts:
    """Cut all runs at rows of the reference, every half turn of the faster wheel.

    `records`: runs to cut. `robot`: the robot as its file has it. `measured`: what the reference
    measures. `fewest`: cuts are shortened until there are this many; a cut is at least one interval
    of the reference.
    """
    usable = [_usable(each, measured) for each in records]
    total = sum(float(_progress(each)[-1]) for each in usable if each.seen.size > 1)
    half_turn = math.pi * robot.wheel_radius
    length = (
        min(max(half_turn, total / rules.MOST_CUTS), total / fewest) if total > 0.0 else half_turn
    )
    view = mount_of(robot)
    parts, offset, stretch = [], 0, 0
    for each in usable:
        if each.seen.size < 2:
            continue
        point = complex(view.ahead, view.left)
        part = _cut_run(each, length, point, view.yaw, stretch, offset)
        offset += part.left.size
        stretch = int(part.stretch[-1]) + 1 if part.count else stretch
        parts.append(part)
    if not parts:
        none, index = np.empty(0), np.empty(0, dtype=np.intp)
        return Cuts(none, none, index, index, none, none, none.astype(complex), index)
    names = [item.name for item in fields(Cuts)]
    return Cuts(*(np.concatenate([getattr(each, name) for each in parts]) for name in names))


def _usable(record: SetUpRecord, measured: Measure) -> SetUpRecord:
    """Rows with the needed values, within the ticks' time span."""
    known = np.ones(record.seen.shape, dtype=np.bool_)
    if measured != "heading":
        known &= np.isfinite(record.place)
    if measured != "position":
        known &= np.isfinite(record.yaw)
    keep = usable_rows(record.seen, known, float(record.time[0]), float(record.time[-1]))
    yaw = record.yaw[keep] if measured != "position" else np.full(keep.size, np.nan)
    return replace(record, seen=record.seen[keep], place=record.place[keep], yaw=yaw)


def _progress(record: SetUpRecord) -> Floats:
    """Cumulative travel of the faster wheel at each reference row [m]."""
    gone = np.interp(record.seen, record.time, _way(record))
    return np.asarray(gone - gone[0])


def _way(record: SetUpRecord) -> Floats:
    """Cumulative travel of the faster wheel at each message [m]."""
    return summed(np.maximum(np.abs(np.diff(record.left)), np.abs(np.diff(record.right))))


def _gaps(record: SetUpRecord, gone: Floats, length: float) -> NDArray[np.bool_]:
    """Reference intervals without driving, or with silence of reference or ticks."""
    inside = (record.time >= record.seen[0]) & (record.time <= record.seen[-1])
    time = record.time[inside]
    ticks = np.flatnonzero(gaps_in(time, _way(record)[inside] / length))
    silences = [(time[each], time[each + 1]) for each in ticks]
    silent = touched(record.seen, [*silences, *record.not_driven, *record.taken_out])
    return gaps_in(record.seen, gone / length) | silent


def _cut_run(
    record: SetUpRecord, length: float, point: complex, yaw: float, stretch: int, offset: int
) -> Cuts:
    gone = _progress(record)
    gap = _gaps(record, gone, length)
    chosen = leg_ends(gone, gap, length)
    at = record.seen[chosen]
    time = np.union1d(record.time, at)
    left, right = between_messages(time, record.time, record.left, record.right).T
    nodes = offset + 1 + np.searchsorted(time, at)
    heading = np.concatenate([[0.0], np.cumsum(wrap_all(np.diff(record.yaw)))])[chosen]
    turn = np.diff(heading)
    move = np.diff(record.place[chosen])
    if np.isfinite(turn).all():
        # Undo the reference's extrinsics as known to the file.
        move = move * np.exp(1j * (yaw - record.yaw[chosen[:-1]]))
        move = move - (np.exp(1j * turn) - 1.0) * point
    before = np.concatenate([[0], np.cumsum(gap)])[chosen]
    whole = np.diff(before) == 0
    return Cuts(
        np.diff(left, prepend=left[0]),
        np.diff(right, prepend=right[0]),
        nodes[:-1][whole],
        nodes[1:][whole],
        np.diff(at)[whole],
        turn[whole],
        move[whole],
        stretch + before[:-1][whole],
    )
