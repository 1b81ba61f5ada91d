# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The numeric core: numpy alone; knows no ROS, no file and no plot. Units are SI (REP-103)."""
