# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a closed polygon crosses itself."""

import numpy as np

from quietblade.typing import FloatArray


def crossing_panels(contour: FloatArray) -> tuple[int, int] | None:
    """Find two sides of a closed polygon that cross.

    Parameters
    ----------
    contour : array (N, 2)
        Nodes; the last is joined to the first. Sides that only touch do not count as crossing.

    Returns
    -------
    tuple of int, or None
        The sides, each by its first node; None if no sides cross.
    """
    if _is_between_two_graphs(contour):
        return None
    side = np.roll(contour, -1, axis=0) - contour
    arm = contour[None, :] - contour[:, None]
    # Exactly 0 at both ends of the side itself, so that neighbours never seem to cross.
    left = np.sign(side[:, None, 0] * arm[..., 1] - side[:, None, 1] * arm[..., 0])
    straddles = left * np.roll(left, -1, axis=1) < 0.0
    found = np.argwhere(straddles & straddles.T)
    return (int(found[0, 0]), int(found[0, 1])) if len(found) else None


def _is_between_two_graphs(contour: FloatArray) -> bool:
    """Whether the polygon lies between two functions of x that meet at its ends only.

    Sufficient for a simple polygon, true for nearly every section, and much cheaper than to
    compare all sides with all.
    """
    if np.array_equal(contour[0], contour[-1]):
        contour = contour[:-1]
    first = int(np.argmax(contour[:, 0]))
    turned = np.roll(contour, -first, axis=0)
    nose = int(np.argmin(turned[:, 0]))
    upper = turned[nose::-1]
    lower = np.concatenate([turned[nose:], turned[:1]])
    return _is_graph(upper) and _is_graph(lower) and _is_above(upper, lower)


def _is_graph(chain: FloatArray) -> bool:
    steps = np.diff(chain[:, 0])
    return bool(np.all(steps[1:-1] > 0.0) and np.all(steps[[0, -1]] >= 0.0))


def _is_above(upper: FloatArray, lower: FloatArray) -> bool:
    below = np.interp(upper[1:-1, 0], lower[:, 0], lower[:, 1])
    above = np.interp(lower[1:-1, 0], upper[:, 0], upper[:, 1])
    return bool(np.all(upper[1:-1, 1] > below) and np.all(lower[1:-1, 1] < above))
