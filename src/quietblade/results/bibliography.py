# SPDX-License-Identifier: LGPL-2.1-or-later
"""The literature behind the methods: ``references.bib``, which the documentation cites too."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType

from quietblade.results.files import ResultError

_LETTERS = {r"{\"o}": "ö", r"{\"u}": "ü", r"{\"a}": "ä", r"\&": "&", r"\_": "_", "--": "-"}
_WHERE = ("journal", "booktitle", "institution", "publisher", "school")


@dataclass(frozen=True)
class Reference:
    """One entry of the bibliography.

    Attributes
    ----------
    key, kind : str
        Such as ``Everstine1981`` and ``article``.
    fields : mapping of str to str
        As they stand in the file.
    bibtex : str
        The whole entry.
    """

    key: str
    kind: str
    fields: Mapping[str, str]
    bibtex: str

    def text(self) -> str:
        """Write author, title, where and when for people."""
        author, title, year = (self._plain(name) for name in ("author", "title", "year"))
        parts = [author.replace(" and ", ", "), title]
        parts += [self._plain(name) for name in _WHERE]
        parts += [self._volume(), self._plain("number"), year, self._plain("note")]
        doi = self._plain("doi")
        return ". ".join(part for part in parts if part) + (f". doi:{doi}" if doi else "")

    def _volume(self) -> str:
        return ", ".join(part for part in (self._plain("volume"), self._plain("pages")) if part)

    def _plain(self, name: str) -> str:
        text = self.fields.get(name, "")
        for tex, letter in _LETTERS.items():
            text = text.replace(tex, letter)
        return text.replace("{", "").replace("}", "").strip().rstrip(".")


@cache
def bibliography() -> Mapping[str, Reference]:
    """All references by key.

    Raises
    ------
    ResultError
        The file of the package is damaged.
    """
    text = files("quietblade").joinpath("references.bib").read_text(encoding="utf-8")
    return MappingProxyType({entry.key: entry for entry in parse_bibtex(text)})


def parse_bibtex(text: str) -> Iterator[Reference]:
    """Read BibTeX whose values stand in braces.

    Raises
    ------
    ResultError
        A brace is missing.
    """
    for head in re.finditer(r"^@(\w+)\{(\w+),", text, re.MULTILINE):
        end = _closing(text, text.index("{", head.start()), head[2])
        fields = {}
        place = head.end()
        while found := re.compile(r"(\w+)\s*=\s*\{").search(text, place, end):
            place = _closing(text, found.end() - 1, head[2])
            fields[found[1].lower()] = " ".join(text[found.end() : place].split())
        yield Reference(head[2], head[1].lower(), fields, text[head.start() : end + 1])


def _closing(text: str, start: int, key: str) -> int:
    """Place of the brace that closes the one at ``start``."""
    depth = 0
    for place in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[place], 0)
        if depth == 0:
            return place
    raise ResultError(f"references.bib: the braces of {key} do not match")
