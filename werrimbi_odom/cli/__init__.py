# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command line `werrimbi`: one verb a module, a shell around `werrimbi_odom.api`.

Reading order: `main` (dispatch, errors, exit codes), `options` (options that verbs share), then the
module of any verb. A verb imports its heavy packages when it runs, so that --help is fast. A
mistake that a user can mend is one line and exit code 2.
"""
