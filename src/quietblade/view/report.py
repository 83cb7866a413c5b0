# SPDX-License-Identifier: LGPL-2.1-or-later
"""A report of a run as one HTML file that needs no network."""

from base64 import b64encode
from collections.abc import Iterable, Iterator
from html import escape
from pathlib import Path
from string import Template

from quietblade.results.headline import summarise
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.table import Table
from quietblade.results.tables import summary_tables
from quietblade.typing import Progress, silent
from quietblade.view.figures import draw_figures

_PAGE = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #1d2328; max-width: 62rem;
  margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: 0.2rem 0.9rem 0.2rem 0;
  border-bottom: 1px solid #e3e6e8; }
td.agrees, td.differs, td.not-judged { white-space: nowrap; }
td.agrees { color: #00694d; } td.differs { color: #a63c00; font-weight: 600; }
figure { margin: 1.2rem 0; } figure img { max-width: 100%; height: auto; }
figcaption, .note { color: #5a646c; font-size: 0.9rem; }
pre { background: #f5f6f7; padding: 0.8rem; overflow-x: auto; font-size: 0.85rem; }
.scroll { overflow-x: auto; }
@media print { body { margin: 0; max-width: none; } figure { break-inside: avoid; } }
</style>
</head>
<body>
<h1>$title</h1>
<p class="note">quietblade $version, $created, on $platform</p>
$body
</body>
</html>
""")

_CAPTIONS = {
    "mesh": "Blade, film and mesh.",
    "deformed": "The blade under its own lift and at rest, with the shear strain of the film.",
    "stress": "Von Mises stress on the deformed blade.",
    "mid-section-normalised": "The mid section over its chord: what the deformation does to its "
    "camber.",
    "mid-section": "The mid section in space: deflection and blade angle.",
    "blade-angle": "Blade angle along the span.",
    "lift-coefficient": "Lift coefficient along the span: rigid blade, rigid blade's load applied "
    "once, and equilibrium.",
    "cavitation": "Suction along the span; cavitation begins where it reaches the cavitation "
    "number of the section at the top of its turn.",
    "convergence": "How the loop between flow and structure converged.",
    "sound-power": "Radiated sound power, with the wet modes that make the peaks.",
    "source-level": "Source level, the mean over all directions.",
    "bands": "Levels of the mean power in frequency bands, with the limits.",
    "directivity-xy": "Directivity in the plane of rotor axis (x) and y, seen from the tip.",
    "directivity-xz": "Directivity in the plane of rotor axis (x) and span (z).",
    "directivity-yz": "Directivity in the plane of the rotor.",
    "directivity": "Sound in all directions at the loudest peaks.",
    "multipoles": "Shares of the multipoles in the radiated power.",
    "radiation-efficiency": "Radiated power over that of a plane wave with the same motion.",
    "power-paths": "Where the injected power goes; the multipoles do not depend on the waves that "
    "the radiation condition reflects.",
    "power-shares": "Where the injected power goes, in shares; dotted: peaks of the sound power.",
    "moduli": "Complex moduli of the materials over frequency.",
    "power-by-load": "Radiated sound power of each load alone, and of all together.",
    "mobility": "Drive-point mobility of each load.",
    "power-per-force": "Radiated power of each load alone per mean square force.",
    "root-forces": "Force and moment of the blade on its root, and the power that a shaft in place "
    "of the clamp takes, beside the radiated power.",
    "mode-shapes-C0": "Wet modes at rest.",
    "mode-shapes-C1": "Wet modes under load.",
    "campbell": "Wet modes under load over the speed of the shaft, with the blade rate's multiples "
    "as rays.",
}


def render_report(folder: RunFolder, progress: Progress = silent) -> str:
    """Report of a run as HTML; missing figures are drawn first.

    Raises
    ------
    ResultError
        The result or one of its fields is missing.
    """
    result = folder.load()
    figures = {file.stem: file for file in folder.figures.glob("*.png")}
    if not figures:
        figures = {file.stem: file for file in draw_figures(folder, progress)}
    summary = summarise(result)
    return _PAGE.substitute(
        title=escape(summary.title),
        version=escape(summary.run.code_version),
        created=escape(summary.run.created),
        platform=escape(summary.run.platform),
        body="\n".join(_body(result, summary_tables(summary), figures)),
    )


def _body(result: Result, tables: Iterable[Table], figures: dict[str, Path]) -> Iterator[str]:
    for table in tables:
        yield _table(table)
    yield "<h2>Figures</h2>"
    # those with a caption in its order, then whatever else the folder holds
    for name in (*_CAPTIONS, *sorted(set(figures) - set(_CAPTIONS))):
        if name in figures:
            yield _figure(figures[name], _CAPTIONS.get(name, name))
    packages = zip(result.run.packages.name, result.run.packages.version, strict=True)
    yield _table(Table("Packages", (), tuple(packages)))
    yield f"<h2>Case file</h2>\n<pre>{escape(result.run.case_text)}</pre>"


def _table(table: Table) -> str:
    lines = [f"<h2>{escape(table.title)}</h2>", '<div class="scroll"><table>']
    if table.columns:
        lines.append(_row("th", table.columns))
    lines += [_row("td", row) for row in table.rows]
    lines.append("</table></div>")
    if table.note:
        lines.append(f'<p class="note">{escape(table.note)}</p>')
    return "\n".join(lines)


def _row(tag: str, cells: tuple[str, ...]) -> str:
    return "<tr>" + "".join(_cell(tag, text) for text in cells) + "</tr>"


def _cell(tag: str, text: str) -> str:
    verdict = text in {"agrees", "DIFFERS", "not judged"}
    kind = f' class="{text.lower().replace(" ", "-")}"' if verdict else ""
    return f"<{tag}{kind}>{escape(text)}</{tag}>"


def _figure(file: Path, caption: str) -> str:
    data = b64encode(file.read_bytes()).decode("ascii")
    return (
        f'<figure><img src="data:image/png;base64,{data}" alt="{escape(caption)}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )
