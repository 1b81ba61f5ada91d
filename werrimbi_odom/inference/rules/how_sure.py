# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How sure a finding must be."""

from __future__ import annotations

SURE = 1e-3
"""A finding is believed when chance would show as much in fewer cases than this, all that was
looked at counted (Bonferroni): one false name in a thousand sound robots. Asked of effects, of what
lasts from drive to drive, of what a calibration leaves, and of what is worth a draft."""

VERY_SURE = 1e-5
"""The same for a dependence on a measured variable. All cells of the map are counted too; but an
effect is a law that somebody found true before, and a dependence has nothing behind it, so a
hundred times as much is asked of it."""

SURE_WHEN_ASKED = 0.01
"""The same of one question that the user asked before the drives answered it (does this effect do
anything, does it raise the error of the drives held out, does this model fit): nothing was
searched, so the usual hundredth is enough."""

SURE_OF_LEGS = 1e-4
"""The same in a comparison. About twenty systematic parts are looked at, uncorrected: a false one
in 500 sound robots. What goes with a variable or a place is corrected for their number."""

SIGNIFICANT = 2.0
"""Standard deviations by which a parameter must differ from null to be told as different: chance
does that to a normal estimate in 4.6 % of cases. Decides words, and which of two parameters that
the drives hardly tell apart goes first; no verdict."""

PENALTY_FLOOR = 6.0
"""The least that a free number must lower minus two log-likelihood by. BIC asks ln n, which is less
where n is below 403; chi-squared of one degree is above 6 in 1.4 % of cases, so that of few data a
number is not had for less than of many."""

USELESS_NUMBER = 2.0
"""What a number that stands for nothing seems to be worth: fitted to noise it lowers the cost by 1
on average, and raises that of new data by 1 (Akaike, IEEE Trans. Autom. Control 19, 1974)."""

RIVAL = 10.0
"""Difference of costs up to which two models cannot be told apart: a Bayes factor of 150, "very
strong" from there on (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995)."""

ENOUGH = 3.0 * RIVAL
"""Difference of costs that a proposed drive is to promise. Where r is promised, the drive shows r
with a standard deviation of 2 sqrt(r): of 30 it shows `RIVAL` or more in 97 % of cases."""

AS_LIKELY_AS_NOT = 0.5
"""Share of cases in which a drive that cannot promise so much within `LONGEST_DRIVE` must tell
rivals apart to be proposed all the same: what it shows counts, and can be driven on."""

CALIBRATION_WORTH = 2.0
"""Penalties that one number of the calibration must be worth to be called a finding, and not only
fitted: once it is in every fit, twice it is news."""

POWER = 0.95
"""Share of cases in which an effect of the detection limit's size is found: as intervals of 95 %,
which is what engineers take a stated limit for. Of one parameter among 60 candidates the limit is
5.95 standard deviations; an effect of 4.3 is found every other time."""
