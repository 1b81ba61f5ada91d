# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The list of effects and their blocks in the YAML text of a robot file, changed and kept.

A value that is there already is changed in its place. Lines that come or go are inserted and cut as
lines of text, so that whatever stands around them stays as it was.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

from werrimbi_odom.files.effect_parameters import EFFECTS
from werrimbi_odom.files.yaml_edit import edited_block, float_text, is_text
from werrimbi_odom.files.yaml_text import round_trip
from werrimbi_odom.model.effect import AppliedEffect, Parameter

_COMMENT_COLUMN = 40
_WIDTH = 110


def with_effects(text: str, place: tuple[str, str], effects: Sequence[AppliedEffect]) -> str:
    """The text with exactly these effects in the block at `place`.

    Parameters
    ----------
    place : (str, str)
        Key of the node, and below it that of its parameters.
    """
    text = edited_block(text, place, lambda block: _change(block, effects))
    if _Layout.of(text, place).flow:
        return text  # all on one line, or in brackets: nothing stands between
    names = [applied.name for applied in effects]
    text = _without(text, place, effects)
    if not any(key == EFFECTS for key in _Layout.of(text, place).last_lines):
        if not names:
            return text
        line = f"{EFFECTS}: [{', '.join(names)}]"
        text = _inserted(text, place, None, [_beside(line, "in order of application")])
    behind = EFFECTS
    for applied in effects:
        behind = _add_missing(text_of := _Text(text), place, applied, behind)
        text = text_of.text
    return text


def _change(block: CommentedMap, effects: Sequence[AppliedEffect]) -> None:
    """What needs no new line: the list, and values that are there; in brackets everything."""
    flow = bool(block.fa.flow_style())
    names = [applied.name for applied in effects]
    if EFFECTS in block:
        if list(block[EFFECTS] or []) != names:
            block[EFFECTS] = _names(names, block[EFFECTS])
    elif flow and names:
        block[EFFECTS] = _names(names, None)
    for applied in effects:
        known = _known(applied)
        own = block.get(applied.name)
        for name, value in known.items():
            dotted = f"{applied.name}.{name}"
            if isinstance(own, CommentedMap) and name in own:
                _set(own, name, value)
            elif dotted in block:
                _set(block, dotted, value)
            elif isinstance(own, CommentedMap) and own.fa.flow_style():
                if value != applied.effect.parameters[name].null:
                    own[_key(name)] = value
            elif flow:
                block.setdefault(applied.name, _flow_map())[_key(name)] = value
    if flow:
        for key in [key for key in block if _is_gone(key, block, effects)]:
            del block[key]
    for applied in effects:
        own = block.get(applied.name)
        if isinstance(own, CommentedMap) and (flow or own.fa.flow_style()):
            for name in [name for name in own if name not in _known(applied)]:
                del own[name]


def _without(text: str, place: tuple[str, str], effects: Sequence[AppliedEffect]) -> str:
    """The text less the lines of effects and parameters that are there no more."""
    layout = _Layout.of(text, place)
    kept = {applied.name: _known(applied) for applied in effects}
    cut: list[tuple[int, int]] = []
    for key, span in layout.spans.items():
        name, _, parameter = key.partition(".")
        if key in layout.blocks:
            own = layout.blocks[key]
            if key not in kept or not any(each in kept[key] for each in own):
                cut.append(span)
            else:
                cut += [lines for each, lines in own.items() if each not in kept[key]]
        elif parameter and name not in _FOREIGN and parameter not in kept.get(name, {}):
            cut.append(span)
    lines = text.splitlines(keepends=True)
    for first, last in sorted(cut, reverse=True):
        del lines[first : last + 1]
    return "".join(lines)


def _add_missing(text: _Text, place: tuple[str, str], applied: AppliedEffect, behind: str) -> str:
    """Add the lines that an effect still needs; returns the key behind which the next belongs."""
    layout = _Layout.of(text.text, place)
    declared, known = applied.effect.parameters, _known(applied)
    dotted = [key for key in layout.spans if key.startswith(f"{applied.name}.")]
    if applied.name in layout.blocks:
        own = layout.blocks[applied.name]
        needed = {n: v for n, v in known.items() if n not in own and v != declared[n].null}
        if needed and not layout.flow_blocks.get(applied.name):
            last = max(end for _, end in own.values())
            new = [_line(name, value, declared[name]) for name, value in needed.items()]
            text.insert(last + 1, layout.below(applied.name), new)
        return applied.name
    if dotted:
        given = {key.partition(".")[2] for key in dotted}
        needed = {n: v for n, v in known.items() if n not in given and v != declared[n].null}
        new = [_line(f"{applied.name}.{n}", v, declared[n]) for n, v in needed.items()]
        text.insert(layout.spans[dotted[-1]][1] + 1, layout.column, new)
        return dotted[-1]
    if known:
        step = " " * layout.step
        new = [f"{applied.name}:"]
        new += [_line(step + name, value, declared[name]) for name, value in known.items()]
        text.insert(layout.last_lines[behind] + 1, layout.column, new)
        return applied.name
    return behind


_FOREIGN = ("qos_overrides",)


def _known(applied: AppliedEffect) -> dict[str, float]:
    values: Mapping[str, float] = {**applied.effect.nulls, **applied.values}
    return {name: float(values[name]) for name in values if name not in applied.unknown}


