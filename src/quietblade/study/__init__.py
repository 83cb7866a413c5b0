# SPDX-License-Identifier: LGPL-2.1-or-later
"""The only glue between what the user says and physics."""
