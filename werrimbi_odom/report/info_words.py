# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Contents of a recording in words: wheels, references, stamps, and how the robot was driven."""

from __future__ import annotations

import math
from collections.abc import Iterator

from werrimbi_odom.files.bags.bag import topic_in_words
from werrimbi_odom.files.bags.bag_contents import SCAN
from werrimbi_odom.files.bags.bag_wheels import ARRAYS, FLOATS
from werrimbi_odom.files.bags.own_odometry import names_a_measurement
from werrimbi_odom.files.bags.reference_choice import other_scans
from werrimbi_odom.files.references.held_poses import words_about_held
from werrimbi_odom.files.references.levelled import TOLD
from werrimbi_odom.files.run_folder import REFERENCE
from werrimbi_odom.inference.legs.motion_states import DrivenAmount
from werrimbi_odom.inference.recording_info import (
    Held,
    Info,
    can_tell,
    measured_seldom,
    measures_of,
    unseen_much,
)
from werrimbi_odom.inference.set_up.findings import WIRING_WORDS
from werrimbi_odom.inference.set_up.search import SWAPPED
from werrimbi_odom.report.document import Paragraph, paragraphs
from werrimbi_odom.report.info_stamps import milliseconds, stamps_words
from werrimbi_odom.report.info_wheels import (
    no_wheels_words,
    other_wheels_words,
    rate_words,
    wheels_words,
)
from werrimbi_odom.report.number_format import capital, listed
from werrimbi_odom.report.phrases import left_out_words, remark_words

_MEASURES = {"poses": "poses", "positions": "positions", "yaw": "headings alone"}
_WITHOUT_FORM = ("std_msgs/msg/String", *FLOATS, *ARRAYS)
"""Types in which anything may be sent, and so a pose."""


def words_of(held: Held, found: Info) -> list[Paragraph]:
    """The path of the recording, and a list of its contents."""
    head = Paragraph(str(held.path), apart=True)
    return [head, *paragraphs(f"- {each}" for each in _lines(held, found))]


def _lines(held: Held, found: Info) -> Iterator[str]:
    if held.contents is not None:
        yield wheels_words(held)
        yield from no_wheels_words(held.joints)
        yield from other_wheels_words(held)
        yield from _references(held)
        yield from stamps_words(held)
    else:
        yield "Wheels: ticks.csv, counters."
    if found.given is None and "bits" in (found.first.told or {}):
        bits = found.first.bits
        yield (
            f"The counters begin anew at {bits} bits: the robot file needs encoder_bits: {bits}; "
            "one that --out writes has it."
        )
    yield from _of_another_file(held)
    yield from _mistakes(held)
    if held.restamped:
        yield (
            "The counts show that the wheels' counters were read at even intervals, and stamped as "
            "their messages came: the stamps are set back to the readings, by "
            f"{milliseconds(held.restamped)} (rms)."
        )
    if held.rare:
        yield (
            f"Its counts come every {held.rare:.2g} s: what the wheels do between two messages is "
            "not in them, as at hard starts. Let the driver send 20 a second, if it can."
        )
    if held.scans_restamped:
        yield (
            "The path shows that the lidar turned evenly, and that its scans are not stamped so: "
            f"their stamps are set back by {milliseconds(held.scans_restamped)} (rms)."
        )
    if held.gyro_bias:
        yield (
            f"Its headings turn by {math.degrees(held.gyro_bias):.2g}°/s while the wheels stand: "
            "a gyro's bias, which is removed."
        )
    if held.at_rest is not None:
        yield remark_words(held.at_rest)
    if held.clock_rate:
        yield (
            f"The reference's clock {'gains' if held.clock_rate > 0.0 else 'loses'} "
            f"{milliseconds(abs(held.clock_rate))} a second on the wheels': only so do both move "
            "alike. `diagnose` fits it (`reference_clock_drift`); better mend the stamps of "
            "whichever is wrong."
        )
    if held.problem:
        yield f"It cannot be used as it is: {held.problem}{'' if held.problem[-1] == '?' else '.'}"
    if held.driven is not None:
        yield _driven(held, held.driven, found.sizes)
    yield from left_out_words(held.left_out, named=False)
    if held.run is None:
        return
    yield from (f"{capital(each)}." for each in held.run.damage)
    repeated = words_about_held([held.run])
    if repeated:
        yield f"{repeated}."
    can, cannot = can_tell(held, found.sizes)
    if can:
        together = "Together with other drives it" if measured_seldom(held) else "It"
        yield f"{together} can show {listed(can)}."
    yield from (f"It cannot show {each}." for each in cannot)
    if held.driven is not None and not found.sizes and measures_of(held) != "nothing":
        counts = " and the counts of a turn" if found.first.lacks_ticks else ""
        yield f"Whether it can show base and radii is said once --robot gives their sizes{counts}."


