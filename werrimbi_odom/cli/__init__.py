# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command line `werrimbi`: one module per verb, a thin layer over `werrimbi_odom.api`.

Reading order: `main` (dispatch, errors, exit codes), `options` (shared options), then the module of
any verb. A verb imports its heavy packages only when it runs, so that --help is fast. An error that
the user can correct is one line and exit code 2.
"""
