# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Quantities that a physical effect may read in a step; the only memory that it has.

Every quantity is causal: it is known when the step's message arrives. It is given at the step's
start and end, so that an effect can integrate between them and does not depend on the logging rate.
The same class holds floats (the node, step by step) and arrays (a whole run).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Generic, NamedTuple

from werrimbi_odom.model.motion import Number

ROLLBACK = 1.5e-3
"""Largest backward travel of a wheel that is not a reversal [m]. Whatever the counters resolve, the
controller of a stopped wheel moves it to and fro by some tenths of a millimetre."""

SMOOTHING = 0.015
"""Time constant of the low-pass filter before a wheel's acceleration is computed [s]. Counts are
quantised, so the plain difference of two speeds is useless. At 50 messages a second the delay is
less than one message."""


class Span(NamedTuple, Generic[Number]):
    """A quantity at the start and at the end of a step."""

    start: Number
    end: Number

    @property
    def mean(self) -> Number:
        """Mean of start and end."""
        return 0.5 * (self.start + self.end)

    @property
    def change(self) -> Number:
        """End minus start."""
        return self.end - self.start


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive(Generic[Number]):
    """One step, or all steps of a run (arrays of shape (n,)), before any effect.

    Speeds of a message that comes much too early, as in a burst, are those of `step_speeds`.
    """

    duration: Number
    """[s]"""
    time: Span[Number]
    """Since the first message [s]."""
    speed: Span[Number]
    """Forward speed [m/s]: mean of the previous step, mean of this one.

    In the first step both are its own mean: a record may begin in full motion."""
    yaw_rate: Span[Number]
    """[rad/s], likewise."""
    left_speed: Span[Number]
    """Speed of the left wheel's rim [m/s], likewise."""
    right_speed: Span[Number]
    """Speed of the right wheel's rim [m/s], likewise."""
    left_smooth_speed: Span[Number]
    """Low-pass filtered speed of the left wheel's rim (`SMOOTHING`), at the start and end of the
    message that contains the step [m/s]."""
    right_smooth_speed: Span[Number]
    """The same for the right wheel's rim."""
    left_acceleration: Number
    """Change of `left_smooth_speed` over the duration of that message [m/s^2]."""
    right_acceleration: Number
    """The same for the right wheel's rim."""
    left_angle: Span[Number]
    """Angle of the left wheel, from its counter's zero [rad]."""
    right_angle: Span[Number]
    """Angle of the right wheel, from its counter's zero [rad]."""
    distance: Span[Number]
    """Path length of the axle's midpoint, both directions counted positive [m]."""
    left_since_reversal: Span[Number]
    """Travel of the left wheel since its last reversal [m]."""
    right_since_reversal: Span[Number]
    """Travel of the right wheel since its last reversal [m]."""
    since_reversal: Span[Number]
    """Travel of the axle's midpoint since its last reversal [m]."""
    left_direction: Number
    """+1 if the left wheel last rolled forwards, -1 if backwards, 0 before it has moved."""
    right_direction: Number
    """The same for the right wheel."""
    direction: Number
    """The same for the axle's midpoint."""
    reversals: Number
    """Number of reversals of the axle's midpoint so far."""
    left_reversals: Number
    """The same for the left wheel."""
    right_reversals: Number
    """The same for the right wheel."""
    castor_angle: Span[Number]
    """Angle of a castor behind the axle, 0 where it trails in forward motion (`castor`) [rad]."""
    heading: Span[Number]
    """Heading of the robot, in the frame of its pose [rad]."""
    x: Span[Number]
    """x of the axle's midpoint, in the same frame [m]."""
    y: Span[Number]
    """y of the axle's midpoint [m]."""
    channels: Mapping[str, Span[Number]] = field(default_factory=dict)
    """Extra measured channels of the record by name, in their own units."""

    def with_heading(self, start: Number, turn: Number) -> Drive[Number]:
        """Return a copy with the odometry's heading at the start of the step."""
        return self.but(heading=Span(start, start + turn))

    def with_place(self, x: Number, y: Number, moved: tuple[Number, Number]) -> Drive[Number]:
        """Return a copy with the odometry's position at the start of the step."""
        return self.but(x=Span(x, x + moved[0]), y=Span(y, y + moved[1]))

    def but(self, **quantities: Any) -> Drive[Number]:
        """Return a copy with these quantities replaced."""
        return replace(self, **quantities)


class RawStep(NamedTuple):
    """Encoder increments of one step, before any effect."""

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
