# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Converts the driver's messages to a stamp and two counters.

Each kind of input is a class; `subscribed` chooses that of the robot file. Invalid messages are
rejected with their cause. Counters are cumulative, so the next valid message contains all motion.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, cast

from builtin_interfaces.msg import Time as Stamp
from rclpy.clock import Clock
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import Int32, Int64, Int64MultiArray

from werrimbi_odom.files.bags.counter_pairs import Pairing
from werrimbi_odom.files.robot_files.node_parameter import Value
from werrimbi_odom.files.robot_files.parameters import WHOLE_COUNTS, robot_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.ros.input_health import Health
from werrimbi_odom.ros.topics import subscribe
from werrimbi_odom.ros.wheel_side import COUNTER_LIMIT, WheelSide

Take = Callable[[Stamp, float, float], None]
"""Callback for a reading: stamp, left and right counts."""
Info = Mapping[str, Any]
"""DDS information on a message: source and reception stamps [ns]."""


@dataclass(frozen=True)
class InputOptions:
    """Options common to all kinds of input."""

    node: Node
    values: Mapping[str, Value]
    take: Take
    health: Health


def robot_at_counters(values: Mapping[str, Value]) -> Robot:
    """Robot parameters for the counters that the inputs deliver.

    Counters of several wheels are unwrapped before they are averaged. A counter sent as Int32
    always wraps at 32 bits.
    """
    robot = robot_of(values)
    if _averages(values):
        return replace(robot, encoder_bits=0)
    if values["input_type"] == "int32_pair" and not robot.encoder_bits:
        return replace(robot, encoder_bits=32)
    return robot


_KINDS: dict[str, tuple[type, tuple[str, ...]]] = {
    "joint_state": (JointState, ("joint_states",)),
    "int32_pair": (Int32, ("left_ticks", "right_ticks")),
    "int64_pair": (Int64, ("left_ticks", "right_ticks")),
    "int64_multi_array": (Int64MultiArray, ("ticks",)),
}


def kind_of(values: Mapping[str, Value]) -> tuple[type, tuple[str, ...]]:
    """Message type of the robot file's input, and its topics before remapping."""
    return _KINDS[str(values["input_type"])]


def subscribed(wiring: InputOptions) -> JointStates | Pair | TicksArray:
    """Subscribe to the input named in the robot file; InputError if a QoS override is invalid."""
    kind, topics = kind_of(wiring.values)
    if kind is JointState:
        return JointStates(wiring)
    return TicksArray(wiring) if kind is Int64MultiArray else Pair(wiring, kind, topics)


class JointStates:
    """Wheel angles or counts among any other joints, in any order (sensor_msgs/JointState).

    Messages without any of the wheel joints are ignored.
    """

    def __init__(self, wiring: InputOptions) -> None:
        values = wiring.values
        bits = robot_of(values).encoder_bits if _averages(values) else 0
        self._sides = tuple(_side(values, side, bits) for side in ("left", "right"))
        self._wanted = tuple(_names(values, side) for side in ("left", "right"))
        self._take, self._health = wiring.take, wiring.health
        self._clock = wiring.node.get_clock()
        self._names: list[str] | None = None
        self._places: tuple[list[int], list[int]] = ([], [])
        self._ours = False
        self._wrong = ""
        self._unit = UnitWatch(in_radians=values["position_unit"] == "radians")
        _subscribe(wiring, JointState, "joint_states", self._arrived)

    def tally(self) -> dict[str, int]:
        """Wraps and resets of single wheels, if a side has several."""
        if all(len(names) == 1 for names in self._wanted):
            return {}
        return {
            "wraps of single wheels": sum(side.wraps for side in self._sides),
            "resets of single wheels": sum(side.resets for side in self._sides),
        }

    def _arrived(self, message: Any, info: Info) -> None:
        names, positions = message.name, message.position  # each access to a field is a call
        if names != self._names:
            self._find(names)
        self._health.hear(0, info, ours=self._ours)
        if not self._ours:
            return
        if self._wrong:
            self._health.refuse(f"joint {self._wrong}", f"it has {self._names}")
            return
        if len(positions) != len(names):
            self._health.refuse(
                "wrong array length" if positions else "empty position",
                f"{len(names)} names and {len(positions)} positions",
            )
            return
        of_left, of_right = self._places
        if not self._unit.settled:
            self._health.doubts += self._unit.look(positions[of_left[0]])
        left = self._sides[0].count([positions[place] for place in of_left])
        right = self._sides[1].count([positions[place] for place in of_right])
        if not (abs(left) < COUNTER_LIMIT and abs(right) < COUNTER_LIMIT):
            finite = math.isfinite(left) and math.isfinite(right)
            cause = "position out of range" if finite else "position not finite"
            self._health.refuse(cause, f"left {left}, right {right}")
            return
        stamp = message.header.stamp
        if stamp.sec == 0 and stamp.nanosec == 0:
            self._health.unstamped += 1
            stamp = self._clock.now().to_msg()
        elif stamp.nanosec >= 10**9:
            self._health.refuse("stamp not valid", f"{stamp.nanosec} nanoseconds past a second")
            return
        self._take(stamp, left, right)

    def _find(self, names: list[str]) -> None:
        """Find the wheels in a message; repeated only when its joint names change."""
        self._names = list(names)
        wanted = [name for side in self._wanted for name in side]
        absent = [name for name in wanted if name not in names]
        twice = [name for name in wanted if names.count(name) > 1]
        # Other joints only: for example from an arm's driver on the same topic.
        self._ours = len(absent) < len(wanted)
        self._wrong = f"{absent[0]} missing" if absent else f"{twice[0]} twice" if twice else ""
        if not self._ours:
            self._health.meet(self._names)
        if not absent:
            left, right = ([names.index(name) for name in side] for side in self._wanted)
            self._places = left, right


