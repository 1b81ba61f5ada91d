# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi explain`: physics, formula and signature of an effect, and how to check it by ruler."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from werrimbi_odom.cli.options import declare, read_effects
from werrimbi_odom.cli.outputs import write_json

if TYPE_CHECKING:
    from rich.console import Console

    from werrimbi_odom.effects import Collection
    from werrimbi_odom.model.effect import Effect

HELP = "what a physical effect is, its formula, its signature, how to check it with a ruler"

_WIDTH_IN_A_FILE = 120


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi explain`."""
    parser.description = (
        "Without a name: all effects that the model can hold. With one: what it is physically, its "
        "formula, its parameters, its signature in the data, and how to check it on the robot."
    )
    parser.add_argument("effect", metavar="EFFECT", nargs="?", help="name of an effect")
    words = "Python file with effects of your own (it is executed); several times for several"
    declare(parser, "--effects", help=words)
    declare(
        parser, "--json", metavar="FILE", help="write what is printed to this file, for programs"
    )


def run(arguments: argparse.Namespace) -> int:
    """Print one page, or the list of all effects; return 0."""
    from werrimbi_odom.effects.effect_docstring import as_json

    collection = read_effects(arguments)
    effect = None if arguments.effect is None else collection.find(arguments.effect)
    if arguments.json is not None:
        every = [as_json(each) for each in collection.effects]
        write_json(arguments.json, {"effects": every} if effect is None else as_json(effect))
    if effect is None:
        _print_list(collection)
    else:
        _print_page(effect)
    return 0


def _print_list(collection: Collection) -> None:
    from werrimbi_odom.effects.effect_docstring import absent_at

    try:
        from rich.table import Table
        from rich.text import Text
    except ModuleNotFoundError:  # rich may not be installed on a robot
        for effect in collection.effects:
            print(f"{effect.name:26}{effect.stage:11}{effect.summary}")
        return
    table = Table(show_lines=False)
    table.add_column("effect", style="bold", no_wrap=True)
    table.add_column("acts on")
    table.add_column("what it is", ratio=1)
    table.add_column("absent at", no_wrap=True)
    table.add_column("typical", no_wrap=True)
    for effect in collection.effects:
        absent = [f"{name} {absent_at(effect, name)}" for name in effect.parameters]
        typical = [f"{item.typical:g} {item.unit}" for item in effect.parameters.values()]
        cells = (
            effect.name,
            effect.stage,
            effect.summary,
            "\n".join(absent) or "no mistake",
            "\n".join(typical),
        )
        table.add_row(*(Text(cell) for cell in cells))
    console = _console()
    console.print(table)
    console.print(Text("werrimbi explain EFFECT shows its page"))


def _print_page(effect: Effect) -> None:
    from werrimbi_odom.effects.effect_docstring import MEANING, STAGES, as_text, numbers, page_of

    try:
        from rich.padding import Padding
        from rich.table import Table
        from rich.text import Text
    except ModuleNotFoundError:
        print(as_text(effect), end="")
        return
    page, console = page_of(effect), _console()
    console.print(Text.assemble((effect.name, "bold"), f": acts {STAGES[effect.stage]}\n"))
    for paragraph in page.physics:
        console.print(Text(f"{paragraph}\n"))
    for name, text in page.sections.items():
        console.print(Text.assemble((name, "bold"), f" ({MEANING[name]})"))
        words = text if name == "Formula" else " ".join(text.split())
        console.print(Padding(Text(words), (0, 0, 1, 2), expand=False))
    if effect.parameters:
        table = Table()
        for column in ("parameter", "unit", "what it is", "values"):
            table.add_column(column, ratio=1 if column == "what it is" else None)
        for name, item in effect.parameters.items():
            cells = (name, item.unit or "1", item.says, numbers(effect, name).replace(", ", "\n"))
            table.add_row(*(Text(cell) for cell in cells))
        console.print(table)


def _console() -> Console:
    from rich.console import Console

    class Piped(Console):
        """Leaves a reader that has gone to `cli.main`, where rich would end the program."""

        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    return Piped() if sys.stdout.isatty() else Piped(width=_WIDTH_IN_A_FILE)
