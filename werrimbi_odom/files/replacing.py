# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Files that are there whole or not at all: written beside their place, then renamed into it."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import TextIO

from werrimbi_odom.errors import InputError


@contextmanager
def replacing(path: Path) -> Iterator[TextIO]:
    """A text file (UTF-8, LF) that takes the place of `path` when the block ends well.

    When it does not, `path` is as it was before. Where `path` is a pipe or a device there is
    nothing to keep, so it is written to directly.

    Raises
    ------
    InputError
        When the file cannot be written: no such folder, no permission, no space.
    """
    try:
        if path.exists() and not path.is_file():
            with path.open("w", encoding="utf-8", newline="\n") as direct:
                yield direct
            return
        target = Path(place_of(path))  # a link stays a link; what it points to is replaced
        part = _part_of(target)
        try:
            with part.open("x", encoding="utf-8", newline="\n") as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            if target.exists():
                part.chmod(target.stat().st_mode & 0o7777)
            part.replace(target)
        finally:
            with suppress(OSError):
                part.unlink(missing_ok=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        why = error.strerror or str(error)
        raise InputError(f"{path} cannot be written: {why}") from error


def refuse_unwritable(path: Path, option: str) -> None:
    """Whether `path` can be written: done by beginning it, which is all that tells in the end.

    Raises
    ------
    InputError
        When there is no such folder, or no file can be made there; `option` begins the message.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):  # a pipe, a device
        if not os.access(path, os.W_OK):
            raise InputError(f"{option} cannot be written: Permission denied")
        return
    target = Path(place_of(path))
    if not target.parent.is_dir():
        raise InputError(f"{option}: there is no folder {target.parent}")
    try:
        with TemporaryFile(dir=target.parent):  # without a name: nobody who interrupts leaves it
            pass
    except OSError as error:
        raise InputError(f"{option} cannot be written: {error.strerror or error}") from error


def place_of(path: Path) -> str:
    """Where a path leads to in the end."""
    try:
        return os.path.realpath(path)
    except ValueError:  # a NUL byte in the name; whoever opens the file says so
        return str(path)


def _part_of(target: Path) -> Path:
    return target.with_name(f".{secrets.token_hex(8)}.part")
