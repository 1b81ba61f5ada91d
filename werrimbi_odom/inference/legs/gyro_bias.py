# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Bias of a gyro, estimated while the wheels stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from werrimbi_odom.files.run import Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.motion_states import TimeSpan
from werrimbi_odom.model.pose import wrap_all


def without_bias(reference: Reference, spans: Sequence[TimeSpan]) -> Reference:
    """Remove the bias estimated at rest from the headings of a gyro, if it is significant.

    The robot model takes no part, so all parts of a drive get the same bias. Its change while the
    robot drives is left to the fits, where the drift of each run is free. `reference`: headings
    alone. `spans`: what the robot did when, in order.
    """
    seen = reference.has_yaw
    time, turned = reference.time[seen], wrap_all(np.diff(reference.yaw[seen]))
    duration = np.diff(time)
    rest = np.zeros(duration.size, dtype=np.bool_)
    for span in spans:
        if span.what == "stood":
            inside = (time >= span.begin + rules.BIAS_EDGE) & (time <= span.end - rules.BIAS_EDGE)
            within = inside[:-1] & inside[1:]
            if duration[within].sum() >= rules.BIAS_REST:  # in a pause it may still come to rest
                rest |= within
    seconds = float(duration[rest].sum())
    if not rest.any():
        return reference
    bias = float(turned[rest].sum()) / seconds
    scatter = turned[rest] - bias * duration[rest]
    unsure = float(np.sqrt(scatter @ scatter)) / seconds  # as of a random walk: the larger one
    if abs(bias) < rules.BIAS_SURE * unsure:
        return reference
    return replace(reference, yaw=reference.yaw - bias * (reference.time - reference.time[0]))
