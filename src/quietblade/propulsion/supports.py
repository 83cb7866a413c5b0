# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Elastic supports: the energy of a mounting, quadratic in the displacement of a face.

Either an elastic bed under the face, or a rigid mounting flange on six springs (theory: S1-56).
Both are linear: the face may turn by a small angle only.
"""

from dataclasses import dataclass
from math import inf, isnan

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.errors import CaseError
from quietblade.mesh.assembly import csr_of
from quietblade.propulsion.forms import StructuralForms
from quietblade.typing import FloatArray

# How much stiffer a flange is than the first layer of cells.  It is as if the blade were longer by
# a hundredth of a cell; a stiffer one would drown small forces in its rounding.
_RIGID = 100.0

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class ElasticBed:
    """A bed that answers each displacement u of a face with the traction ``-modulus u``.

    Attributes
    ----------
    modulus : float
        Stiffness per area [N/m3], the same in all directions.
    boundary : str
        Name pattern of the face.
    """

    modulus: float
    boundary: str = "root"

    def __post_init__(self) -> None:
        if not 0.0 < self.modulus < inf:
            raise CaseError(
                f"elastic bed: the modulus has to be positive and finite, got {self.modulus:g} N/m3"
            )


@dataclass(frozen=True)
class RootSpring:
    """A rigid flange on the face, held by six springs.

    Attributes
    ----------
    translation : tuple of 3 floats
        Stiffness against translation along x, y and z [N/m]; ``inf`` is as stiff as the flange.
    rotation : tuple of 3 floats
        Stiffness against rotation about x, y and z through the centre [N m/rad], likewise.
    centre : tuple of 3 floats or None
        Where the springs are attached [m]; default the centroid of the face.
    boundary : str
        Name pattern of the face.
    """

    translation: Triple = (inf, inf, inf)
    rotation: Triple = (inf, inf, inf)
    centre: Triple | None = None
    boundary: str = "root"

    def __post_init__(self) -> None:
        for name, values in (("translation", self.translation), ("rotation", self.rotation)):
            if len(values) != 3 or any(isnan(k) or k < 0.0 for k in values):
                raise CaseError(
                    f"root spring: the stiffness against {name} has to be three numbers, zero or "
                    f"positive, got {values}"
                )


Support = ElasticBed | RootSpring
"""What holds a face elastically."""


@dataclass(frozen=True, eq=False)
class ElasticSupport:
    """A support on the unknowns of a structure.

    Attributes
    ----------
    stiffness : csr array
        Second derivative of the energy, (ndof, ndof) [N/m], symmetric.
    bed : csr array
        Part of it that a bed under the face makes, (ndof, ndof) [N/m].
    motions : (6, ndof) float array
        Unknowns of the flange's unit motions; no rows without a flange.
    means : (6, ndof) float array
        The flange's motion is ``means @ x``.
    springs : (6,) float array
        Stiffness against its motions [N/m], [N m/rad].
    """

    stiffness: csr_matrix
    bed: csr_matrix
    motions: FloatArray
    means: FloatArray
    springs: FloatArray

    def force(self, x: FloatArray) -> FloatArray:
        """Return the force of the support on the structure, (ndof,) [N].

        The flange's motion is taken out first, since the bed is so stiff that it would leave
        nothing but rounding of it.
        """
        moved = self.means @ x
        return np.asarray(
            -(self.bed @ (x - self.motions.T @ moved)) - self.means.T @ (self.springs * moved)
        )


def assemble_support(forms: StructuralForms, support: Support) -> ElasticSupport:
    """Put a support on the unknowns of a structure.

    Raises
    ------
    CaseError
        If the face is clamped, so that the support would do nothing.
    """
    face = forms.boundary(support.boundary)
    u, _ = forms.trial()
    form = forms.form([ngs.InnerProduct(u.Trace(), forms.test().Trace()) * ngs.ds(face)])
    form.Assemble()
    spread = csr_of(form)
    touched = np.flatnonzero(np.abs(spread.diagonal()) > 0.0)
    if not forms.free[touched].any():
        raise CaseError(
            f"the elastic support of {support.boundary!r} does nothing, since that face is "
            "clamped; use Structure(..., clamped=None)"
        )
    if isinstance(support, ElasticBed):
        bed = csr_matrix(support.modulus * spread)
        none = np.zeros((0, forms.ndof))
        return ElasticSupport(bed, bed, none, none, np.zeros(0))
    return _flange(forms, support, face, spread)


def _flange(
    forms: StructuralForms, spring: RootSpring, face: ngs.Region, spread: csr_matrix
) -> ElasticSupport:
    """Stiff bed of what the six rigid motions leave, and springs against these (theory: S1-56)."""
    place = ngs.CF((ngs.x, ngs.y, ngs.z))
    area = ngs.Integrate(1.0, forms.fem, definedon=face)
    centre = spring.centre
    if centre is None:
        centre = tuple(c / area for c in ngs.Integrate(place, forms.fem, definedon=face))
    axes = np.eye(3)
    arms = forms.basis.points - np.array(centre)
    nodal = [np.broadcast_to(axis, arms.shape) for axis in axes]
    nodal += [np.cross(axis, arms) for axis in axes]
    motions = np.zeros((6, forms.ndof))
    motions[:, : forms.n_displacement] = [forms.basis.to_dofs(motion) for motion in nodal]
    works = np.asarray((spread @ motions.T).T)
    products = works @ motions.T
    means = np.linalg.solve(products, works)
    modulus = _flange_modulus(forms, spread, area)
    asked = np.array([*spring.translation, *spring.rotation])
    springs = np.where(np.isinf(asked), modulus * np.diag(products), asked)
    touched = np.flatnonzero(np.abs(works).max(axis=0) > 0.0)
    local = means[:, touched]
    block = local.T @ (np.diag(springs) - modulus * products) @ local
    rows, columns = np.meshgrid(touched, touched, indexing="ij")
    shape = (forms.ndof, forms.ndof)
    entries = 0.5 * (block + block.T).ravel()
    rigid = csr_matrix((entries, (rows.ravel(), columns.ravel())), shape=shape)
    bed = csr_matrix(modulus * spread)
    return ElasticSupport(csr_matrix(bed + rigid), bed, motions, means, springs)


def _flange_modulus(forms: StructuralForms, spread: csr_matrix, area: float) -> float:
    """Stiffness per area that is large beside that of the cells at the face [N/m3]."""
    terms = [*forms.elastic_terms(), *forms.mixed_terms()]
    stiffness = forms.linearise(terms, np.zeros(forms.ndof)).diagonal()
    n, nv = forms.n_displacement // 3, forms.fem.nv
    corners = np.concatenate([axis * n + np.arange(nv) for axis in range(3)])
    corners = corners[np.abs(spread.diagonal()[corners]) > 0.0]
    return float(_RIGID * stiffness[corners].sum() / (3.0 * area))


def rotation_stiffness(measured: float, clamped: float, lever: float) -> float:
    """Root spring that explains why a blade is softer than its clamped model.

    A force across the blade at the distance `lever` from the root turns a flange on a spring k by
    ``force lever / k``, so that the compliances add: ``1/measured = 1/clamped + lever^2 / k``
    (theory: S1-57).

    Parameters
    ----------
    measured, clamped : float
        Force over displacement at the same point [N/m], measured and of the clamped model.
    lever : float
        Distance of the force from the centre of the root [m].

    Returns
    -------
    float
        k [N m/rad], for `RootSpring.rotation`.

    Raises
    ------
    CaseError
        If the blade is not softer than its clamped model.
    """
    if not 0.0 < measured < clamped:
        raise CaseError(
            f"root spring: the measured stiffness {measured:g} N/m is not below that of the "
            f"clamped model, {clamped:g} N/m; a spring at the root cannot explain it"
        )
    return lever**2 / (1.0 / measured - 1.0 / clamped)
