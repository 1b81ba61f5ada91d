# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Publishers and subscriptions of the nodes, without the default callbacks for QoS events.

Every default callback costs the executor some 10 µs per message. With best effort and volatile no
QoS of a subscription can be incompatible; an incompatible subscriber reports it on its own side.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import InvalidQosOverridesError, QoSOverridingOptions

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
    """Subscribe, by default with `sensor_qos`.

    Parameters
    ----------
    overridable : bool
        Whether the QoS can be overridden by parameters; if one is invalid, InputError names it.
    raw : bool
        Whether `take` gets serialised messages.
    lost : callable, optional
        Called when messages are lost.
    """
    with _errors_of_overrides(topic, overridable):
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
    with _errors_of_overrides(topic, overridable):
        return node.create_publisher(
            kind,
            topic,
            qos,
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
            qos_overriding_options=_overriding(overridable),
        )


def _overriding(overridable: bool) -> QoSOverridingOptions | None:
    return QoSOverridingOptions.with_default_policies() if overridable else None


@contextmanager
def _errors_of_overrides(topic: str, overridable: bool) -> Iterator[None]:
    """Convert exceptions of rclpy on an invalid QoS override to one that names the topic."""
    try:
        yield
    except (ParameterException, InvalidQosOverridesError, RuntimeError) as error:
        if not overridable:
            raise
        raise InputError(f"QoS override of {topic}: {error}") from error
