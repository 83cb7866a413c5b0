# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of a run, drawn from its files only."""
