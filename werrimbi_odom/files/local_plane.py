# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Positions of satellites' receivers in a plane: metres east and north of the first fix."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.pose import Floats


def east_and_north(
    place: str, latitude: Floats, longitude: Floats, altitude: Floats
) -> tuple[Floats, Floats]:
    """Metres east and north of the first fix, in the plane that touches the ellipsoid below it.

    Parameters
    ----------
    place
        Where the fixes are, for errors.
    latitude, longitude, altitude : ndarray, shape (n,)
        WGS 84 [degrees, degrees, m]; NaN where there was no fix. Where the altitude alone is NaN
        the first one that is known is taken.

    Raises
    ------
    InputError
        When pyproj is not installed.
    """
    fixed = np.isfinite(latitude) & np.isfinite(longitude)
    x, y = np.full(latitude.size, np.nan), np.full(latitude.size, np.nan)
    if not fixed.any():
        return x, y
    try:
        from pyproj import Transformer
    except ModuleNotFoundError as missing:
        raise InputError(
            f"{place}: fixes of satellites are projected by the Python package {missing.name}: "
            'pip install "werrimbi_odom[gps]"'
        ) from missing
    known = altitude[fixed & np.isfinite(altitude)]
    level = float(known[0]) if known.size else 0.0
    first = int(np.flatnonzero(fixed)[0])
    origin = (float(latitude[first]), float(longitude[first]), level)
    plane = Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
        "+step +proj=cart +ellps=WGS84 "
        "+step +proj=topocentric +ellps=WGS84 +lat_0={!r} +lon_0={!r} +h_0={!r}".format(*origin)
    )
    height = np.full(latitude.size, level)  # a wheeled robot's path is measured on the floor
    x[fixed], y[fixed], _ = plane.transform(longitude[fixed], latitude[fixed], height[fixed])
    return x, y
