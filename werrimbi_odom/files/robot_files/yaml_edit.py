# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Edits values and effects in the text of a robot file; everything else is kept.

The YAML parser gives the position of each value, which is replaced in the text. Additions and
removals are whole lines. A flow-style block is rewritten as a whole.
"""

from __future__ import annotations

import functools
import io
import json
import operator
import re
from collections.abc import Mapping, Sequence
from typing import Any

from ruamel.yaml.comments import CommentedMap
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from werrimbi_odom.files.robot_files.effect_parameters import EFFECTS
from werrimbi_odom.files.robot_files.node_parameter import Value
from werrimbi_odom.files.robot_files.yaml_text import plain, round_trip
from werrimbi_odom.model.effect import AppliedEffect, Parameter

_PLAIN_TEXT = re.compile(r"[A-Za-z_/~][\w/~-]*(\.\w+)*\Z", re.ASCII)
_NOT_TEXT = re.compile(r"(y|n|yes|no|on|off|true|false|null|~)\Z", re.IGNORECASE)
"""Words that a YAML 1.1 parser, as in ROS, reads as text only if quoted."""
_UNPRINTABLE = re.compile("[\x7f-\x9f\u2028\u2029\ufeff]")
_COMMENT_COLUMN = 40
_WIDTH = 110


def with_values(
    text: str,
    place: tuple[str, ...],
    values: Mapping[str, Value],
    order: Sequence[str],
    effects: Sequence[AppliedEffect] | None = None,
) -> str:
    """Set `values`, and exactly these effects, in the block at `place`.

    `place`: keys down to the block, the last but one the node's. `values`: equal values are left
    untouched. `order`: a new name is inserted after its nearest predecessor in this order.
    `effects`: default: the existing ones are kept.
    """
    text = text if text.endswith("\n") else f"{text}\n"
    yaml = round_trip()
    given = functools.reduce(operator.getitem, place, yaml.load(text))
    above = functools.reduce(_child, place[:-1], yaml.compose(io.StringIO(text)))
    node = _child(above, place[-1])
    if node.flow_style:
        new = {**plain(given), **values}
        new = new if effects is None else _with_effects(new, effects)
        start, end = node.start_mark.index, node.end_mark.index
        return text[:start] + _written(new, quoted=True) + text[end:]
    block = _Block(text, node, given, [])
    for name in sorted(values, key=order.index):
        if name in block.nodes:
            block.change(name, values[name])
        else:
            before = [each for each in order[: order.index(name)] if each in block.nodes]
            at = block.behind(before[-1]) if before else block.begin
            block.insert(at, [f"{name}: {_written(values[name])}"])
    if effects is not None:
        step = max(block.column - above.start_mark.column, 2)
        _change_effects(block, effects, " " * step)
    return block.edited()


def known_values(applied: AppliedEffect) -> dict[str, float]:
    """All values of an effect that a file can hold; per-run values are excluded."""
    values: Mapping[str, float] = {**applied.effect.nulls, **applied.values}
    return {name: float(values[name]) for name in values if name not in applied.unknown}


class _Block:
    """A mapping in block style, one key per line, and the edits to apply.

    `edits`: start and end (in characters), and the new text.
    """

    def __init__(
        self, text: str, node: MappingNode, given: CommentedMap, edits: list[tuple[int, int, str]]
    ) -> None:
        self.text, self.given, self.edits = text, given, edits
        self.column = int(node.start_mark.column)
        self.begin = int(node.start_mark.index) - self.column
        self.nodes = {str(key.value): (key, value) for key, value in node.value}

    def below(self, name: str) -> _Block:
        """The block below a key."""
        return _Block(self.text, self.nodes[name][1], self.given[name], self.edits)

    def behind(self, name: str) -> int:
        """Start of the line after a key's value."""
        return self.text.index("\n", _end(self.text, *self.nodes[name])) + 1

    def insert(self, at: int, lines: Sequence[str]) -> None:
        """Insert lines with the indentation of the keys."""
        new = "".join(f"{' ' * self.column}{line}\n" for line in lines)
        self.edits.append((at, at, new))

    def cut(self, name: str) -> None:
        """Remove the lines of a key."""
        start = self.nodes[name][0].start_mark
        self.edits.append((start.index - start.column, self.behind(name), ""))

    def change(self, name: str, value: Any, *, named: bool = False) -> None:
        """Replace a value, unless it is equal; a comment beside it keeps its column.

        `named`: whether a comment beside a list item refers to that item.
        """
        key, node = self.nodes[name]
        old = plain(self.given[name])
        known = tuple(old) if isinstance(old, list) else old
        if type(known) is type(value) and known == value:
            return
        start, end, new = node.start_mark.index, _end(self.text, key, node), _written(value)
        if _is_empty(node):
            start, new = end, f" {new}"
        elif isinstance(node, SequenceNode) and not node.flow_style:
            end = self.text.index("\n", end)
            if value:
                new = self._items(node, old, value, named)
            else:
                colon = self.text.index(":", key.end_mark.index) + 1
                self.edits.append((colon, colon, " []"))
                start, new = self.text.rindex("\n", 0, start), ""
        beside = self.text[end : self.text.index("\n", end)]
        comment = beside.lstrip(" ")
        gap = len(beside) - len(comment) if comment.startswith("#") else 0
        room = max(end + gap - start - len(new), min(gap, 2))
        self.edits.append((start, end + gap, new + " " * room if gap else new))

    def _items(
        self, node: SequenceNode, old: Sequence[Any], value: Sequence[str], named: bool
    ) -> str:
        """Write a block list; items that stay keep their comments."""
        ends = [_end(self.text, None, item) for item in node.value]
        nexts = [self.text.rindex("\n", 0, item.start_mark.index) for item in node.value[1:]]
        nexts.append(self.text.index("\n", ends[-1]))
        beside = {name: self.text[a:b] for name, a, b in zip(old, ends, nexts, strict=True)}
        if old[-1] not in value and not named:
            beside[value[-1]] = beside.get(value[-1], "") + beside[old[-1]]
        lines = [f"- {_written(item)}{beside.get(item, '')}" for item in value]
        return f"\n{' ' * int(node.start_mark.column)}".join(lines)

    def edited(self) -> str:
        """Apply the edits to the text."""
        parts, done = [], 0
        for start, end, new in sorted(self.edits, key=lambda edit: edit[:2]):
            parts += [self.text[done:start], new]
            done = end
        return "".join([*parts, self.text[done:]])


