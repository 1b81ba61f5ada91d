# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Planar position, heading and covariance from 3D messages, with all checks.

A message may contain any 64 bits as a number. The results of this module are finite and small
enough for their squares not to overflow, and the covariance is valid.
"""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.covariance import PoseCovariance

FARTHEST = 1e12
"""Largest coordinate accepted [m], beyond the orbit of Jupiter; fourth powers of larger ones
overflow."""
LARGEST = FARTHEST**2
"""Largest entry of a covariance accepted; larger ones stand for "unknown"."""

UP = 1.0 + 1e-12
"""Factor on every published variance, so that rounding cannot make a semi-definite matrix
indefinite."""

_ASYMMETRY = 1e-6  # tolerance of two entries that should be equal, relative to a correlation of 1
_ROUNDING = 1e-9  # tolerance of a correlation matrix's eigenvalues for rounding
_TINY = sys.float_info.min  # a smaller variance has too few digits for a matrix to be valid
_SMALL = 1e-60  # smallest variance for which squares and products of two do not underflow
_PLANE = (0, 1, 5)  # indices of x, y and yaw among x, y, z, roll, pitch, yaw


def place_of(place: Any) -> tuple[float, float]:
    """Position [m] in the plane.

    InputError, as of all functions here, has the cause and the detail as its arguments.
    """
    if not (math.isfinite(place.x) and math.isfinite(place.y)):
        raise InputError("pose not finite", "NaN or infinite")
    if max(abs(place.x), abs(place.y)) > FARTHEST:
        raise InputError("pose out of range", f"farther than {FARTHEST:g} m")
    return place.x, place.y


def yaw_of(turn: Any, slack: float) -> float:
    """Heading [rad] of a quaternion with norm 1 up to a factor of 1 + `slack`."""
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    if not all(map(math.isfinite, (x, y, z, w))):
        raise InputError("pose not finite", "NaN or infinite")
    norm = math.hypot(x, y, z, w)  # hypot does not overflow as squares do
    if not 1.0 / (1.0 + slack) <= norm <= 1.0 + slack:
        raise InputError("orientation not a rotation", f"the quaternion's norm is {norm:g}, not 1")
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def covariance_of(entries: Any) -> PoseCovariance[float]:
    """Covariance of x, y and yaw among the 36 entries of a message.

    Metres and radians may have any ratio, so the correlation matrix is checked for positive
    semi-definiteness; the size of an entry says nothing.
    """
    values = np.asarray(entries, dtype=np.float64)
    sound = _plainly_sound(values.tolist())
    if sound is not None:
        return sound
    block = values.reshape(6, 6)[np.ix_(_PLANE, _PLANE)]
    if not np.isfinite(block).all():
        raise InputError("covariance not finite", "NaN or infinite")
    if np.abs(block).max() > LARGEST:
        raise InputError("covariance out of range", f"more than {LARGEST:g}")
    variances = block.diagonal()
    if (variances < 0.0).any():
        raise InputError("covariance not positive semi-definite", "a variance is negative")
    if block[variances == 0.0].any() or block[:, variances == 0.0].any():
        raise InputError("covariance not positive semi-definite", "a variance of 0 has covariances")
    sigma = np.sqrt(np.where(variances > 0.0, variances, 1.0))
    with np.errstate(over="ignore", invalid="ignore"):
        correlation = block / sigma[:, None] / sigma  # in two steps: the product may underflow
        apart = np.abs(correlation - correlation.T).max()
    if apart > _ASYMMETRY:
        raise InputError("covariance not symmetric", "of x, y and yaw")
    # A correlation above 1 is invalid, and eigenvalues of much larger ones overflow.
    if np.abs(correlation).max() > 1.0 + _ASYMMETRY or (
        np.linalg.eigvalsh(0.5 * (correlation + correlation.T))[0] < -_ROUNDING
    ):
        raise InputError("covariance not positive semi-definite", "of x, y and yaw")
    symmetric = (0.5 * (block + block.T))[np.triu_indices(3)]
    return PoseCovariance(*symmetric.tolist())


def _plainly_sound(entries: list[float]) -> PoseCovariance[float] | None:
    """Covariance that a few products show to be valid, as for nearly all messages; else None.

    The complete check takes ten times as long.
    """
    xx, xy, xyaw = entries[0], entries[1], entries[5]
    yy, yyaw, yawyaw = entries[7], entries[11], entries[35]
    if entries[6] != xy or entries[30] != xyaw or entries[31] != yyaw:
        return None
    if not (_SMALL < xx < LARGEST and _SMALL < yy < LARGEST and _SMALL < yawyaw < LARGEST):
        return None
    if not (xyaw * xyaw < xx * yawyaw and yyaw * yyaw < yy * yawyaw):
        return None
    a, b, c = xx - xyaw * (xyaw / yawyaw), yy - yyaw * (yyaw / yawyaw), xyaw * (yyaw / yawyaw)
    if not (xy - c) * (xy - c) <= a * b:
        return None
    return PoseCovariance(xx, xy, xyaw, yy, yyaw, yawyaw)


def rounded_up(covariance: PoseCovariance[float]) -> PoseCovariance[float]:
    """Make a covariance valid for publishing: positive semi-definite in spite of rounding.

    When a poorly known heading is propagated far away and back, the squared distance cancels. What
    remains of a variance is rounding error of either sign; its absolute value then replaces the
    variance. A variance below the smallest normal number becomes zero.
    """
    xx, xy, xyaw, yy, yyaw, yawyaw = covariance
    xx, yy, yawyaw = xx * UP, yy * UP, yawyaw * UP
    if 0.0 < xx < _TINY or 0.0 < yy < _TINY or 0.0 < yawyaw < _TINY:
        pass
    elif yawyaw > 0.0:  # conditional covariance of x and y given the heading
        a, b, c = xx - xyaw * (xyaw / yawyaw), yy - yyaw * (yyaw / yawyaw), xyaw * (yyaw / yawyaw)
        if a >= 0.0 and b >= 0.0 and abs(xy - c) <= math.sqrt(a) * math.sqrt(b):
            return PoseCovariance(xx, xy, xyaw, yy, yyaw, yawyaw)
    elif not (xyaw or yyaw or yawyaw) and (
        min(xx, yy) >= 0.0 and abs(xy) <= math.sqrt(xx) * math.sqrt(yy)  # xx * yy may underflow
    ):
        return PoseCovariance(xx, xy, xyaw, yy, yyaw, yawyaw)
    matrix = PoseCovariance(abs(xx), xy, xyaw, abs(yy), yyaw, abs(yawyaw)).matrix()
    variances = matrix.diagonal()
    sigma = np.sqrt(np.where(variances < _TINY, 0.0, variances))
    size = np.where(sigma > 0.0, sigma, np.inf)
    with np.errstate(over="ignore"):
        correlation = np.clip(matrix / size[:, None] / size, -1.0, 1.0)
    values, vectors = np.linalg.eigh(correlation)
    near = (vectors * np.maximum(values, 0.0)) @ vectors.T * sigma[:, None] * sigma
    near[np.diag_indices(3)] *= UP
    return PoseCovariance(*near[np.triu_indices(3)].tolist())
