# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What changed from drive to drive, and which of it is told."""

from __future__ import annotations

MOST_CHANGES = 40
"""Changes that are looked for, one after the other: one every nine days of a year. Chosen: more
are no changes but a scatter from drive to drive, which is estimated as such."""

MOST_ALONE = 1
"""Drives on one side of a change that are too few to show it by a reference that wanders: how it
errs is as much alike within a drive as a change is."""

WORTH_OF_A_CHANGE = 0.5
"""Share of what a dependence is worth that changes must be, to be told beside it. Chosen, the half:
a marker that sat otherwise on another day was worth 0.7 of the time since the start, which stood
for it; where a floor is slippery in one place, the drives that meet it err otherwise, worth 0.2."""

DATED = 1e8
"""Stamps [s] above this are dates: no clock that begins with a drive shows three years."""

WHICH_DRIVE = 6.0
"""Difference of costs up to which a change may as well have come with another drive: a Bayes factor
of 20, "strong" from there on (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995)."""

TREND_DRIVES = 4
"""Drives after the one at which a trend begins, at the least. Chosen: of three a step in the middle
lies as near a line as noise lets one see."""

SCATTER_DRIVES = 8
"""Drives from which on their scatter is estimated from their differences: the median of seven is
known to a half. Of fewer, one change is looked for, and held against what the drives differ by
beside it (Fisher's F): two would find their own among five."""

SURE_OF_A_CHANGE = 0.01
"""How often chance may do as much in a history whose drives scatter by what they themselves must
tell (Fisher's F, all that was looked at counted). Chosen on simulated
histories: asked for `SURE`, ten drives, which tell their scatter with eight degrees of freedom,
found a tenth fewer of the changes of 0.3 % of a radius. On others it told 4 of 870 in vain."""

CALIBRATE_AGAIN = 1e-3
"""Share by which a radius or the base must differ from the robot file to ask for a calibration.
Chosen: of one radius, on a base of 35 cm, it is a degree in six metres; parquet and good tyres keep
their sizes to half of that."""

COPIED_WITHIN = 3600.0
"""Files of drives that were all written within so many seconds were copied then: that is no date.
Chosen: drives of months that have no stamps of their own are copied in minutes."""
