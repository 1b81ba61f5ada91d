# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Values changed and added in YAML text that keeps its comments, order and look."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.error import CommentMark
from ruamel.yaml.nodes import ScalarNode
from ruamel.yaml.representer import RoundTripRepresenter
from ruamel.yaml.scalarfloat import ScalarFloat
from ruamel.yaml.scalarstring import DoubleQuotedScalarString
from ruamel.yaml.tokens import CommentToken

from werrimbi_odom.files.parameters import Value
from werrimbi_odom.files.yaml_text import plain, round_trip

_PLAIN_TEXT = re.compile(r"[A-Za-z_/~][\w/~{}-]*(\.\w+)*\Z", re.ASCII)
_NOT_TEXT = re.compile(r"(y|n|yes|no|on|off|true|false|null|~)\Z", re.IGNORECASE)
"""What a reader of YAML 1.1, as in ROS, does not take for text unless it is quoted."""


def is_text(value: str) -> bool:
    """Whether a reader of YAML 1.1, too, takes it for text without quotes."""
    return bool(_PLAIN_TEXT.match(value)) and not _NOT_TEXT.match(value)


def float_text(value: float) -> str:
    """A float that a reader of YAML 1.1 takes for one."""
    digits = repr(value)
    return digits if "." in digits else digits.replace("e", ".0e")


class _Representer(RoundTripRepresenter):
    """Floats with a point, also before an exponent: without one YAML 1.1 reads a text."""

    def represent_float(self, data: float) -> ScalarNode:
        return self.represent_scalar("tag:yaml.org,2002:float", float_text(data))

    def represent_scalar_float(self, data: ScalarFloat) -> ScalarNode:
        """A float in the look it had; ruamel drops digits of long ones with an exponent."""
        node: ScalarNode = super().represent_scalar_float(data)
        return node if float(node.value) == data else self.represent_float(float(data))


_Representer.add_representer(float, _Representer.represent_float)
_Representer.add_representer(ScalarFloat, _Representer.represent_scalar_float)


def edited(
    text: str, place: tuple[str, str], values: Mapping[str, Value], order: Sequence[str]
) -> str:
    """The text with `values` in the block at `place`.

    Parameters
    ----------
    place : (str, str)
        Key of the node, and below it that of its parameters.
    values : mapping
        What is there already and says the same is not touched.
    order : sequence of names
        An added name goes behind the nearest one before it in this order.
    """

    def change(block: CommentedMap) -> None:
        for name, value in values.items():
            if name not in block:
                _add(block, name, _as_yaml(value), order)
            elif not _same(block[name], value):
                block[name] = _replaced(block[name], value)

    return edited_block(text, place, change)


def edited_block(text: str, place: tuple[str, str], change: Callable[[CommentedMap], None]) -> str:
    """The text after `change` has been made to the block at `place`."""
    yaml = round_trip()
    yaml.Representer = _Representer
    content = yaml.load(text)
    below = content[place[0]]
    if below[place[1]] is None:
        below[place[1]] = CommentedMap()
    block = below[place[1]]
    _keep_indent(yaml, below, block)
    yaml.explicit_start = text.startswith("---") or "\n---" in text
    change(block)
    stream = io.StringIO()
    yaml.dump(content, stream)
    return stream.getvalue()


def _same(old: Any, value: Value) -> bool:
    known = plain(old)
    if isinstance(known, list):
        known = tuple(known)
    return type(known) is type(value) and known == value


def _as_yaml(value: Value) -> Any:
    if isinstance(value, str):
        return value if is_text(value) else DoubleQuotedScalarString(value)
    if isinstance(value, tuple):
        names = CommentedSeq(_as_yaml(item) for item in value)
        names.fa.set_flow_style()
        return names
    return value


def _replaced(old: Any, value: Value) -> Any:
    """The new value in the look of the old one: a list item below item stays so."""
    new = _as_yaml(value)
    if isinstance(old, CommentedSeq) and isinstance(new, CommentedSeq):
        if not old.fa.flow_style():
            new.fa.set_block_style()
        last = old.ca.items.get(len(old) - 1)
        if last is not None:
            new.ca.items[len(new) - 1] = last
    return new


def _keep_indent(yaml: YAML, below: CommentedMap, block: CommentedMap) -> None:
    """Indent as the source does; ruamel has one width for all mappings and one for all lists."""
    yaml.map_indent = max(int(below.lc.col), 2)
    for value in block.values():
        if isinstance(value, CommentedSeq) and not value.fa.flow_style() and len(value):
            offset = max(int(value.lc.col) - int(block.lc.col), 0)
            yaml.sequence_indent, yaml.sequence_dash_offset = offset + 2, offset
            return


def _add(block: CommentedMap, name: str, value: Any, order: Sequence[str]) -> None:
    before = order[: order.index(name)]
    previous = next((item for item in reversed(before) if item in block), None)
    if previous is None:
        block.insert(0, name, value)
        return
    block.insert(list(block).index(previous) + 1, name, value)
    # ruamel hangs the lines of comment below a value on that value. They tell of what comes next,
    # so the new line goes above them.
    lines_below = _take_lines_below(block, previous)
    if lines_below:
        block.ca.items[name] = [None, None, _comment("\n" + lines_below), None]


def _take_lines_below(block: CommentedMap, name: str) -> str:
    value = block[name]
    items, slot = block.ca.items, 2
    key: str | int = name
    if isinstance(value, CommentedSeq) and not value.fa.flow_style() and len(value):
        items, slot = value.ca.items, 0
        key = len(value) - 1
    tokens = items.get(key)
    if tokens is None or tokens[slot] is None:
        return ""
    beside, _, below = tokens[slot].value.partition("\n")
    if beside:
        tokens[slot] = _comment(beside + "\n", tokens[slot].start_mark)
    else:
        tokens[slot] = None
    return str(below)


def _comment(text: str, mark: Any = None) -> CommentToken:
    return CommentToken(text, mark or CommentMark(0), None)
