# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What to drive next, by drives that are imagined."""

from __future__ import annotations

# ------------------------------------------------------------------------------- what to drive next

NEARLY_AS_MUCH = 0.9
"""Gain relative to the best dependence, above which another one may be the better name: what
depends on the speed depends slightly on the distance too; the reverse is rare."""

HIDDEN_FROM = 3.0
"""Detection limit in multiples of the typical size, above which an effect counts as hidden. Chosen:
typical sizes are hardly known to better."""

LONGEST_DRIVE = 30.0
"""Most minutes of driving that are proposed: half a battery of a small robot."""

MINUTES_OF_A_LAW, MINUTES_OF_PLACES, MINUTES_OF_TIME = 2.0, 4.0, 10.0
"""Minutes of driving for an unknown error: over the range of a variable; at several places or
values of a channel, twice as long; and until something warms up or drifts."""

APART_POSITION, APART_HEADING = 5e-4, 0.02
"""Difference of two rivals on a short leg above which it is reported [m, degrees]: half a
millimetre and 0.35 mrad, which motion capture resolves after some legs."""

WAY_WORTH_SAYING, TURN_WORTH_SAYING = 0.05, 20.0
"""Travel [m] and turn [degrees] in a gap above which they are reported: if one is below, the other
says enough."""

# ------------------------------------------------------------------------- drives that are imagined

TAPED_INTERVALS = 3
"""Intervals of a drive's reference up to which it is by tape: predicted drives then have a pose at
the start and one at the end."""

PACE_UNKNOWN = 0.3
"""Assumed speed of the wheels [m/s] of a robot without recorded motion: a slow walk."""

SLOWEST_PACE, FASTEST_PACE = 0.02, 20.0
"""Limits of the speed of predicted drives [m/s]: recordings beyond them have a wrong unit."""

HARD_START = 2.5
"""Acceleration of a hard start, over the speed [1/s]: 0.4 s to full speed."""
