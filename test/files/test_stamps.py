# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of a bag's topics, and which clock is believed."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.files.bags.bag import BagMessage, opened_bag
from werrimbi_odom.files.bags.stamps import _judged, newest_of_bursts, stamps_of
from werrimbi_odom.files.bags.unstamped import NEVER_STAMPS, with_stamps
from werrimbi_odom.files.clocks import Lateness, of_one_rate, on_one_clock
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.run import Collected, Reference, Ticks
from werrimbi_odom.report.info_stamps import clock_words

MS = 10**6
WHEELS = ["left_wheel_joint", "right_wheel_joint"]


def test_the_rate_of_messages_in_bursts_is_how_many_come_a_second(tmp_path: Path, ros: Any) -> None:
    """Motion capture over a radio: ten poses within a millisecond, ten times a second."""
    entries = []
    for burst in range(1, 40):
        for n in range(10):
            at = burst * 100 * MS + n * MS // 10
            entries.append(("/pose", at, ros.pose(at, 0.0, 0.0, 0.0)))
    with opened_bag(ros.write(tmp_path / "bag", entries)) as bag:
        stamps = stamps_of(bag, ["/pose"])["/pose"]
    assert stamps.rate == pytest.approx(100.0, rel=0.05)
    assert stamps.bursts > 0.8


def test_stamps_of_a_simulation_are_of_another_clock() -> None:
    """Received in 2025, stamped from zero, by a clock that goes a little slower."""
    stamped = np.arange(0.0, 60.0, 0.05)
    words = clock_words("/joint_states", _judged(stamped, 1.7e9 + 1.02 * stamped))
    assert "another clock" in words
    assert "e+09" not in words
    assert "late" not in words


@pytest.mark.parametrize(
    ("uneven", "told"),
    [(0.5, "believe the headers"), (1.02, "either clock will do"), (1.5, "receipt are the evener")],
)
def test_the_evener_clock_is_to_be_believed_if_either_is(uneven: float, told: str) -> None:
    random = np.random.default_rng(1)
    received = 0.2 * np.arange(500.0) + random.normal(0.0, 0.02, 500)
    stamped = 0.2 * np.arange(500.0) + uneven * (received - 0.2 * np.arange(500.0))
    assert told in clock_words("/odom", _judged(stamped, received))


def test_milliseconds_of_a_simulation_are_even_enough() -> None:
    """A Gazebo's joints at 10 Hz: stamped 99 to 101 ms apart, received 100 ms apart."""
    received = 0.1 * np.arange(300.0)
    stamped = np.round(received + np.random.default_rng(1).choice([0.0, 1e-3], 300), 3)
    assert "believe the headers" in clock_words("/joint_states", _judged(stamped, received))


def test_what_waited_behind_a_pause_is_stamped_late() -> None:
    """Poses at 100 Hz, stamped on receipt, over a network that now and then holds them back.

    A robot at 0.2 m/s goes 40 mm in a pause of 0.2 s; the poses that wait then come at once, and
    each looked like a jump of the reference.
    """
    measured = 0.01 * np.arange(1000.0)
    came = measured + np.random.default_rng(1).uniform(0.0, 0.004, 1000)
    for begin in (3.0, 5.0, 5.6):
        waits = (begin < measured) & (measured < begin + 0.2)
        came[waits] = begin + 0.2 + 1e-4 * np.arange(waits.sum())
    keep, told = newest_of_bursts(came)
    assert np.max(came[keep] - measured[keep]) < 0.02
    assert np.sum(~keep) == pytest.approx(57, abs=3)
    assert "came at once" in told


@pytest.mark.parametrize(
    "time",
    [
        np.repeat(0.1 * np.arange(50.0), 2) + np.tile([0.0, 0.02], 50),  # two sensors in turn
        np.delete(0.1 * np.arange(200.0), [30, 31, 32, 90, 91]),  # some are lost
        np.sort(0.1 * np.arange(200.0) + np.random.default_rng(2).uniform(0.0, 0.09, 200)),
        (0.005 * np.arange(1000.0).reshape(4, 250) + 60.0 * np.arange(4.0)[:, None]).ravel(),
    ],
)
def test_what_only_comes_unevenly_is_kept(time: np.ndarray) -> None:
    keep, told = newest_of_bursts(time)
    assert keep.mean() > 0.95
    assert not (keep.all() and told)


def test_transforms_beside_scans_tell_nothing_of_the_scans_clock() -> None:
    """Where /tf said where the lidar sits, one clock for lidar and wheels was never believed."""
    random = np.random.default_rng(1)
    taker = SimpleNamespace(take=lambda message: None)
    wheels, scans, frames = (Lateness(taker) for _ in range(3))

    def take(by: Lateness, topic: str, at: float, stamp: float) -> None:
        late = random.exponential(0.01)
        header = SimpleNamespace(
            stamp=SimpleNamespace(sec=int(stamp), nanosec=round(1e9 * (stamp % 1.0)))
        )
        content = SimpleNamespace(header=header)
        if topic == "/tf":
            content = SimpleNamespace(transforms=[content])
        by.take(BagMessage(topic, round(1e9 * (at + late)), content))

    for at in np.arange(1.0, 40.0, 0.1):
        take(wheels, "/joint_states", at, at)
        for by in (scans, frames):
            take(by, "/tf", at, at + 0.3)  # some date their transforms forward
        take(scans, "/scan", at, at)
    assert of_one_rate(wheels, scans)
    assert scans.usual == pytest.approx(0.007, abs=0.003)
    assert not of_one_rate(wheels, frames)


