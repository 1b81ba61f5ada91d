# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Catalogue of hidden effects: names, units, realistic strengths."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from .axle_and_reference import (
    AskewAxle,
    DriftingClock,
    ReferenceDelay,
    ReferenceMirrored,
    ReferenceMount,
    WarmingGyro,
)
from .beyond_library import (
    BaseByPayload,
    OneTyreBackwards,
    OneTyreByLoadOverPressure,
    OneTyreByPressure,
    SlideByTiltAndPayload,
)
from .counters import EncoderSkew, MissedTicks, WheelReversed, WheelsSwapped
from .creep import (
    CastorKick,
    CastorSwing,
    CoulombSlip,
    LateralSlip,
    LongitudinalSlip,
    TurnDependentTrack,
)
from .floor import CablePull, FloorSlope, GrainedFloor, SlipperySpot
from .geometry import TrackWidth, UnequalWheelRadii, WheelRadiusScale
from .hidden_effect import Peculiarity, Rng
from .knocks import Knock, ReferenceJump
from .skid import skid_steer
from .tyres import LoadTransfer, RadiusFollowsPayload, RadiusFollowsTemperature, TyreSquash
from .wheels import Backlash, EccentricWheel, OvalWheel, RadiusDrift, Side, TreadBump

Make = Callable[[float, Rng], Peculiarity]
Kind = Literal["effect", "mistake", "outside", "robot", "event"]

UTMOST = 10.0
"""Times the largest realistic strength beyond which no robot has an effect: wheels 15 mm off their
centre, floors that fall 0.2 m in a metre. Most bounds of the library's effects are near that."""

ANY_SCALE = 1 / 16, 16.0
"""Of a number of the robot file: a diameter for a radius, quarters of counts, both."""


@dataclass(frozen=True)
class Entry:
    """One entry of the catalogue."""

    name: str
    make: Make
    """Makes the peculiarity; its further parameters, such as a direction, are drawn from `rng`."""
    unit: str
    """Unit of the strength."""
    low: float
    high: float
    """Realistic range of its distance from `null`, drawn log-uniformly."""
    says: str
    """Description in one line."""
    null: float = 0.0
    """Strength at which there is no effect."""
    signed: bool = True
    """Whether this distance can be negative."""
    kind: Kind = "effect"
    """Effect of the library, set-up mistake, effect outside the library, another kind of robot, or
    abrupt event."""
    within: tuple[float, float] | None = None
    """Strengths that a robot can have, where they are not `UTMOST` times the realistic ones."""

    @property
    def possible(self) -> tuple[float, float]:
        """Least and largest strength that a robot can have."""
        if self.within is not None:
            return self.within
        reach = UTMOST * self.high
        return self.null - (reach if self.signed else 0.0), self.null + reach

    def draw(self, rng: Rng) -> float:
        """Draw a realistic strength."""
        size = math.exp(rng.uniform(math.log(self.low), math.log(self.high)))
        sign = rng.choice([-1.0, 1.0]) if self.signed else 1.0
        return float(self.null + sign * size)

    @property
    def unit_in_words(self) -> str:
        """Unit as it follows a number, with a space before it; "" for a share or a ratio."""
        return f" {self.unit}" if self.unit not in ("", "1") else ""

    @property
    def range_in_words(self) -> str:
        """Realistic strengths, as text."""
        if self.kind == "mistake":
            return "yes or no"
        unit = self.unit_in_words
        if not self.signed:
            return f"{self.null + self.low:g} to {self.null + self.high:g}{unit}"
        null = f"{self.null:g} " if self.null else ""
        return f"{null}+/- {self.low:g} to {self.high:g}{unit}"


def _mistake(name: str, make: Callable[[Rng], Peculiarity], says: str) -> Entry:
    """Entry of a mistake: strength 0 means without it, any other with it."""
    return Entry(
        name,
        lambda strength, rng: make(rng) if strength else Peculiarity(),
        "",
        1.0,
        1.0,
        says,
        signed=False,
        kind="mistake",
        within=(0.0, 1.0),
    )


