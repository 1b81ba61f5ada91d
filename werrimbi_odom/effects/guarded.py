# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that are not ours: whatever goes wrong in one is an error of its author, told in a line.

Not only what `Exception` covers: a law that calls `sys.exit` would end the tool without a word.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.effect import Apply, Effect


def guarded(effect: Effect, place: str) -> Effect:
    """The same effect, whose law raises nothing but `InputError`.

    Parameters
    ----------
    place
        Where it comes from: a file, or a package.
    """
    return replace(effect, apply=_Guarded(effect.apply, effect.name, place))


@dataclass(frozen=True)
class _Guarded:
    """A law, and what is said where it goes wrong; equal for equal laws."""

    law: Apply
    name: str
    place: str

    def __call__(self, before: Any, *rest: Any, **values: float) -> Any:
        try:
            after = self.law(before, *rest, **values)
        except (KeyboardInterrupt, MemoryError):
            raise  # of the user, and of the machine
        except BaseException as error:
            raise self._wrong(words_of(error), line_of(error, self._file), values) from error
        complaint = _complaint(before, after)
        if complaint:
            raise self._wrong(complaint, "", values)
        return after

    @property
    def _file(self) -> str:
        return str(getattr(getattr(self.law, "__code__", None), "co_filename", self.place))

    def _wrong(self, what: str, line: str, values: Mapping[str, float]) -> InputError:
        given = ", ".join(f"{name}={value:g}" for name, value in values.items())
        return InputError(f"{self.place}{line}: the law of {self.name}({given}) fails: {what}")


def _complaint(before: Any, after: Any) -> str:
    """What is wrong with a result; "" when nothing is."""
    kind = type(before)
    if not isinstance(after, kind):
        return f"it gives a {type(after).__name__}, and must give a {kind.__name__}"
    for name, old, new in zip(kind._fields, before, after, strict=True):
        if not isinstance(new, (np.ndarray, np.generic, int, float)):
            return f"its {name} is a {type(new).__name__}, and must be a number for each step"
        if isinstance(new, np.ndarray) and new.shape not in ((), np.shape(old)):
            return f"its {name} has the shape {new.shape}, and must have {np.shape(old)}"
        if isinstance(new, np.ndarray) and new.dtype.kind not in "fiub":
            return f"its {name} holds {new.dtype}, and must hold numbers"
    return ""


def line_of(error: BaseException, file: str) -> str:
    """Where in a file it went wrong, as ":12"; "" where that is not known."""
    line, trace = 0, error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == file:
            line = trace.tb_lineno
        trace = trace.tb_next
    if not line and isinstance(error, SyntaxError):  # it has not run yet
        line = error.lineno or 0
    return f":{line}" if line else ""


def words_of(error: BaseException) -> str:
    """Its kind and its message, whatever that is."""
    try:
        message = error.msg if isinstance(error, SyntaxError) else str(error)
    except Exception:  # an exception of a user's own may fail even at this
        message = ""
    return f"{type(error).__name__}: {message}" if message else type(error).__name__
