# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Specialises functions that take floats or arrays to floats.

The odometry calls some functions a dozen times per message; skipping the check for arrays saves a
sixth of its cost. The code is the same: a copy of the function calls float versions of others.
"""

from __future__ import annotations

from collections.abc import Callable
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
