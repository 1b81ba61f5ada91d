# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Hash of the content of a drive: the same bytes give the same hash."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files
from pathlib import Path

from werrimbi_odom.files.bags.bag import SUFFIXES
from werrimbi_odom.files.bags.echoed_topics import SUFFIXES as OF_TEXT
from werrimbi_odom.files.recordings import BAG
from werrimbi_odom.files.run_folder import REFERENCE, TICKS

_BLOCK = 2**20  # bytes


def files_of(path: Path) -> Iterator[Path]:
    """Files that are read for a path."""
    if path.is_file():
        yield path
    elif path.is_dir():
        wanted = {TICKS, REFERENCE} if (path / TICKS).exists() else {BAG}
        for each in sorted(path.iterdir()):
            name = each.name.lower()  # `.BAG` is read as well
            bag = TICKS not in wanted and any(end in name for end in (*SUFFIXES, *OF_TEXT))
            if each.name in wanted or bag:
                yield each


def mark_of(paths: Iterable[Path], *words: str) -> str:
    """Hash the files of some paths, and some words; OSError if a file cannot be read."""
    digest = hashlib.sha256("\0".join(words).encode())
    for path in paths:
        for file in files_of(path):
            own = hashlib.sha256()
            with file.open("rb") as opened:  # a bag may be larger than the memory
                while block := opened.read(_BLOCK):
                    own.update(block)
            digest.update(f"\0{file.name}\0{own.hexdigest()}".encode())
        digest.update(b"\0\0")
    return digest.hexdigest()


def written_at(path: Path) -> float:
    """Time at which a drive was written, by the file system [s since 1970]; 0 without files.

    The earliest file counts: files added later do not make the drive younger.
    """
    return min((file.stat().st_mtime for file in files_of(path)), default=0.0)


@cache
def code_mark() -> str:
    """Hash of all source files of the package, with their names."""
    root = Path(str(files("werrimbi_odom")))
    total = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        total.update(f"{path.relative_to(root)}\0{path.stat().st_size}\0".encode())
        total.update(path.read_bytes())
    return total.hexdigest()[:12]