def _change_effects(block: _Block, effects: Sequence[AppliedEffect], step: str) -> None:
    """Set exactly these effects in a block; `step`: indentation below a key."""
    names = tuple(applied.name for applied in effects)
    gone = {name for name in block.given.get(EFFECTS) or () if name not in names}
    cut = [key for key in block.nodes if key.partition(".")[0] in gone]
    if EFFECTS in block.nodes:
        block.change(EFFECTS, names, named=True)
        behind = block.behind(EFFECTS)
    else:
        behind = block.behind([key for key in block.nodes if key not in cut][-1])
        if names:
            line = f"{EFFECTS}: [{', '.join(names)}]"
            block.insert(behind, [_beside(line, "in order of application")])
    for applied in effects:
        behind = _change_effect(block, applied, behind, step)
    for key in cut:
        block.cut(key)


def _change_effect(block: _Block, applied: AppliedEffect, behind: int, step: str) -> int:
    """Set an effect's values in a block; return the position for the next effect."""
    name, known, declared = applied.name, known_values(applied), applied.effect.parameters
    holder, prefix = block, f"{name}."
    if name in block.nodes:
        if block.nodes[name][1].flow_style:
            own = plain(block.given[name])
            block.change(name, _needed(own, known, declared))
            return block.behind(name)
        holder, prefix = block.below(name), ""
    there = {key.removeprefix(prefix): key for key in holder.nodes if key.startswith(prefix)}
    stay = [key for parameter, key in there.items() if parameter in known]
    if stay:
        for parameter, key in there.items():
            if parameter in known:
                holder.change(key, known[parameter])
            else:
                holder.cut(key)
        more = {key: known[key] for key in _needed(there, known, declared) if key not in there}
        lines = [_line(prefix + key, value, declared[key]) for key, value in more.items()]
        holder.insert(holder.behind(stay[-1]), lines)
        return block.behind(name if holder is not block else stay[-1])
    for key in [name] if holder is not block else there.values():
        block.cut(key)
    if known:
        stated = _stated(known, declared)
        lines = [_line(step + key, value, declared[key]) for key, value in stated.items()]
        block.insert(behind, [f"{name}:", *lines])
    return behind


