# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""All parameters of the robot file, for the node, the command line and the docs."""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from dataclasses import fields

from werrimbi_odom.errors import InputError, nearest
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter, Value
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.robot import Robot

TICKS = ("left_ticks_per_revolution", "right_ticks_per_revolution")
VIRTUAL_TICKS_PER_REVOLUTION = 2.0e6 * math.pi
"""Counts of one microradian, for wheel angles from an unknown encoder: no quantisation."""
WHOLE_COUNTS = 50
"""Different whole numbers, and nothing else, that no angle in radians runs through by chance."""

PARAMETERS: tuple[NodeParameter, ...] = (
    NodeParameter(
        "wheel_separation",
        None,
        "Nominal distance between the wheels' contact points. Too large: turns come out too small.",
        unit="m",
        above=0.0,
    ),
    NodeParameter(
        "wheel_radius",
        None,
        "Nominal radius of both wheels. Too large: every distance comes out too long.",
        unit="m",
        above=0.0,
    ),
    NodeParameter(
        "wheel_separation_multiplier",
        1.0,
        "C_B of the UMBmark calibration: effective over nominal separation.",
        above=0.0,
    ),
    NodeParameter(
        "left_wheel_radius_multiplier",
        1.0,
        "C_L of the UMBmark calibration: effective over nominal radius of the left wheel.",
        above=0.0,
    ),
    NodeParameter(
        "right_wheel_radius_multiplier",
        1.0,
        "C_R of the UMBmark calibration: effective over nominal radius of the right wheel.",
        above=0.0,
    ),
    NodeParameter(
        "left_ticks_per_revolution",
        None,
        "Counts of the left encoder for one turn of its wheel, gear and edges included. "
        "Not needed where positions come in radians: then there is no quantisation.",
        unit="ticks",
        above=0.0,
    ),
    NodeParameter(
        "right_ticks_per_revolution",
        None,
        "The same for the right encoder.",
        unit="ticks",
        above=0.0,
    ),
    NodeParameter(
        "encoder_bits",
        0,
        "Width at which the counters wrap, 2 or more; 0: they do not. Wrong: the pose jumps at "
        "each wrap.",
        unit="bits",
        minimum=0,
        maximum=64,
    ),
    NodeParameter(
        "left_wheel_noise",
        4.0e-4,
        "k_L: the left wheel errs by k_L·√s over a travel s. Default: the paper's robot.",
        unit="m^0.5",
        minimum=0.0,
    ),
    NodeParameter(
        "right_wheel_noise",
        5.8e-4,
        "k_R: the same for the right wheel. Default: the paper's robot.",
        unit="m^0.5",
        minimum=0.0,
    ),
    NodeParameter(
        "covariance_order",
        "first",
        "first: the paper's covariance. exact: exact moments, for headings known to worse than "
        "about 0.3 rad (long drives without a fix); costs a little more time per message.",
        choices=("first", "exact"),
    ),
    NodeParameter(
        "piece_path_tolerance",
        0.003,
        "How far the path may leave a piece's arc. Smaller: more pieces, not a better pose.",
        unit="m",
        above=0.0,
    ),
    NodeParameter(
        "piece_heading_tolerance",
        0.01,
        "How far the heading may leave a piece's arc. Smaller: more pieces, not a better pose.",
        unit="rad",
        above=0.0,
    ),
    NodeParameter(
        "max_wheel_speed",
        0.0,
        "Fastest that a wheel can go; 0: unknown. Given, faster steps are refused until a second "
        "message confirms them. Too small: true motion is refused (/diagnostics counts it).",
        unit="m/s",
        minimum=0.0,
    ),
    NodeParameter(
        "gap_duration",
        1.0,
        "Intervals longer than this count as gaps on /diagnostics; their motion is kept.",
        unit="s",
        above=0.0,
    ),
    NodeParameter("odom_frame_id", "odom", "Frame of the pose (REP-105)."),
    NodeParameter("base_frame_id", "base_link", "Frame of the robot (REP-105)."),
    NodeParameter(
        "enable_odom_tf",
        False,
        "Broadcast odom -> base_link on /tf; needs tf2_ros. Off where an EKF broadcasts it.",
    ),
    NodeParameter(
        "input_type",
        "joint_state",
        "Kind of the input messages.",
        choices=("joint_state", "int32_pair", "int64_pair", "int64_multi_array"),
    ),
    NodeParameter(
        "position_unit",
        "radians",
        "Unit of JointState positions: radians of the wheel, or ticks of its encoder.",
        choices=("radians", "ticks"),
    ),
    NodeParameter(
        "left_wheel_names",
        ("left_wheel_joint",),
        "Joints of the left side; several (four wheels) are averaged.",
    ),
    NodeParameter(
        "right_wheel_names",
        ("right_wheel_joint",),
        "Joints of the right side; several (four wheels) are averaged.",
    ),
    NodeParameter(
        "pairing_window",
        0.02,
        "Left and right counts that arrive within this time are one reading (int32_pair, "
        "int64_pair). Too large: a reading of one wheel may be paired with an older one.",
        unit="s",
        above=0.0,
    ),
    NodeParameter(
        "learn_from_topic",
        "",
        "Topic of a measured heading from which the node learns what each drive has anew (the "
        "phase of an eccentric wheel); empty: it does not.",
    ),
    NodeParameter(
        "learn_from_type",
        "imu",
        "Kind of its messages: sensor_msgs/Imu (yaw rate), geometry_msgs/PoseStamped or "
        "nav_msgs/Odometry (yaw).",
        choices=("imu", "pose_stamped", "odometry"),
    ),
    NodeParameter(
        "slip_imu_topic",
        "",
        "Topic of a gyro (sensor_msgs/Imu, not upside down): where it contradicts the wheels, they "
        "slip, and the covariance grows by what was missed; empty: it does not.",
    ),
)


