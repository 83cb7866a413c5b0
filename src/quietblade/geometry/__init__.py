# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shape of the blade: span functions, sections, blade and film."""

from quietblade.geometry.blade import Blade
from quietblade.geometry.film import Film
from quietblade.geometry.naca import (
    NacaFiveDigit,
    NacaFourDigit,
    NacaSixteen,
    NacaSixtySix,
    naca_designation,
    section_family,
)
from quietblade.geometry.section_files import read_section, section_from_file
from quietblade.geometry.sections import SectionFamily
from quietblade.geometry.spanwise import SpanFunction, constant, formula, table
from quietblade.geometry.table_sections import TableFamily

__all__ = [
    "Blade",
    "Film",
    "NacaFiveDigit",
    "NacaFourDigit",
    "NacaSixteen",
    "NacaSixtySix",
    "SectionFamily",
    "SpanFunction",
    "TableFamily",
    "constant",
    "formula",
    "naca_designation",
    "read_section",
    "section_family",
    "section_from_file",
    "table",
]
