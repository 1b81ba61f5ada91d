# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs recorded as a bag."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, Protocol

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import Bag, BagMessage, opened_bag, topic_in_words
from werrimbi_odom.files.bags.bag_chain import ChainCollector, mounting_chain
from werrimbi_odom.files.bags.bag_contents import SCAN, Contents, contents_of
from werrimbi_odom.files.bags.bag_laser_scans import LidarCollector
from werrimbi_odom.files.bags.bag_reference import ReferenceCollector, kinds_in_words
from werrimbi_odom.files.bags.bag_ticks import choose_ticks, ticks_collector
from werrimbi_odom.files.bags.bag_wheels import JOINT_STATE, Wheels
from werrimbi_odom.files.bags.reference_choice import Chosen, choose_reference
from werrimbi_odom.files.bags.unstamped import unstamped_words, with_stamps
from werrimbi_odom.files.clocks import Lateness, of_one_rate, on_one_clock
from werrimbi_odom.files.references.merged_reference import merged
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import WORKED_OUT, Collected, Reference, Run, Ticks
from werrimbi_odom.files.text_files import readable

Progress = Callable[[float], None]
"""Callback for the share of the work done."""


Topics = str | Sequence[str] | None
"""A topic, several, or none in particular."""


def read_run_bag(
    path: str | Path,
    robot_file: RobotFile,
    *,
    ticks_topic: str | None,
    reference_topic: Topics,
    force: bool,
    progress: Progress | None,
) -> Run:
    """Read a run from a bag.

    `path`: a rosbag2 folder (sqlite3 or MCAP), a .mcap or .db3 file, or a ROS 1 .bag. `robot_file`:
    gives the joint names, the unit of positions, and how two topics are paired. `ticks_topic`:
    topic of the ticks, LEFT,RIGHT for two; required if there are several candidates.
    `reference_topic`: topic of the reference, /tf:PARENT:CHILD for transforms, `none` for no
    reference; required if there are several candidates. Two are merged, see `merged`. `force`:
    accept an unsuitable reference. Result: stamps are those of the headers if present, otherwise
    times of recording. InputError if the bag is unreadable, or the choice of topics is ambiguous.
    """
    path = Path(path)
    with opened_bag(path) as bag:
        held = _contents_of(bag, robot_file, reference_topic)
        source = choose_ticks(held, ticks_topic, robot_file)
        chosen = _chosen(held, source, reference_topic, force)
        ticks_of = ticks_collector(path, source, robot_file)
        collectors = [_collector(path, held, each, robot_file) for each in chosen]
        late = [Lateness(each) for each in (ticks_of, *collectors)]
        topics = [each.topics for each in (source, *collectors)]
        unstamped = _collect(bag, list(zip(topics, late, strict=True)), progress)
    ticks, notes = ticks_of.ticks()
    collected = [each.reference() for each in collectors]
    ticks, collected, clocks = on_one_clock(ticks, collected, [each.usual for each in late])
    collected = [
        each._replace(reference=replace(each.reference, one_rate=of_one_rate(late[0], its)))
        for each, its in zip(collected, late[1:], strict=True)
    ]
    found = _put_together(held, source, chosen, collectors, collected)
    lacking = ""
    if found.reference is None:
        lacking = f"({kinds_in_words()}); the bag has {', '.join(map(topic_in_words, bag.topics))}"
    return Run(
        readable(path.resolve().name),
        path,
        ticks,
        found.reference,
        (f"ticks from {source.name} ({source.kind})", *notes, *found.notes),
        damage=(*bag.damage, *unstamped, *found.damage, *clocks, *_stand(held, source, ticks)),
        no_reference=lacking,
        circle=found.circle,
        wheels_from="velocities" if WORKED_OUT["velocities"] in notes else source.gives,
        taken_out=found.taken_out,
        of_bag=True,
    )


def _stand(held: Contents, source: Wheels, ticks: Ticks) -> tuple[str, ...]:
    """Remark on wheels that never turn, where odometry may hold the drive."""
    others = [each.name for each in held.wheels if each.gives == "odometry"]
    turned = any((counts != counts[0]).any() for counts in (ticks.left, ticks.right))
    if source.kind != JOINT_STATE or turned or not others:
        return ()
    return (
        f"{source.name}: the wheels never turn in it, as where a joint_state_publisher alone sends "
        f"them; if the robot drove, --ticks-topic {others[0]} holds how",
    )


class FoundReference(NamedTuple):
    """A reference and the remarks from reading it."""

    reference: Reference | None
    notes: tuple[str, ...]
    circle: str = ""
    """See `Run.circle`."""
    damage: tuple[str, ...] = ()
    """See `Run.damage`."""
    taken_out: tuple[tuple[float, float], ...] = ()
    """See `Run.taken_out`."""