def _anywhere(rng: Rng) -> float:
    """A random direction [rad]."""
    return float(rng.uniform(-math.pi, math.pi))


def _either(rng: Rng) -> bool:
    return bool(rng.integers(2))


def _inertia(rng: Rng) -> float:
    """Moment of inertia over mass * (base / 2)^2, of a robot with its masses between its wheels."""
    return float(rng.uniform(0.3, 1.0))


def _tread_bump(side: Side, thickness: float, rng: Rng) -> TreadBump:
    """A bump that covers 30 to 90 degrees of the wheel."""
    return TreadBump(side, thickness, float(rng.uniform(0.5, 1.6)), _anywhere(rng))


def _lever_arm(length: float, rng: Rng) -> ReferenceMount:
    direction = _anywhere(rng)
    return ReferenceMount(x=length * math.cos(direction), y=length * math.sin(direction))


def _radius_drift(per_drive: float, rng: Rng) -> RadiusDrift:
    """Drift for a drive of 20 m or a minute."""
    if _either(rng):
        return RadiusDrift(per_drive / 20.0, "metre")
    return RadiusDrift(per_drive / 60.0, "second")


def _by_channel(per_swing: float, rng: Rng) -> Peculiarity:
    """Change for a swing of 10 K or 10 kg."""
    if _either(rng):
        return RadiusFollowsTemperature(per_swing / 10.0)
    return RadiusFollowsPayload(abs(per_swing) / 10.0)


def _load_transfer(softness: float, rng: Rng) -> LoadTransfer:
    """Driven wheels at the middle with a castor before or behind, or only the lateral part."""
    height, length = rng.uniform((0.6, -0.8), (1.2, 0.8))
    return LoadTransfer(softness, float(height), float(length) * _either(rng))


def _one_side(rng: Rng) -> Side:
    return "left" if _either(rng) else "right"


def _slippery_spot(loss: float, rng: Rng) -> SlipperySpot:
    x, y, radius = rng.uniform((-0.8, -0.8, 0.3), (0.8, 0.8, 0.6))
    return SlipperySpot(loss, float(x), float(y), float(radius))


def _castor_swing(strength: float, rng: Rng) -> CastorSwing:
    """A castor of other lengths than the library's law, behind the axle or in front of it."""
    pivot = float(rng.uniform(0.4, 0.8)) * (1.0 if _either(rng) else -1.0)
    trail = float(rng.uniform(0.1, 0.2))
    return CastorSwing(strength, pivot, trail, float(rng.uniform(-math.pi, math.pi)))