@pytest.mark.parametrize(
    ("gain", "copied", "one_rate"),
    [(0.0, False, True), (2e-3, False, False), (0.0, True, False)],
    ids=["one clock", "two clocks", "a log written to a bag"],
)
def test_receipt_tells_whether_two_clocks_run_at_one_rate(
    tmp_path: Path, ros: Any, robot: Any, gain: float, copied: bool, one_rate: bool
) -> None:
    """A recorder's clock that is set right by 0.2 s on the way, as of a laptop beside a robot.

    Three drives of a TurtleBot3, whose lidar and wheels one computer stamps, were told of a clock
    that gains 4 to 11 ms a second.
    """
    random = np.random.default_rng(1)
    entries = []

    def sent(topic: str, at: float, stamp: float, make: Any) -> None:
        waited = random.exponential(0.01) + 0.2 * (at > 20.0)
        stamped = round(1e9 * stamp)
        entries.append((topic, stamped if copied else round(1e9 * (at + waited)), make(stamped)))

    for at in np.arange(1.0, 40.0, 0.05):
        angle = 0.01 * at
        sent("/joint_states", at, at, lambda t, a=angle: ros.joints(t, WHEELS, [a, a]))
    for at in np.arange(1.0, 40.0, 0.1):
        sent("/mocap", at, at * (1.0 + gain), lambda t, x=0.1 * at: ros.pose(t, x, 0.0, 0.2))
    entries.sort(key=lambda entry: entry[1])
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.reference is not None
    assert run.reference.one_rate is one_rate


def _drive_of_a_simulation(ros: Any, unstamped: str) -> list[Any]:
    """Stamped from ten seconds on, received in 2025; the first message of a topic has no stamp."""
    entries = []
    for n in range(40):
        stamp, received = 10 * 1000 * MS + 50 * n * MS, 1_750_000_000 * 10**9 + 50 * n * MS
        for topic, make in (
            ("/joint_states", lambda t, n=n: ros.joints(t, WHEELS, [0.1 * n, 0.2 * n])),
            ("/mocap", lambda t, n=n: ros.pose(t, 0.01 * n, 0.0, 0.0)),
        ):
            without = topic == unstamped and n == 0
            entries.append((topic, received, make(0 if without else stamp)))
    return entries


@pytest.mark.parametrize("topic", ["/joint_states", "/mocap"])
def test_one_message_without_a_stamp_is_left_out(
    tmp_path: Path, ros: Any, robot: Any, topic: str
) -> None:
    """When it was received is by another clock: the ticks "went back in time" by 55 years."""
    path = ros.write(tmp_path / "bag", _drive_of_a_simulation(ros, topic))
    run = read_run(path, robot())
    assert run.reference is not None
    for time in (run.ticks.time, run.reference.time):
        assert (np.diff(time) > 0.0).all()
    assert min(run.ticks.rows, run.reference.time.size) == 39
    assert run.ticks.time.max() == run.reference.time.max()
    assert any(words.startswith(f"{topic}: 1 of its messages has no stamp") for words in run.damage)
    with opened_bag(path) as bag:
        assert "no stamps" not in clock_words(topic, stamps_of(bag, [topic])[topic])


def test_a_sender_that_never_stamps_is_told_by_receipt(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Beside an arm's node, which sends to the same topic and stamps."""
    entries = []
    for n in range(1, 40):
        entries.append(("/joint_states", 50 * n * MS, ros.joints(50 * n * MS, ["arm"], [0.0])))
        entries.append(("/joint_states", 50 * n * MS, ros.joints(0, WHEELS, [0.1 * n, 0.2 * n])))
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    np.testing.assert_allclose(run.ticks.time, 0.05 * np.arange(1, 40))
    assert not run.damage


def test_messages_of_a_sender_that_never_stamps_are_not_held_to_the_end() -> None:
    """A long recording would be held in memory, and its order over topics lost."""
    left_out: Counter[str] = Counter()
    header = SimpleNamespace(frame_id="", stamp=SimpleNamespace(sec=0, nanosec=0))
    taken = []

    def messages() -> Iterator[BagMessage]:
        for n in range(2 * NEVER_STAMPS):
            taken.append(n)
            yield BagMessage("/joint_states", n * 10**7, SimpleNamespace(header=header))

    found = with_stamps(messages(), left_out)
    assert next(found).received == 0
    assert len(taken) == NEVER_STAMPS
    assert sum(1 for _ in found) == 2 * NEVER_STAMPS - 1
    assert not left_out


def test_a_reference_of_which_no_clock_is_known_keeps_the_wheels() -> None:
    """Beside one that is on another computer's clock: all its times were lost."""
    time, zeros = np.arange(5.0), np.zeros(5)
    late = [2.0, np.nan, 1002.0]
    found = [Collected(Reference(time - away, zeros, zeros, zeros), "") for away in (0.0, 1000.0)]
    ticks, moved, told = on_one_clock(Ticks(time, zeros, zeros), found, late)
    assert "1000 s apart" in told[0]
    for each in moved:
        assert np.array_equal(each.reference.time, ticks.time)


def test_stamps_that_stand_still_are_no_bursts() -> None:
    with np.errstate(all="raise"), warnings.catch_warnings():
        warnings.simplefilter("error")
        keep, told = newest_of_bursts(np.full(50, 7.0))
    assert keep.all()
    assert not told
