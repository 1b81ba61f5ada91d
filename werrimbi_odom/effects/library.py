# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""All effects of this package: one file for each, or for a pair of left and right."""

from __future__ import annotations

from werrimbi_odom.effects.anisotropic_floor import anisotropic_floor
from werrimbi_odom.effects.backlash import left_backlash, right_backlash
from werrimbi_odom.effects.castor_kick import castor_kick
from werrimbi_odom.effects.castor_swing import castor_swing
from werrimbi_odom.effects.coulomb_slip import coulomb_slip
from werrimbi_odom.effects.eccentric_wheel import eccentric_left_wheel, eccentric_right_wheel
from werrimbi_odom.effects.encoder_skew import encoder_skew
from werrimbi_odom.effects.floor_slope import floor_slope
from werrimbi_odom.effects.lateral_slip import lateral_slip
from werrimbi_odom.effects.load_transfer import load_transfer
from werrimbi_odom.effects.longitudinal_slip import longitudinal_slip
from werrimbi_odom.effects.missed_ticks import left_missed_ticks, right_missed_ticks
from werrimbi_odom.effects.oval_wheel import oval_left_wheel, oval_right_wheel
from werrimbi_odom.effects.radius_by_channel import radius_by_channel
from werrimbi_odom.effects.radius_drift import radius_drift
from werrimbi_odom.effects.reference_clock import (
    reference_clock_drift,
    reference_delay,
    reference_heading_delay,
)
from werrimbi_odom.effects.reference_gyro_drift import reference_gyro_drift
from werrimbi_odom.effects.reference_mirrored import reference_mirrored
from werrimbi_odom.effects.reference_mount import reference_lever_arm, reference_yaw_offset
from werrimbi_odom.effects.reference_scale import reference_scale
from werrimbi_odom.effects.sideways_drift import sideways_drift
from werrimbi_odom.effects.skid_steer import skid_steer
from werrimbi_odom.effects.track_width import track_width
from werrimbi_odom.effects.tread_bump import left_tread_bump, right_tread_bump
from werrimbi_odom.effects.turn_dependent_track import turn_dependent_track
from werrimbi_odom.effects.tyre_squash import tyre_squash
from werrimbi_odom.effects.unequal_wheel_radii import unequal_wheel_radii
from werrimbi_odom.effects.wheel_radius_scale import wheel_radius_scale
from werrimbi_odom.effects.wiring_mistakes import (
    left_wheel_reversed,
    right_wheel_reversed,
    wheels_swapped,
)
from werrimbi_odom.model.effect import Effect

LIBRARY: tuple[Effect, ...] = (
    track_width,
    unequal_wheel_radii,
    wheel_radius_scale,
    eccentric_left_wheel,
    eccentric_right_wheel,
    oval_left_wheel,
    oval_right_wheel,
    left_tread_bump,
    right_tread_bump,
    tyre_squash,
    load_transfer,
    longitudinal_slip,
    coulomb_slip,
    lateral_slip,
    turn_dependent_track,
    skid_steer,
    sideways_drift,
    floor_slope,
    anisotropic_floor,
    castor_kick,
    castor_swing,
    left_backlash,
    right_backlash,
    left_missed_ticks,
    right_missed_ticks,
    radius_drift,
    radius_by_channel,
    reference_lever_arm,
    reference_yaw_offset,
    reference_delay,
    reference_heading_delay,
    reference_clock_drift,
    reference_scale,
    reference_gyro_drift,
    encoder_skew,
    wheels_swapped,
    left_wheel_reversed,
    right_wheel_reversed,
    reference_mirrored,
)