def _references(held: Held) -> Iterator[str]:
    assert held.contents is not None
    for each in held.contents.references:
        taken = ""
        if each.independent and held.wheels is not None and each.name == held.wheels.name:
            continue
        if each == held.reference and not held.problem:
            taken = " It is taken." if held.beside is None else " Its positions are taken."
        elif held.beside is not None and each == held.beside and not held.problem:
            others = held.reference is not None and held.reference.measures == "poses"
            taken = f" Its headings are taken{': they wander less' if others else ''}."
        kind = f"{each.name}: {_MEASURES[each.measures]}{rate_words(held, each.name)}"
        if each.independent:
            yield f"Reference {kind} ({each.why}).{taken}"
            if taken and held.run is not None:
                yield from (
                    f"R{note[1:]}."
                    for note in held.run.notes
                    if note.startswith("reference ")
                    and (each.kind == SCAN or "accelerometer" in note or TOLD in note)
                )
        else:
            yield f"No reference: {each.name}, {each.why}."
    yield from (
        f"No reference{'' if name in held.contents.moved else ' as it is'}: {name}, {what}."
        for name, what in other_scans(held.contents)
    )
    yield from _gyro_in_odometry(held)
    if held.reference is None and held.other is None:
        but = " but its own wheels" if held.wheels is not None else ""
        yield f"Nothing that is read in the bag measures the robot{but}.{_unread_sensors(held)}"


def _mistakes(held: Held) -> Iterator[str]:
    """What the reference shows to be set up wrongly."""
    for each in held.mistakes:
        mend = ""
        if each.effect == SWAPPED and held.wheels is None:
            mend = " If it is the counters, exchange their names in the first line of ticks.csv."
        elif each.effect == SWAPPED and held.wheels is not None and held.wheels.exchanged:
            mend = f" If it is the counters, --ticks-topic {held.wheels.exchanged} exchanges them."
        yield f"Set up wrongly, as the reference shows: {each.words}.{mend}"


def _of_another_file(held: Held) -> Iterator[str]:
    """The reference that is no topic of the recording itself."""
    measures, topic = measures_of(held), held.reference
    if held.other is not None and topic is not None:
        taken = "" if held.problem else " It is taken."
        yield (
            f"Reference {topic.name} in {held.other}: {_MEASURES[topic.measures]} ({topic.why})."
            f"{taken}"
        )
    elif topic is None and measures != "nothing":
        table = REFERENCE if held.other is None else held.other / REFERENCE
        yield f"Reference: {table}, {_MEASURES[measures]}."


def _unread_sensors(held: Held) -> str:
    """Topics whose names tell of a sensor or of poses, of types that are not read."""
    assert held.contents is not None
    may = [
        topic_in_words(each)
        for each in held.contents.topics
        if each.kind in _WITHOUT_FORM and names_a_measurement(each.name)
    ]
    if not may:
        return ""
    return (
        f" By name {listed(may)} may: written as rows of t_s (when each was received), x_m, y_m "
        "and yaw_rad into the reference.csv of a folder, --reference FOLDER gives them to info, "
        "compare and diagnose."
    )


def _gyro_in_odometry(held: Held) -> Iterator[str]:
    """Warn where the wheels' headings may be those of the gyro that is to judge them."""
    if (
        held.wheels is not None
        and held.wheels.gives == "odometry"
        and any(each and each.measures == "yaw" for each in (held.reference, held.beside))
    ):
        yield (
            "Many drivers (TurtleBot3's, Kobuki's) put the gyro's heading into "
            f"{held.wheels.name}. If this one does, the gyro is judged by itself: it always "
            "agrees, and shows nothing of base and wheels. Joint angles or counters, recorded too, "
            "do."
        )


def _driven(held: Held, drive: DrivenAmount, sizes: bool) -> str:
    times: dict[str, float] = {}
    for span in drive.spans:
        times[span.what] = times.get(span.what, 0.0) + span.end - span.begin
    whole = drive.spans[-1].end - drive.spans[0].begin if drive.spans else 0.0
    told = [
        f"{verb} for {times[what]:.1f} s"
        for what, verb in (
            ("drove", "drove"),
            ("stood", "stood"),
            ("held", "was held"),
            ("slid", "was held (or its scans slid along a wall)"),
            ("carried", "was carried or turned by hand"),
            ("lost", "drove with a heading that is not known"),
            ("silent", "moved unrecorded"),
        )
        if what in times
    ]
    way = ""
    if sizes and "drove" in times:
        turned = math.degrees(drive.turned)
        wired = any(each.effect in WIRING_WORDS for each in held.mistakes)
        right = ", with that put right," if wired else ""
        way = f" By its wheels{right} it went {drive.way:.1f} m and turned {turned:.0f}°"
        times_told = "once" if drive.reversals == 1 else f"{drive.reversals} times"
        way += f", and changed its direction {times_told}." if drive.reversals else "."
        if held.seen is not None and unseen_much(held):
            seen, turned = held.seen, math.degrees(held.seen.turned)
            way += f" The reference measured {seen.way:.1f} m and {turned:.0f}° of it."
    return f"In {whole:.1f} s the robot {listed(told) if told else 'did nothing'}.{way}"
