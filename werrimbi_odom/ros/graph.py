# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Other nodes in the ROS graph: publishers on a topic, nodes with the same name."""

from __future__ import annotations

import time

from rclpy.node import Node

KILLED = 21.0
"""Delay before others are reported [s]: DDS lists a killed node for 20 s."""
UNNAMED = "_NODE_NAME_UNKNOWN_"
"""Name that rmw gives to a node while only its publisher has been discovered."""


def full_name(node: Node) -> str:
    """Name with namespace; it distinguishes the diagnostics of several robots."""
    return str(node.get_fully_qualified_name().lstrip("/"))


def others_on(node: Node, topic: str, *, own: bool) -> str:
    """Other publishers on a topic, in words; "" if there are none.

    Parameters
    ----------
    topic : str
        With its namespace.
    own : bool
        Whether the node itself publishes it.
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

    Parameters
    ----------
    node : Node
        Its name should be unique.
    topics : tuple of str
        Topics that should have one publisher each.
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
