# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Contents of recordings: as a document, as JSON, and the command that comes next."""

from __future__ import annotations

import math
import shlex
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from werrimbi_odom.files.bags.bag_contents import SCAN
from werrimbi_odom.files.robot_descriptions.first_robot import PLACEHOLDER_TICKS
from werrimbi_odom.files.run_folder import REFERENCE
from werrimbi_odom.files.text_files import beside
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.recording_info import Held, Info, can_tell, drove, measures_of
from werrimbi_odom.inference.seldom_measured import more_to_judge, tell_sizes
from werrimbi_odom.report.document import Document, Paragraph
from werrimbi_odom.report.info_wheels import WITHOUT_WHEELS, wheels_to_try
from werrimbi_odom.report.info_words import words_of
from werrimbi_odom.report.number_format import counted, listed, more_like_these, picked
from werrimbi_odom.report.phrases import left_out_json


def document_of(found: Info) -> Document:
    """The complete report."""
    words = [part for each in found.held for part in words_of(each, found)]
    step, command = next_step(found)
    words += [Paragraph(step, apart=True), *([Paragraph(command, "command")] if command else [])]
    return Document(title="What the recordings hold", words=words)


def info_json(found: Info) -> dict[str, Any]:
    """Complete result as JSON; times in each run's own clock [s]."""
    return {
        "runs": [_json_of(each, found) for each in found.held],
        "robot": found.given or found.written,
        "first_robot": picked(found.first, _FIRST) if found.given is None else None,
        "next": next_step(found)[1] or None,
    }


_FIRST = (
    "wheel_radius:radius wheel_separation:separation ticks_per_revolution:ticks "
    "left_wheel_names:left right_wheel_names:right"
)


def _json_of(held: Held, found: Info) -> dict[str, Any]:
    contents, drive = held.contents, held.driven
    taken = "" if held.wheels is None else held.wheels.name
    can, cannot = can_tell(held, found.sizes)
    return {
        "run": str(held.path),
        "problem": held.problem or None,
        "wheels": [
            picked(each, "topic:name type:kind gives joints messages")
            | {"taken": each.name == taken}
            for each in (contents.wheels if contents is not None else ())
        ],
        "wheel_joints": picked(held.joints, "left right no_wheels:others"),
        "references": _references(held),
        "stamps": {
            name: asdict(each) | {"believed": each.believed} for name, each in held.stamps.items()
        },
        "spans": [
            picked(span, "from_s:begin to_s:end what") for span in (drive.spans if drive else ())
        ],
        "distance_m": drive.way if drive is not None and found.sizes else None,
        "turned_rad": drive.turned if drive is not None and found.sizes else None,
        "left_out": left_out_json(held.left_out),
        **picked(held, "restamped_s:restamped scans_restamped_s:scans_restamped"),
        "gyro_bias_rad_per_s": held.gyro_bias,
        "clock_rate": held.clock_rate,
        "speeds_at_rest_m_per_s": None
        if held.at_rest is None
        else {"left": held.at_rest.size, "right": held.at_rest.usual},
        "can_show": can,
        "cannot_show": cannot,
    }


def _references(held: Held) -> list[dict[str, Any]]:
    """Those of the recording, then what another one holds, with that one's path."""
    names = "topic:name type:kind measures independent why messages"
    taken = held.topics if held.other is None else []
    known = held.contents.references if held.contents is not None else ()
    found = [picked(each, names) | {"taken": each.name in taken} for each in known]
    where = {} if held.other is None else {"run": str(held.other)}
    if held.other is not None and held.reference is not None:
        found.append(picked(held.reference, names) | {"taken": True} | where)
    elif held.other is not None or held.contents is None:
        table = {"topic": REFERENCE, "measures": measures_of(held), "taken": True}
        found.append(table | where)
    return found


