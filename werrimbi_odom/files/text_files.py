# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Text files: atomic writing by renaming, and reading of small ones."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import TextIO

from werrimbi_odom.errors import InputError


def beside(file: Path, word: str) -> str:
    """Name for a new file, beside the one that it is made of: robot_better.yaml."""
    return str(file.with_name(f"{file.stem}_{word}{file.suffix}"))


@contextmanager
def replacing(path: Path) -> Iterator[TextIO]:
    """Open a text file (UTF-8, LF) that replaces `path` if the block succeeds.

    Otherwise `path` is unchanged. A pipe or device is written directly. InputError if the file is
    not writable: no such folder, no permission, no space.
    """
    try:
        if path.exists() and not path.is_file():
            with path.open("w", encoding="utf-8", newline="\n") as direct:
                yield direct
            return
        target = Path(place_of(path))  # a link stays; its target is replaced
        part = target.with_name(f".{secrets.token_hex(8)}.part")
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
    """Check that `path` is writable, by creating a file: the only reliable test.

    InputError if there is no such folder, or no file can be created; `option` begins the message.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):  # a pipe, a device
        if not os.access(path, os.W_OK):
            raise InputError(f"{option} cannot be written: Permission denied")
        return
    target = Path(place_of(path))
    if not target.parent.is_dir():
        raise InputError(f"{option}: there is no folder {target.parent}")
    try:
        with TemporaryFile(dir=target.parent):  # without a name: an interruption leaves nothing
            pass
    except OSError as error:
        raise InputError(f"{option} cannot be written: {error.strerror or error}") from error


def place_of(path: Path) -> str:
    """Resolved path, with links followed."""
    try:
        return os.path.realpath(path)
    except ValueError:  # a NUL byte in the name; opening the file reports it
        return str(path)


@contextmanager
def reading(path: Path, wanted: str) -> Iterator[None]:
    """Raise an InputError where a file cannot be opened; `wanted`: what to give, if not a folder.

    What is wrong with its content is left to the block.
    """
    try:
        yield
    except (InputError, UnicodeError):
        raise
    except IsADirectoryError:
        raise InputError(f"{path} is a folder; {wanted}") from None
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file") from None
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the name
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{path} cannot be read: {why}") from error


MAX_BYTES = 1_000_000


def read_small_text(path: Path, *, wanted: str, too_large: str) -> str:
    """Read a small UTF-8 file; line ends become LF.

    `wanted`: what to give instead of a folder, as in "give the YAML file in it". `too_large`:
    remark on a file larger than `MAX_BYTES`, as in "it is not a robot file". InputError if it
    cannot be opened, is larger than `MAX_BYTES`, or is not UTF-8 (with the line).
    """
    with reading(path, wanted), path.open("rb") as file:
        raw = file.read(MAX_BYTES + 1)
    if len(raw) > MAX_BYTES:
        raise InputError(f"{path} is larger than {MAX_BYTES:,} bytes; {too_large}")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}, line {line}: byte 0x{raw[error.start]:02x} is not UTF-8; "
            "save the file as UTF-8 text"
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def readable(text: str) -> str:
    """Escape bytes of a path that are not valid UTF-8."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
