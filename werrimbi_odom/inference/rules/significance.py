# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Significance levels, penalties and Bayes factors."""

from __future__ import annotations

SURE = 1e-3
"""Significance level of a finding, with a Bonferroni correction for all candidates: one false name
in a thousand sound robots. For effects, for what lasts from drive to drive, and for what is worth a
draft."""

VERY_SURE = 1e-5
"""Significance level of a dependence on a measured variable, with a Bonferroni correction for all
cells of the map. An effect is a law that was found true before; a dependence has no such support,
so its level is a hundredth, by what a calibration leaves as by what a diagnosis does."""

SURE_WHEN_ASKED = 0.01
"""Significance level of a single question that was asked before the data answered it (does this
effect do anything, does it raise the held-out error, does this model fit): nothing was searched, so
the usual hundredth is enough."""

SURE_OF_LEGS = 1e-4
"""Significance level in a comparison. About twenty systematic parts are tested, uncorrected: a
false one in 500 sound robots. Dependences on a variable or a place have a Bonferroni correction."""

SIGNIFICANT = 2.0
"""Standard deviations from null above which a parameter is reported as different: chance exceeds
that for a normal estimate in 4.6 % of cases. It decides words, which of two hardly distinguishable
parameters is dropped first, and whether a size is told at all; it names nothing."""

PENALTY_FLOOR = 6.0
"""Floor of the penalty of a free parameter, in minus two log-likelihood. BIC has ln n, which is
less for n below 403. Chi-squared with one degree of freedom exceeds 6 in 1.4 % of cases; the floor
makes few data no more permissive than many."""

USELESS_NUMBER = 2.0
"""Expected gain of a null parameter, in and out of sample: fitted to noise it lowers the cost by 1
on average, and raises that of new data by 1 (Akaike, IEEE Trans. Autom. Control 19, 1974)."""

RIVAL = 10.0
"""Difference of costs up to which two models cannot be told apart: a Bayes factor of 150, the start
of "very strong" evidence (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995)."""

ENOUGH = 3.0 * RIVAL
"""Expected difference of costs that a proposed drive must have. If r is expected, the drive shows r
with a standard deviation of 2 sqrt(r): with 30 it shows `RIVAL` or more in 97 % of cases."""

AS_LIKELY_AS_NOT = 0.5
"""Share of cases in which a drive that cannot promise so much within `LONGEST_DRIVE` must tell
rivals apart to be proposed all the same: what it shows counts, and can be driven on."""

CALIBRATION_WORTH = 2.0
"""Gain in penalties above which a calibration parameter is a finding, and not only fitted: one
penalty selects it for the fit, a report takes twice that."""

POWER = 0.95
"""Power at the detection limit: the share of cases in which an effect of that size is found. 95 %
as for intervals, which is what engineers expect of a stated limit. For one parameter among 60
candidates the limit is 5.95 standard deviations; an effect of 4.3 is found in half of the cases."""