def defaults() -> dict[str, Value]:
    """Default values of all optional parameters."""
    return {item.name: item.default for item in PARAMETERS if item.default is not None}


def find(name: str) -> NodeParameter:
    """The parameter with this name.

    InputError for an unknown name; the message suggests the closest known one.
    """
    for item in PARAMETERS:
        if item.name == name:
            return item
    near = nearest(name, [item.name for item in PARAMETERS])
    raise InputError(f"unknown parameter {name}{near or ' (docs/node.md lists all)'}")


_LARGEST = {"wheel_separation": 20.0, "wheel_radius": 2.5}
"""Sizes beyond those of the largest vehicles there are [m]: haul trucks, container carriers."""


def doubtful_sizes(values: Mapping[str, Value]) -> list[str]:
    """Remarks on sizes that are hardly metres."""
    return [
        f"{name} is {values[name]:g} m: is it in millimetres?"
        for name, most in _LARGEST.items()
        if float(values[name]) > most  # type: ignore[arg-type]
    ]


def robot_of(values: Mapping[str, Value], effects: tuple[AppliedEffect, ...] = ()) -> Robot:
    """Robot described by a complete set of checked values, and its effects."""
    numbers = {item.name: values[item.name] for item in fields(Robot) if item.name in values}
    names = (values["left_wheel_names"], values["right_wheel_names"])
    many = max(len(each) for each in names)  # type: ignore[arg-type]
    return Robot(**numbers, effects=effects, wheels_a_side=max(many, 1))  # type: ignore[arg-type]


def tolerance_of(values: Mapping[str, Value]) -> PieceTolerance:
    """Piece tolerance from a complete set of checked values."""
    return PieceTolerance(
        path=float(values["piece_path_tolerance"]),  # type: ignore[arg-type]
        heading=float(values["piece_heading_tolerance"]),  # type: ignore[arg-type]
    )


def limits_of(values: Mapping[str, Value]) -> EncoderLimits:
    """Encoder limits from a complete set of checked values."""
    return EncoderLimits(
        max_wheel_speed=float(values["max_wheel_speed"]),  # type: ignore[arg-type]
        gap_duration=float(values["gap_duration"]),  # type: ignore[arg-type]
    )


def virtual_ticks(values: Mapping[str, Value], given: Container[str]) -> dict[str, Value]:
    """Counts of a turn where none are given and none are needed, else nothing.

    Where wheel positions are in radians, counts of a turn are only their resolution. `values`: all
    parameters known so far, defaults included. `given`: names of the parameters that are given,
    well or badly. InputError if positions are to be wrapped at a number of counts.
    """
    radians = values["input_type"] == "joint_state" and values["position_unit"] == "radians"
    if not radians or any(name in given for name in TICKS):
        return {}
    if values["encoder_bits"]:
        raise InputError(f"encoder_bits needs {' and '.join(TICKS)}")
    return dict.fromkeys(TICKS, VIRTUAL_TICKS_PER_REVOLUTION)


def on_both_sides(values: Mapping[str, Value]) -> list[str]:
    """Joints that are named left and right, in words: such a robot would never turn."""
    left, right = (values[f"{side}_wheel_names"] for side in ("left", "right"))
    assert isinstance(left, tuple)
    assert isinstance(right, tuple)
    if values["input_type"] != "joint_state":
        return []
    return [
        f"{name} is in left_wheel_names and in right_wheel_names; name the joint of each side"
        for name in left
        if name in right
    ]