def _with_effects(block: dict[str, Any], effects: Sequence[AppliedEffect]) -> dict[str, Any]:
    """Return a flow-style block with exactly these effects."""
    kept = {applied.name: applied for applied in effects}
    gone = set(block.get(EFFECTS) or ()) - set(kept)
    new = {key: value for key, value in block.items() if key.partition(".")[0] not in gone}
    if kept or EFFECTS in new:
        new[EFFECTS] = list(kept)
    for name, applied in kept.items():
        known = known_values(applied)
        dotted = [key for key in new if key.startswith(f"{name}.")]
        own = new.pop(name, None) or {key.partition(".")[2]: new.pop(key) for key in dotted}
        if known:
            declared = applied.effect.parameters
            new[name] = _needed(own, known, declared) if own else _stated(known, declared)
    return new


def _stated(known: Mapping[str, float], declared: Mapping[str, Parameter]) -> dict[str, float]:
    """Values of a new block: all but what refines a law, where that is not refined."""
    return {name: value for name, value in known.items() if not declared[name].is_unrefined(value)}


def _needed(
    own: Mapping[str, Any], known: Mapping[str, float], declared: Mapping[str, Parameter]
) -> dict[str, float]:
    """Values to write: those present, those not null, and per-run ones (absent means unknown)."""
    return {
        name: value
        for name, value in known.items()
        if name in own or value != declared[name].null or declared[name].per_run
    }


def _child(node: Node, key: str) -> MappingNode:
    assert isinstance(node, MappingNode)
    found = next(value for name, value in node.value if name.value == key)
    assert isinstance(found, MappingNode)
    return found


def _end(text: str, key: Node | None, node: Any) -> int:
    """End of a value's last token; a block's own end includes the comments below it."""
    if _is_empty(node) and key is not None:
        return text.index(":", key.end_mark.index) + 1
    if isinstance(node, ScalarNode) or node.flow_style or not node.value:
        end = node.end_mark
        return int(end.index) - int(end.column == 0 and end.line > node.start_mark.line)
    last = node.value[-1]
    return _end(text, *last) if isinstance(node, MappingNode) else _end(text, None, last)


def _is_empty(node: Node) -> bool:
    return bool(node.start_mark.index == node.end_mark.index)


def _written(value: Any, *, quoted: bool = False) -> str:
    """Format a value in one line, valid for YAML 1.1 too; `quoted`: quote all texts."""
    if isinstance(value, bool) or value is None:
        return json.dumps(value)
    if isinstance(value, float):  # without a point, YAML 1.1 reads an exponent as text
        digits = repr(value)
        return digits if "." in digits else digits.replace("e", ".0e")
    if isinstance(value, str):
        if not quoted and _PLAIN_TEXT.match(value) and not _NOT_TEXT.match(value):
            return value
        text = json.dumps(value, ensure_ascii=False)
        return _UNPRINTABLE.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
    if isinstance(value, Mapping):
        each = (": ".join(_written(part, quoted=quoted) for part in pair) for pair in value.items())
        return f"{{{', '.join(each)}}}"
    if isinstance(value, Sequence):
        return f"[{', '.join(_written(item, quoted=quoted) for item in value)}]"
    return str(value)


def _line(key: str, value: float, parameter: Parameter) -> str:
    """A value with unit and meaning as a comment, if there is room."""
    says = f"{parameter.unit}, {parameter.says}" if parameter.unit else parameter.says
    name = key.lstrip()
    line = f"{key[: len(key) - len(name)]}{_written(name)}: {_written(value)}"
    short = says if len(says) + _COMMENT_COLUMN <= _WIDTH else parameter.unit
    return _beside(line, short) if short else line


def _beside(line: str, comment: str) -> str:
    return f"{line:<{_COMMENT_COLUMN - 4 - 2}}  # {comment}"