def next_step(found: Info) -> tuple[str, str]:
    """The next step, and its command; "" if there is none."""
    usable = [each for each in found.held if not each.problem and each.run is not None]
    if not usable:
        return _otherwise(found)
    if any(measures_of(each) == "nothing" for each in usable):
        return (
            "If another recording measured these drives (a tracker's bag, or poses as the "
            "reference.csv of a folder), give it with --reference, to info, compare and diagnose "
            "alike. If none did, record again with something that measures the robot beside its "
            "wheels: an IMU's gyro shows its turning, a localiser or a scan matcher its poses."
        ), ""
    if not any(drove(each, found.sizes) for each in usable):
        return "Record again while the robot drives.", ""
    if found.given is None and found.written is None:
        if not found.first.has_sizes:
            if all(each.wheels is not None and each.wheels.gives == "odometry" for each in usable):
                return (
                    "Next: write the wheel_separation and the wheel_radius that its driver works "
                    "with into a robot file (config/robot.yaml is one to copy), and give it with "
                    "--robot: by them its odometry is turned back into travel of the wheels. A "
                    "ruler tells how far they are right, and so does this."
                ), ""
            return (
                "Next: measure the wheels' radius and the distance between them, enter both in a "
                "robot file (config/robot.yaml is one to copy), and give it with --robot. Or give "
                "the parameter file of the diff_drive_controller with --robot."
            ), ""
        return "Next: a first robot file.", command_of(found)
    apart = [str(each.path) for each in usable if each not in _of_one_command(usable)]
    told = ""
    if apart:
        alone = "it" if len(apart) == 1 else "each"
        told = (
            f"The topics of {listed(apart)} have other names: info of {alone} alone prints its "
            "command. "
        )
    return told + _before_command(found), command_of(found)


def _of_one_command(usable: Sequence[Held]) -> list[Held]:
    """Those whose topics have the names that the first one's have; folders have none."""
    named = {
        index: (each.wheels.name, each.reference and each.reference.name)
        for index, each in enumerate(usable)
        if each.wheels is not None
    }
    first = next(iter(named.values()), None)
    return [each for index, each in enumerate(usable) if named.get(index, first) == first]


def _before_command(found: Info) -> str:
    """Words before the command: what to enter first, or why it has another length of legs."""
    if found.written is not None and found.first.lacks_ticks:
        return (
            f"Nothing tells how many counts a turn of a wheel has: {PLACEHOLDER_TICKS:.0f} in "
            f"{found.written} is a placeholder. Enter left_ticks_per_revolution and "
            "right_ticks_per_revolution there (the encoder's data sheet; times four for both edges "
            "of two channels, times the gear), or turn a wheel by hand ten times and divide. Then:"
        )
    if found.leg > 1.0:
        return (
            f"By legs of {found.leg:g} m, because in shorter ones the noise of these positions "
            "hides what the robot does. Next:"
        )
    if found.intervals < rules.FEWEST_LEGS:
        these = more_like_these(more_to_judge(found.runs))
        shown = "what these show is printed by"
        if _wants_fit(found):
            shown = "base and radii alone are told by these drives together"
        return (
            f"Too seldom measured to judge by: no leg is shorter than from pose to pose, which is "
            f"{counted(found.intervals, 'leg')} at most, and {rules.FEWEST_LEGS} are the least. "
            f"Measure more often on the way, or drive more{these}; {shown}:"
        )
    most = math.floor(found.legs_of(found.leg))
    if found.leg < 1.0 and most < rules.FEWEST_LEGS:
        return (
            f"Too little was driven to judge by: it makes {counted(most, 'leg')} of {found.leg:g} "
            f"m or a quarter turn at most, {rules.FEWEST_LEGS} are the least. Record more; what "
            "these show is printed by:"
        )
    if found.leg < 1.0:
        legs = counted(math.floor(found.legs), "leg")
        return (
            f"By legs of {found.leg:g} m, because of a metre or a quarter turn these drives have "
            f"only {legs}, too few to judge by. Next:"
        )
    return "Next:"


def _wants_fit(found: Info) -> bool:
    """Whether the next command is a calibration: nothing else works on drives so seldom measured.

    With placeholders in the robot file it would be of no use.
    """
    whole = found.leg <= 1.0 and not (found.written is not None and found.first.lacks_ticks)
    return whole and found.intervals < rules.FEWEST_LEGS and tell_sizes(found.runs)


