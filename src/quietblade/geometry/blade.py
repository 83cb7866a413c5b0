# SPDX-License-Identifier: LGPL-2.1-or-later
"""The undeformed blade: planar sections stacked along the span.

Axes of the rotating blade frame: origin on the rotor axis, x along the axis and positive
downstream, z radial along the undeformed span, y = e_z x e_x. A section lies in the plane
z = hub_radius + s span. Its chord direction is t = (cos theta, -sin theta, 0), from the leading to
the trailing edge, and its normal n = (sin theta, cos theta, 0), to the upper (suction) side, with
the blade angle theta; t x n = e_z.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from quietblade.card import Card, Shown, outlines
from quietblade.errors import GeometryError
from quietblade.geometry.film import Film
from quietblade.geometry.sections import SectionFamily, section_moments
from quietblade.geometry.spanwise import SpanFunction
from quietblade.typing import FloatArray

_CONTOUR_NODES = 2001  # polygon areas within 1e-6
_STATIONS = np.linspace(0.0, 1.0, 201)


@dataclass(frozen=True, repr=False)
class Blade(Shown):
    """Shape of one blade. All lengths in m, angles in rad.

    Attributes
    ----------
    hub_radius, span : float
        Radius of the root section; distance from root to tip section [m].
    chord, blade_angle, sweep, rake : SpanFunction
        Chord [m]; angle from the rotor axis, positive raises the incidence [rad]; displacement
        of the section along its chord direction [m] and along the rotor axis [m].
    thickness, camber : SpanFunction
        Largest thickness and camber as fractions of the chord.
    family : SectionFamily
    trailing_edge : float
        Thickness of the blunt trailing edge / chord.
    alignment : float
        Chord fraction that lies on the reference line (0.5: mid-chord).
    film : Film or None
    """

    hub_radius: float
    span: float
    chord: SpanFunction
    blade_angle: SpanFunction
    sweep: SpanFunction
    rake: SpanFunction
    thickness: SpanFunction
    camber: SpanFunction
    family: SectionFamily
    trailing_edge: float
    alignment: float = 0.5
    film: Film | None = None

    def card(self) -> Card:
        """Measures at root, middle and tip, and the planform."""
        s = np.array([0.0, 0.5, 1.0])
        measures = {
            "radius [mm]": 1e3 * self.radius(s),
            "chord [mm]": 1e3 * self.chord(s),
            "thickness [% of the chord]": 100.0 * self.thickness(s),
            "camber [% of the chord]": 100.0 * self.camber(s),
            "blade angle [deg]": np.degrees(self.blade_angle(s)),
        }
        rows = [(name, *(f"{v:.4g}" for v in values)) for name, values in measures.items()]
        rows.append(("volume [cm^3]", f"{1e6 * self.volume():.4g}"))
        if self.film is not None:
            rows.append(("film [mm]", f"{1e3 * self.film.thickness:.4g}"))
        return Card(
            f"Blade of {self.family.name} sections",
            tuple(rows),
            ("", "root", "middle", "tip"),
            self._planform(),
        )

    def _planform(self) -> str:
        """Draw the outline over span and chord, and that of the film in it."""

        def outline(span: tuple[float, float], chord: tuple[float, float]) -> FloatArray:
            s = np.linspace(*span, 41)
            along = np.concatenate([s, s[::-1], s[:1]])
            xi = np.repeat([*chord, chord[0]], [41, 41, 1])
            across = self.sweep(along) + (xi - self.alignment) * self.chord(along)
            return np.stack([self.radius(along), -across], axis=1)

        curves = [outline((0.0, 1.0), (0.0, 1.0))]
        if self.film is not None:
            curves.append(outline(self.film.span, self.film.chord))
        return outlines(*curves)

    def radius(self, s: ArrayLike) -> FloatArray:
        """Radius z [m] at span fraction ``s``; shape of ``s``."""
        return np.asarray(self.hub_radius + np.asarray(s) * self.span, dtype=np.float64)

    def frame(self, s: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Frame of the sections.

        Parameters
        ----------
        s : array_like, shape (...)
            Span fraction.

        Returns
        -------
        origin : ndarray, shape (..., 3)
            Leading-edge point [m].
        t, n : ndarray, shape (..., 3)
            Unit chord direction and unit normal to the upper side.
        """
        s = np.asarray(s, dtype=np.float64)
        theta = self.blade_angle(s)
        zero = np.zeros_like(theta)
        t = np.stack([np.cos(theta), -np.sin(theta), zero], axis=-1)
        n = np.stack([np.sin(theta), np.cos(theta), zero], axis=-1)
        origin = np.stack([self.rake(s), zero, self.radius(s)], axis=-1)
        shift = self.sweep(s) - self.alignment * self.chord(s)
        return origin + shift[..., None] * t, t, n

    def place(self, s: ArrayLike, xy: ArrayLike) -> FloatArray:
        """Section coordinates to space (theory: S1-4).

        Parameters
        ----------
        s : array_like, shape (...)
            Span fraction.
        xy : array_like, shape (..., 2)
            Chord fraction and height / chord; broadcasts with ``s``.

        Returns
        -------
        ndarray, shape (..., 3)
            Points [m].
        """
        s, xy = np.asarray(s, dtype=np.float64), np.asarray(xy, dtype=np.float64)
        origin, t, n = self.frame(s)
        scaled = self.chord(s)[..., None] * xy
        return np.asarray(origin + scaled[..., :1] * t + scaled[..., 1:] * n, dtype=np.float64)

    def locate(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Inverse of `place`, exact because sections are planar.

        Parameters
        ----------
        points : ndarray, shape (..., 3)
            Points of the undeformed blade [m].

        Returns
        -------
        s, xi, eta : ndarray, shape (...)
            Span fraction, chord fraction, height / chord.
        """
        s = (points[..., 2] - self.hub_radius) / self.span
        origin, t, n = self.frame(s)
        arm = points - origin
        chord = self.chord(s)
        return s, np.sum(arm * t, axis=-1) / chord, np.sum(arm * n, axis=-1) / chord

    def section(self, s: ArrayLike, n: int) -> FloatArray:
        """Contour nodes of sections in space.

        Parameters
        ----------
        s : array_like, shape (M,)
            Span fractions.
        n : int
            Nodes a section, odd.

        Returns
        -------
        ndarray, shape (M, n, 3)
            From the upper trailing edge over the nose to the lower trailing edge [m].
        """
        s = np.asarray(s, dtype=np.float64)
        xy = self.family.contour(self.thickness(s), self.camber(s), self.trailing_edge, n)
        return self.place(s[..., None], xy)

    def face_height(self, side: int, s: ArrayLike, xi: ArrayLike) -> FloatArray:
        """Height / chord of the upper (side +1) or lower (-1) face above the chord line.

        Parameters
        ----------
        side : {+1, -1}
        s, xi : array_like
            Span and chord fraction; broadcast to shape (...).

        Returns
        -------
        ndarray, shape (...)
        """
        s, xi = np.broadcast_arrays(np.asarray(s, dtype=np.float64), xi)
        shape = (self.thickness(s), self.camber(s), self.trailing_edge)
        phi = self.family.parameter_at(side, xi, *shape)
        return np.asarray(self.family.point(phi, *shape)[..., 1], dtype=np.float64)

    def film_surface(self, side: int, s: ArrayLike, xi: ArrayLike) -> FloatArray:
        """Points of the film's upper (side +1), middle (0) or lower (-1) surface.

        Parameters
        ----------
        side : {+1, 0, -1}
        s, xi : array_like
            Span and chord fraction of the blade; broadcast to shape (...).

        Returns
        -------
        ndarray, shape (..., 3)
            Points [m].

        Raises
        ------
        GeometryError
            The blade has no film.
        """
        s, xi = np.broadcast_arrays(np.asarray(s, dtype=np.float64), xi)
        half = 0.5 * self._film.thickness / self.chord(s)
        height = self.family.camber_line(xi, self.camber(s))[0] + side * half
        return self.place(s, np.stack([xi, height], axis=-1))

    def film_cover(self, s: ArrayLike, xi: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Material between the film and the faces, along the section normal.

        Parameters
        ----------
        s, xi : array_like
            Span and chord fraction of the blade; broadcast to shape (...).

        Returns
        -------
        above, below : ndarray, shape (...)
            Cover [m]; negative where the film sticks out.

        Raises
        ------
        GeometryError
            The blade has no film.
        """
        s, xi = np.broadcast_arrays(np.asarray(s, dtype=np.float64), xi)
        chord, half = self.chord(s), 0.5 * self._film.thickness
        middle = self.family.camber_line(xi, self.camber(s))[0]
        above = chord * (self.face_height(+1, s, xi) - middle) - half
        below = chord * (middle - self.face_height(-1, s, xi)) - half
        return above, below

    def volume(self) -> float:
        """Volume of the blade, film included [m^3]; within 1e-6 for smooth span functions."""
        s, weight = _gauss_along_span()
        xy = self.family.contour(
            self.thickness(s), self.camber(s), self.trailing_edge, _CONTOUR_NODES
        )
        area = section_moments(xy).area * self.chord(s) ** 2
        return float(self.span * weight @ area)

    def planform_area(self) -> float:
        """Integral of the chord along the span [m^2]."""
        s, weight = _gauss_along_span()
        return float(self.span * weight @ self.chord(s))

    def check(self, minimum_cover: float = 0.0) -> None:
        """Check that the blade is a possible shape and that the film fits into it.

        Parameters
        ----------
        minimum_cover : float
            Least thickness of material that must remain over the film [m].

        Raises
        ------
        GeometryError
            Says what is wrong, where along the span and the chord, by how much, and a remedy.
        """
        self._check_shape()
        if self.film is not None:
            self.film.check()
            self._check_cover(self.film, minimum_cover)

    @property
    def _film(self) -> Film:
        if self.film is None:
            raise GeometryError("the blade has no film; give Blade(film=Film(...))")
        return self.film

    def _check_shape(self) -> None:
        if not self.span > 0.0:
            raise GeometryError(f"blade: span {self.span:g} m; it must be positive")
        if not self.hub_radius >= 0.0:
            raise GeometryError(f"blade: hub radius {self.hub_radius:g} m; it must not be negative")
        if not 0.0 <= self.alignment <= 1.0:
            raise GeometryError(
                f"blade: alignment {self.alignment:g}; give the chord fraction on the reference "
                "line, from 0 to 1"
            )
        if not self.trailing_edge > 0.0:
            raise GeometryError(
                f"blade: trailing-edge thickness {self.trailing_edge:g} of the chord; it must be "
                "positive, because a solid needs a blunt edge (0.006 is usual)"
            )
        names = ("chord", "thickness", "blade_angle", "sweep", "rake", "camber")
        for name in names:
            value = getattr(self, name)(_STATIONS)
            if not np.all(np.isfinite(value)):
                worst = int(np.argmin(np.isfinite(value)))
                raise GeometryError(f"blade: {name} is {value[worst]} {self._at(worst)}")
        chord, thickness = self.chord(_STATIONS), self.thickness(_STATIONS)
        worst = int(np.argmin(chord))
        if chord[worst] <= 0.0:
            raise GeometryError(
                f"blade: chord is {1e3 * chord[worst]:.4g} mm {self._at(worst)}; it must be "
                "positive along the whole span (end the span where the chord ends)"
            )
        worst = int(np.argmin(thickness))
        if thickness[worst] <= self.trailing_edge:
            raise GeometryError(
                f"blade: thickness is {thickness[worst]:.4g} of the chord {self._at(worst)}; it "
                f"must be positive and above the trailing edge's, {self.trailing_edge:g}"
            )

    def _at(self, station: int) -> str:
        s = _STATIONS[station]
        return f"at span fraction {s:.3g} (radius {float(self.radius(s)):.4g} m)"

    def _check_cover(self, film: Film, minimum_cover: float) -> None:
        s, xi = np.meshgrid(
            np.linspace(*film.span, 61), np.linspace(*film.chord, 121), indexing="ij"
        )
        covers = np.stack(self.film_cover(s, xi))
        worst = np.unravel_index(int(np.argmin(covers)), covers.shape)
        least, place = float(covers[worst]), worst[1:]
        if least > 0.0 and least >= minimum_cover:
            return
        face = ("upper", "lower")[int(worst[0])]
        where = (
            f"at span fraction {s[place]:.3g} (radius {float(self.radius(s[place])):.4g} m), "
            f"chord fraction {xi[place]:.3g}"
        )
        if least > 0.0:
            what = (
                f"film: only {1e3 * least:.3g} mm of material remain below the {face} face {where},"
                f" against a minimum cover of {1e3 * minimum_cover:.3g} mm"
            )
        else:
            what = f"film: it sticks out of the {face} face {where}, by {-1e3 * least:.3g} mm"
        fits = film.thickness + 2.0 * (least - minimum_cover)
        thinner = f"a film below {1e3 * fits:.3g} mm, " if fits > 0.0 else ""
        raise GeometryError(f"{what}; use {thinner}a smaller chord range or a thicker blade")


def _gauss_along_span() -> tuple[FloatArray, FloatArray]:
    # panels much shorter than the distance between the kinks of a table
    x, w = np.polynomial.legendre.leggauss(4)
    edges = np.linspace(0.0, 1.0, 51)
    length = edges[1] - edges[0]
    s = edges[:-1, None] + 0.5 * length * (1.0 + x)
    return s.ravel(), np.tile(0.5 * length * w, edges.size - 1)
