# SPDX-License-Identifier: LGPL-2.1-or-later
"""What stands where in a report: sections, their tables by title, their figures with captions."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Section:
    """A part of the report.

    Attributes
    ----------
    title : str
    tables : tuple of str
        Titles of its tables.
    figures : mapping
        Captions of its figures by name.
    """

    title: str
    tables: tuple[str, ...] = ()
    figures: Mapping[str, str] = field(default_factory=dict)


VIEW = "displacement"
"""Figure that stands where the interactive view cannot."""

BODY_VIEW = "mode-shapes-C0"
"""The same of a body that is no blade, which has no steady deformation."""

BODY_CAPTIONS = {
    "directivity-xy": "Directivity in the plane of x and y.",
    "directivity-xz": "Directivity in the plane of x and z.",
    "directivity-yz": "Directivity in the plane of y and z.",
}
"""Captions of a body that is no blade, where they are other ones."""

CASE = "The case"
"""Section of the case in words, which do not come from the result."""

TRUST = "What converged, and how"

SECTIONS = (
    Section(
        "How much does it bend?",
        ("Steady load", "Strength"),
        {
            VIEW: "The blade under its own lift, coloured by its displacement, and at rest.",
            "deformed": "The shear strain of the film under load.",
            "stress": "Von Mises stress on the deformed blade.",
            "mid-section-normalised": "The mid section over its chord: what the deformation does "
            "to its camber.",
            "mid-section": "The mid section in space: deflection and blade angle.",
            "blade-angle": "Blade angle along the span.",
        },
    ),
    Section(
        "What happens to the lift?",
        ("Performance",),
        {
            "lift-coefficient": "Lift coefficient along the span: rigid blade, rigid blade's load "
            "applied once, and equilibrium.",
            "cavitation": "Suction along the span; cavitation begins where it reaches the "
            "cavitation number of the section at the top of its turn.",
        },
    ),
    Section(
        "Where are the resonances?",
        (
            "Wet modes and peaks of the sound power",
            "Kind and loss of the wet modes",
            "Campbell diagram",
            "Crossings of modes and blade rate",
        ),
        {
            BODY_VIEW: "Wet modes at rest.",
            "mode-shapes-C1": "Wet modes under load.",
            "campbell": "Wet modes under load over the speed of the shaft, with the blade rate's "
            "multiples as rays.",
        },
    ),
    Section(
        "How loud is it?",
        (
            "Peaks of the radiated power",
            "Limits",
            "Bands",
            "Multipoles and directivity at the peaks",
        ),
        {
            "sound-power": "Radiated sound power, with the wet modes that make the peaks.",
            "source-level": "Source level, the mean over all directions.",
            "bands": "Levels of the mean power in frequency bands, with the limits.",
            "directivity-xy": "Directivity in the plane of rotor axis (x) and y, from the tip.",
            "directivity-xz": "Directivity in the plane of rotor axis (x) and span (z).",
            "directivity-yz": "Directivity in the plane of the rotor.",
            "directivity": "Sound in all directions at the loudest peaks.",
            "multipoles": "Shares of the multipoles in the radiated power.",
            "radiation-efficiency": "Radiated power over that of a plane wave with the same "
            "motion.",
        },
    ),
    Section(
        "Where does the power go?",
        ("Where the power goes", "Complex moduli"),
        {
            "power-paths": "Where the injected power goes; the multipoles do not depend on the "
            "waves that the radiation condition reflects.",
            "power-shares": "Where the injected power goes, in shares; dotted: peaks of the sound "
            "power.",
            "moduli": "Complex moduli of the materials over frequency.",
        },
    ),
    Section(
        "What excites it?",
        ("Excitation", "Transfer functions"),
        {
            "power-by-load": "Radiated sound power of each load alone, and of all together.",
            "mobility": "Drive-point mobility of each load.",
            "power-per-force": "Radiated power of each load alone per mean square force.",
            "root-forces": "Force and moment of the blade on its root, and the power that a shaft "
            "in place of the clamp takes, beside the radiated power.",
        },
    ),
    Section("The paper's claims", ("The paper's claims",)),
    Section(CASE),
    Section(
        "Mesh",
        ("Cells and their quality", "Free unknowns of step 2"),
        {"mesh": "What is meshed, and the cells."},
    ),
    Section(
        TRUST,
        (
            "How far to trust it",
            "Passes between flow and structure",
            "Newton's method in the structure",
            "Sweeps over frequency",
            "Linear solvers",
        ),
        {"convergence": "How the loop between flow and structure converged."},
    ),
    Section("Warnings", ("Warnings",)),
    Section("Where it comes from", ("Run", "Time", "Packages")),
    Section("What to cite", ("What to cite",)),
)
"""In the order in which people ask."""
