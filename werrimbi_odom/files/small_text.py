# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Text of small files that people wrote, and of names that are no text."""

from __future__ import annotations

from pathlib import Path

from werrimbi_odom.errors import InputError

MAX_BYTES = 1_000_000


def read_small_text(path: Path, *, wanted: str, too_large: str) -> str:
    """The text of a small UTF-8 file, its line ends made LF.

    Parameters
    ----------
    wanted : str
        What to give instead of a folder, as in "give the YAML file in it".
    too_large : str
        What a file of more than `MAX_BYTES` cannot be, as in "it is not a robot file".

    Raises
    ------
    InputError
        When it cannot be opened, is larger than `MAX_BYTES`, or is not UTF-8 (with the line).
    """
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except IsADirectoryError:
        raise InputError(f"{path} is a folder; {wanted}") from None
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file") from None
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the name
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{path} cannot be read: {why}") from error
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
    """The same for people and pages: bytes of a path that are no UTF-8 are spelt out."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
