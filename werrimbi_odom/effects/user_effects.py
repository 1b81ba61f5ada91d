# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of users: their files, and guards, by which any error is reported in one line as theirs.

This includes errors beyond `Exception`: an effect that calls `sys.exit` would end the tool
silently.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.effect import Apply, Effect


def load_file(path: Path) -> tuple[Effect, ...]:
    """Execute a user's Python file and return the effects that it defines.

    Raises
    ------
    InputError
        If the file cannot be read or run, or defines no effect; the message names the line.
    """
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    before = {id(effect) for effect in LIBRARY}
    found: dict[str, Effect] = {}
    for value in vars(_executed(path)).values():
        if not isinstance(value, Effect) or id(value) in before:
            continue  # what it imported, from the library too
        if found.setdefault(value.name, value) is not value:
            raise InputError(f"{path}: two effects are called {value.name}")
    if not found:
        raise InputError(
            f"{path}: it defines no effect; write one under @wheel_effect(...), @body_effect(...) "
            "or @reference_effect(...), as docs/effects.md shows"
        )
    return tuple(found.values())


def _executed(path: Path) -> ModuleType:
    name = f"werrimbi_odom_effects_of_{path.stem}"
    spec = importlib.util.spec_from_loader(name, loader=None, origin=str(path))
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    module.__file__ = str(path)
    known = sys.modules.get(name)
    sys.modules[name] = module  # dataclasses and typing look up their module there
    try:
        exec(compile(path.read_bytes(), str(path), "exec"), vars(module))
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        if known is None:
            del sys.modules[name]
        raise InputError(f"{path}{line_of(error, str(path))}: {words_of(error)}") from error
    return module


def guarded(effect: Effect, place: str) -> Effect:
    """The same effect with errors converted to `InputError`.

    Parameters
    ----------
    place : str
        Its origin: a file, or a package.
    """
    return replace(effect, apply=_Guarded(effect.apply, effect.name, place))


@dataclass(frozen=True)
class _Guarded:
    """The function of an effect with its error message; equal for equal functions."""

    law: Apply
    name: str
    place: str

    def __call__(self, before: Any, *rest: Any, **values: float) -> Any:
        try:
            after = self.law(before, *rest, **values)
        except (KeyboardInterrupt, MemoryError):
            raise  # by the user, and by the machine
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
        given = ", ".join(f"{name}={_told(value)}" for name, value in values.items())
        return InputError(f"{self.place}{line}: the law of {self.name}({given}) fails: {what}")


def _complaint(before: Any, after: Any) -> str:
    """Fault of a result; "" for none."""
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


def _told(value: Any) -> str:
    """Value of a parameter; the range of one that each run has of its own."""
    low, high = float(np.min(value)), float(np.max(value))
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def line_of(error: BaseException, file: str) -> str:
    """Line of an error in a file, as ":12"; "" if unknown."""
    line, trace = 0, error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == file:
            line = trace.tb_lineno
        trace = trace.tb_next
    if not line and isinstance(error, SyntaxError):  # before execution
        line = error.lineno or 0
    return f":{line}" if line else ""


def words_of(error: BaseException) -> str:
    """Type and message of an error."""
    try:
        message = error.msg if isinstance(error, SyntaxError) else str(error)
    except Exception:  # `str` of a user's exception may fail too
        message = ""
    return f"{type(error).__name__}: {message}" if message else type(error).__name__
