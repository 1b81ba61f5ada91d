# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The angle at which a castor trails, from the motion of the robot.

A castor is a trailer of one wheel (LaValle, Planning Algorithms, 2006, section 13.1.2.4) that is
hitched off the axle: its contact with the floor rolls, and does not slide sideways. Its pivot, l in
front of the axle, moves forward with the speed v and sideways with l w; the contact trails it by t.
So the angle a of the castor, 0 where it trails in forward motion, obeys

    da/dt = -w - (v sin(a) - l w cos(a)) / t

In reverse, the angle 0 is unstable and the castor swings round, to the side to which the last curve
has left it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.pose import Floats

Steps = Sequence[float] | Floats
"""A list where Python runs, an array where compiled code does."""

PIVOT = -0.6
"""Forward from the axle to the pivot, in wheel separations: a castor behind the axle.

One in front swings to the other side at nearly the same places, so that an effect of the swing has
the other sign there, and no need of a second angle."""

TRAIL = 0.15
"""From the pivot to the contact, in wheel separations: 15 to 50 mm on robots of 0.1 to 0.35 m."""

PLAY = 1e-4
"""How far from straight it trails at best [rad]. Robots do not drive straighter; a simulated one
does, and rounding would decide to which side the castor swings."""


def swing(angle: float, along: float, turn: float, track: float) -> float:
    """By how much the castor's angle changes in a step of constant speeds [rad].

    The equation is one of Riccati in exp(i a), so the step is a Moebius map of the unit circle and
    exact, however long it is.

    Parameters
    ----------
    angle
        Of the castor at the start of the step [rad].
    along, turn
        Motion of the axle's midpoint [m] and of the body [rad] in the step.
    track
        Wheel separation [m].
    """
    lag = along / (TRAIL * track)
    sway = turn * PIVOT / TRAIL
    steady = PLAY * abs(lag) - turn
    # da = steady + sway * cos(a) - lag * sin(a)
    growth = 0.25 * (sway * sway + lag * lag - steady * steady)
    if growth > 0.0:  # not below: the pivot is farther from the axle than the contact from it
        rate = math.sqrt(growth)
        half = 0.5 * math.tanh(rate) / rate
    else:
        half = 0.5
    cosine, sine = math.cos(angle), math.sin(angle)
    along_circle = half * (steady + sway * cosine - lag * sine)
    return 2.0 * math.atan2(along_circle, 1.0 + half * (lag * cosine + sway * sine))


def trailed(along: Steps, turn: Steps, track: float, swings: Floats) -> None:
    """Fill the swing of each step [rad]; before the first the angle is 0. All of shape (n,)."""
    angle = 0.0
    for step in range(len(along)):
        swings[step] = swing(angle, along[step], turn[step], track)
        angle += swings[step]


def castor_swings(along: Floats, turn: Floats, track: float) -> Floats:
    """Change of the castor's angle in each step of a run [rad], shape (n,).

    Parameters
    ----------
    along, turn
        Motion of the axle's midpoint [m] and of the body [rad] in each step, shape (n,).
    track
        Wheel separation [m].
    """
    swings = np.empty(along.size)
    work = compiled(trailed)  # fits compute it hundreds of times
    if work is None:
        trailed(along.tolist(), turn.tolist(), track, swings)
    else:
        work(np.ascontiguousarray(along), np.ascontiguousarray(turn), track, swings)
    return swings
