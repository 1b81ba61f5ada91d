# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs of effects that are indistinguishable on any drive, and what separates them."""

from __future__ import annotations

from werrimbi_odom.model.effect_declarations import Twin


def askew(name: str) -> Twin:
    """An oblique axle under the body, or an oblique marker on it; `name` is the other one."""
    return Twin(
        name,
        told_apart_by="no drive can tell a robot that crabs from a marker mounted askew by the "
        "opposite angle; turned by 90 degrees, the mount's angle turns with it and a crab's stays",
        do="take the reference's marker or sensor off, mount it anew turned by 90 degrees, enter "
        "that, and drive again",
        manoeuvre="remount_reference",
        values={"angle": ("angle", -1.0)},
    )


def turning_the_wrong_way(name: str) -> Twin:
    """Counters exchanged, or a reference in a left-handed frame."""
    return Twin(
        name,
        told_apart_by="no drive can tell a robot that turns the wrong way from a reference that "
        "does (once the radii of left and right are exchanged too); a hand can",
        do="turn the robot to the left by hand: the reference's yaw must grow, and so must right "
        "minus left counts; whichever does not is wrong",
        manoeuvre="turn_by_hand",
    )


def radii_over_base(name: str) -> Twin:
    """The wheel base, or both radii, if only headings are measured."""
    return Twin(
        name,
        told_apart_by="where headings alone are measured only radii over base shows; a taped "
        "distance tells the radii",
        do="drive 10 m straight by the odometry beside a tape, or use a reference that measures "
        "positions",
        manoeuvre="out_and_back",
        minutes=2.0,
        values={"multiplier": ("multiplier", 1.0)},
        of_headings=True,
        inverse=True,
    )


def own_scale(name: str, inverse: bool = False) -> Twin:
    """The wheel base, or both radii, or the scale of a gyro."""
    return Twin(
        name,
        told_apart_by="where headings alone are measured a base that is wider and a gyro that "
        "shows too little of a turn are one; a hand can tell",
        do="turn the robot by hand ten times, from a line on the floor back onto it: the "
        "reference's heading must change by 3600 degrees, and over that it is its own scale",
        manoeuvre="ten_turns_by_hand",
        values={"multiplier": ("multiplier", 1.0)},
        of_headings=True,
        inverse=inverse,
    )


def turning_about_another_point(name: str) -> Twin:
    """A centre of rotation that is not the middle of the wheels, or a displaced marker."""
    return Twin(
        name,
        told_apart_by="where the reference is mounted is known by a tape, and about which point of "
        "its body the robot turns is seen on the floor; to the reference both are one",
        do="spin on the spot and mark the point of the body that stays over one place of the floor",
        values={"x": ("x", -1.0), "y": ("y", -1.0)},
    )


def as_a_wider_base(name: str) -> Twin:
    """Wheels that skid, or a wider wheel base than entered, if only headings are measured."""
    return Twin(
        name,
        told_apart_by="where headings alone are measured both are one number; the wheels tell "
        "which name is right, for more than two driven ones skid in turns",
        do="count the driven wheels, and measure how far apart the two sides stand",
        of_headings=True,
    )
