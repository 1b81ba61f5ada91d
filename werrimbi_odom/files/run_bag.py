# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs recorded as a ROS 2 bag."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from werrimbi_odom.files.bag import opened_bag, topic_in_words
from werrimbi_odom.files.bag_reference import (
    ReferenceCollector,
    choose_reference,
    kinds_in_words,
)
from werrimbi_odom.files.bag_ticks import choose_ticks, ticks_collector
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
    progress: Progress | None = None,
) -> Run:
    """Read a run from a bag.

    Parameters
    ----------
    path : path
        A rosbag2 folder (sqlite3 or MCAP), a .mcap or a .db3 file.
    robot_file : RobotFile
        Says the joints' names, the unit of their positions, and how two topics are paired.
    ticks_topic : str, optional
        Where the ticks are, LEFT,RIGHT for two topics; needed where there are several.
    reference_topic : str, optional
        Where the reference is, TOPIC:CHILD_FRAME among several transforms, `none` for no
        reference; needed where there are several.

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
        topics = source.name.split(",")
        others = [topic for topic in bag.topics if topic.name not in topics]
        measured = choose_reference(path, others, reference_topic)
        ticks_of = ticks_collector(path, source, robot_file)
        reference_of = measured and ReferenceCollector(path, measured, robot_file)
        wanted = (*topics, *([measured.topic] if measured else []))
        total = sum(topic.messages for topic in bag.topics if topic.name in wanted)
        for number, message in enumerate(bag.messages(wanted)):
            if message.topic in topics:
                ticks_of.take(message)
            elif reference_of:
                reference_of.take(message)
            if progress is not None and number % 1000 == 0:
                progress(min(number / total, 1.0))
    ticks, notes = ticks_of.ticks()
    notes = [f"ticks from {source.name} ({source.kind})", *notes]
    reference = None
    if measured and reference_of:
        reference, frames = reference_of.reference()
        notes.append(f"reference from {measured.topic} ({measured.kind}), {frames}")
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
    )
