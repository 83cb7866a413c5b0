# SPDX-License-Identifier: LGPL-2.1-or-later
"""The moving blade in a browser: plotly.js, the surfaces and our controls inside the page.

The surfaces travel as one block of numbers, packed by gzip and written in base64; the browser
unpacks them, and plotly.js, which is packed in the same way.
"""

import gzip
import json
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from string import Template
from typing import Any

import numpy as np
from plotly.offline import get_plotlyjs

from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.typing import AnyArray
from quietblade.view.surfaces import Motion, MovingSurface, moving_surfaces

_STEPS = 32767
"""Steps of a displacement up to the largest of its motion: two bytes a number."""

POLICY = (
    "default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline' 'unsafe-eval'"
)
"""Content security policy of a page with the view: the browser refuses it every network."""


def interactive_view(folder: RunFolder, result: Result) -> str:
    """Make the part of a page that shows the moving blade.

    Raises
    ------
    ResultError
        A file of fields is missing.
    """
    scene, numbers = packed(moving_surfaces(folder, result))
    blade = result.static is not None
    scene["scale"] = "span" if blade else "body's height"
    axes = ": x rotor axis, y suction side, z span" if blade else ""
    parts = files("quietblade.view")
    # the text of a case may stand in a name; nothing in it may end the element
    told = json.dumps(scene).replace("<", "\\u003c")
    return "\n".join(
        (
            Template(parts.joinpath("interactive.html").read_text(encoding="utf-8"))
            .substitute(axes=axes)
            .strip(),
            f'<script type="application/json" id="view3d-scene">{told}</script>',
            f'<script type="text/plain" id="view3d-numbers">{_text(numbers)}</script>',
            f'<script type="text/plain" id="view3d-library">{_library()}</script>',
            f"<script>{parts.joinpath('interactive.js').read_text(encoding='utf-8')}</script>",
        )
    )


def packed(surfaces: Sequence[MovingSurface]) -> tuple[dict[str, Any], bytes]:
    """Surfaces as a description for the browser and the numbers that it points to.

    Returns
    -------
    scene : dict
        Lengths in millimetres; an array is its place (in bytes) and its length.
    numbers : bytes
        Points as 32-bit floats, corners as 32-bit and displacements as 16-bit integers.
    """
    block = _Block()
    span = 1e3 * float(np.ptp(surfaces[0].points[:, 2]))
    return {
        "span": span,
        "surfaces": [
            {
                "configuration": surface.configuration,
                "points": block.add(1e3 * surface.points, "<f4"),
                "blade": block.add(surface.blade, "<i4"),
                "film": block.add(surface.film, "<i4"),
                "motions": [_motion(block, motion) for motion in surface.motions],
            }
            for surface in surfaces
        ],
    }, bytes(block.data)


def _motion(block: "_Block", motion: Motion) -> dict[str, Any]:
    largest = float(motion.amplitude.max())
    steps = np.rint(motion.shape * (_STEPS / largest if largest else 0.0))
    return {
        "name": motion.name,
        "largest": 1e3 * largest,  # mm; of a mode its unit
        "frequency": motion.frequency if motion.name else None,
        # a rigid motion has none
        "loss": motion.loss_factor if np.isfinite(motion.loss_factor) else None,
        "real": block.add(steps.real, "<i2"),
        # a mode without loss moves in one phase
        "imag": block.add(steps.imag, "<i2") if np.any(steps.imag) else None,
    }


@dataclass
class _Block:
    """Numbers in a row, each array at a multiple of four bytes."""

    data: bytearray = field(default_factory=bytearray)

    def add(self, values: AnyArray, kind: str) -> tuple[int, int]:
        place = len(self.data)
        self.data += np.ascontiguousarray(values, dtype=kind).tobytes()
        self.data += bytes(-len(self.data) % 4)
        return place, int(np.size(values))


def _library() -> str:
    return _text(get_plotlyjs().encode("utf-8"))


def _text(data: bytes) -> str:
    # without a time, so that the same run gives the same page
    return b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")