def _is_gone(key: object, block: CommentedMap, effects: Sequence[AppliedEffect]) -> bool:
    kept = {applied.name: _known(applied) for applied in effects}
    name, _, parameter = str(key).partition(".")
    if name in _FOREIGN:
        return False
    if parameter:
        return parameter not in kept.get(name, {})
    return isinstance(block[key], CommentedMap) and name not in kept


def _names(names: Sequence[str], old: Any) -> CommentedSeq:
    new = CommentedSeq(names)
    if isinstance(old, CommentedSeq) and not old.fa.flow_style() and names:
        new.fa.set_block_style()
        for place, name in enumerate(names):  # a name keeps the comment beside it
            if name in old and old.ca.items.get(old.index(name)):
                new.ca.items[place] = old.ca.items[old.index(name)]
    else:
        new.fa.set_flow_style()
    return new


def _key(name: str) -> str:
    return name if is_text(name) else DoubleQuotedScalarString(name)


def _set(block: CommentedMap, name: str, value: float) -> None:
    if type(block[name]) is bool or float(block[name]) != value:
        block[name] = value


def _flow_map() -> CommentedMap:
    new = CommentedMap()
    new.fa.set_flow_style()
    return new


def _line(key: str, value: float, parameter: Parameter) -> str:
    says = f"{parameter.unit}, {parameter.says}" if parameter.unit else parameter.says
    indent, name = key[: len(key) - len(key.lstrip())], key.lstrip()
    if not is_text(name):  # y, of a lever arm: YAML 1.1 takes it for a truth value
        name = f'"{name}"'
    line = f"{indent}{name}: {float_text(value)}"
    short = says if len(says) + _COMMENT_COLUMN <= _WIDTH else parameter.unit
    return _beside(line, short) if short else line


def _beside(line: str, comment: str) -> str:
    return f"{line:<{_COMMENT_COLUMN - 4 - 2}}  # {comment}"


def _inserted(text: str, place: tuple[str, str], behind: str | None, new: Sequence[str]) -> str:
    """The text with new lines behind a key of the block; by default at the block's end."""
    layout = _Layout.of(text, place)
    last = max(layout.last_lines.values()) if behind is None else layout.last_lines[behind]
    into = _Text(text)
    into.insert(last + 1, layout.column, new)
    return into.text


class _Text:
    """A text that takes new lines."""

    def __init__(self, text: str) -> None:
        self.text = text

    def insert(self, line: int, column: int, new: Sequence[str]) -> None:
        """Put new lines, indented by `column`, before the line of that number (from 0)."""
        lines = self.text.splitlines(keepends=True)
        if lines and not lines[-1].endswith("\n"):
            lines[-1] += "\n"
        lines[line:line] = [f"{' ' * column}{each}\n" for each in new]
        self.text = "".join(lines)


class _Layout(NamedTuple):
    """Where in the text everything of the parameter block stands; lines from 0."""

    flow: bool
    """In brackets."""
    column: int
    """Of its keys."""
    step: int
    """By which a level is indented."""
    spans: dict[str, tuple[int, int]]
    """First and last line of each key."""
    blocks: dict[str, dict[str, tuple[int, int]]]
    """The same within each effect's block."""
    flow_blocks: dict[str, bool]
    columns: dict[str, int]
    """Of the keys in each block."""

    @property
    def last_lines(self) -> dict[str, int]:
        """Last line of each key."""
        return {key: last for key, (_, last) in self.spans.items()}

    def below(self, name: str) -> int:
        """Column of the keys in a block."""
        return self.columns[name]

    @classmethod
    def of(cls, text: str, place: tuple[str, str]) -> _Layout:
        """Look at a text."""
        root = round_trip().compose(io.StringIO(text))
        above = _child(root, place[0])
        block = _child(above, place[1])
        spans, blocks, flow_blocks, columns = {}, {}, {}, {}
        for key, value in block.value:
            spans[str(key.value)] = _span(key, value)
            if isinstance(value, MappingNode) and key.value not in _FOREIGN:
                blocks[str(key.value)] = {str(k.value): _span(k, v) for k, v in value.value}
                flow_blocks[str(key.value)] = bool(value.flow_style)
                columns[str(key.value)] = value.start_mark.column
        column = block.start_mark.column
        step = max(column - above.start_mark.column, 2)
        return cls(bool(block.flow_style), column, step, spans, blocks, flow_blocks, columns)


def _child(node: Node, key: str) -> MappingNode:
    assert isinstance(node, MappingNode)
    found = next(value for name, value in node.value if name.value == key)
    assert isinstance(found, MappingNode)
    return found


def _span(key: Node, value: Node) -> tuple[int, int]:
    return key.start_mark.line, max(key.start_mark.line, _last_line(value))


def _last_line(node: Any) -> int:
    """Last line with something of a node; a block's own end lies behind the comments below it."""
    children = node.value if isinstance(node, SequenceNode) else []
    if isinstance(node, MappingNode):
        children = [value for _, value in node.value]
    if isinstance(node, ScalarNode) or node.flow_style or not children:
        end = node.end_mark
        return int(end.line) - (1 if end.column == 0 and end.line > node.start_mark.line else 0)
    return _last_line(children[-1])
