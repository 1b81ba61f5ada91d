# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What of the recordings was left out, and why: told alike by all verbs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from werrimbi_odom.inference.legs.gaps import LeftOut

_MOST = 3  # stretches that are told one by one


def left_out_words(parts: Sequence[LeftOut]) -> list[str]:
    """A sentence for each of a few stretches, and one for what is beyond; none for nothing.

    Jumps of the reference are told by how many legs they spoil.
    """
    runs = {part.run for part in parts}
    silent = [part for part in parts if part.why != "reference"]
    lines = []
    for part in silent[:_MOST]:
        where = f" of {part.run.name}" if len(runs) > 1 or len(silent) > _MOST else ""
        lines.append(f"From {part.begin:.1f} s to {part.end:.1f} s{where} {part.words}: left out.")
    rest = silent[_MOST:]
    if rest:
        seconds = sum(part.end - part.begin for part in rest)
        lines.append(
            f"So {'is' if len(rest) == 1 else 'are'} {len(rest)} more such "
            f"stretch{'' if len(rest) == 1 else 'es'}, {seconds:.1f} s in all."
        )
    return lines


def jumps_words(parts: Sequence[LeftOut]) -> list[str]:
    """On how many legs the reference jumped; none where it did not."""
    count = sum(part.why == "reference" for part in parts)
    if not count:
        return []
    legs, they = ("1 leg", "it is") if count == 1 else (f"{count} legs", "they are")
    return [f"On {legs} the reference jumped; {they} left out."]


def left_out_json(parts: Sequence[LeftOut]) -> list[dict[str, Any]]:
    """Field for field; times in the run's own clock [s]."""
    return [
        {
            "run": str(part.run),
            "from_s": part.begin,
            "to_s": part.end,
            "why": part.why,
            "words": part.words,
        }
        for part in parts
    ]
