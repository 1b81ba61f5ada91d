# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The covariance of a piece to 50 digits, from the noise itself and from the paper's expression.

`by_quadrature` shares no formula with the package. A wheel error dε at the path parameter u moves
the end along the tangent there, and a heading error dφ swings what is still to be driven:

    δ(1) = ∫ (cos Δu, sin Δu, 0) dε + ∫ (-(Y - y(u)), X - x(u), 1) dφ

with E[dε²] = a du, E[dφ²] = b du, E[dε dφ] = c du. Both columns repeat after every whole turn, so
the integral over many turns is that over one, times their number, and one over what is left.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache

from mpmath import mp, mpf
from mpmath.calculus.quadrature import GaussLegendre

ENTRIES = ("xx", "xy", "xyaw", "yy", "yyaw", "yawyaw")
KINDS = {"xx": "m²", "xy": "m²", "yy": "m²", "xyaw": "m rad", "yyaw": "m rad", "yawyaw": "rad²"}

Entries = list[mpf]


def by_quadrature(motion: Sequence[float], noise: Sequence[float], yaw: float = 0.0) -> Entries:
    """Entries in the order of `ENTRIES`; motion is (along, sideways, turn), noise (a, b, c)."""
    return turned([*_ahead(tuple(motion), tuple(noise), mp.prec)], mpf(yaw))


@cache
def _ahead(motion: Sequence[float], noise: Sequence[float], prec: int) -> Entries:
    """The same of a piece that begins at yaw zero, by numbers of `prec` bits."""
    along, sideways, turn = (mpf(value) for value in motion)
    a, b, c = (mpf(value) for value in noise)
    travel = mp.mpc(along, sideways)

    end_tangent = mp.expj(turn)

    def density(u: mpf) -> Entries:
        tangent = mp.expj(turn * u)
        ahead = (end_tangent - tangent) / (mp.j * turn) if turn else 1 - u
        lever = mp.j * travel * ahead
        ex, ey, px, py = tangent.real, tangent.imag, lever.real, lever.imag
        return [
            a * ex * ex + 2 * c * ex * px + b * px * px,
            a * ex * ey + c * (ex * py + ey * px) + b * px * py,
            c * ex + b * px,
            a * ey * ey + 2 * c * ey * py + b * py * py,
            c * ey + b * py,
            b,
        ]

    turns = int(abs(turn) / (2 * mp.pi))
    period = 2 * mp.pi / abs(turn) if turns else mpf(0)
    one = integral(density, mpf(0), period) if turns else [mpf(0)] * 6
    rest = integral(density, turns * period, mpf(1))
    return [turns * o + r for o, r in zip(one, rest, strict=True)]


def by_model_page(motion: Sequence[float], noise: Sequence[float], yaw: float = 0.0) -> Entries:
    """The paper's E and F (`model.covariance`), term by term; no sideways travel.

    They lose four digits for every one of a small Δ, so at 1e-12 they need 48 more than they give.
    """
    along, sideways, turn = (mpf(value) for value in motion)
    a, b, c = (mpf(value) for value in noise)
    assert sideways == 0
    if turn == 0:
        chord = [a, c * along / 2, c, b * along**2 / 3, b * along / 2, b]
        return turned(chord, mpf(yaw))
    h, rho = turn / 2, along / turn
    s, s2 = mp.sin(h) / h, mp.sin(turn) / turn
    e_x, e_y = rho * (mp.cos(h) - s), rho * mp.sin(h)
    e_xx = rho**2 * (mp.cos(h) ** 2 - 2 * s * mp.cos(h) + (1 + s2) / 2)
    e_yy = rho**2 * (mp.sin(h) ** 2 + (1 - s2) / 2)
    e_xy = rho**2 * mp.sin(h) * (mp.cos(h) - s)
    f_xx, f_yy = rho * (s * mp.cos(h) - (1 + s2) / 2), -rho * (1 - s2) / 2
    f_xy = rho * s * mp.sin(h)
    chord = [
        a * (1 + s2) / 2 + 2 * c * f_xx + b * e_xx,
        c * f_xy + b * e_xy,
        c * s + b * e_x,
        a * (1 - s2) / 2 + 2 * c * f_yy + b * e_yy,
        b * e_y,
        b,
    ]
    return turned(chord, mpf(yaw) + h)


def turned(entries: Entries, angle: mpf) -> Entries:
    """The same covariance in the frame against which its own is turned by `angle`."""
    xx, xy, xyaw, yy, yyaw, yawyaw = entries
    cos, sin = mp.cos(angle), mp.sin(angle)
    return [
        cos**2 * xx - 2 * cos * sin * xy + sin**2 * yy,
        cos * sin * (xx - yy) + (cos**2 - sin**2) * xy,
        cos * xyaw - sin * yyaw,
        sin**2 * xx + 2 * cos * sin * xy + cos**2 * yy,
        sin * xyaw + cos * yyaw,
        yawyaw,
    ]


def integral(density: Callable[[mpf], Entries], begin: mpf, end: mpf) -> Entries:
    """Gauss and Legendre with 48 nodes: exact to over 70 digits for up to one whole turn."""
    middle, half = (begin + end) / 2, (end - begin) / 2
    total = [mpf(0)] * 6
    for node, weight in nodes(mp.prec):
        values = density(middle + half * node)
        total = [t + half * weight * v for t, v in zip(total, values, strict=True)]
    return total


@cache
def nodes(precision: int) -> list[tuple[mpf, mpf]]:
    return list(GaussLegendre(mp).get_nodes(-1, 1, degree=5, prec=precision))


def worst_error(computed: Sequence[float], exact: Entries) -> tuple[float, str]:
    """Largest relative error of an entry, and the entry.

    Where an entry is under a thousandth of the largest of its kind (it is zero, or its parts
    cancel), its error is taken relative to that one.
    """
    largest = {
        kind: max(abs(e) for name, e in zip(ENTRIES, exact, strict=True) if KINDS[name] == kind)
        for kind in KINDS.values()
    }
    worst = (0.0, "")
    for name, value, truth in zip(ENTRIES, computed, exact, strict=True):
        scale = largest[KINDS[name]]
        if abs(truth) > scale / 1000:
            scale = abs(truth)
        error = abs(mpf(value) - truth)
        worst = max(worst, (float(error / scale) if scale else float(error), name))
    return worst
