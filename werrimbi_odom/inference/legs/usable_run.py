# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What of a recorded run can be judged: stamps put right, and what is no driving, or no reference.

The order matters: a stretch is found by stamps that are even, among poses that are not wrong, and a
gyro's bias is told by rests that are known as such.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import NoDriving, Reference, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.clock_rate import ReferenceClock, clock_of
from werrimbi_odom.inference.legs.count_interpolation import Counters, counters_of
from werrimbi_odom.inference.legs.even_stamps import (
    in_packets_of,
    stamped_together,
    with_even_scan_stamps,
)
from werrimbi_odom.inference.legs.gyro_bias import without_bias
from werrimbi_odom.inference.legs.held_or_carried import no_driving
from werrimbi_odom.inference.legs.motion_states import driven
from werrimbi_odom.inference.legs.noisy_phases import noisy_phases
from werrimbi_odom.inference.legs.reference_lapses import lapses
from werrimbi_odom.inference.legs.windows import later_than_all_before
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.robot import Robot


def with_no_driving(run: Run, robot: Robot, limits: EncoderLimits | None = None) -> Run:
    """Attach to a run its stretches without driving, found once and kept by its parts.

    Scan stamps are corrected first (`even_stamps`); a gyro's bias is removed last (`gyro_bias`).
    The delay that the robot file states is allowed for: a gyro that is late still turns while the
    wheels stand already.
    """
    if run.no_driving is not None or run.reference is None:
        return run
    seen, together = with_even_scan_stamps(run.reference), stamped_together(run)
    seen = replace(in_packets_of(run, seen) if together else seen, stamped_together=together)
    run = replace(run, reference=seen)
    try:
        counters = counters_of(run, robot, limits)
    except InputError:
        return run  # cutting into legs raises the error
    clock = clock_of(counters, seen, robot, clock_offset(robot))
    seen, useless = _without_useless_poses(seen, counters, robot, clock)
    in_time = clock.put_right(seen)
    found = tuple(_by_both(part, clock) for part in no_driving(counters, in_time, robot))
    at_rest = None
    if not seen.has_position.any():  # a gyro
        spans = driven(counters, robot, found).spans
        in_time, at_rest = without_bias(in_time, spans, counters, robot)
    seen = replace(seen, yaw=in_time.yaw)
    return replace(
        run,
        reference=seen,
        no_driving=tuple(sorted([*found, *useless])),
        at_rest=at_rest,
        clock_rate=clock.rate,
        taken_out=(
            *run.taken_out,
            *((clock.stamp(part.begin), clock.stamp(part.end)) for part in useless),
        ),
    )


def _by_both(part: NoDriving, clock: ReferenceClock) -> NoDriving:
    """A stretch by either clock: legs are cut before the rate of the reference's is fitted."""
    begin, end = (clock.stamp(at) - clock.delay for at in (part.begin, part.end))
    return part._replace(begin=min(part.begin, begin), end=max(part.end, end))


def clock_offset(robot: Robot) -> float:
    """Delay of the reference by the robot model if its clock is apart [s]; zero for less.

    Legs of a reference that is only late, by its transport, are cut by its stamps; fits move them.
    """
    delay = view_of(robot.effects).delay
    return delay if abs(delay) >= rules.DELAY_SHORTEST else 0.0


def _without_useless_poses(
    seen: Reference, counters: Counters, robot: Robot, clock: ReferenceClock
) -> tuple[Reference, tuple[NoDriving, ...]]:
    """Blank the poses of lapses and of phases of much more noise, and list these stretches.

    They are in the time of the counters. Another delay, found later, moves no pose out of a stretch
    or into one.
    """
    if seen.own_axes:
        return seen, ()
    in_time = clock.put_right(seen)
    rising = in_time.chosen(later_than_all_before(in_time.time))
    found = sorted([*lapses(counters, rising, robot), *noisy_phases(counters, rising, robot)])
    useless = np.zeros(seen.time.shape, dtype=np.bool_)
    for part in found:
        useless |= (in_time.time > part.begin) & (in_time.time < part.end)
    if not useless.any():
        return seen, ()
    x, y, yaw = (np.where(useless, np.nan, each) for each in (seen.x, seen.y, seen.yaw))
    return replace(seen, x=x, y=y, yaw=yaw), tuple(found)
