# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files: ROS 2 parameter files, read, checked, and written again with their comments.

`robot_file` reads one; `parameters` has all that may stand in it, for the node, the command line
and the docs. `yaml_text` and `yaml_edit` are the text under it.
"""
