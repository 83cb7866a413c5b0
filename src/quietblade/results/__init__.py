# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run leaves behind: registered quantities, files, headline figures and claims."""
