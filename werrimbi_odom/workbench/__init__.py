# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The workbench: compare, diagnose, add and save on one local page.

What is open (`opened`) is read once and shared; what a browser tab has done with it (`steps`) is
a value of its own. Long work (`verbs`) runs in a process of its own (`job`, `work`), so that it
can be stopped. The page (`page`, `views`) shows it all; `guard` and `server` see to it that only
this machine can ask.
"""