class UnitWatch:
    """Whether the first positions of a wheel that turns are in the stated unit."""

    def __init__(self, *, in_radians: bool) -> None:
        self._in_radians = in_radians
        self._last = math.nan
        self._whole = self._others = 0
        self.settled = False

    def look(self, position: float) -> list[str]:
        """Look at one more position; return what is suspected, once it is."""
        if position == self._last or not math.isfinite(position):
            return []
        self._last = position
        whole = position == round(position)
        self._whole += whole
        self._others += not whole
        enough = self._whole + self._others >= WHOLE_COUNTS
        self.settled = enough or (self._in_radians and self._others > 0)
        if not self.settled:
            return []
        if self._in_radians and not self._others:
            return [
                "the wheels' positions are whole numbers, and rather counts than radians: "
                "position_unit: ticks"
            ]
        if not self._in_radians and self._others > self._whole:
            return [
                "the wheels' positions are no whole numbers, and rather radians than counts: "
                "position_unit: radians"
            ]
        return []


class Pair:
    """Two topics, one per wheel (std_msgs/Int32 or Int64), paired by arrival; see `Pairing`."""

    def __init__(self, wiring: InputOptions, message_type: type, topics: tuple[str, ...]) -> None:
        self._take, self._health = wiring.take, wiring.health
        self._stamps = ArrivalStamps(wiring.node)
        window = float(wiring.values["pairing_window"])  # type: ignore[arg-type]
        self._pairing = Pairing(int(1e9 * window))
        for side, topic in enumerate(topics):
            _subscribe(wiring, message_type, topic, partial(self._arrived, side))

    def tally(self) -> dict[str, int]:
        """Numbers of counts without a partner, and of counts that preceded theirs."""
        return {"unpaired": self._pairing.unpaired, "earlier of a pair": self._pairing.earlier}

    def _arrived(self, side: int, message: Any, info: Info) -> None:
        self._health.hear(side, info)
        pair = self._pairing.take(side, message.data, arrival_of(info))
        if pair is not None:
            self._take(self._stamps.of(info), *pair)


class TicksArray:
    """Both counters in one message, left first (std_msgs/Int64MultiArray)."""

    def __init__(self, wiring: InputOptions) -> None:
        self._take, self._health = wiring.take, wiring.health
        self._stamps = ArrivalStamps(wiring.node)
        _subscribe(wiring, Int64MultiArray, "ticks", self._arrived)

    def tally(self) -> dict[str, int]:
        """No counters of its own."""
        return {}

    def _arrived(self, message: Any, info: Info) -> None:
        self._health.hear(0, info)
        counts = message.data
        if len(counts) != 2:
            self._health.refuse("wrong array length", f"{len(counts)} values, not [left, right]")
            return
        self._take(self._stamps.of(info), counts[0], counts[1])


class ArrivalStamps:
    """Stamps for messages without one: arrival time by the node's clock."""

    def __init__(self, node: Node) -> None:
        self._clock: Clock = node.get_clock()

    def of(self, info: Info) -> Stamp:
        """Arrival time of a message."""
        if self._clock.ros_time_is_active:
            return self._clock.now().to_msg()
        return Time(nanoseconds=arrival_of(info)).to_msg()


def arrival_of(info: Info) -> int:
    """Arrival time of a message by the system clock [ns].

    The time recorded by DDS precedes the message's wait in the queue.
    """
    return info["received_timestamp"] or time.time_ns()


def _averages(values: Mapping[str, Value]) -> bool:
    most = max(len(_names(values, side)) for side in ("left", "right"))
    return values["input_type"] == "joint_state" and most > 1


def _names(values: Mapping[str, Value], side: str) -> tuple[str, ...]:
    return cast("tuple[str, ...]", values[f"{side}_wheel_names"])


def _side(values: Mapping[str, Value], side: str, bits: int) -> WheelSide:
    per_revolution = float(values[f"{side}_ticks_per_revolution"])  # type: ignore[arg-type]
    in_radians = values["position_unit"] == "radians"
    per_unit = per_revolution / (2.0 * math.pi) if in_radians else 1.0
    return WheelSide(per_unit, per_revolution, bits)


def _subscribe(
    wiring: InputOptions, message_type: type, topic: str, arrived: Callable[..., None]
) -> None:
    lost = wiring.health.lose
    subscribe(wiring.node, message_type, topic, arrived, overridable=True, lost=lost)
