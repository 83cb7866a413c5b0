# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1: the deformed blade in equilibrium with its flow."""
