# SPDX-License-Identifier: LGPL-2.1-or-later
"""What to cite for a run: the method, and every model and material that its case uses."""

from collections.abc import Iterator
from dataclasses import dataclass

from quietblade.case import AnyCase, Case
from quietblade.case.laminate import LaminateWords
from quietblade.case.library import SOURCE_OF
from quietblade.case.materials import AnisotropicWords, OrthotropicWords
from quietblade.results.bibliography import Reference, bibliography
from quietblade.results.table import Table
from quietblade.study.solids import used_materials

_SECTIONS = {
    "naca-4": ("Jacobs1933",),
    "naca-5": ("Jacobs1935",),
    "naca-16": ("Lindsey1948", "Abbott1959"),
    "naca-66": ("Brockett1966", "Abbott1959"),
}
_INFLOWS = {
    "none": ("Glauert1935",),
    "lifting-line": ("KatzPlotkin2001",),
    "momentum": ("Ning2014", "Buhl2005", "Glauert1935"),
}
_CONTROLS = {"prandtl": "Glauert1926", "weissinger": "Weissinger1947"}
_FRICTION = {
    "ittc-1957": ("ITTC1957", "Hoerner1965"),
    "prandtl-schlichting": ("Hoerner1965",),
    "boundary-layer": ("DrelaGiles1987", "Fidkowski2022", "Squire1938"),
    "none": (),
}
_COUPLING = {"aitken": "Kuttler2008", "anderson": "Anderson1965"}
_RADIATION = {
    "bgt1": ("Bayliss1982",),
    "bgt2": ("Bayliss1982",),
    "dtn": ("Keller1989", "Wiscombe1980"),
}
_LOSS = {"fractional-zener": ("Bagley1986", "Pritz1996")}


@dataclass(frozen=True)
class Citation:
    """One thing to cite.

    Attributes
    ----------
    why : str
        What of the run comes from there.
    text : str
        The reference in words.
    reference : Reference or None
        Its entry in the bibliography; None if there are only words, as of a material.
    """

    why: str
    text: str
    reference: Reference | None = None


def citations(case: AnyCase) -> tuple[Citation, ...]:
    """Return what to cite for a case, each source once, the two-step paper first."""
    reasons: dict[str, list[str]] = {}
    for why, keys in _used(case):
        for key in keys:
            reasons.setdefault(key, []).append(why)
    known = bibliography()
    found = [
        Citation("; ".join(dict.fromkeys(whys)), known[key].text(), known[key])
        for key, whys in reasons.items()
    ]
    for name in sorted(used_materials(case)):
        # a material that the case itself defines has the user's source
        if name in SOURCE_OF and name not in case.materials:
            found.append(Citation(f"constants of the material {name}", SOURCE_OF[name]))
    return tuple(found)


def program(version: str) -> str:
    """Say in words how the program itself is cited."""
    return f"The quietblade developers. quietblade {version}: flexible propeller blades in water"


def citation_table(case: AnyCase, version: str) -> Table:
    """Tabulate the program of a version and the `citations` of a case."""
    rows = [("program", program(version)), *((c.why, c.text) for c in citations(case))]
    note = "quietblade cite --bibtex writes these as a bibliography"
    return Table("What to cite", ("For", "Source"), tuple(rows), note)


def _used(case: AnyCase) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Say what a case uses, with the keys of the sources."""
    yield "two-step method", ("TwoStep",)
    yield "finite elements", ("Schoeberl2014",)
    yield "mesh", ("Geuzaine2009",)
    if isinstance(case, Case):
        yield from _step_1(case)
    yield from _step_2(case)


def _step_1(case: Case) -> Iterator[tuple[str, tuple[str, ...]]]:
    flow = case.flow
    for family, keys in _SECTIONS.items():
        if case.blade.section.startswith(family):
            yield f"sections {case.blade.section}", keys
    yield "flow past a section (panels)", ("Drela1989",)
    yield f"inflow {flow.inflow}", _INFLOWS[flow.inflow]
    if flow.inflow == "lifting-line":
        yield f"control points {flow.control}", (_CONTROLS[flow.control],)
    if flow.friction != "none":
        yield f"friction {flow.friction}", _FRICTION[flow.friction]
    yield "edges that sing", ("Gongwer1952", "Blake2017")
    yield "structure with large deformation", ("Bonet2008",)
    yield "stress at points", ("Barlow1976",)
    solid = case.material("blade")
    if isinstance(solid, LaminateWords):
        yield "laminate", ("Jones1999", "SunLi1988")
    elif isinstance(solid, OrthotropicWords | AnisotropicWords):
        yield "composite as one solid", ("Jones1999",)
    yield "loads from sections to elements", ("Farhat1998",)
    yield "Newton iterations of the structure", ("Magisano2017",)
    if case.static.method in _COUPLING:
        yield f"coupling accelerated by {case.static.method}", (_COUPLING[case.static.method],)


def _step_2(case: AnyCase) -> Iterator[tuple[str, tuple[str, ...]]]:
    acoustics = case.acoustics
    if "C1" in acoustics.configurations:
        yield "motion of the water's mesh", ("Boncoraglio2021",)
    if set(acoustics.configurations) == {"C0", "C1"}:
        yield "modes of C0 and C1 side by side", ("Allemang1982",)
    yield f"{case.parts[0]} and water, symmetric form", ("Everstine1981",)
    yield f"radiation condition {acoustics.radiation}", _RADIATION[acoustics.radiation]
    yield "complex modes", ("Neumaier1985",)
    if acoustics.sweep == "reduced":
        yield "reduced sweep", ("LuSuBai2016", "KressnerRoman2014")
    yield "sound of bodies", ("Junger1986",)
    yield "levels", ("ISO18405",)
    yield f"bands, {case.bands.kind}", ("IEC61260",)
    if acoustics.flow_damping:
        yield "damping by the stream", ("Theodorsen1935", "Bisplinghoff1955")
    if acoustics.signal == "random":
        yield "random loads", ("Crandall1963",)
    yield from _losses(case)


def _losses(case: AnyCase) -> Iterator[tuple[str, tuple[str, ...]]]:
    for part in case.parts:
        loss = getattr(case.material(part), "loss_factor", None)
        model = getattr(loss, "model", None)
        if model in _LOSS:
            yield f"loss of the {part}, {model}", _LOSS[model]
        if getattr(getattr(loss, "shift", None), "law", None) == "wlf":
            yield f"temperature of the {part}'s loss", ("Williams1955",)
