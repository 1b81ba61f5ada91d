# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What recordings hold, in words and for programs."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator
from typing import Any

from werrimbi_odom.files.bag_contents import SCAN
from werrimbi_odom.files.reference_choice import other_scans
from werrimbi_odom.files.stamps import Stamps
from werrimbi_odom.inference.legs.spans import Driven
from werrimbi_odom.inference.recording_info import Held, Info, can_tell, measures_of
from werrimbi_odom.report.document import Document, Paragraph, paragraphs
from werrimbi_odom.report.info_wheels import (
    WITHOUT_WHEELS,
    no_wheels_words,
    rate_words,
    wheels_words,
)
from werrimbi_odom.report.numbers import TIME_OF_DAY, listed
from werrimbi_odom.report.phrases import left_out_words

_MEASURES = {"poses": "poses", "positions": "positions", "yaw": "headings alone"}
_WANDERS = 0.1  # of stamps against receipt, from which on it is worth saying [s]


def document_of(found: Info) -> Document:
    """Everything that is told."""
    words = [part for each in found.held for part in _of_one(each, found)]
    step, command = next_step(found)
    words += [Paragraph(step, apart=True), *([Paragraph(command, "command")] if command else [])]
    return Document(title="What the recordings hold", words=words)


def _of_one(held: Held, found: Info) -> list[Paragraph]:
    head = Paragraph(str(held.path), apart=True)
    return [head, *paragraphs(f"- {each}" for each in _lines(held, found))]


def _lines(held: Held, found: Info) -> Iterator[str]:
    if held.contents is not None:
        yield wheels_words(held)
        yield from no_wheels_words(held.joints)
        yield from _references(held)
        yield from _stamps(held)
    else:
        yield "Wheels: ticks.csv, counters."
        measures = measures_of(held)
        if measures != "nothing":
            yield f"Reference: reference.csv, {_MEASURES[measures]}."
    if held.restamped:
        yield (
            "By their counts, a timer read the wheels' counters evenly, and the stamps say when a "
            f"message came: they are put back to when it was read, by {_ms(held.restamped)} (rms)."
        )
    if held.scans_restamped:
        yield (
            "By its path, the lidar turned evenly, and its scans are not stamped so: they are put "
            f"back by {_ms(held.scans_restamped)} (rms)."
        )
    if held.gyro_bias:
        yield (
            f"Its headings turn by {math.degrees(held.gyro_bias):.2g}°/s while the wheels stand: "
            "a gyro's bias, which is taken off."
        )
    if held.problem:
        yield f"It cannot be used as it is: {held.problem}."
    if held.driven is not None:
        yield _driven(held, held.driven, found.sizes)
    yield from left_out_words(held.left_out)
    if held.run is None:
        return
    yield from (f"{each}." for each in held.run.damage)
    can, cannot = can_tell(held, found.sizes)
    if can:
        yield f"It can show {listed(can)}."
    yield from (f"It cannot show {each}." for each in cannot)
    if held.driven is not None and not found.sizes and measures_of(held) != "nothing":
        yield "Whether it can show base and radii is told once their sizes are known."


def _references(held: Held) -> Iterator[str]:
    assert held.contents is not None
    for each in held.contents.references:
        taken = " It is taken." if each == held.reference else ""
        kind = f"{each.name}: {_MEASURES[each.measures]}{rate_words(held, each.name)}"
        if each.independent:
            yield f"Reference {kind} ({each.why}).{taken}"
            if taken and held.run is not None:
                yield from (
                    f"R{note[1:]}."
                    for note in held.run.notes
                    if note.startswith("reference ")
                    and (each.kind == SCAN or "accelerometer" in note)
                )
        else:
            yield f"No reference: {each.name}, {each.why}."
    yield from (
        f"No reference as it is: {name}, {what}." for name, what in other_scans(held.contents)
    )
    if held.reference is None:
        yield "Nothing in the bag measures the robot but its own wheels."


def _stamps(held: Held) -> Iterator[str]:
    for name, stamps in held.stamps.items():
        chosen = [held.wheels and held.wheels.name, held.reference and held.reference.name]
        if any(each and name in (*each.split(","), each.partition(":")[0]) for each in chosen):
            yield _clock(name, stamps)
    yield from _apart(held)


