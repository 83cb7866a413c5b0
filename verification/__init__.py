# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks of quietblade against closed forms, published tables and other codes."""
