# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Modules and definitions that docstrings of the package name are there."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "werrimbi_odom"
COMMANDS = {"werrimbi", "add", "calibrate", "compare", "diagnose", "draft"}
NO_MODULES = {
    *("amount", "effect", "found", "scans.time"),  # of parameters and attributes
    *("eccentric_left_wheel", "numpy", "odom.csv", "figure.js"),  # an effect, a library, files
}


@cache
def trees() -> dict[Path, ast.Module]:
    """Of every file of the package, when a test asks: every worker imports this file."""
    return {path: ast.parse(path.read_text("utf-8")) for path in sorted(PACKAGE.rglob("*.py"))}


def of_module(path: Path) -> str:
    """Dotted name of a file of the package."""
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__")


def defined(tree: ast.Module) -> set[str]:
    """Names of functions, classes, methods and assigned variables."""
    nodes = list(ast.walk(tree))
    names = {node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    return names | {
        node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    }


@cache
def names_of_modules() -> dict[str, set[str]]:
    """What each module defines."""
    return {of_module(path): defined(tree) for path, tree in trees().items()}


def named(tree: ast.Module) -> Iterator[str]:
    """Names in backticks in the docstrings of modules, definitions and variables."""
    for node in ast.walk(tree):
        match node:
            case ast.Expr(value=ast.Constant(value=str(text))):
                yield from re.findall(r"`([A-Za-z_]\w*(?:\.\w+)*)`", text)


def is_there(dotted: str) -> bool:
    """Whether some module has this name, or holds what follows its name."""
    parts = dotted.split(".")
    for count in range(1, len(parts) + 1):
        end = "." + ".".join(parts[:count])
        if any(
            f".{module}".endswith(end) and names.issuperset(parts[count:])
            for module, names in names_of_modules().items()
        ):
            return True
    return False


def test_modules_that_docstrings_name_are_there() -> None:
    """`module.name` has the module and the name; those of classes are not looked at."""
    wrong = [
        f"{path.relative_to(PACKAGE)}: {name}"
        for path, tree in trees().items()
        for name in named(tree)
        if "." in name and name[0].islower()
        if not {name, name.partition(".")[0]} & (NO_MODULES | sys.stdlib_module_names)
        if not is_there(name)
    ]
    assert not wrong, "\n".join(wrong)


def test_a_folder_describes_what_it_holds() -> None:
    """A name in the docstring of a folder is a file, folder or definition in it."""
    wrong = []
    for path, tree in trees().items():
        if path.name == "__init__.py":
            inside = [each for each in trees() if path.parent in each.parents]
            held = {each.stem for each in inside} | {each.parent.name for each in inside}
            for each in inside:
                held |= {
                    node.name
                    for node in trees()[each].body
                    if isinstance(node, ast.FunctionDef | ast.ClassDef)
                }
            names = {name for name in named(tree) if "." not in name} - COMMANDS
            wrong += [f"{path.relative_to(PACKAGE)}: {name}" for name in sorted(names - held)]
    assert not wrong, "\n".join(wrong)
