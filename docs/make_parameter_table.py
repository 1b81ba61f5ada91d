# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The table of parameters for docs/node.md, from their one declaration.

python docs/make_parameter_table.py
"""

from __future__ import annotations

from werrimbi_odom.files.robot_files.node_parameter import NodeParameter
from werrimbi_odom.files.robot_files.parameters import PARAMETERS


def markdown_table() -> str:
    """All parameters as a table in Markdown."""
    head = "| parameter | type | default | unit | range | what it is |\n|---|---|---|---|---|---|\n"
    return head + "".join(f"| {' | '.join(_cells(item))} |\n" for item in PARAMETERS)


def _cells(item: NodeParameter) -> tuple[str, ...]:
    kind = "list of strings" if item.kind == "strings" else item.kind
    return f"`{item.name}`", kind, _default(item), item.unit, _range(item), item.says


def _default(item: NodeParameter) -> str:
    if item.default is None:
        counts = item.name.endswith("_ticks_per_revolution")
        return "**required**, unless positions are in radians" if counts else "**required**"
    if isinstance(item.default, tuple):
        return f"`[{', '.join(item.default)}]`"
    if isinstance(item.default, bool):
        return f"`{str(item.default).lower()}`"
    return f"`{item.default}`" if item.default != "" else "empty"


def _range(item: NodeParameter) -> str:
    if item.choices:
        return ", ".join(f"`{choice}`" for choice in item.choices)
    bounds = (("> {:g}", item.above), (">= {:g}", item.minimum), ("<= {:g}", item.maximum))
    return ", ".join(words.format(bound) for words, bound in bounds if bound is not None)


if __name__ == "__main__":
    print(markdown_table(), end="")
