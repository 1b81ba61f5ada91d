# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Machine code of the model's own functions, made by numba where that is installed.

The functions stay as they are written, in plain Python, and are what tests know; numba translates
them, operation by operation, and keeps the result on disk for the next process. Where it is not
installed, or has nowhere to keep anything, there is no machine code, and nobody misses it but for
its speed. Importing numba takes a third of a second and 70 MB; so nothing here does before it is
asked to, and the node never asks.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar, cast

from werrimbi_odom.model.of_floats import copied_for_floats

Function = TypeVar("Function", bound=Callable[..., Any])


WORTH_COMPILING = 200_000
"""Steps from which machine code saves more than it takes to load it (0.4 s)."""


WORTH_AGAIN = 30_000
"""The same for who goes along them again and again, as a fit does (0.2 s for each function)."""


def compiled_for(steps: int, function: Function, again: bool = False) -> Function | None:
    """Machine code to go along so many steps, where it pays; `again` and again, or once."""
    return compiled(function) if steps >= (WORTH_AGAIN if again else WORTH_COMPILING) else None


@cache
def compiled(function: Function) -> Function | None:
    """Machine code of a function of the model and of those that it calls, for floats.

    Returns
    -------
    callable or None
        It compiles when it is first called, or loads what an earlier process has compiled. None
        where there is no numba, or no folder that it may write to.
    """
    try:
        import numba
    except ImportError:
        return None
    # What is called is put in its place: to hand on tuples of many numbers takes its time.
    inner = numba.njit(error_model="numpy", forceinline=True)
    own = copied_for_floats(function, inner)
    own.__qualname__ += f"_{_digest()}"  # names the file that it is kept in
    try:
        return cast("Function", numba.njit(cache=True, error_model="numpy")(own))
    except RuntimeError:  # no folder to keep it in; to compile anew each time costs too much
        return None


def _digest() -> str:
    """Of all sources of the model: numba itself looks at the outermost function's file alone."""
    sources = sorted(Path(__file__).parent.glob("*.py"))
    return sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()[:16]
