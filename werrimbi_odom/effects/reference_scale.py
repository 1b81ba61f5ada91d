# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference with a scale error: of a gyro, or of a scan matcher."""

from __future__ import annotations

from werrimbi_odom.effects.indistinguishable_pairs import own_scale
from werrimbi_odom.model.effect import Parameter, Sketch, reference_effect
from werrimbi_odom.model.reference_view import View


@reference_effect(
    twins=(own_scale("track_width", inverse=True), own_scale("wheel_radius_scale")),
    sketch=Sketch(
        "scale",
        "the reference shows a longer way, or more of a turn, than there was",
        "the reference's own measure is off",
    ),
    multiplier=Parameter(
        "", null=1.0, typical=1.02, bounds=(0.8, 1.25), says="what it shows over what was"
    ),
)
def reference_scale(view: View, multiplier: float) -> View:
    """The reference's own scale is off: what it shows is a little more, or less, than there was.

    A gyro's is good to one to three percent as it comes, and was seen to be off by 17. A scan
    matcher measures by its laser's range, and a map has the scale of whoever made it.

    Formula    measured turn = multiplier * turn, of a gyro                     [rad]
               measured way = multiplier * way, where positions are measured    [m]
    Signature  every turn (or every way) is off by the same share, whatever the wheels do
    Ruler      a gyro: turn the robot by hand ten times, from a line on the floor back onto it;
               multiplier = its heading over 20 pi. A scan matcher or a map: two walls by tape
    Twins      where positions are measured: wheel_radius_scale and track_width by the same
               multiplier together, larger wheels that stand as much wider apart
    """
    return view._replace(scale=view.scale * multiplier)
