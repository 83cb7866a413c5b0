# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conforming second-order meshes of blade, film and water."""