def _otherwise(found: Info) -> tuple[str, str]:
    """Next step if the chosen topics are not usable: what is missing, or another topic to try."""
    if all(held.contents is not None and held.wheels is None for held in found.held):
        if topic := wheels_to_try(found.held[0]):
            return f"Next, if {topic} is of its wheels:", _once_more(found, "--ticks-topic", topic)
        return WITHOUT_WHEELS, ""
    for held in found.held:
        if held.at_fault == "names":
            return f"Next: {_names_to_write(held, found)}", ""
        if held.at_fault:
            return "Nothing of it can be judged as it is.", ""
    for held in found.held:
        if held.contents is None or held.reference is None:
            continue
        known = held.contents.preferred
        # Those before it may have led here: the commands would go round in a circle.
        first = known.index(held.reference) + 1 if held.reference in known else 0
        # Where a lidar sees nothing, what is made of its scans holds nothing either.
        scans = held.reference.kind == SCAN
        others = sorted(known[first:], key=lambda each: scans and each.kind == SCAN)
        if others:
            asked = _wheels_asked([held])
            command = _once_more(found, *asked, "--reference-topic", others[0].name)
            return f"By {held.reference.name} nothing can be judged. Next:", command
    return "Nothing of it can be judged as it is.", ""


def _once_more(found: Info, *words: str) -> str:
    """The command itself with more words."""
    file = found.given or found.written or found.parameters
    robot = [] if file is None else ["--robot", str(file)]
    paths = [str(each.path) for each in found.held]
    return shlex.join(["werrimbi", "info", *paths, *robot, *_others(found.held), *words])


def _names_to_write(held: Held, found: Info) -> str:
    """Lines for a robot file that names other joints than the recording has."""
    lines = (
        f"{side}_wheel_names: [{', '.join(names)}]"
        for side, names in (("left", held.joints.left), ("right", held.joints.right))
    )
    return f"if these are its wheels, write {' and '.join(lines)} into {found.given}."


def _wheels_asked(usable: Sequence[Held]) -> list[str]:
    """The option for wheels that are not the first to be looked at."""
    for held in usable:
        known = () if held.contents is None else held.contents.wheels
        if held.wheels is not None and known and held.wheels.name != known[0].name:
            return ["--ticks-topic", held.wheels.name]
    return []


def _asked(usable: Sequence[Held]) -> list[str]:
    """The option for a reference that would not be taken by itself."""
    for held in usable:
        if held.reference is None:
            continue
        known = () if held.contents is None else held.contents.preferred
        if held.other is not None or held.reference in known[1:]:
            return ["--reference-topic", held.reference.name]
    return []


def _others(usable: Sequence[Held]) -> list[str]:
    """The recordings that hold the references, each with its option."""
    others = [str(each.other) for each in usable if each.other is not None]
    return [word for other in others for word in ("--reference", other)]


def command_of(found: Info) -> str:
    """The next command, quoted for a shell."""
    usable = [each for each in found.held if not each.problem and each.run is not None]
    paths = [str(each.path) for each in usable]
    robot = found.given or found.written
    if robot is None:
        given = [] if found.parameters is None else ["--robot", str(found.parameters)]
        return shlex.join(
            [
                *("werrimbi", "info", *paths, *given, *_wheels_asked(usable), *_asked(usable)),
                *(*_others(usable), "--out", "robot.yaml"),
            ]
        )
    fit = _wants_fit(found)
    words = ["werrimbi", *(["calibrate", "fit"] if fit else ["compare"]), "--robot", str(robot)]
    if found.leg != 1.0 and not fit:
        words += ["--leg", f"{found.leg:g}"]
    usable = _of_one_command(usable)
    paths = [str(each.path) for each in usable]
    held = next((each for each in usable if each.wheels is not None), usable[0])
    if held.wheels is not None:
        words += ["--ticks-topic", held.wheels.name]
    if held.reference is not None:
        topics = held.topics if all(each.beside for each in usable) else held.topics[:1]
        words += [word for topic in topics for word in ("--reference-topic", topic)]
    out = ["--out", beside(robot, "fitted")] if fit else []
    return shlex.join([*words, *_others(usable), *paths, *out])
