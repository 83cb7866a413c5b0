# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moving pictures of the deformation and of the wet modes, as GIF or MP4 files."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw, ImageFont

from quietblade.results.files import replacing
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.typing import AnyArray, FloatArray, Progress, silent
from quietblade.view.movie import require_mp4, write_mp4
from quietblade.view.render import FROM_UPSTREAM, Stage, cropped
from quietblade.view.style import SEQUENTIAL
from quietblade.view.surfaces import Motion, MovingSurface, moving_surfaces

_FRAMES, _PERIOD = 16, 1.6  # of one swing; seconds
_SWINGS = 4  # of a film, which need not begin again by itself as a GIF does
_SIZE = (960, 640)  # pixels, before the margins are cut
_AMPLITUDE = 0.08  # largest displacement of a mode in the picture, over the span
_MARGIN, _FONT = 8, 15  # pixels
_COLORS, _SHADES, _GREYS = 48, (1.0, 0.85, 0.7, 0.55), 32  # a GIF has at most 256 colours


def draw_animations(
    folder: RunFolder, result: Result, progress: Progress = silent, kinds: Sequence[str] = ("gif",)
) -> tuple[Path, ...]:
    """Draw the steady deformation and every wet mode into the run's folder of figures.

    Parameters
    ----------
    folder, result
        The run; nothing is computed.
    progress : callable
    kinds : sequence of str
        Endings of the files: ``gif``, or ``mp4`` of several swings.

    Returns
    -------
    tuple of Path
        ``steady.gif`` and a file such as ``mode-C1-B6.gif`` for each mode.

    Raises
    ------
    ResultError
        A file of fields is missing.
    MovieError
        There is no program for MP4 files.
    """
    if "mp4" in kinds:
        require_mp4()  # before anything is drawn
    surfaces = moving_surfaces(folder, result)
    moving = [(surface, motion) for surface in surfaces for motion in surface.motions]
    made = []
    for done, (surface, motion) in enumerate(moving):
        name = f"mode-{surface.configuration}-{motion.name}" if motion.name else "steady"
        progress("animations", done / len(moving), name)
        frames = _titled(animation(surface, motion), _title(surface, motion))
        for kind in kinds:
            file = folder.figures / f"{name}.{kind}"
            with replacing(file) as temporary:
                if kind == "mp4":
                    write_mp4(temporary, _SWINGS * list(map(np.asarray, frames)), _FRAMES / _PERIOD)
                else:
                    _write_gif(temporary, frames)
            made.append(file)
    progress("animations", 1.0, f"{len(made)} files in {folder.figures}")
    return tuple(made)


def animation(surface: MovingSurface, motion: Motion) -> list[AnyArray]:
    """Take pictures of one swing: Re(U exp(i phase)) of a mode, growth and return of a steady load.

    Returns
    -------
    list of (rows, columns, 3) uint8 arrays
    """
    span = float(np.ptp(surface.points[:, 2]))
    phases = 2.0 * np.pi * np.arange(_FRAMES) / _FRAMES
    if motion.name:
        shifts = [_AMPLITUDE * span * np.real(motion.shape * np.exp(1j * p)) for p in phases]
    else:
        shifts = [0.5 * (1.0 - np.cos(p)) * motion.shape.real for p in phases]
    return cropped(_pictures(surface, motion.amplitude, shifts))


def _pictures(
    surface: MovingSurface, colour: FloatArray, shifts: Sequence[FloatArray]
) -> list[AnyArray]:
    rest = pv.PolyData.from_regular_faces(surface.points, surface.blade)
    moving = rest.copy()
    moving.point_data["amplitude"] = colour
    shown = _shaded(moving)
    places = surface.points + np.array(shifts)
    box = np.stack([places.min(axis=(0, 1)), places.max(axis=(0, 1))], axis=1).ravel()

    def changes() -> Iterator[None]:
        for place in places:
            moving.points = place
            shown.copy_from(_shaded(moving))
            yield

    stage = Stage(_SIZE)
    edges = rest.extract_feature_edges(feature_angle=40.0)
    stage.add(edges, color="#9AA0A6", line_width=1.5)
    limits = (0.0, float(colour.max()) or 1.0)
    stage.add(shown, scalars="amplitude", cmap=SEQUENTIAL, clim=limits)
    return stage.pictures(FROM_UPSTREAM, box.tolist(), changes())


def _shaded(surface: pv.PolyData) -> pv.PolyData:
    return surface.compute_normals(feature_angle=30.0, split_vertices=True)


def _title(surface: MovingSurface, motion: Motion) -> str:
    if not motion.name:
        return f"Deformation under load, up to {1e3 * motion.amplitude.max():.1f} mm, to scale"
    return (
        f"{surface.configuration}, mode {motion.name}, {motion.frequency:z.1f} Hz, drawn up to "
        f"{100 * _AMPLITUDE:.0f} % of the length along z; bright: large amplitude"
    )


def _titled(pictures: Sequence[AnyArray], title: str) -> list[Image.Image]:
    font = ImageFont.load_default(_FONT)
    frames = []
    for picture in pictures:
        rows, columns, _ = picture.shape
        head = _FONT + 2 * _MARGIN
        frame = Image.new("RGB", (columns + 2 * _MARGIN, rows + head + _MARGIN), "white")
        frame.paste(Image.fromarray(picture), (_MARGIN, head))
        ImageDraw.Draw(frame).text((_MARGIN, _MARGIN), title, fill="black", font=font)
        frames.append(frame)
    return frames


def _write_gif(file: Path, frames: Sequence[Image.Image]) -> None:
    palette = _palette()
    first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    first.save(
        file, "GIF", save_all=True, append_images=others, loop=0,
        duration=round(1e3 * _PERIOD / len(frames)), optimize=True,
    )  # fmt: skip


def _palette() -> Image.Image:
    """Colours of the scale in several shades, and greys from black to white."""
    scale = mpl.colormaps[SEQUENTIAL](np.linspace(0.0, 1.0, _COLORS))[:, :3]
    shaded = np.concatenate([shade * scale for shade in _SHADES])
    greys = np.repeat(np.linspace(0.0, 1.0, _GREYS)[:, None], 3, axis=1)
    colours = np.rint(255.0 * np.concatenate([shaded, greys])).astype(np.uint8)
    image = Image.new("P", (1, 1))
    image.putpalette(colours.tobytes())
    return image
