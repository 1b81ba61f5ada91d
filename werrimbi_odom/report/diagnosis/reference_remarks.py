# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Remarks on what the reference and the counters of these drives can and cannot tell."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import best_sizes, values_of
from werrimbi_odom.inference.diagnosis.mended_mount import mended_mount
from werrimbi_odom.inference.fitting.identifiable import NOT_BY_COURSE
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.ideal_drives import rates_of
from werrimbi_odom.inference.set_up.misentered_values import is_ordinary
from werrimbi_odom.report.number_format import (
    error_words,
    listed,
    two_digits,
    with_std,
)

_CLOSED = 0.125
"""Distance of its end from its begin up to which a path is closed, in its length: half a side of a
square; of a bend that is open it is more."""


_NOTHING = 1e-5
"""Uncertainty of a wheel's place that no reference sees [m]."""


def floor_not_asked(diagnosis: Diagnosis) -> list[str]:
    """That effects of the floor have no name here, where axes begin anew."""
    if not diagnosis.runs.own_axes:
        return []
    return [
        "What lies on the floor, as a slope or a carpet, has no name by scans, whose axes begin "
        "anew with each drive: it looks like an error that goes with the heading, in each drive by "
        "a wave of its own. Motion capture or a localiser's map shows it."
    ]


def crab_not_asked(diagnosis: Diagnosis) -> list[str]:
    """That nothing tells at which angle the robot drives, where the path gave its headings."""
    if not diagnosis.runs.has_course_headings:
        return []
    return [
        "The headings were laid upon the direction of the path, so nothing tells at which angle to "
        f"them the robot drives: {listed(NOT_BY_COURSE, 'and')} are not asked. A reference that "
        "measures headings beside its positions shows them."
    ]


def by_ruler(diagnosis: Diagnosis) -> list[str]:
    """What tells rivals apart that no manoeuvre of the library does."""
    said = "No manoeuvre of the library tells them apart in reasonable time; "
    if set(diagnosis.rivals) != {"wheel_radius_scale", "track_width"}:
        return [f"{said}a ruler may."]
    lines = [f"{said}a line to and fro beside a tape does: it shows the mean radius alone."]
    if _are_squares(diagnosis):
        lines.append(
            "Squares both ways, measured at begin and end, are what `werrimbi calibrate umbmark` "
            "is for: it takes that radius as entered, and fits the rest."
        )
    return lines


def _are_squares(diagnosis: Diagnosis) -> bool:
    """Whether the drives are rounds both ways, measured at the begin and the end alone."""
    runs = diagnosis.runs
    if runs.count != len(runs.runs):
        return False
    driven = predict_all(diagnosis.final.point.model, runs)
    closed = np.hypot(*driven.relative[:, :2].T) < _CLOSED * driven.length
    round_about = np.abs(np.abs(driven.turn) - math.tau) < 0.25 * math.tau
    both = bool((driven.turn > 0.0).any() and (driven.turn < 0.0).any())
    return bool(np.all(closed & round_about)) and both


def wandering(diagnosis: Diagnosis) -> list[str]:
    """Remark that the reference was taken as absolute, and wanders."""
    wander = diagnosis.wander
    if wander is None:
        return []
    return [
        "But: the reference is not absolute. Its error wanders, by "
        f"{_of_both(wander.place_in_a_second, wander.heading_in_a_second)} in a second, and by "
        f"{_of_both(wander.place, wander.heading)} in the long run (some "
        f"{two_digits(wander.seconds)} s), as a localiser's does. That explains these drives far "
        "better than poses that err one by one. So all of this is reckoned with it, as by "
        "--reference-kind local_map; compare and add want that option too."
    ]


def as_one_that_wanders(diagnosis: Diagnosis, command: str) -> list[str]:
    """Next step where errors of poses that were taken as absolute wander; `command` fits noise."""
    if diagnosis.final.point.options.reference_kind != "absolute":
        return []
    return [
        "Next: there is nothing to add. With poses that err one by one, the reference's wander "
        "would be put down to the wheels' noise: take it for one that wanders, here and in "
        "`werrimbi compare`:",
        f"    {command}",
    ]


def _of_both(place: float, heading: float | None) -> str:
    """Sizes of the errors of positions [m] and, where they were measured, of headings [rad]."""
    sizes = [error_words(place, "m")]
    return listed(sizes if heading is None else [*sizes, error_words(heading, "rad")])


def not_shown(advised: AdvisedDiagnosis) -> list[str]:
    """Effects that would not have been detected, and what would show them."""
    # Named effects were detected, with more than their typical size.
    found = advised.diagnosis.found
    hidden = [sight for sight in advised.sights if sight.hidden and sight.effect not in found]
    if not hidden:
        return []
    # By a noise that is assumed, a base that would be found passes for one that stays hidden.
    by_drive = [
        f"{sight.effect} ({sight.shown_by} would show it)"
        for sight in hidden
        if sight.shown_by and advised.diagnosis.runs.tells_noise
    ]
    lines = []
    if by_drive:
        lines.append(
            f"These drives cannot show whether there is, of usual size, {listed(by_drive, 'or')}."
        )
    needing = [sight.effect for sight in hidden if sight.needs_more]
    if needing:
        lines.append(
            f"No drive shows {listed(needing)} with such a reference; one "
            f"{_better_reference(advised.diagnosis)}."
        )
    return lines


