# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A folder of several recordings, each finished, in place of the files of one."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.unfinished_bag import ending

APART, OVERLAP = 10.0, 0.5
"""Time between two files [s] from which they are not of one recording: a recorder that begins a new
file loses next to nothing, and does not go on with the one before."""


def refuse_several(path: Path, files: Sequence[Path]) -> None:
    """Raise if files without metadata are several recordings: read as one, they are no drive.

    Files of one recording that was killed follow one another, and the last one is cut off.
    """
    if len(files) < 2 or (path / "metadata.yaml").exists():
        return
    spans = [(file, span) for file in files if (span := _span(file)) is not None]
    for (one, (_, end)), (other, (begin, _)) in itertools.pairwise(
        sorted(spans, key=lambda each: each[1])
    ):
        gap = begin - end
        if -OVERLAP <= gap <= APART:
            continue
        told = f"{gap:.4g} s apart" if gap > 0.0 else "which overlap in time"
        raise InputError(
            f"{path} holds {len(files)} recordings of their own ({one.name} and {other.name}, "
            f"{told}) and no metadata.yaml of one: give each by itself, as {one} {other}"
        )


def _span(file: Path) -> tuple[float, float] | None:
    """First and last time of receipt [s]; None of a file that is not finished, or empty."""
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2

    with suppress(Exception), (Reader1 if ending(file) == ".bag" else Reader2)(file) as reader:
        if reader.message_count:
            return reader.start_time / 1e9, reader.end_time / 1e9
    return None