def _clock(name: str, stamps: Stamps) -> str:
    if stamps.jitter is None:
        words = (
            f"{name} has no stamps: the times of receipt are used, whose intervals vary by "
            f"± {_ms(stamps.received_jitter)}"
        )
    else:
        pair = f"± {_ms(stamps.jitter)} against ± {_ms(stamps.received_jitter)} of receipt"
        if stamps.believed == "header":
            words = f"Stamps of {name}: believe the headers, whose intervals vary by {pair}"
        else:
            words = (
                f"Stamps of {name}: the headers are used, though their intervals vary by {pair}: "
                "the times of receipt are the evener"
            )
        if abs(stamps.offset or 0.0) > TIME_OF_DAY:
            apart = "they are of another clock than receipt (a simulation's, or one that began"
            return f"{words}; {apart} when a computer was switched on)."
        if (stamps.wander or 0.0) > _WANDERS:
            words += (
                f"; what lies between stamp and receipt wanders by {stamps.wander:.2g} s, and is "
                f"{stamps.offset:.2g} s as a rule and {stamps.latest:.2g} s at most"
            )
            if (stamps.offset or 0.0) < 0.0:
                words += " (negative: two clocks that differ)"
    extras = []
    if stamps.bursts > 0.01:
        extras.append(f"{100 * stamps.bursts:.0f} % come together with the one before")
    if stamps.late > 0.01:
        extras.append(f"{100 * stamps.late:.0f} % are late by a tenth of a second and more")
    if stamps.back:
        extras.append(f"the stamps go back {stamps.back} times")
    return f"{words}{'; ' if extras else ''}{', '.join(extras)}."


def _apart(held: Held) -> Iterator[str]:
    names = [each.name.split(",")[0].partition(":")[0] for each in _chosen(held)]
    offsets = [held.stamps[name].offset for name in names if name in held.stamps]
    if len(offsets) == 2 and offsets[0] is not None and offsets[1] is not None:
        apart = offsets[0] - offsets[1]
        if abs(apart) > _WANDERS:
            yield (
                f"Their clocks are apart: the reference's stamps are {abs(apart):.3g} s "
                f"{'later' if apart > 0 else 'earlier'} than those of the wheels, by when both "
                "were received."
            )


def _chosen(held: Held) -> list[Any]:
    return [each for each in (held.wheels, held.reference) if each is not None]


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.0f} ms"


def _driven(held: Held, drive: Driven, sizes: bool) -> str:
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
            ("carried", "was carried or turned by hand"),
        )
        if what in times
    ]
    way = ""
    if sizes and "drove" in times:
        turned = math.degrees(drive.turned)
        way = f" By its wheels it went {drive.way:.1f} m and turned {turned:.0f}°"
        way += f", and changed its direction {drive.reversals} times." if drive.reversals else "."
    return f"In {whole:.1f} s the robot {listed(told) if told else 'did nothing'}.{way}"


def next_step(found: Info) -> tuple[str, str]:
    """The next step, and its command; "" where it has none."""
    usable = [each for each in found.held if not each.problem and each.run is not None]
    if not usable:
        return _otherwise(found)
    if any(measures_of(each) == "nothing" for each in usable):
        again = "Record again with something that measures the robot beside its wheels"
        how = "an IMU's gyro shows its turning, a localiser or a scan matcher its poses"
        return f"{again}: {how}.", ""
    if found.given is None and found.written is None:
        if not found.first.has_sizes:
            return (
                "Next: measure the wheels' radius and the distance between them, enter both in a "
                "robot file (config/robot.yaml is one to copy), and give it with --robot. Or give "
                "the parameter file of the diff_drive_controller with --robot."
            ), ""
        return "Next: a first robot file.", command_of(found)
    return "Next:", command_of(found)


def _otherwise(found: Info) -> tuple[str, str]:
    """Where nothing can be judged by what was taken: what lacks, or what else may do."""
    if all(held.contents is not None and held.wheels is None for held in found.held):
        return WITHOUT_WHEELS, ""
    for held in found.held:
        if held.contents is None or held.reference is None:
            continue
        others = [each.name for each in held.contents.independent if each != held.reference]
        if others:
            words = ["werrimbi", "info", *(str(each.path) for each in found.held)]
            robot = [] if found.given is None else ["--robot", str(found.given)]
            command = shlex.join([*words, *robot, "--reference-topic", others[0]])
            return f"By {held.reference.name} nothing can be judged. Next:", command
    return "Nothing of it can be judged.", ""


def command_of(found: Info) -> str:
    """The command that comes next, as a shell takes it."""
    usable = [each for each in found.held if not each.problem and each.run is not None]
    paths = [str(each.path) for each in usable]
    robot = found.given or found.written
    if robot is None:
        return shlex.join(["werrimbi", "info", *paths, "--out", "robot.yaml"])
    words = ["werrimbi", "compare", "--robot", str(robot)]
    if found.leg != 1.0:
        words += ["--leg", f"{found.leg:g}"]
    held = usable[0]
    if held.contents is not None and held.wheels is not None and held.reference is not None:
        words += ["--ticks-topic", held.wheels.name, "--reference-topic", held.reference.name]
    return shlex.join([*words, *paths])
