# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command `werrimbi`: one module per verb; a user error is one line and exit code 2."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from importlib import import_module, metadata
from types import ModuleType
from typing import NoReturn

from werrimbi_odom.cli.options import add_verb
from werrimbi_odom.cli.outputs import refuse_files
from werrimbi_odom.cli.packages import EXTRAS, lacking, refuse_lacking
from werrimbi_odom.errors import InputError

VERBS = (
    *("info", "odom", "compare", "diagnose", "history", "add", "draft", "workbench", "calibrate"),
    *("simulate", "explain"),
)
"""Each is a module in this folder with HELP, `add_arguments(parser)` and `run(arguments)`, which
returns 0 on success, and raises `InputError` on user errors, with no file half written."""

BAD_INPUT = 2
INTERRUPTED = 130  # 128 + SIGINT, as in shells
NO_READER = 141  # 128 + SIGPIPE


class _Parser(argparse.ArgumentParser):
    """Prints errors in one line, without the usage."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"{self.prog}: {_one_line(message)} (see {self.prog} --help)\n")

    # A verb refuses what it does not know: argparse leaves it to `werrimbi`, whose help lacks it.
    def parse_known_args(self, args=None, namespace=None):  # type: ignore[no-untyped-def]
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}")
        return found, unknown


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line with `argv`, by default that of the process; return its exit code."""
    # Set before numpy is imported. The matrices are small: two OpenBLAS threads mostly wait for
    # each other, the more so on a busy machine (the workbench, with its browser).
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    words = sys.argv[1:] if argv is None else list(argv)
    for stream in (sys.stdout, sys.stderr):
        # Paths may not be valid text, and terminals may lack characters: these are escaped.
        if isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
            stream.reconfigure(errors="backslashreplace")
    verb = "werrimbi"
    try:
        try:
            arguments = _parser(words).parse_args(words)
        except SystemExit as end:  # argparse ends --help and usage errors this way
            return end.code if isinstance(end.code, int) else BAD_INPUT
        verb = f"werrimbi {arguments.verb}"
        refuse_lacking(arguments)
        refuse_files(arguments)
        code = int(_module(arguments.verb).run(arguments))
        sys.stdout.flush()  # here, where a broken pipe is still handled
        return code
    except SystemExit as end:  # not raised by this package; the work is not done
        problem = f"code that it ran ended it (SystemExit: {end.code})"
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The interpreter flushes stdout once more at its end; redirect it to nothing.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NO_READER
    except InputError as error:
        problem = str(error)
    except ModuleNotFoundError as missing:
        if (missing.name or "").partition(".")[0] not in EXTRAS:
            raise
        problem = lacking(missing.name or "", verb)
    except MemoryError:
        problem = "this needs more memory than there is; cut the run into several"
    except OSError as error:
        problem = str(error)
    print(f"{verb}: {_one_line(problem)}", file=sys.stderr)
    return BAD_INPUT


def _parser(words: Sequence[str]) -> argparse.ArgumentParser:
    parser = _Parser(
        prog="werrimbi",
        description="Wheel odometry that knows how wrong it is, and can tell its user why.",
        epilog="werrimbi VERB --help tells more of each.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"werrimbi_odom {_version()}")
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True, title="verbs")
    chosen = next((word for word in words if not word.startswith("-")), None)
    for name in VERBS:
        if chosen == name or chosen not in VERBS:
            module = _module(name)
            below = add_verb(verbs, name, module.HELP)
            if chosen == name:  # other verbs do not need their options, which cost time
                module.add_arguments(below)
    return parser


def _module(verb: str) -> ModuleType:
    return import_module(f"werrimbi_odom.cli.{verb}")


def _version() -> str:
    try:
        return metadata.version("werrimbi_odom")
    except metadata.PackageNotFoundError:
        return "(a checkout, not installed)"


def _one_line(text: str) -> str:
    return " ".join(text.split())


if __name__ == "__main__":
    sys.exit(main())
