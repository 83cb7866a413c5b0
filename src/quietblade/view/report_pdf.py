# SPDX-License-Identifier: LGPL-2.1-or-later
"""A report as PDF, by WeasyPrint, which is an optional extra."""

from importlib import import_module
from typing import Any

from quietblade.errors import QuietbladeError

_REMEDY = 'install the extra with `pip install "quietblade[pdf]"`'


class PdfError(QuietbladeError):
    """A PDF cannot be made here."""


def require_pdf() -> Any:
    """Give WeasyPrint.

    Raises
    ------
    PdfError
        It, or a library of the system that it needs, is missing.
    """
    try:
        return import_module("weasyprint")
    except ImportError as error:
        raise PdfError(f"a PDF needs WeasyPrint, which is not installed: {_REMEDY}") from error
    except OSError as error:  # the text library Pango comes from the system
        raise PdfError(
            f"a PDF needs WeasyPrint, which cannot load the library Pango ({error}): install it, "
            "on Debian and Ubuntu with `apt install libpango-1.0-0 libpangoft2-1.0-0`"
        ) from error


def pdf_of(page: str) -> bytes:
    """Pages of a report; it must carry all of its pictures.

    Parameters
    ----------
    page : str
        What `quietblade.view.report.render_report` makes without the interactive view.
    """
    weasyprint = require_pdf()
    return bytes(weasyprint.HTML(string=page, url_fetcher=_only_inlined(weasyprint)).write_pdf())


def _only_inlined(weasyprint: Any) -> Any:
    """Refuse every address that is not data inside the page."""
    return weasyprint.URLFetcher(allowed_protocols=["data"])
