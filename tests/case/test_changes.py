# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was changed in memory is read back from the text of a case."""

from quietblade.case import Case
from quietblade.case.changes import read_changes
from quietblade.case.presets import preset_text


def test_changes_come_back_as_they_were_made() -> None:
    text = preset_text("paper-composite")
    first = {"mesh.size": "40 mm", "film.span": [0.2, 0.6], "blade.thickness": 0.07}
    case = Case.parse(text, "blade").varied(first).varied({"mesh.size": "30 mm"})
    assert read_changes(text) == {}
    assert read_changes(case.text) == {**first, "mesh.size": "30 mm"}
    again = Case.parse(text, "blade").varied(read_changes(case.text))
    assert again.content_key() == case.content_key()


def test_values_may_have_anything_in_them() -> None:
    text = preset_text("paper-aluminium")
    changes = {"title": "a = b\n# changed in memory: mesh.size = '1 m'"}
    assert read_changes(Case.parse(text, "blade").varied(changes).text) == changes