def _better_reference(diagnosis: Diagnosis) -> str:
    """What motion capture has over the reference of these drives, which may be one."""
    runs, point = diagnosis.runs, diagnosis.final.point
    if runs.own_axes:
        return "that measures finely, in axes of the floor, does (motion capture)"
    if not np.isfinite(runs.start).all(axis=1).any():
        return "that measures positions and headings does (motion capture, scans)"
    _, interval = rates_of(runs)
    as_often = interval < math.sqrt(2.0) * rules.MOTION_CAPTURE_INTERVAL
    if point.options.reference_kind != "absolute" or not as_often:
        return "that measures more finely, and more often, does (motion capture)"
    xy, yaw = (math.sqrt(float(part[0])) for part in (point.variances.xy, point.variances.yaw))
    return (
        f"that errs by {error_words(rules.MOTION_CAPTURE_XY, 'm')} and "
        f"{error_words(rules.MOTION_CAPTURE_YAW, 'rad')} would: the poses of this one are off by "
        f"{error_words(xy, 'm')} and {error_words(yaw, 'rad')} each, as fitted"
    )


def coarse_counters(diagnosis: Diagnosis) -> list[str]:
    """Of counters whose steps show from message to message, what is not asked."""
    if not diagnosis.runs.has_coarse_counters:
        return []
    count = max(diagnosis.robot.left_tick, diagnosis.robot.right_tick)
    return [
        f"A count of a wheel is {error_words(count, 'm')}, and a message brings a few at "
        "most: how hard the robot starts is told roughly by that. Laws that bend with the "
        "acceleration (coulomb_slip) are not looked for, and would look like longitudinal_slip."
    ]


def rare_counts(diagnosis: Diagnosis) -> list[str]:
    """Of counters whose messages are rare, how little is known of the wheels between two."""
    runs, robot = diagnosis.runs, diagnosis.robot
    rare = [run.counters.interval for run in runs.runs if run.counters.are_rare]
    if not rare:
        return []
    unseen = float(runs.unseen.max(initial=0.0)) * max(robot.left_tick, robot.right_tick)
    if unseen < _NOTHING:  # a reference with the stamps of the counts asks for none between them
        return []
    return [
        f"Counts come every {two_digits(max(rare))} s: how the wheels changed their speed from one "
        "message to the next is not in them. Where a wheel was between two is uncertain by up to "
        f"{two_digits(1e3 * unseen)} mm (standard deviation), which the fits allow for."
    ]


def or_the_reference_s_scale(diagnosis: Diagnosis) -> list[str]:
    """What looks the same as a size that was found, as the reference's own scale is not known."""
    runs, found = diagnosis.runs, diagnosis.found
    by_ratio = not diagnosis.told.design.sized and "track_width" in found
    radii = "wheel_radius_scale" in found
    absolute = diagnosis.final.point.options.reference_kind == "absolute"
    if not by_ratio and not (runs.own_axes and radii):
        metre = or_its_metre(diagnosis)
        if metre or not radii or (absolute and diagnosis.wander is None):
            return metre
    size = values_of(diagnosis, "wheel_radius_scale")["multiplier"].value
    share = f"{100.0 * abs(size - 1.0):.2g} %"
    if by_ratio:
        larger = "larger" if size > 1.0 else "smaller"
        know = "Headings know" if runs.headings_alone else "Drives that end where they began show"
        return [
            f"{know} the wheels' size over the base alone: wheels that are both {share} "
            f"{larger} than entered look the same to them as that base. A straight line of 10 m "
            "beside a tape tells."
        ]
    if not is_ordinary(size):
        return []
    off = f"{share} too {'long' if size > 1.0 else 'short'}"
    if runs.own_axes:
        return [
            f"A lidar whose ranges are {off} shows the same: a wall at a taped distance, or a "
            "straight line of 10 m beside a tape, tells."
        ]
    other = "smaller" if size > 1.0 else "larger"
    return [
        f"A camera's or a map's metre that is {off} shows the same: the wheels are as entered "
        f"then, and the base is {share} {other} than is told here. A straight line of 10 m beside "
        "a tape tells."
    ]


def or_its_axes(diagnosis: Diagnosis) -> list[str]:
    """That a reference whose axes differ in scale looks like a floor with a grain."""
    if "anisotropic_floor" not in diagnosis.found:
        return []
    sizes = (item.value for item in values_of(diagnosis, "anisotropic_floor").values())
    apart = f"about {200.0 * math.hypot(*sizes):.1g} %"
    return [
        f"A camera (tilted, its picture stretched) or a map that is too long by {apart} along one "
        "direction, against the other, shows nearly the same. If the odometry agrees with the tape "
        "along both, it is that: mend the reference, and do not add a grain, which would bend the "
        "odometry."
    ]


