# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Changes between drives: how many are searched for, and which are reported."""

from __future__ import annotations

MOST_CHANGES = 40
"""Most changes that are searched for: one every nine days of a year. Chosen: if there are more,
they are scatter between drives, which is estimated as such."""

MOST_ALONE = 1
"""Drives on one side of a change that are too few to show it by a reference with correlated errors:
these are as much alike within a drive as the effect of a change is."""

WORTH_OF_A_CHANGE = 0.5
"""Penalised gain of changes, relative to that of a dependence, above which they are reported beside
it. Chosen, the half: a marker that was mounted differently on another day was worth 0.7 of the time
since the start, which stood for it; a floor that is slippery in one place makes the drives across
it err differently, which was worth 0.2."""

DATED = 1e8
"""Stamps [s] above this are dates: three years are more than a clock shows that starts with the
drive."""

WHICH_DRIVE = 6.0
"""Difference of costs up to which a change may as well have come with another drive: a Bayes factor
of 20, the start of "strong" evidence (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995)."""

TREND_DRIVES = 4
"""Fewest drives after the start of a trend. Chosen: with three, a step in the middle fits a line
within the noise."""

SCATTER_DRIVES = 8
"""Fewest drives for an estimate of the scatter from their differences: the median of seven is known
to a half. With fewer, only one change is searched for, and compared with the remaining differences
between drives (Fisher's F): a search for two would always find some among five drives."""

SHOWS_NO_SCATTER = 10.0
"""Standard deviation of a drive, over that of the drive that knows a number best, above which it
does not count among those that show its scatter. Chosen: the scatter that it can show is ten times
the noise of that one; minutes and hours, or curves and lines, differ by less, and a drive beside
another reference by far more."""

SURE_OF_A_CHANGE = 0.01
"""Significance level of a change in a history whose drives must give their own scatter (Fisher's F,
Bonferroni correction). Chosen on simulated histories: at `SURE`, ten drives, which give the scatter
with eight degrees of freedom, found a tenth fewer of the changes of 0.3 % of a radius. At this
level, 4 of 870 reported changes in other histories were false."""

CALIBRATE_AGAIN = 1e-3
"""Relative difference of a radius or the base from the robot file above which a calibration is
recommended. Chosen: for one radius, on a base of 35 cm, it is a degree in six metres; parquet and
good tyres keep their sizes to half of that."""

COPIED_WITHIN = 3600.0
"""Time [s] within which all files were written if they were copied; then their times are no dates.
Chosen: drives of months without stamps of their own are copied in minutes."""
