# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Who we are, and who else is there: publishers on a topic, other nodes of our name."""

from __future__ import annotations

from rclpy.node import Node


def full_name(node: Node) -> str:
    """Name with namespace, as the diagnostics of several robots need it to be told apart."""
    return str(node.get_fully_qualified_name().lstrip("/"))


def crowds(node: Node, topics: tuple[str, ...]) -> dict[str, str]:
    """Topics with more than one publisher, and their names in words."""
    return {
        topic: ", ".join(sorted(_name(each) for each in node.get_publishers_info_by_topic(topic)))
        for topic in topics
        if node.count_publishers(topic) > 1
    }


def namesakes(node: Node) -> list[str]:
    """What is wrong where another node has our name; nothing where none has."""
    own = (node.get_name(), node.get_namespace())
    count = sum(each == own for each in node.get_node_names_and_namespaces())
    if count < 2:
        return []
    name = node.get_fully_qualified_name()
    return [f"{count} nodes are named {name}, and each publishes: end one, or rename it"]


def _name(endpoint: object) -> str:
    namespace, name = (getattr(endpoint, f"node_{part}") for part in ("namespace", "name"))
    return f"{str(namespace).rstrip('/')}/{name}"
