# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Functions of the model for floats alone, and their compilation with numba, where it is installed.

The odometry calls some functions a dozen times per message; skipping the check for arrays saves a
sixth of its cost. The code is the same: a copy of the function calls float versions of others.

The functions are written, and tested, in plain Python. Numba translates their float versions
operation by operation and caches the result on disk for later processes. Without numba, or without
a writable cache folder, the Python versions run, only slower. Importing numba takes a third of a
second and 70 MB, so it is imported only on request, and never by the node.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar, cast

from werrimbi_odom.model.covariance import entire, entire_of_float
from werrimbi_odom.model.motion import cos_sin, cos_sin_of_float, sinc, sinc_of_float

_OF_FLOATS: dict[Any, Any] = {
    sinc: sinc_of_float,
    cos_sin: cos_sin_of_float,
    entire: entire_of_float,
}
"""Functions that distinguish floats from arrays, and their float versions."""

Function = TypeVar("Function", bound=Callable[..., Any])


def of_floats(function: Function) -> Function:
    """The same function of the model, for floats only."""
    return cast("Function", copied_for_floats(function, lambda copy: copy))


def copied_for_floats(
    function: Callable[..., Any], translate: Callable[[FunctionType], Any]
) -> FunctionType:
    """Copy a function of the model for floats; the copy calls translated copies of its callees."""
    original = cast("FunctionType", function)
    names = dict(original.__globals__)
    for name in original.__code__.co_names:
        called = names.get(name)
        if isinstance(called, FunctionType) and called.__module__.startswith(__package__):
            copy = copied_for_floats(_OF_FLOATS.get(called, called), translate)
            names[name] = translate(copy)
    copy = FunctionType(original.__code__, names, original.__name__, original.__defaults__)
    copy.__module__, copy.__qualname__ = original.__module__, original.__qualname__
    return copy


WORTH_COMPILING = 200_000
"""Number of steps from which compiled code saves more time than loading it takes (0.4 s)."""


def compiled_for(steps: int, function: Function) -> Function | None:
    """Return the compiled function where one pass over this many steps pays for it."""
    return compiled(function) if steps >= WORTH_COMPILING else None


@cache
def compiled(function: Function) -> Function | None:
    """Compile a function of the model, and those that it calls, for floats.

    Result: compiled at its first call, or loaded from the cache. None without numba, or without a
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
