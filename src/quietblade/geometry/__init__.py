# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shape of the blade: span functions, sections, blade and film."""

from quietblade.geometry.blade import Blade
from quietblade.geometry.film import Film
from quietblade.geometry.sections import NacaFourDigit, SectionFamily, section_family
from quietblade.geometry.spanwise import SpanFunction, constant, formula, table

__all__ = [
    "Blade",
    "Film",
    "NacaFourDigit",
    "SectionFamily",
    "SpanFunction",
    "constant",
    "formula",
    "section_family",
    "table",
]
