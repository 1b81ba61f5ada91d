# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What of a recorded run can be judged: stamps put right, and what is no driving, or no reference.

The order matters: a stretch is found by stamps that are even, among poses that are not wrong, and a
gyro's bias is told by rests that are known as such.
"""

from __future__ import annotations

from dataclasses import replace

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.legs.blanked_poses import without_useless_poses
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.inference.legs.even_stamps import (
    in_packets_of,
    stamped_together,
    with_even_scan_stamps,
)
from werrimbi_odom.inference.legs.gyro_bias import without_bias
from werrimbi_odom.inference.legs.held_or_carried import no_driving
from werrimbi_odom.inference.legs.modelled_clock_offset import clock_offset
from werrimbi_odom.inference.legs.motion_states import driven
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
    delay = clock_offset(robot)
    seen, useless = without_useless_poses(seen, counters, robot, delay)
    in_time = seen.earlier(delay)
    found = no_driving(counters, in_time, robot)
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
        taken_out=(*run.taken_out, *((part.begin + delay, part.end + delay) for part in useless)),
    )
