# SPDX-License-Identifier: LGPL-2.1-or-later
"""Times and memory of quietblade, beside other programs or its own other ways."""
