# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stress and strain measures of arrays of tensors, (..., 3, 3)."""

import numpy as np

from quietblade.typing import FloatArray


def cauchy_stress(gradient: FloatArray, second_piola: FloatArray) -> FloatArray:
    """``F S F^T / det F`` [Pa] (theory: S1-60)."""
    F = gradient
    return np.asarray(F @ second_piola @ _transposed(F) / np.linalg.det(F)[..., None, None])


def green_lagrange_strain(gradient: FloatArray) -> FloatArray:
    """``(F^T F - 1) / 2``."""
    strain: FloatArray = 0.5 * (_transposed(gradient) @ gradient - np.eye(3))
    return strain


def logarithmic_strain(gradient: FloatArray) -> FloatArray:
    """``1/2 ln(F^T F)``, logarithms of the stretches along their axes (theory: S1-61)."""
    squares, directions = np.linalg.eigh(_transposed(gradient) @ gradient)
    return np.asarray(
        (directions * (0.5 * np.log(squares))[..., None, :]) @ _transposed(directions)
    )


def in_axes(tensor: FloatArray, axes: FloatArray) -> FloatArray:
    """Components ``A^T T A`` in axes that are the columns of A (theory: S1-62)."""
    components: FloatArray = _transposed(axes) @ tensor @ axes
    return components


def principal_values(tensor: FloatArray) -> FloatArray:
    """Principal values of symmetric tensors, greatest first, (..., 3)."""
    return np.asarray(np.linalg.eigvalsh(tensor)[..., ::-1])


def von_mises_stress(stress: FloatArray) -> FloatArray:
    """``sqrt(3/2 s : s)`` of the deviator s [Pa] (theory: S1-64)."""
    mean = np.trace(stress, axis1=-2, axis2=-1) / 3.0
    deviator = stress - mean[..., None, None] * np.eye(3)
    return np.asarray(np.sqrt(1.5 * np.sum(deviator**2, axis=(-2, -1))))


def _transposed(tensor: FloatArray) -> FloatArray:
    return np.swapaxes(tensor, -1, -2)
