# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`python -m werrimbi_odom`: the command `werrimbi`, where no script is on the path."""

import sys

from werrimbi_odom.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
