# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks and poses in arrays of the user: what they must be, and a run folder of them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference, Ticks, counts_of
from werrimbi_odom.files.run_folder import REFERENCE_COLUMNS, write_run_folder
from werrimbi_odom.model.pose import Floats


def write_run(
    path: str | Path,
    t: ArrayLike,
    left: ArrayLike,
    right: ArrayLike,
    reference: ArrayLike | None = None,
    channels: Mapping[str, ArrayLike] | None = None,
) -> Path:
    """Write a drive in arrays as a run folder, which every verb takes.

    Parameters
    ----------
    path
        New folder.
    t
        Stamps of the ticks [s], shape (n,).
    left, right
        Cumulative signed counts of the encoders, shape (n,).
    reference
        Measured poses on the same clock, shape (m, 4): t [s], x [m], y [m], yaw [rad]; NaN where
        nothing was measured.
    channels
        Further measured columns by name, shape (n,) each.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    InputError
        If an array has another shape, a table cannot have a channel's name, or the folder exists.
    """
    ticks = ticks_of(t, left, right, channels)
    poses = None if reference is None else Reference(*_poses(reference))
    return write_run_folder(Path(path), ticks, poses)


def ticks_of(
    t: ArrayLike, left: ArrayLike, right: ArrayLike, channels: Mapping[str, ArrayLike] | None = None
) -> Ticks:
    """Check and convert arrays of ticks; for their meaning see `write_run`.

    InputError if one holds no numbers, or they are not one column each, all of one length.
    """
    channels = channels or {}
    given = [("t", t), ("left", left), ("right", right), *channels.items()]
    columns = [numbers(name, values) for name, values in given]
    shapes = {values.shape for values in columns}
    if len(shapes) > 1 or len(shapes.pop()) != 1:
        names = (name for name, _ in given)
        told = ", ".join(f"{name} {each.shape}" for name, each in zip(names, columns, strict=True))
        raise InputError(f"a column each is wanted, all as long as each other; shapes are: {told}")
    time, of_left, of_right, *others = columns
    if time.size == 0:
        raise InputError("t, left and right are empty: there are no ticks")
    return Ticks(
        time.astype(np.float64),
        _counts(of_left),
        _counts(of_right),
        dict(zip(channels, (each.astype(np.float64) for each in others), strict=True)),
    )


def _counts(values: NDArray[np.int64] | Floats) -> NDArray[np.int64] | Floats:
    return values if values.dtype.kind == "i" else counts_of(values.astype(np.float64))


def numbers(name: str, values: ArrayLike) -> NDArray[np.int64] | Floats:
    """An array of int64 or float64; None is NaN, as is what a mask hides.

    InputError if it holds no numbers; the message has its name.
    """
    if isinstance(values, np.ma.MaskedArray) and values.dtype.kind in "iuf" and values.mask.any():
        values = np.ma.filled(values.astype(np.float64), np.nan)
    found = np.asarray(values)
    if found.dtype.kind in "mM":
        raise InputError(
            f"{name} holds dates; give seconds: ({name} - {name}[0]) / numpy.timedelta64(1, 's')"
        )
    if found.dtype.kind not in "iuf":
        try:
            if found.dtype.kind not in "OU":
                raise TypeError(found.dtype)
            found = found.astype(np.float64)
        except (TypeError, ValueError) as error:
            raise InputError(f"{name} must hold numbers, and holds {found.dtype}") from error
    return found.astype(np.float64) if found.dtype.kind == "f" else found.astype(np.int64)


def _poses(reference: ArrayLike) -> Floats:
    found = numbers("reference", reference)
    if found.ndim != 2 or found.shape[1] != len(REFERENCE_COLUMNS):
        raise InputError(
            "reference must have a row for each pose and four columns, t [s], x [m], y [m] and "
            f"yaw [rad], and has the shape {found.shape}"
        )
    if found.size == 0:
        raise InputError("reference has no poses; give none for a drive that nothing measured")
    return found.astype(np.float64).T
