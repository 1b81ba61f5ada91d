# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a physical effect may look at in a step, and all the memory it may use.

Every quantity is known when the step's message arrives (causal), and is given at the step's start
and end, so that an effect can integrate between them and does not depend on the logging rate. The
same class holds floats (the node, step by step) and arrays (a whole run).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Generic, NamedTuple

from werrimbi_odom.model.motion import Number

ROLLBACK = 1.5e-3
"""A wheel that goes back by no more than this [m] has not reversed: whatever the counters resolve,
a stopped wheel is still settled by its controller, by some tenths of a millimetre to and fro."""

SMOOTHING = 0.015
"""Time constant of the low pass before a wheel's acceleration is told [s]: counters step, so that
the difference of two speeds is none. At 50 messages a second it is late by less than one."""


class Span(NamedTuple, Generic[Number]):
    """A quantity at the start and at the end of a step."""

    start: Number
    end: Number

    @property
    def mean(self) -> Number:
        """Half way between."""
        return 0.5 * (self.start + self.end)

    @property
    def change(self) -> Number:
        """End minus start."""
        return self.end - self.start


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive(Generic[Number]):
    """One step, or all steps of a run (arrays of shape (n,)), before any effect."""

    duration: Number
    """[s]"""
    time: Span[Number]
    """Since the first message [s]."""
    speed: Span[Number]
    """Forward speed [m/s]: mean of the last step, mean of this one.

    In the first step both are its own mean: a record may begin in full motion, and nothing is known
    of what was before."""
    yaw_rate: Span[Number]
    """[rad/s], likewise."""
    left_speed: Span[Number]
    """Of the left wheel's rim [m/s], likewise."""
    right_speed: Span[Number]
    """Of the right wheel's rim [m/s], likewise."""
    left_smooth_speed: Span[Number]
    """Of the left wheel's rim behind a low pass of `SMOOTHING`, at the start and at the end of the
    message that the step is a part of [m/s]."""
    right_smooth_speed: Span[Number]
    """Of the right wheel's rim, likewise."""
    left_acceleration: Number
    """Change of `left_smooth_speed` over how long that message lasted [m/s^2]."""
    right_acceleration: Number
    """Of the right wheel's rim, likewise."""
    left_angle: Span[Number]
    """Of the left wheel, from its counter's zero [rad]."""
    right_angle: Span[Number]
    """Of the right wheel, from its counter's zero [rad]."""
    distance: Span[Number]
    """Path of the axle's midpoint, both directions counted [m]."""
    left_since_reversal: Span[Number]
    """Travel of the left wheel since it last reversed [m]."""
    right_since_reversal: Span[Number]
    """Travel of the right wheel since it last reversed [m]."""
    since_reversal: Span[Number]
    """Travel of the axle's midpoint since it last reversed [m]."""
    left_direction: Number
    """+1 when the left wheel last rolled forwards, -1 backwards, 0 before it has moved."""
    right_direction: Number
    """The same for the right wheel."""
    direction: Number
    """The same for the axle's midpoint."""
    reversals: Number
    """How often the axle's midpoint has reversed so far."""
    left_reversals: Number
    """The same for the left wheel."""
    right_reversals: Number
    """The same for the right wheel."""
    heading: Span[Number]
    """Of the robot, in the frame that its pose is given in [rad]."""
    x: Span[Number]
    """Where the axle's midpoint is, in the same frame [m]."""
    y: Span[Number]
    """Likewise, across [m]."""
    channels: Mapping[str, Span[Number]] = field(default_factory=dict)
    """Extra measured channels of the record, by name, in their own units."""

    def with_heading(self, start: Number, turn: Number) -> Drive[Number]:
        """The same with the heading that the odometry has at the start of the step."""
        return self.but(heading=Span(start, start + turn))

    def with_place(self, x: Number, y: Number, moved: tuple[Number, Number]) -> Drive[Number]:
        """The same with the place that the odometry has at the start of the step."""
        return self.but(x=Span(x, x + moved[0]), y=Span(y, y + moved[1]))

    def but(self, **quantities: Any) -> Drive[Number]:
        """The same with other quantities."""
        return replace(self, **quantities)


class RawStep(NamedTuple):
    """What the encoders say of one step, before any effect."""

    duration: float
    left: float
    """Travel of the left wheel [m]."""
    right: float
    """Travel of the right wheel [m]."""
    along: float
    """Travel of the axle's midpoint [m]."""
    turn: float
    """[rad]"""
    left_angle: float
    """Change of the left wheel's angle [rad]."""
    right_angle: float
    """Change of the right wheel's angle [rad]."""
