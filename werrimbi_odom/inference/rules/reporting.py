# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is reported of a finding, and of a recording."""

from __future__ import annotations

# ------------------------------------------------------------------------------------ what is added

ONE_WHEEL = 0.05
"""Error of one wheel relative to the other's, below which it is not reported: a wheel that is 3 %
larger beside one that is 0.1 % smaller is one cause on the robot, a tyre."""

HELD_OUT_FALL = 1e-4
"""Relative fall of the held-out error that counts as a fall: fits that stop a little earlier differ
by as much. Whether a rise is significant is tested leg by leg (`SURE_WHEN_ASKED`)."""

OUTDATED_FALL = 0.01
"""Relative fall of the held-out error from which on values of the robot file are told to be off.
With less, what they are off by is below a seventh (the square root of 1 - 0.99²) of what a leg errs
by."""

SHAPES_FITTED = 3
"""Trial shapes of an effect (threshold, length of a lag) that are fitted in full when it is added.
Chosen: of neighbours on the grid of shapes the best by score is among the first."""

UNUSUAL_PROMISE = 25.0
"""Variance of a leg in multiples of the median, five of its deviation, above which it is left out
of the predicted error: it begins with an unknown heading (`UNKNOWN_HEADING`)."""

MOVED_BY_ODOMETRY = 0.02
"""Relative error of the base from which on a localiser, moved by this odometry, is told to err by
it: AMCL turns by odometry for 0.2 rad until a scan corrects it, and 2 % of that are 4 mrad, twice
the noise of a match (`TYPICAL_MATCH`)."""

# ------------------------------------------------------------------------ what a recording can show

LEGS_ENOUGH, SHORT_LEG = 30, 0.25
"""Legs of a metre or a quarter turn, below which shorter ones are proposed, and tried where they
leave a verdict *ambiguous*, and their length [m].
Chosen: three times the fewest that are judged, as a part of them is held out."""

TURN_SHOWS, WAY_SHOWS = 3.14, 2.0
"""Turn [rad], and travel [m], above which a recording can show base and radii. Chosen: half a turn
and two metres show them to a percent, with a reference good to a degree and to 2 cm."""

ONE_CURVE = 0.995
"""Correlation of turn and way, second by second, above which a drive is one curve. Chosen: base and
ratio of the radii are then ten times less sure than of a drive whose turn and way go apart."""

SEEN_IN_FULL = 0.9
"""Share of the driving that the reference measured, below which `info` tells it beside the whole.
Chosen: a reference that begins a little later than the wheels, or ends before, loses less."""

LONGER_LEG = 1.5
"""Length of the legs in multiples of what was asked for, above which their own is told. Chosen: a
leg ends at the first pose after that length, so poses twice a leg make it half as long again."""
