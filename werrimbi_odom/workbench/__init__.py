# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The workbench: compare, diagnose, add and save on one local page.

The input (`loaded_input`) is read once and shared by all browser tabs. The history of a tab
(`session`) is an immutable value. Long work (`worker_tasks`) runs in another process (`job`,
`worker`), so that it can be cancelled. `page` and `views` show it all; `server` accepts requests of
this machine only.
"""
