# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A systematic error as a phrase: what the robot did, against what the model says."""

from __future__ import annotations

import math

from werrimbi_odom.inference.comparison.systematic import Systematic


def systematic_told(part: Systematic) -> str:
    """What the robot did, against what the model says."""
    value, std = part.value, part.std
    if part.channel == "heading" and part.per == "turn":
        return _share("turns", "the other way", value, std)
    if part.channel == "heading" and part.per == "size of turn":
        side = "left" if value > 0.0 else "right"
        return (
            f"whatever the sense, it turns {_degrees(value, std)} per turned radian to the {side}"
        )
    if part.channel == "heading":
        side = "left" if value > 0.0 else "right"
        return f"driving forward the robot veers to the {side} by {_degrees(value, std)} per metre"
    if part.channel == "along" and part.per == "travel":
        return _share("goes", "backward where the model says forward", value, std)
    if part.channel == "sideways" and part.per == "travel":
        side = "left" if value > 0.0 else "right"
        return f"the robot ends {_to_side(value, std)} to the {side} per metre forward"
    quarter = 0.5 * math.pi
    where = {
        ("along", True): "forward",
        ("along", False): "back",
        ("sideways", True): "to the left",
        ("sideways", False): "to the right",
    }[(part.channel, value > 0.0)]
    return (
        f"what the reference measures moves {_to_side(value * quarter, std * quarter)} {where} "
        "in a quarter turn to the left"
    )


def _share(verb: str, otherwise: str, value: float, std: float) -> str:
    """As a percentage: the robot turns 1.8 ± 0.1 % less than the model says."""
    if value < -1.0:
        return f"the robot {verb} {otherwise}"
    if value > 1.0:
        return f"the robot {verb} {1.0 + value:.3g} times as far as the model says"
    word = "more" if value > 0.0 else "less"
    return (
        f"the robot {verb} {_rounded(100.0 * abs(value), 100.0 * std)} % {word} than the model says"
    )


def _degrees(value: float, std: float) -> str:
    return f"{_rounded(math.degrees(abs(value)), math.degrees(std))}°"


def _to_side(value: float, std: float) -> str:
    return f"{_rounded(1e3 * abs(value), 1e3 * std)} mm"


def _rounded(value: float, std: float) -> str:
    """Value and standard error, to the digits that the error leaves."""
    if not std > 0.0:
        return f"{value:.3g}"
    digits = min(max(-math.floor(math.log10(std)), 0), 6)
    return f"{value:.{digits}f} ± {std:.{digits}f}"