def or_upside_down(diagnosis: Diagnosis) -> list[str]:
    """That scans are mirrored by a lidar that hangs upside down, which nobody need drive to see."""
    if not diagnosis.runs.own_axes or "reference_mirrored" not in diagnosis.rivals:
        return []
    return [
        "A lidar that hangs upside down shows the same: look at it. Its transform (URDF, "
        "/tf_static) should then turn it over, by a roll of 180°. Mend it there, or add "
        "reference_mirrored, but not both."
    ]


def or_a_compass(diagnosis: Diagnosis, goes_with: str) -> list[str]:
    """That a compass errs by the direction, where headings alone do; `goes_with`: a variable."""
    if goes_with != "heading" or not diagnosis.runs.headings_alone:
        return []
    return [
        "A compass beside iron errs so: by the direction it faces, as no wheel does (an IMU's "
        "heading may come from one). A gyro's yaw rate, or a compass far from motors, tells."
    ]


def or_its_metre(diagnosis: Diagnosis) -> list[str]:
    """That one number explains base and radii that are off by one factor within their deviations.

    Where positions are measured, a wrong metre of theirs shows just that.
    """
    if not {"wheel_radius_scale", "track_width"} <= set(diagnosis.found):
        return []
    sizes = best_sizes(diagnosis)
    shares = [
        (value / getattr(diagnosis.given, name), (std or 0.0) / getattr(diagnosis.given, name))
        for name, (value, std) in sizes.items()
    ]
    apart = [
        abs(one - other) > rules.SIGNIFICANT * math.hypot(std, its)
        for (one, std), (other, its) in combinations(shares, 2)
    ]
    size = values_of(diagnosis, "wheel_radius_scale")["multiplier"].value
    if any(apart) or not is_ordinary(size):
        return []
    less = "little" if size < 1.0 else "much"
    return [
        f"Base and radii are off by one factor, {size:.3f}, within their ±. A reference that shows "
        f"{100.0 * abs(size - 1.0):.2g} % too {less} of every way shows the same (reference_scale: "
        "a camera's or a map's metre). Drive a straight line of 10 m beside a tape: if the wheels, "
        "with the robot file as it is, count 10 m, it is the reference: write reference_scale with "
        f"multiplier {size:.4g} into its effects by hand, in place of both (`add` cannot tell it "
        "from the radii), and diagnose again."
    ]


def moved_by_its_odometry(diagnosis: Diagnosis) -> list[str]:
    """That a localiser errs by the base that was found, as this odometry moves it."""
    localised = not diagnosis.runs.has_course_headings and any(
        run.measured.kind == "local_map" and run.measured.has_yaw.any()
        for run in diagnosis.runs.runs
    )
    named = next((name for name in ("track_width", "skid_steer") if name in diagnosis.found), "")
    if not localised or not named:
        return []
    base = values_of(diagnosis, named)["multiplier"].value
    if abs(base - 1.0) < rules.MOVED_BY_ODOMETRY:
        return []
    return [
        "The localiser was moved by this odometry, if it is the robot's own, and so turns by "
        f"{100.0 * abs(base - 1.0):.2g} % too {'much' if base > 1.0 else 'little'} until each scan "
        "corrects it: delays and small sizes found beside the base may be those of its "
        "corrections. Drive once more with the new file on the robot, and diagnose that drive."
    ]


def transform_to_mend(diagnosis: Diagnosis) -> list[str]:
    """What to write into the transform that says where the lidar sits, where it is wrong."""
    found = mended_mount(diagnosis)
    if found is None:
        return []
    where = f"{found.entered.base} -> {found.entered.sensor}"
    should = [
        f"{part} = {_mended(getattr(found.mended, part), std)} {unit}"
        for (part, std), unit in zip(found.std.items(), ("m", "m", "rad"), strict=True)
    ]
    is_now = [f"{part} = {getattr(found.entered, part) + 0.0:.4g}" for part in found.std]
    others = dict.fromkeys(
        other
        for name in found.effects
        for other in (
            *find(name).twins,
            *(diagnosis.rivals if name in diagnosis.rivals else ()),
            *diagnosis.rivals_of_others.get(name, ()),
        )
        if other not in found.effects
    )
    the = f"Unless it is {listed(list(others), 'or')}, the" if others else "The"
    return [
        f"{the} transform {where} (URDF, /tf_static) should be {listed(should)}, where it is "
        f"{listed(is_now)}. Mend it there, or add {listed(found.effects)}, but not both."
    ]


def _mended(value: float, std: float) -> str:
    """Part of a transform; to the millimetre where nothing was found of it."""
    return with_std(value, std) if math.isfinite(std) else f"{value + 0.0:.3f}"
