# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs recorded as a bag."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from werrimbi_odom.files.bag import opened_bag, topic_in_words
from werrimbi_odom.files.bag_chain import ChainCollector
from werrimbi_odom.files.bag_reference import ReferenceCollector, kinds_in_words
from werrimbi_odom.files.bag_ticks import choose_ticks, ticks_collector
from werrimbi_odom.files.choosing import Chosen, choose_reference, listed
from werrimbi_odom.files.contents import contents_of_bag
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.text import readable

Progress = Callable[[float], None]
"""Told, now and then, which share of the work is done."""


def read_run_bag(
    path: str | Path,
    robot_file: RobotFile,
    *,
    ticks_topic: str | None = None,
    reference_topic: str | None = None,
    force: bool = False,
    progress: Progress | None = None,
) -> Run:
    """Read a run from a bag.

    Parameters
    ----------
    path : path
        A rosbag2 folder (sqlite3 or MCAP), a .mcap or .db3 file, or a ROS 1 .bag.
    robot_file : RobotFile
        Says the joints' names, the unit of their positions, and how two topics are paired.
    ticks_topic : str, optional
        Where the ticks are, LEFT,RIGHT for two topics; needed where there are several.
    reference_topic : str, optional
        Where the reference is, /tf:PARENT:CHILD among transforms, `none` for no reference; needed
        where there are several.
    force : bool
        Take for a reference what is none.

    Returns
    -------
    Run
        Stamps are those of the headers, where there are any; else when messages were received.

    Raises
    ------
    InputError
        When the bag cannot be read, or what to read is not plain.
    """
    path = Path(path)
    with opened_bag(path) as bag:
        held = contents_of_bag(bag, str(robot_file.values["base_frame_id"]))
        source = choose_ticks(held, ticks_topic, robot_file)
        measured = choose_reference(held, source, reference_topic, force)
        ticks_of = ticks_collector(path, source, robot_file)
        reference_of = measured and _collector(path, measured, robot_file)
        topics = source.name.split(",")
        wanted = (*topics, *(reference_of.topics if reference_of else ()))
        total = sum(topic.messages for topic in bag.topics if topic.name in wanted)
        for number, message in enumerate(bag.messages(wanted)):
            if message.topic in topics:
                ticks_of.take(message)
            if reference_of and message.topic in reference_of.topics:
                reference_of.take(message)
            if progress is not None and number % 1000 == 0:
                progress(min(number / total, 1.0))
    ticks, notes = ticks_of.ticks()
    notes = [f"ticks from {source.name} ({source.kind})", *notes]
    reference, circle = None, ""
    if measured and reference_of:
        reference, frames = reference_of.reference()
        named = measured.source
        notes.append(f"reference from {reference_of.topics[0]} ({named.kind}), {frames}")
        if not named.independent:
            others = listed([each for each in held.independent if each.name not in topics])
            circle = f"{named.name}: {named.why}; independent references in the bag: {others}"
    lacking = ""
    if reference is None:
        lacking = f"({kinds_in_words()}); the bag has {', '.join(map(topic_in_words, bag.topics))}"
    return Run(
        readable(path.resolve().name),
        path,
        ticks,
        reference,
        tuple(notes),
        damage=bag.damage,
        no_reference=lacking,
        circle=circle,
    )


def _collector(
    path: Path, chosen: Chosen, robot_file: RobotFile
) -> ChainCollector | ReferenceCollector:
    if chosen.source.chain is not None:
        return ChainCollector(path, chosen.source.chain)
    return ReferenceCollector(path, chosen.source, robot_file, chosen.child)
