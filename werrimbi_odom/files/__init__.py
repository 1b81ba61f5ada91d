# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files and recorded runs, read and written; every error names file, place and mend."""
