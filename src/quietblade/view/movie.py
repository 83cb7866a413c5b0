# SPDX-License-Identifier: LGPL-2.1-or-later
"""Films as MP4 files, by the ffmpeg that the package imageio-ffmpeg brings, an optional extra."""

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quietblade.errors import QuietbladeError
from quietblade.typing import AnyArray

_QUALITY = 8
"""Of 10: thin lines and small letters stay sharp."""


class MovieError(QuietbladeError):
    """A film cannot be made here."""


def require_mp4() -> Any:
    """Give imageio-ffmpeg.

    Raises
    ------
    MovieError
        It is not installed, or has no program for this system.
    """
    remedy = 'install the extra with `pip install "quietblade[mp4]"`, or take GIF files'
    try:
        module = import_module("imageio_ffmpeg")
        module.get_ffmpeg_exe()
    except ImportError as error:
        raise MovieError(
            f"MP4 files need imageio-ffmpeg, which is not installed: {remedy}"
        ) from error
    except RuntimeError as error:
        raise MovieError(f"MP4 files need the program ffmpeg ({error}): {remedy}") from error
    return module


def write_mp4(file: Path, pictures: Sequence[AnyArray], rate: float) -> None:
    """Write a film in H.264, which presentations and browsers play.

    Parameters
    ----------
    file : Path
    pictures : sequence of (rows, columns, 3) uint8 arrays
        Of one size; a white line is added where a number of pixels is odd, as the code needs.
    rate : float
        Pictures a second.

    Raises
    ------
    MovieError
        The extra is missing.
    OSError
        The file cannot be written.
    """
    rows, columns, _ = pictures[0].shape
    spare = ((0, rows % 2), (0, columns % 2), (0, 0))
    size = (columns + columns % 2, rows + rows % 2)
    film = require_mp4().write_frames(
        str(file), size, fps=rate, quality=_QUALITY, macro_block_size=2, codec="libx264"
    )
    film.send(None)
    for picture in pictures:
        film.send(np.pad(picture, spare, constant_values=255))
    film.close()