def read_reference_bag(
    path: Path, robot_file: RobotFile, reference_topic: Topics, force: bool
) -> FoundReference:
    """Read only the reference from a bag; wheels are ignored."""
    nothing = Wheels("", "", 0, "counts")
    with opened_bag(path) as bag:
        held = _contents_of(bag, robot_file, reference_topic)
        chosen = _chosen(held, nothing, reference_topic, force)
        collectors = [_collector(path, held, each, robot_file) for each in chosen]
        unstamped = _collect(bag, [(each.topics, each) for each in collectors], None)
    collected = [each.reference() for each in collectors]
    found = _put_together(held, nothing, chosen, collectors, collected)
    if found.reference is None:
        told = ", ".join(map(topic_in_words, held.topics)) or "nothing"
        raise InputError(
            f"{path}: there is no reference in it ({kinds_in_words()}); the bag has {told}"
        )
    damage = (*bag.damage, *unstamped, *found.damage)
    return found._replace(damage=tuple(f"{path}: {words}" for words in damage))


def _contents_of(bag: Bag, robot_file: RobotFile, wish: Topics) -> Contents:
    wished = [wish] if isinstance(wish, str) else wish or ()
    base = str(robot_file.values["base_frame_id"])
    return contents_of(bag, base, choosing=not wish, wished=wished)


def _chosen(held: Contents, source: Wheels, wish: Topics, force: bool) -> list[Chosen]:
    wishes: Sequence[str | None] = (
        [wish] if wish is None or isinstance(wish, str) else list(wish) or [None]
    )
    if len(wishes) > 2:
        raise InputError(
            f"{held.path}: {len(wishes)} references were asked for; two at most are judged together"
        )
    found = [choose_reference(held, source, each, force) for each in wishes]
    return [each for each in found if each is not None]


def _collect(
    bag: Bag, takers: Sequence[tuple[Sequence[str], _Taker]], progress: Progress | None
) -> tuple[str, ...]:
    """Pass each message of a bag to the collectors of its topic; what was left out, in words."""
    wanted = {name for names, _ in takers for name in names}
    total = sum(topic.messages for topic in bag.topics if topic.name in wanted)
    left_out: Counter[str] = Counter()
    for number, message in enumerate(with_stamps(bag.messages(sorted(wanted)), left_out)):
        for names, taker in takers:
            if message.topic in names:
                taker.take(message)
        if progress is not None and number % 1000 == 0:
            progress(min(number / total, 1.0))
    return unstamped_words(left_out)


class _Taker(Protocol):
    def take(self, message: BagMessage) -> None: ...


def _put_together(
    held: Contents,
    source: Wheels,
    chosen: Sequence[Chosen],
    collectors: Sequence[_Collector],
    collected: Sequence[Collected],
) -> FoundReference:
    references, notes, circle = [], [], ""
    cuts: tuple[tuple[float, float], ...] = ()
    damage: tuple[str, ...] = ()
    for (named, _), collector, found in zip(chosen, collectors, collected, strict=True):
        references.append(found.reference)
        cuts, damage = (*cuts, *found.taken_out), (*damage, *found.damage)
        notes.append(f"reference from {collector.topics[0]} ({named.kind}), {found.told}")
        if not named.independent:
            topics = source.name.split(",")
            others = [each for each in held.independent if each.name not in topics]
            told = ", ".join(f"{each.name} ({each.measures})" for each in others) or "none"
            circle = f"{named.name}: {named.why}; independent references in the bag: {told}"
    if len(references) == 2:
        names = " and ".join(each.source.name for each in chosen)
        first, second = references
        whole, told = merged(f"{held.path}: {names}", first, second, cuts)
        return FoundReference(whole, (*notes, told), circle, damage, cuts)
    only = references[0] if references else None
    return FoundReference(only, tuple(notes), circle, damage, cuts)


_Collector = ChainCollector | LidarCollector | ReferenceCollector


def _collector(path: Path, held: Contents, chosen: Chosen, robot_file: RobotFile) -> _Collector:
    if chosen.source.kind == SCAN:
        base = str(robot_file.values["base_frame_id"])
        mounting = mounting_chain(held.edges, base, chosen.source.child)
        return LidarCollector(path, chosen.source, mounting)
    if chosen.source.chain is not None:
        return ChainCollector(f"{path}: {chosen.source.chain.topic}", chosen.source.chain)
    return ReferenceCollector(path, chosen.source, robot_file, chosen.child)
