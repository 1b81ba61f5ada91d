# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Compilation of functions of the model with numba, where it is installed.

The functions are written, and tested, in plain Python. Numba translates them operation by operation
and caches the result on disk for later processes. Without numba, or without a writable cache
folder, the Python versions run, only slower. Importing numba takes a third of a second and 70 MB,
so it is imported only on request, and never by the node.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar, cast

from werrimbi_odom.model.float_versions import copied_for_floats

Function = TypeVar("Function", bound=Callable[..., Any])


WORTH_COMPILING = 200_000
"""Number of steps from which compiled code saves more time than loading it takes (0.4 s)."""


WORTH_AGAIN = 30_000
"""The same for repeated passes over the same steps, as in a fit (0.2 s for each function)."""


def compiled_for(steps: int, function: Function, again: bool = False) -> Function | None:
    """Return the compiled function where this many steps pay for it; `again`: repeated passes."""
    return compiled(function) if steps >= (WORTH_AGAIN if again else WORTH_COMPILING) else None


@cache
def compiled(function: Function) -> Function | None:
    """Compile a function of the model, and those that it calls, for floats.

    Returns
    -------
    callable or None
        Compiled at its first call, or loaded from the cache. None without numba, or without a
        writable cache folder.
    """
    try:
        import numba
    except ImportError:
        return None
    # Callees are inlined: passing tuples of many numbers is slow.
    inner = numba.njit(error_model="numpy", forceinline=True)
    own = copied_for_floats(function, inner)
    own.__qualname__ += f"_{_digest()}"  # names the cache file
    try:
        return cast("Function", numba.njit(cache=True, error_model="numpy", nogil=True)(own))
    except RuntimeError:  # no cache folder; compiling in every process costs too much
        return None


def _digest() -> str:
    """Hash of all sources of the model; numba itself checks only the file of the outer function."""
    sources = sorted(Path(__file__).parent.glob("*.py"))
    return sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()[:16]
