# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""YAML text to plain values with line numbers; safe and cheap for malicious text."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.composer import Composer
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)
from ruamel.yaml.nodes import MappingNode, Node
from ruamel.yaml.scalarbool import ScalarBoolean

from werrimbi_odom.errors import InputError

MAX_DEPTH = 8
ERRORS_OF_SCALARS = (ValueError, ArithmeticError, LookupError, TypeError, AttributeError)
"""Exceptions that ruamel does not wrap (a date in month 13)."""
_TAGS = ("!", *("tag:yaml.org,2002:" + kind for kind in ("str", "int", "float", "bool", "null")))

_READ_OTHERWISE = re.compile(
    r"[-+]?(0[0-9_]+|0[ob][0-7_]+|0x[0-9a-f_]*_[0-9a-f_]*|(?=[^_]*_)(?=[._]*[0-9])[0-9._]+(e[-+]?[0-9_]+)?)",
    re.IGNORECASE,
)
"""Numbers that YAML 1.2 and ROS read differently: ROS uses C's strtol, which reads 0100 as 64 and
does not accept 0o, 0b or 1_000."""


class BlocksInParts(Composer):
    """Blocks that are there twice under one key are one, as to ROS, which goes by full names."""

    def __init__(self, loader: Any = None) -> None:
        super().__init__(loader)
        self.joined: list[str] = []
        """Keys of such blocks."""

    def compose_mapping_node(self, anchor: Any) -> Any:
        """Compose a block, its parts joined."""
        node = super().compose_mapping_node(anchor)
        node.value = self._join(node.value)
        return node

    def _join(self, pairs: list[tuple[Node, Node]]) -> list[tuple[Node, Node]]:
        kept: list[tuple[Node, Node]] = []
        blocks: dict[object, MappingNode] = {}
        for key, value in pairs:
            first = blocks.setdefault(key.value, value) if isinstance(value, MappingNode) else value
            if first is value:
                kept.append((key, value))
            else:
                self.joined.append(str(key.value))
                first.value = self._join([*first.value, *value.value])
        return kept


def round_trip() -> YAML:
    """YAML reader and writer that keeps comments, order, quotes and number formats."""
    yaml = YAML(typ="rt", pure=True)
    yaml.Composer = BlocksInParts
    yaml.preserve_quotes = True
    yaml.width = 4096
    return yaml


def load(text: str, path: Path) -> tuple[CommentedMap, tuple[str, ...]]:
    """Parse a text with one mapping, and remark on blocks in parts.

    Its keys have line numbers (see `line_of`).
    InputError if the text is empty, not YAML, not a mapping, or uses features that parameter files
    do not need and attackers do: aliases, tags, deep nesting, several documents.
    """
    yaml = round_trip()
    try:
        _refuse_the_unusual(yaml, text, path)
        content = yaml.load(text)
    except InputError:
        raise
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        if str(error.context).startswith("while scanning"):  # where the token began
            mark = error.context_mark or mark
        where = f", line {mark.line + 1}" if mark is not None else ""
        problem = " ".join(str(error.problem or error.context).split())
        raise InputError(f"{path}{where}: this is not YAML: {problem}") from None
    except NotImplementedError as error:  # ruamel keeps comments, but not at every position
        found = re.search(r"line: (\d+)", str(error))
        where = f", line {int(found[1]) + 1}" if found else ""
        raise InputError(
            f"{path}{where}: a comment between a key and its value cannot be kept; put it on a "
            "line above them"
        ) from None
    except (YAMLError, *ERRORS_OF_SCALARS) as error:
        problem = " ".join(str(error).split())
        raise InputError(f"{path}: this is not YAML: {problem}") from None
    if content is None:
        raise InputError(f"{path} is empty; config/robot.yaml is an example to start from")
    if not isinstance(content, CommentedMap):
        raise InputError(f"{path}: a robot file begins with the node's name and a colon")
    twice = dict.fromkeys(yaml.composer.joined)
    return content, tuple(f"{key} is there twice; its parts are read as one" for key in twice)


def _refuse_the_unusual(yaml: YAML, text: str, path: Path) -> None:
    depth = documents = 0
    for event in yaml.parse(text):
        line = event.start_mark.line + 1
        if isinstance(event, AliasEvent):
            raise InputError(f"{path}, line {line}: write the value out instead of an alias (*)")
        if isinstance(event, (MappingStartEvent, SequenceStartEvent)):
            depth += 1
            if depth > MAX_DEPTH:
                raise InputError(f"{path}, line {line}: nested more than {MAX_DEPTH} deep")
        elif isinstance(event, (MappingEndEvent, SequenceEndEvent)):
            depth -= 1
        elif isinstance(event, DocumentStartEvent):
            documents += 1
            if event.version is not None and tuple(event.version) < (1, 2):
                raise InputError(
                    f"{path}, line {line}: leave out %YAML, which ROS does not look at"
                )
            if documents > 1:
                raise InputError(f"{path}, line {line}: a second document begins; keep one")
        if isinstance(event, (MappingStartEvent, SequenceStartEvent, ScalarEvent)):
            tag = event.tag
            if tag is not None and str(tag) not in _TAGS:
                raise InputError(f"{path}, line {line}: the tag {tag} is not allowed; leave it out")
        if isinstance(event, ScalarEvent) and _is_number_to_yaml_alone(event):
            raise InputError(
                f"{path}, line {line}: ROS reads {event.value} otherwise than YAML does (0100 is "
                "64; 1_000, 0o17 and 0b11 are texts); write the number in plain digits"
            )


def _is_number_to_yaml_alone(event: ScalarEvent) -> bool:
    plain_or_tagged = event.style is None or str(event.tag).endswith((":int", ":float"))
    return plain_or_tagged and _READ_OTHERWISE.fullmatch(event.value) is not None


def line_of(block: CommentedMap, key: object) -> int:
    """Line number of a key, from 1."""
    return int(block.lc.key(key)[0]) + 1


def plain(value: Any) -> Any:
    """A value without the round-trip information (number format, comments)."""
    if isinstance(value, CommentedMap):
        return {str(key): plain(below) for key, below in value.items()}
    if isinstance(value, CommentedSeq):
        return [plain(item) for item in value]
    if isinstance(value, ScalarBoolean):
        return bool(value)
    if isinstance(value, bool):
        return value
    for kind in (int, float, str):
        if isinstance(value, kind):
            return kind(value)
    return value