# fmt: off
CATALOGUE: tuple[Entry, ...] = (
    Entry("track_width", lambda s, rng: TrackWidth(s), "1", 0.003, 0.04,
            "true base over believed base", null=1.0, within=ANY_SCALE),
    Entry("unequal_wheel_radii", lambda s, rng: UnequalWheelRadii(s), "1", 0.001, 0.02,
            "right radius over left radius", null=1.0, within=ANY_SCALE),
    Entry("wheel_radius_scale", lambda s, rng: WheelRadiusScale(s), "1", 0.002, 0.03,
            "true radii over believed radius", null=1.0, within=ANY_SCALE),
    Entry("eccentric_left_wheel", lambda s, rng: EccentricWheel("left", s, _anywhere(rng)),
            "m", 3e-4, 1.5e-3, "left axle off the wheel's centre", signed=False),
    Entry("eccentric_right_wheel", lambda s, rng: EccentricWheel("right", s, _anywhere(rng)),
            "m", 3e-4, 1.5e-3, "right axle off the wheel's centre", signed=False),
    Entry("longitudinal_slip", lambda s, rng: LongitudinalSlip(s, _inertia(rng)), "s^2/m", 0.003,
            0.03, "share of a wheel's travel lost per its acceleration", signed=False),
    Entry("lateral_slip", lambda s, rng: LateralSlip(s), "s", 0.002, 0.02,
            "outward creep per speed times yaw rate", signed=False),
    Entry("turn_dependent_track",
            lambda s, rng: TurnDependentTrack(s, "sense" if _either(rng) else "sharpness"),
            "1", 0.004, 0.04, "growth of the base in sharp turns, or in left ones"),
    Entry("sideways_drift", lambda s, rng: AskewAxle(s), "rad", 0.003, 0.03,
            "direction of travel off the body's forward axis"),
    Entry("floor_slope", lambda s, rng: FloorSlope(s, _anywhere(rng)), "m/m", 0.002, 0.02,
            "drift downhill per metre of path", signed=False),
    Entry("castor_kick", lambda s, rng: CastorKick(s, alternating=_either(rng)),
            "rad", 0.004, 0.03, "heading gained after each reversal"),
    Entry("left_backlash", lambda s, rng: Backlash("left", s), "m", 1e-3, 6e-3,
            "free travel of the left rim", signed=False),
    Entry("right_backlash", lambda s, rng: Backlash("right", s), "m", 1e-3, 6e-3,
            "free travel of the right rim", signed=False),
    Entry("left_missed_ticks",
            lambda s, rng: MissedTicks("left", s, float(rng.uniform(0.25, 0.45))), "1", 0.003, 0.05,
            "share of the left counts lost at speed", signed=False),
    Entry("right_missed_ticks",
            lambda s, rng: MissedTicks("right", s, float(rng.uniform(0.25, 0.45))), "1", 0.003,
            0.05, "share of the right counts lost at speed", signed=False),
    Entry("radius_drift", _radius_drift, "per drive", 0.002, 0.02,
            "growth of both radii in 20 m or in a minute"),
    Entry("reference_lever_arm", _lever_arm, "m", 0.01, 0.15,
            "from the axle's midpoint to the point measured", signed=False, within=(0.0, 5.0)),
    Entry("reference_yaw_offset", lambda s, rng: ReferenceMount(yaw=s), "rad", 0.004, 0.05,
            "reference's forward axis against the robot's", within=(-math.pi, math.pi)),
    Entry("reference_delay", lambda s, rng: ReferenceDelay(delay=s), "s", 0.01, 0.1,
            "reference's stamps late", within=(-5.0, 5.0)),
    Entry("reference_heading_delay", lambda s, rng: ReferenceDelay(heading_delay=s), "s", 0.01,
            0.15, "reference's yaw later than its position", signed=False, within=(-2.0, 2.0)),
    Entry("reference_clock_drift", lambda s, rng: DriftingClock(s), "s/s", 5e-4, 5e-3,
            "what the reference's clock gains on the encoders' in a second"),
    Entry("encoder_skew", lambda s, rng: EncoderSkew(s), "s", 0.002, 0.02,
            "right counter read later than the left one"),
    Entry("oval_left_wheel", lambda s, rng: OvalWheel("left", s), "m", 6e-4, 2.5e-3,
            "half the difference of the left wheel's radii", signed=False),
    Entry("oval_right_wheel", lambda s, rng: OvalWheel("right", s), "m", 6e-4, 2.5e-3,
            "half the difference of the right wheel's radii", signed=False),
    Entry("radius_by_channel", _by_channel, "per swing", 0.005, 0.02,
            "growth of both radii in 10 K, or loss in 10 kg, measured"),
    Entry("tyre_squash", lambda s, rng: TyreSquash(s), "1", 0.01, 0.06,
            "loss of each radius at 1 m/s"),
    Entry("load_transfer", _load_transfer, "1", 0.05, 0.3,
            "loss of a radius under half the robot's weight", signed=False, within=(0.0, 0.9)),
    Entry("anisotropic_floor", lambda s, rng: GrainedFloor(s, _anywhere(rng)), "1", 0.003, 0.02,
            "way gained along the floor's grain, and lost across", signed=False),
    Entry("left_tread_bump", lambda s, rng: _tread_bump("left", s, rng), "m", 6e-4, 2.5e-3,
            "thickness of a bump on the left tread, or depth of a flat"),
    Entry("right_tread_bump", lambda s, rng: _tread_bump("right", s, rng), "m", 6e-4, 2.5e-3,
            "thickness of a bump on the right tread, or depth of a flat"),
    Entry("reference_gyro_drift", lambda s, rng: WarmingGyro(s), "rad/s^2", 1e-5, 1e-4,
            "growth of the bias of the reference's heading", signed=False, within=(-1e-3, 1e-3)),
    Entry("coulomb_slip",
            lambda s, rng: CoulombSlip(s, float(rng.uniform(0.3, 0.6)), _inertia(rng)), "s^2/m",
            0.02, 0.15, "share of a wheel's travel lost per acceleration above a threshold",
            signed=False),
    Entry("castor_swing", _castor_swing, "1", 0.003, 0.015,
            "heading gained per angle that the castor swings"),
    _mistake("wheels_swapped", lambda rng: WheelsSwapped(), "left and right exchanged"),
    _mistake("left_wheel_reversed", lambda rng: WheelReversed("left"),
             "left counter with the wrong sign"),
    _mistake("right_wheel_reversed", lambda rng: WheelReversed("right"),
             "right counter with the wrong sign"),
    _mistake("reference_mirrored", lambda rng: ReferenceMirrored(exchanged=_either(rng)),
             "reference's frame left-handed"),
    Entry("one_tyre_by_pressure", lambda s, rng: OneTyreByPressure(_one_side(rng), s), "1/kPa",
            1e-4, 6e-4, "growth of one radius per kilopascal, measured", kind="outside"),
    Entry("base_by_payload", lambda s, rng: BaseByPayload(s), "1/kg", 1.5e-3, 6e-3,
            "growth of the base per kilogram, measured", signed=False, kind="outside"),
    Entry("one_tyre_backwards", lambda s, rng: OneTyreBackwards(_one_side(rng), s), "1", 0.004,
            0.02, "share of one radius lost when rolling backwards", signed=False, kind="outside"),
    Entry("slippery_spot", _slippery_spot, "1", 0.03, 0.3,
            "share of the travel lost on a spot of the floor", signed=False, kind="outside",
            within=(0.0, 1.0)),
    Entry("cable_pull", lambda s, rng: CablePull(s, _anywhere(rng)), "rad/m", 0.005, 0.05,
            "turning towards one direction of the room", signed=False, kind="outside"),
    Entry("slide_by_tilt_and_payload", lambda s, rng: SlideByTiltAndPayload(s), "1/(rad kg)", 0.02,
            0.1, "way downhill per tilt and kilogram, measured", signed=False, kind="outside"),
    Entry("one_tyre_by_load_over_pressure",
            lambda s, rng: OneTyreByLoadOverPressure(_one_side(rng), s), "kPa/kg", 0.1, 0.5,
            "share of one radius lost per load over pressure, measured", signed=False,
            kind="outside"),
    Entry("skid_steer", skid_steer, "1", 0.3, 1.5, "turn by four skidding wheels over true turn",
            null=1.0, signed=False, kind="robot", within=(1.0, 4.0)),
    Entry("push", lambda s, rng: Knock("push", s), "m", 0.01, 0.03,
            "pushed sideways, every 25 s or so", signed=False, kind="event"),
    Entry("heading_kick", lambda s, rng: Knock("heading_kick", s), "rad", 0.02, 0.06,
            "turned at once, every 25 s or so", signed=False, kind="event"),
    Entry("bump", lambda s, rng: Knock("bump", s), "m", 0.01, 0.03,
            "thrown forwards or back, every 25 s or so", signed=False, kind="event"),
    Entry("wheel_slip", lambda s, rng: Knock("wheel_slip", s), "m", 0.01, 0.03,
            "one wheel loses travel at once, every 25 s or so", signed=False, kind="event"),
    Entry("reference_jump", lambda s, rng: ReferenceJump(s, stays=_either(rng)), "m", 0.02, 0.2,
            "reference at another place, once or from then on", signed=False, kind="event"),
)
# fmt: on
