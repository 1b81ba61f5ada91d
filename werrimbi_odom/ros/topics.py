# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Publishers and subscriptions of the nodes, transforms on /tf, and other nodes in the ROS graph.

The default callbacks for QoS events are left out: each costs the executor some 10 µs per message.
With best effort and volatile no QoS of a subscription can be incompatible; an incompatible
subscriber reports it on its own side.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from builtin_interfaces.msg import Time as Stamp
from geometry_msgs.msg import TransformStamped
from rclpy.clock import Clock
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.exceptions import InvalidTopicNameException, ParameterException
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import InvalidQosOverridesError, QoSOverridingOptions
from rclpy.validate_topic_name import validate_topic_name

from werrimbi_odom.errors import InputError


def sensor_qos() -> QoSProfile:
    """Best effort and volatile match every publisher; the depth is 0.1 s at 1 kHz."""
    return QoSProfile(
        depth=100, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.VOLATILE
    )


def subscribe(
    node: Node,
    kind: type,
    topic: str,
    take: Callable[..., None],
    *,
    qos: QoSProfile | None = None,
    overridable: bool = False,
    raw: bool = False,
    lost: Callable[[Any], None] | None = None,
) -> None:
    """Subscribe, by default with `sensor_qos`; `raw`: `take` gets serialised messages.

    `overridable`: the QoS can be overridden by parameters. InputError names an override that is
    invalid, or a topic whose name is. `lost` is called when messages are lost.
    """
    with _errors_of(topic, overridable):
        node.create_subscription(
            kind,
            topic,
            take,
            qos or sensor_qos(),
            event_callbacks=SubscriptionEventCallbacks(
                message_lost=lost, use_default_callbacks=False
            ),
            qos_overriding_options=_overriding(overridable),
            raw=raw,
        )


def publisher(
    node: Node, kind: type, topic: str, qos: QoSProfile | int = 100, *, overridable: bool = False
) -> Publisher:
    """Create a publisher; `qos` may be the depth alone, `overridable` is as in `subscribe`."""
    with _errors_of(topic, overridable):
        return node.create_publisher(
            kind,
            topic,
            qos,
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
            qos_overriding_options=_overriding(overridable),
        )


def _overriding(overridable: bool) -> QoSOverridingOptions | None:
    return QoSOverridingOptions.with_default_policies() if overridable else None


def stamp_at(seconds: float) -> Stamp:
    """Convert a time [s] that is not negative to a stamp."""
    whole, part = divmod(round(1e9 * seconds), 10**9)
    return Stamp(sec=whole, nanosec=part)


def stamp_of(message: Any, clock: Clock) -> Stamp:
    """Stamp of a message; where it has none (zero), the present time."""
    stamp = message.header.stamp
    return stamp if stamp.sec or stamp.nanosec else clock.now().to_msg()


@contextmanager
def _errors_of(topic: str, overridable: bool) -> Iterator[None]:
    """Convert exceptions of rclpy on a name or a QoS override to one that names the topic."""
    try:
        yield
    except InvalidTopicNameException as error:
        raise InputError(_no_name(topic, error)) from error
    except (ParameterException, InvalidQosOverridesError, RuntimeError) as error:
        if not overridable:
            raise
        raise InputError(f"QoS override of {topic}: {error}") from error


def full_topic(node: Node, topic: str) -> str:
    """Name of a topic with its namespace and after remapping; InputError if it is no name."""
    try:
        validate_topic_name(topic)
        return str(node.resolve_topic_name(topic))
    except (InvalidTopicNameException, RuntimeError) as error:
        raise InputError(_no_name(topic, error)) from error


def _no_name(topic: str, error: Exception) -> str:
    why = str(error).splitlines()[0].partition(", at /")[0].rpartition(": ")[2].rstrip(":")
    return f"{topic!r} is not the name of a topic: {why}"


SendTransform = Callable[[TransformStamped], None]


def transform_sender(node: Node, parameter: str) -> SendTransform:
    """Create a function that broadcasts a transform.

    InputError if tf2_ros is not installed; `parameter` is the one that requests it.
    """
    try:
        from tf2_ros import TransformBroadcaster
    except ImportError as error:
        raise InputError(
            f"{parameter} needs tf2_ros, which is not installed here: install the package "
            f"ros-jazzy-tf2-ros-py, or set {parameter}: false"
            + (" and let an EKF broadcast" if parameter == "enable_odom_tf" else "")
        ) from error
    sender: SendTransform = TransformBroadcaster(node).sendTransform
    return sender


KILLED = 21.0
"""Delay before others are reported [s]: DDS lists a killed node for 20 s."""
UNNAMED = "_NODE_NAME_UNKNOWN_"
"""Name that rmw gives to a node while only its publisher has been discovered."""


def full_name(node: Node) -> str:
    """Name with namespace; it distinguishes the diagnostics of several robots."""
    return str(node.get_fully_qualified_name().lstrip("/"))


def others_on(node: Node, topic: str, *, own: bool) -> str:
    """Other publishers on a topic (with its namespace), in words; "" if there are none.

    `own`: whether the node itself publishes it.
    """
    if node.count_publishers(topic) <= own:
        return ""
    names = [_name(each) for each in node.get_publishers_info_by_topic(topic)]
    if own and (name := f"/{full_name(node)}") in names:
        names.remove(name)
    return (
        f"another publishes {topic} too ({', '.join(sorted(names))}); a node that was killed is "
        "listed for 20 s"
    )


class Company:
    """Detects publishers and nodes that should not exist, once they have lasted for a while.

    The node's name should be unique, and each of `topics` should have one publisher.
    """

    def __init__(self, node: Node, topics: tuple[str, ...]) -> None:
        self.crowded: frozenset[str] = frozenset()
        """Topics that had several publishers at the last check."""
        self._node = node
        self._topics = topics
        self._since: dict[str, float] = {}

    def look(self, *, others_welcome: bool = False) -> list[str]:
        """Describe conflicts; `others_welcome`: several publishers are no conflict."""
        node, now = self._node, time.monotonic()
        self.crowded = frozenset(each for each in self._topics if node.count_publishers(each) > 1)
        seen = [] if others_welcome else sorted(self.crowded)
        own = (node.get_name(), node.get_namespace())
        namesakes = sum(each == own for each in node.get_node_names_and_namespaces())
        if namesakes > 1:
            seen.append("")
        self._since = {each: self._since.get(each, now) for each in seen}
        lasting = [each for each, since in self._since.items() if now - since > KILLED]
        return [self._of_topic(each) if each else self._of_name(namesakes) for each in lasting]

    def _of_topic(self, topic: str) -> str:
        publishers = self._node.get_publishers_info_by_topic(topic)
        names = ", ".join(sorted(_name(each) for each in publishers))
        return f"several publish {topic} ({names}): poses jump from one to the other"

    def _of_name(self, count: int) -> str:
        name = self._node.get_fully_qualified_name()
        return f"{count} nodes are named {name}, and each publishes: end one, or rename it"


def _name(endpoint: object) -> str:
    namespace, name = (getattr(endpoint, f"node_{part}") for part in ("namespace", "name"))
    if name == UNNAMED:
        return "a node whose name is not known yet"
    return f"{str(namespace).rstrip('/')}/{name}"
