# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sphinx configuration."""

from importlib.metadata import version as installed

project = "quietblade"
author = "The quietblade developers"
copyright = "the quietblade developers, LGPL-2.1-or-later"  # noqa: A001  # Sphinx's name
version = release = installed("quietblade")

extensions = ["myst_parser", "sphinxcontrib.bibtex"]
myst_enable_extensions = ["amsmath", "attrs_block", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["_generated"]

bibtex_bibfiles = ["../src/quietblade/references.bib"]  # one copy: of the package
bibtex_default_style = "unsrt"
bibtex_reference_style = "author_year"

html_theme = "furo"
html_title = f"quietblade {version}"
html_static_path = ["_static"]
html_css_files = ["quietblade.css"]
