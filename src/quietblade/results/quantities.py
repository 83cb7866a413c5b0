# SPDX-License-Identifier: LGPL-2.1-or-later
"""The register of every quantity that a run stores: name, symbol, unit, dimensions, meaning.

The groups are those of ``result.nc``; ``C*`` stands for ``C0`` and ``C1``. The group ``fields``
holds the point data of the VTU files. What is not registered cannot be stored.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Literal

Kind = Literal["real", "complex", "integer", "flag", "text"]

CONFIGURATIONS = ("C0", "C1")
"""At rest, and deformed by the steady load."""

LABELS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "axis": ("x", "y", "z"),
        "plane": ("chordwise", "normal"),
        "state": ("rigid", "chained", "coupled"),
        "edge": ("low", "high"),
        "path": ("sphere", "wet_surface", "multipoles"),
        "multipole": ("monopole", "dipole", "quadrupole", "higher"),
        "family": ("bending", "torsion", "edgewise", "chordwise"),
        "complex": ("re", "im"),
    }
)
"""Dimensions whose entries have names."""

DIMENSIONS: Mapping[str, str] = MappingProxyType(
    {
        "axis": "blade frame: x downstream along the rotor axis, z along the span, y = z cross x",
        "plane": "along the chord (leading to trailing edge), and normal to it (upper side)",
        "state": "undeformed blade; its load applied once; equilibrium with its own load",
        "edge": "ends of the band of the sweep",
        "path": "where the sound power is measured: outer sphere, wetted surface, outgoing "
        "multipoles of the wetted surface's motion and pressure",
        "complex": "real and imaginary part, exp(+i omega t)",
        "iteration": "passes of the loop between flow and structure",
        "newton_step": "Newton steps of the structure, in the order taken",
        "section": "hydrodynamic sections from root to tip",
        "contour": "nodes of a section: upper trailing edge, nose, lower trailing edge",
        "mode": "wet modes in ascending frequency",
        "family": "kinds of motion of the sections",
        "lossy": "where a mode loses energy: lossy materials, stream, radiation",
        "response": "frequencies at which the response is split among the modes: the peaks of a "
        "reduced sweep, the frequencies nearest to the modes of a direct one",
        "dry_mode": "modes without water in ascending frequency",
        "shaft": "speeds of the shaft in the Campbell diagram, ascending",
        "branch": "modes that are followed over the speed of the shaft",
        "order": "multiples of the blade rate",
        "crossing": "speeds of the shaft at which a multiple of the blade rate meets a mode",
        "peak": "maxima of the radiated power in ascending frequency",
        "grid": "sweeps in even steps, from fine to coarse",
        "band": "bands that the frequencies cover",
        "multipole": "outgoing waves of degree 0, 1, 2 and all above",
        "point": "places in the water, in the order of the case",
        "pattern": "frequencies whose directivity is told: peaks, then those of the case",
        "cut": "planes of the polar diagrams",
        "angle": "angle in the plane, from its first axis towards the second [rad]",
        "polar": "angle from the z axis [rad]",
        "azimuth": "angle about the z axis, from x towards y [rad]",
        "limit": "limits of the case",
        "limit_row": "frequencies or bands of all limits, one limit after the other",
        "solid": "solid regions: blade, film",
        "index": "failure indices by region",
        "load": "loads besides those of flow and spin, in the order of the case",
        "frequency": "frequencies of the sweep [Hz]",
        "sink": "where the injected power goes: lossy regions, water",
        "modulus": "complex moduli, by region and static shear",
        "sample": "frequencies at which the moduli are tabulated",
        "measured": "measured moduli",
        "excitation": "loads that set the blade in motion, in the order of the case",
        "function": "transfer functions, in the order of the case",
        "degree": "degree of the outgoing spherical harmonics, from 0 (monopole)",
        "block": "cells of one kind in one region",
        "region": "regions of the mesh",
        "part": "parts of the vector of unknowns",
        "stage": "stages of the run, in order",
        "use": "uses of linear solvers",
        "fallback": "changes of solver during the run",
        "notice": "warnings",
        "package": "packages that the result depends on",
        "alternative": "models of one blade that are compared; the first one is the reference",
    }
)
"""Every dimension and what runs along it."""


@dataclass(frozen=True)
class Quantity:
    """A registered quantity.

    Attributes
    ----------
    group, name : str
        Group of ``result.nc`` and name of the variable in it.
    symbol, unit : str
        Symbol in the equations and SI unit ("1": a ratio or a count, "": not a number).
    dims : tuple of str
        Dimensions; none is a scalar.
    description : str
        What it is, in one sentence.
    equation : str
        How it is defined, where a definition is needed.
    kind : {"real", "complex", "integer", "flag", "text"}
        What one value is. A real that was not computed is NaN.
    reference : str
        Reference value of a level, such as "1 pW".
    """

    group: str
    name: str
    symbol: str
    unit: str
    dims: tuple[str, ...]
    description: str
    equation: str = ""
    kind: Kind = "real"
    reference: str = ""

    def per_hertz(self) -> "Quantity":
        """Return the quantity as it is of random loads.

        Powers are spectral densities then, and pressures their roots.
        """
        units = {"W": "W/Hz", "Pa": "Pa/sqrt(Hz)", "Pa m": "Pa m/sqrt(Hz)"}
        references = {
            "1 pW": "1 pW/Hz", "1 uPa": "1 uPa/sqrt(Hz)", "1 uPa m": "1 uPa m/sqrt(Hz)",
        }  # fmt: skip
        return replace(
            self,
            unit=units.get(self.unit, self.unit),
            reference=references.get(self.reference, self.reference),
        )

    @property
    def label(self) -> str:
        """Unit with its reference, as it stands on an axis: ``m``, ``dB re 1 pW``."""
        return f"{self.unit} re {self.reference}" if self.reference else self.unit


def _q(
    name: str,
    symbol: str,
    unit: str,
    dims: str,
    description: str,
    equation: str = "",
    *,
    kind: Kind = "real",
    reference: str = "",
) -> Quantity:
    return Quantity(
        "", name, symbol, unit, tuple(dims.split()), description, equation, kind, reference
    )


def _text(name: str, dims: str, description: str) -> Quantity:
    return _q(name, "", "", dims, description, kind="text")


def _count(name: str, symbol: str, dims: str, description: str) -> Quantity:
    return _q(name, symbol, "1", dims, description, kind="integer")


# fmt: off
_GROUPS: dict[str, tuple[Quantity, ...]] = {
    "": (
        _text("title", "", "title of the case"),
        _text("blade", "", "blade of the paper that the case stands for, or empty"),
    ),
    "static": (
        _q("tip_displacement", "u_tip", "m", "axis", "displacement of the mid-chord of the tip"),
        _q("max_film_shear_strain", "gamma_max", "1", "",
           "largest engineering shear strain in the film, between its normal and its plane",
           "gamma = sqrt((2 E_13)^2 + (2 E_23)^2), Green-Lagrange E, axis 3 through the film"),
        _q("film_shear_strain_p99", "gamma_99", "1", "",
           "shear strain that 99 % of the film's volume stays below"),
        _q("max_film_shear_strain_place", "X_gamma", "m", "axis",
           "integration point with the largest shear strain, on the undeformed blade"),
        _q("max_blade_shear_strain", "gamma_blade", "1", "",
           "largest engineering shear strain outside the film", "largest E_i - E_j, i != j"),
        _q("force", "F", "N", "state axis", "force of the water on the blade"),
        _q("moment", "M", "N m", "state axis", "moment of that force about the origin"),
        _q("lift", "L", "N", "state", "lift of all sections", "int L' ds along the deformed span"),
        _q("thrust", "T", "N", "state", "thrust of one blade", "T = -F_x"),
        _q("torque", "Q", "N m", "state", "power-absorbing torque of one blade about the axis"),
        _q("tolerance", "epsilon", "1", "", "relative change or error at which the coupling stops"),
        _q("converged", "", "", "", "whether the coupling met its tolerance", kind="flag"),
        _text("coupling_method", "", "newton, fixed-point, aitken or anderson"),
        _text("coupling_kind", "",
              "steady, wash-out, divergence, post-divergence or unresolved"),
        _q("divergence_ratio", "q_D/q", "1", "",
           "estimated dynamic pressure of static divergence over that of the case; NaN: none"),
        _q("load_fraction", "", "1", "", "fraction of the dynamic pressure that the state is for"),
    ),
    "static/history": (
        _q("relative_change", "", "1", "iteration", "change of the displacement in one pass",
           "||u_k - u_(k-1)|| / ||u_(k-1)||; NaN in the first pass, which starts from zero"),
        _q("tip_displacement", "u_tip", "m", "iteration axis", "tip displacement after the pass"),
        _q("lift", "L", "N", "iteration", "lift that was applied in the pass"),
        _q("error", "", "1", "iteration", "estimated relative error of the displacement"),
        _q("rate", "", "1", "iteration", "change over the change before"),
        _q("eigenvalue", "lambda", "1", "iteration",
           "dominant eigenvalue of a pass of flow and structure, beyond 1: divergence",
           kind="complex"),
        _q("fraction", "", "1", "iteration", "fraction of the dynamic pressure"),
        _count("factorizations", "", "iteration", "tangents factorised in the pass"),
    ),
    "static/newton": (
        _count("coupling_iteration", "k", "newton_step", "pass of the coupling, from 1"),
        _q("fraction", "lambda", "1", "newton_step", "fraction of the way to the pass's load"),
        _count("iteration", "j", "newton_step", "Newton iteration at this load, from 0"),
        _q("residual", "", "1", "newton_step", "relative residual before the correction"),
        _q("increment", "", "1", "newton_step", "correction relative to the displacement"),
        _q("force", "", "N", "newton_step", "largest unbalanced force at a node"),
        _q("motion", "", "m", "newton_step", "largest correction at a node"),
        _q("new_tangent", "", "", "newton_step", "whether the tangent is new", kind="flag"),
    ),
    "static/sections": (
        _q("span_fraction", "s", "1", "section", "place along the span: 0 root, 1 tip"),
        _q("radius", "r", "m", "state section", "distance of the mid-chord from the rotor axis"),
        _q("chord", "c", "m", "state section", "chord"),
        _q("blade_angle", "theta", "rad", "state section",
           "angle of the chord to the rotor axis, positive if it raises the incidence"),
        _q("camber", "f", "1", "state section", "largest camber over the chord"),
        _q("incidence", "alpha", "rad", "state section",
           "angle from the chord to the relative velocity normal to the deformed span"),
        _q("lift_coefficient", "C_L", "1", "state section", "lift coefficient of the section",
           "C_L = L' / (1/2 rho W_n^2 c)"),
        _q("lift_per_length", "L'", "N/m", "state section", "lift per deformed length of span"),
        _q("warp", "", "1", "state section",
           "largest distance of the deformed section from its plane, over the chord"),
        _q("reynolds", "Re", "1", "state section", "Reynolds number of stream and chord"),
        _q("drag_coefficient", "C_D", "1", "state section", "viscous drag, friction and form"),
        _q("suction", "-Cp_min", "1", "state section", "negative of the least pressure coefficient",
           "C_p = (p - p_inf) / (1/2 rho W_n^2)"),
        _q("cavitation_number", "sigma", "1", "state section",
           "cavitation number at the top of the turn; inception where -Cp_min reaches it",
           "sigma = (p_inf - p_v) / (1/2 rho W_n^2)"),
        _q("shedding_frequency", "f_s", "Hz", "state section",
           "frequency of the vortices that the trailing edge sheds",
           "f_s = 0.21 W / (edge thickness + displacement thicknesses)"),
    ),
    "static/performance": (
        _text("inflow", "", "model of the induced velocities"),
        _text("friction", "", "friction line of the viscous drag"),
        _count("blades", "Z", "", "number of blades"),
        _q("advance_speed", "V_A", "m/s", "", "mean axial inflow of the ring from root to tip"),
        _q("diameter", "D", "m", "state", "twice the largest distance of a section from the axis"),
        _q("thrust", "T", "N", "state", "thrust of all blades, with friction"),
        _q("torque", "Q", "N m", "state", "torque of the shaft on all blades, with friction"),
        _q("advance_ratio", "J", "1", "state", "advance ratio", "J = V_A / (n D)"),
        _q("thrust_coefficient", "K_T", "1", "state", "thrust coefficient, with friction",
           "K_T = T / (rho n^2 D^4)"),
        _q("torque_coefficient", "K_Q", "1", "state", "torque coefficient, with friction",
           "K_Q = Q / (rho n^2 D^5)"),
        _q("efficiency", "eta", "1", "state", "efficiency, with friction",
           "eta = T V_A / (Q omega)"),
        _q("inviscid_efficiency", "eta_i", "1", "state", "efficiency without friction"),
        _q("inception_depth", "h_i", "m", "",
           "depth of the rotor axis at which cavitation begins in equilibrium, negative if never "
           "below the surface"),
        _q("inception_speed", "V_i", "m/s", "",
           "ship speed at which cavitation begins with the shape and the advance ratio of the "
           "equilibrium"),
    ),
    "static/stress": (
        _text("region", "solid", "region of the blade"),
        _q("von_mises", "sigma_vM", "Pa", "solid", "largest von Mises stress, Cauchy"),
        _q("von_mises_p99", "", "Pa", "solid", "von Mises stress that 99 % of the volume keep"),
        _q("von_mises_place", "", "m", "solid axis", "where it is largest, on C0"),
        _q("principal_stress", "sigma_1", "Pa", "solid", "largest principal Cauchy stress"),
        _q("logarithmic_strain", "epsilon_1", "1", "solid",
           "largest principal logarithmic strain", "1/2 ln(F^T F)"),
    ),
    "static/failure": (
        _text("region", "index", "region of the blade"),
        _text("name", "index", "yield, tsai_hill or maximum_strain"),
        _q("value", "", "1", "index", "largest failure index; 1 is failure, 1/index the reserve"),
        _q("p99", "", "1", "index", "index that 99 % of the volume stay below"),
        _q("place", "", "m", "index axis", "where it is largest, on C0"),
    ),
    "static/reaction": (
        _q("force", "R", "N", "axis", "force of the root on the blade"),
        _q("moment", "", "N m", "axis", "moment of the root on the blade about the origin"),
        _q("force_imbalance", "", "1", "", "|reaction + loads| / |loads|"),
        _q("moment_imbalance", "", "1", "", "the same of the moments"),
        _q("transferred_force_error", "", "1", "",
           "relative difference of the transferred pressure's force from the sections'"),
        _q("transferred_moment_error", "", "1", "", "the same of the moments about the origin"),
    ),
    "static/loads": (
        _text("kind", "load", "load besides those of flow and spin"),
        _q("force", "F", "N", "load axis", "its force on the undeformed blade"),
        _q("moment", "M", "N m", "load axis", "its moment about the origin"),
    ),
    "static/mid_section": (
        _q("span_fraction", "s", "1", "", "place of the section along the span"),
        _q("normalised", "", "1", "state contour plane",
           "contour over the chord, leading edge at (0, 0), trailing edge at (1, 0)"),
        _q("placed", "x", "m", "state contour axis", "contour in the blade frame"),
    ),
    "C*/sweep": (
        _text("method", "", "reduced or direct"),
        _q("accuracy", "", "dB", "", "wanted accuracy of the reduced model's power level"),
        _q("largest_estimate", "", "dB", "",
           "largest estimated error of the power level, at frequencies and resonances"),
        _count("vectors", "", "", "Krylov vectors, one solve each"),
        _count("columns", "", "", "columns of the reduced model"),
        _count("factorizations", "", "", "factorisations of the whole system"),
    ),
    "C*/peaks": (
        _q("frequency", "f", "Hz", "peak", "where the radiated power is largest"),
        _q("power_level", "L_W", "dB", "peak", "sound power level of the peak",
           "10 log10(W / 1 pW)", reference="1 pW"),
        _q("width", "Delta f", "Hz", "peak", "half-power width, NaN if the flanks do not fall"),
        _q("estimate", "", "dB", "peak", "estimated error of the level, NaN in a direct sweep"),
    ),
    "C*/stepped": (
        _q("step", "", "Hz", "grid", "step of a sweep"),
        _q("power_level", "L_W", "dB", "peak grid",
           "level that such a sweep from the lower end of the band shows of the peak",
           "10 log10(W / 1 pW)", reference="1 pW"),
        _q("worst_level", "L_W", "dB", "peak grid",
           "level that it shows if its frequencies lie most unluckily",
           "10 log10(W / 1 pW)", reference="1 pW"),
    ),
    "C*/bands": (
        _text("kind", "", "decidecade, or third-octave in base two"),
        _q("centre", "f_m", "Hz", "band", "centre of the band"),
        _q("lower", "f_1", "Hz", "band", "lower edge of the band"),
        _q("upper", "f_2", "Hz", "band", "upper edge of the band"),
        _q("level", "L_W", "dB", "band", "level of the mean power in the band",
           "the same exciting amplitude at every frequency", reference="1 pW"),
        _q("source_level", "L_S", "dB", "band", "the same of the outgoing waves, mean over all "
           "directions", reference="1 uPa m"),
        _q("mean_level", "L_W", "dB", "", "level of the mean power over the whole band",
           reference="1 pW"),
        _q("mean_source_level", "L_S", "dB", "", "the same as a source level",
           reference="1 uPa m"),
    ),
    "C*/far_field": (
        _text("origin", "", "where the outgoing waves are taken from: sphere or multipoles"),
        _q("frequency", "f", "Hz", "frequency", "frequency of the excitation"),
        _q("kr", "kR", "1", "frequency", "wave number times radius of the outer sphere"),
        _q("source_level", "L_S", "dB", "frequency", "source level, mean over all directions",
           "10 log10(rho c W / (4 pi (1 uPa m)^2)), W of the outgoing waves",
           reference="1 uPa m"),
        _q("efficiency", "sigma", "1", "frequency", "radiation efficiency",
           "W / (rho c/2 int |v_n|^2 dS)"),
        _q("share", "W_l / W", "1", "multipole frequency", "share of the power, by the degree of "
           "the waves about the centre of C*/directivity"),
        _q("condition_error", "", "dB", "frequency",
           "estimated error of the power through the sphere by its radiation condition"),
        _q("place", "x", "m", "point axis", "place in the blade frame"),
        _q("pressure", "p", "Pa", "point frequency", "sound pressure amplitude there",
           "p = -i omega rho psi", kind="complex"),
        _q("pressure_level", "L_p", "dB", "point frequency", "sound pressure level there",
           "20 log10(|p| / sqrt(2) / 1 uPa)", reference="1 uPa"),
    ),
    "C*/directivity": (
        _q("frequency", "f", "Hz", "pattern", "frequency of the pattern"),
        _text("reason", "pattern", "peak, or given in the case"),
        _q("source_level", "L_S", "dB", "pattern", "source level, mean over all directions",
           reference="1 uPa m"),
        _q("efficiency", "sigma", "1", "pattern", "radiation efficiency"),
        _q("share", "W_l / W", "1", "pattern multipole", "share of each multipole in the power"),
        _q("index", "DI", "dB", "pattern", "largest squared pressure over the mean over all "
           "directions"),
        _q("loudest", "", "1", "pattern axis", "direction of the largest pressure on the grid"),
        _q("centre", "x_c", "m", "axis", "where the directions start"),
        _q("distance", "r", "m", "", "distance of the directivity, infinite for the far field"),
        _text("cut", "cut", "axes of the plane of a polar diagram: xy, xz, yz"),
        _q("angle", "", "rad", "angle", "angle in the plane, from its first axis to the second"),
        _q("cut_level", "L", "dB", "pattern cut angle", "level of pressure times distance in "
           "the planes", "20 log10(|p| r / sqrt(2) / 1 uPa m)", reference="1 uPa m"),
        _q("polar", "theta", "rad", "polar", "angle from the z axis"),
        _q("azimuth", "phi", "rad", "azimuth", "angle about the z axis, from x towards y"),
        _q("level", "L", "dB", "pattern polar azimuth",
           "level of pressure times distance in all directions", reference="1 uPa m"),
        _q("product", "", "Pa m", "pattern polar azimuth", "pressure times distance",
           "p r exp(+i k r)", kind="complex"),
    ),
    "C*/limits": (
        _text("name", "limit", "name of the limit"),
        _text("quantity", "limit", "sound-power (re 1 pW) or source-level (re 1 uPa m)"),
        _text("bands", "limit", "narrow, decidecade or third-octave"),
        _q("worst_excess", "", "dB", "limit", "largest excess, negative below the limit, NaN if "
           "the limit does not touch the band"),
        _q("worst_frequency", "", "Hz", "limit", "where that is: frequency or centre of the band"),
        _count("row_of", "", "limit_row", "place of the limit that the row belongs to, from 0"),
        _q("frequency", "f", "Hz", "limit_row", "frequency, or centre of the band"),
        _q("found", "", "dB", "limit_row", "level that is held against the limit"),
        _q("allowed", "", "dB", "limit_row", "level of the limit"),
        _q("excess", "", "dB", "limit_row", "found minus allowed"),
    ),
    "C*/excitations": (
        _text("signal", "", "harmonic, or random: then powers are spectral densities, per hertz"),
        _text("correlation", "", "of random loads: none or full; empty for harmonic ones"),
        _text("name", "excitation", "name of the load"),
        _text("kind", "excitation", "pressure, point-force, line-force or root-motion"),
        _text("unit", "excitation", "unit of its amplitude, or of its spectral density"),
        _q("size", "", "1", "excitation",
           "force of a unit amplitude [N]: area [m^2] of a patch, length [m] of a line, 1 at a "
           "point, NaN of a moved root"),
        _q("amplitude", "a", "1", "excitation frequency",
           "peak amplitude, or one-sided spectral density, in the unit named", kind="complex"),
        _q("radiated", "W", "W", "excitation frequency", "sound power if it acts alone"),
        _q("injected", "W_in", "W", "excitation frequency", "power that it puts in while all act",
           "their sum is the injected power"),
        _q("mean_level", "L_W", "dB", "excitation",
           "level of its mean sound power over the band if it acts alone", reference="1 pW"),
    ),
    "C*/transfer": (
        _text("functions", "function", "transfer functions that the case asks for"),
        _q("about", "", "m", "axis", "centre of the root face, to which moments refer"),
        _q("mobility", "Y", "m/(s N)", "excitation frequency",
           "drive-point mobility; rad/(s N m) where the root is turned",
           "Y = i omega b^T x / F^2", kind="complex"),
        _q("power_per_force", "", "W/N^2", "excitation frequency",
           "radiated power per mean square force of each load alone", "W / (|F|^2 / 2)"),
        _q("blocked_force", "F_b", "N", "excitation axis frequency",
           "force of the blade on its root per unit amplitude of each load", kind="complex"),
        _q("blocked_moment", "M_b", "N m", "excitation axis frequency",
           "moment of the blade on its root per unit amplitude of each load", kind="complex"),
        _q("root_force", "|F_b|", "N", "axis frequency",
           "peak force of all loads on the root; root of its density [N/sqrt(Hz)] if random"),
        _q("root_moment", "|M_b|", "N m", "axis frequency",
           "peak moment of all loads on the root; root of its density if random"),
        _q("shaft_power", "W_s", "W", "frequency",
           "power into the shaft that takes the place of the clamp",
           "W_s = 1/2 Re(v^H Z v), (D + i omega Z) q = F_b"),
    ),
    "C*": (
        _text("radiation_condition", "", "condition on the outer sphere"),
        _q("outer_radius", "R", "m", "", "radius of the outer sphere"),
        _q("sound_speed", "c", "m/s", "", "speed of sound in the water"),
        _q("water_density", "rho", "kg/m^3", "", "density of the water"),
        _q("excitation_pressure", "p_exc", "Pa", "",
           "amplitude of the first load, if it is a constant harmonic pressure, else NaN"),
        _q("excitation_area", "S_exc", "m^2", "",
           "area of the first load, if it is a pressure, else NaN"),
    ),
    "C*/modes": (
        _text("name", "mode", "family (B bending, T torsion, E edgewise, C camber) and number; of "
              "a sphere n or t (twisting) with the degree, or rigid, and a second number"),
        _q("frequency", "f_n", "Hz", "mode", "natural frequency in the water",
           "undamped, incompressible water, static exterior"),
        _q("loss_factor", "eta_n", "1", "mode",
           "loss factor: materials, stream if there is one, and radiation"),
        _q("film_loss", "eta_film", "1", "mode", "loss factor by the materials alone"),
        _q("radiation_loss", "eta_rad", "1", "mode", "what radiation adds to it"),
        _q("purity", "", "1", "mode", "share of the kinetic energy in the family of the name"),
        _text("partner", "mode", "mode of the other configuration that belongs to it, or empty"),
        _q("partner_mac", "MAC", "1", "mode", "similarity to that mode, or to the most similar one",
           "MAC = |a^T P b|^2 / (a^T P a  b^T P b), P: mass of blade and moved water on C0; the "
           "sections carry their motion along"),
        _q("participation", "Gamma_n", "1", "mode",
           "square of the excitation's work on the mode, over the largest"),
    ),
    "C*/mode_count": (
        _count("counted", "m", "", "modes below the highest frequency by Sturm's count; every one "
               "of them was found"),
        _q("highest", "", "Hz", "", "frequency below which no mode is missing"),
        _text("character", "mode", "bending, torsion, edgewise, chordwise, of a sphere degree or "
              "torsion with the degree, or rigid; mixed where the family of the name has less than "
              "0.6 of the kinetic energy"),
        _q("family_share", "", "1", "mode family",
           "share of the kinetic energy in each family; NaN of a body that is no blade"),
        _q("residual", "", "1", "mode", "relative residual of the real mode",
           "||(K - s B) x|| / ||s B x||"),
    ),
    "C*/loss_shares": (
        _text("name", "lossy", "region of the solid, stream, or radiation"),
        _q("share", "eta_n,r", "1", "mode lossy",
           "what it adds to the loss factor; outside the band of the real mode, without radiation",
           "eta_n P_r / sum P"),
    ),
    "C*/participation": (
        _q("frequency", "f", "Hz", "response", "frequency of the response"),
        _q("share", "", "1", "response mode", "share of the mode in the response's kinetic energy",
           "|u_n^T P U|^2 / (U^H P U), P: mass of blade and moved water"),
    ),
    "C*/dry_modes": (
        _text("name", "dry_mode", "family and number"),
        _q("frequency", "f", "Hz", "dry_mode", "natural frequency without water"),
        _q("loss_factor", "eta", "1", "dry_mode", "loss factor by the materials"),
        _q("purity", "", "1", "dry_mode", "share of the kinetic energy in the family of the name"),
        _text("partner", "dry_mode", "wet mode that belongs to it, or empty"),
        _q("partner_mac", "MAC", "1", "dry_mode", "similarity to it, or to the most similar one",
           "as C*/modes/partner_mac, with the mass of the blade alone"),
    ),
    "campbell": (
        _text("advance", "", "speed of advance: fixed, or scaled with the shaft"),
        _count("blades", "Z", "", "number of blades"),
        _q("rotation", "Omega_p", "rad/s", "shaft", "speed of the shaft"),
        _q("advance_speed", "V", "m/s", "shaft", "speed of advance"),
        _q("tip_displacement", "u_tip", "m", "shaft axis", "displacement of the tip"),
        _count("order", "n", "order", "multiple of the blade rate"),
        _text("name", "branch", "name of the mode where its branch begins"),
        _q("frequency", "f_n", "Hz", "branch shaft", "wet natural frequency, or NaN"),
        _q("blade_rate", "n f_b", "Hz", "order shaft", "multiple of the blade rate",
           "n Z Omega_p / (2 pi)"),
        _text("crossing_mode", "crossing", "name of the branch"),
        _count("crossing_order", "n", "crossing", "multiple of the blade rate"),
        _q("crossing_rotation", "Omega_p", "rad/s", "crossing", "speed of the shaft there"),
        _q("crossing_frequency", "f", "Hz", "crossing", "frequency there"),
    ),
    "C*/dissipation": (
        _text("sink", "sink", "region that loses power, or water: what is radiated"),
        _q("power", "W_r", "W", "sink frequency", "power lost in the region, or radiated",
           "W_r = omega/2 Im(g_r) U^H D_r U"),
        _q("mean_share", "", "1", "sink", "share of it in the mean over the band"),
        _q("peak_frequency", "f", "Hz", "peak", "peaks of the radiated power"),
        _q("peak_share", "", "1", "sink peak", "share of it at each peak"),
    ),
    "C*/spectrum": (
        _q("frequency", "f", "Hz", "frequency", "frequency of the excitation"),
        _q("power", "W", "W", "path frequency", "radiated sound power",
           "W = +1/2 Re int p v_n* dS on the sphere, n outward"),
        _q("power_level", "L_W", "dB", "path frequency", "radiated sound power level",
           "10 log10(W / 1 pW)", reference="1 pW"),
        _q("power_by_degree", "W_l", "W", "degree frequency", "power of one degree"),
        _q("injected", "W_in", "W", "frequency", "power of the excitation"),
        _q("dissipated", "W_diss", "W", "frequency",
           "power that materials dissipate, and a stream that damps the blade"),
        _q("balance_residual", "", "1", "frequency", "error of the energy balance",
           "|W_in - W_sphere - W_diss| / W_in"),
        _q("solver_residual", "", "1", "frequency", "relative residual of the linear solve",
           "||A x - b|| / ||b||"),
        _q("error_estimate", "", "dB", "frequency",
           "estimated error of the level by the reduced model, NaN in a direct sweep"),
        _q("mobility", "Y", "m/(s N)", "frequency",
           "mean velocity of the excited area over the exciting force, of the first load alone",
           "W_in = 1/2 |p_exc S_exc|^2 Re Y", kind="complex"),
    ),
    "moduli": (
        _text("name", "modulus", "region, with the static shear if there is one"),
        _text("model", "modulus", "model of the loss: constant, fractional-zener, maxwell, table"),
        _q("static", "G_0", "Pa", "modulus",
           "shear modulus of a film, Young's modulus of an isotropic solid, NaN of another"),
        _q("temperature", "T", "K", "modulus", "temperature, NaN if the case gives none"),
        _q("shift", "a_T", "1", "modulus", "factor of the frequency by that temperature"),
        _q("fit_error", "", "1", "modulus",
           "largest relative distance of the fit from a measured modulus, NaN without a fit"),
        _q("band", "f", "Hz", "edge", "ends of the band"),
        _q("band_ratio", "g", "1", "modulus edge", "complex modulus over the static one there",
           kind="complex"),
        _q("frequency", "f", "Hz", "sample", "frequencies"),
        _q("ratio", "g", "1", "modulus sample", "complex modulus over the static one",
           "g = G(omega) / G_0", kind="complex"),
        _count("measured_modulus", "", "measured", "number of the modulus, from 0"),
        _q("measured_frequency", "f", "Hz", "measured",
           "frequency of the measured modulus, moved to the case's temperature", "f / a_T"),
        _q("measured_ratio", "", "1", "measured", "measured modulus over the static one",
           kind="complex"),
    ),
    "mesh": (
        _count("nodes", "N", "", "nodes of the mesh, vertices and mid-edge nodes"),
    ),
    "mesh/cells": (
        _text("region", "block", "region of the cells"),
        _text("kind", "block", "kind of the cells: tetra10, pyramid13, hexahedron20"),
        _count("count", "n", "block", "number of cells"),
    ),
    "mesh/quality": (
        _text("region", "region", "region of the cells"),
        _q("worst", "", "1", "region", "least signed inverse condition number (1: regular cell)"),
        _q("mean", "", "1", "region", "mean of it"),
        _q("least_jacobian", "", "1", "region",
           "least ratio of the Jacobian at a quadrature point to the cell's mean"),
    ),
    "mesh/unknowns": (
        _text("part", "part", "part of the vector of unknowns"),
        _count("count", "n", "part", "free unknowns of the part"),
    ),
    "run": (
        _text("created", "", "date and time at which the run ended, UTC, ISO 8601"),
        _text("platform", "", "operating system, processor and Python"),
        _count("threads", "", "", "threads that the run could use"),
        _text("code_version", "", "version of quietblade"),
        _text("content_key", "", "hash of the case and of the code that the result depends on"),
        _text("case_text", "", "the case file"),
    ),
    "run/packages": (
        _text("name", "package", "package that the result depends on"),
        _text("version", "package", "its version"),
    ),
    "run/timings": (
        _text("stage", "stage", "stage of the run"),
        _q("seconds", "t", "s", "stage", "wall-clock time of the stage"),
    ),
    "run/cost": (
        _text("stage", "stage", "stage of the run"),
        _q("kept", "", "", "stage", "whether it was taken from an earlier run, whose time counts",
           kind="flag"),
        _q("memory", "", "B", "stage", "largest memory of the process until its end, or NaN"),
        _q("factorization", "", "s", "",
           "mean wall-clock time of one factorisation of the coupled matrix, analysis included"),
    ),
    "run/solvers": (
        _text("use", "use", "what was solved"),
        _text("solver", "use", "solver and precision"),
        _count("factorizations", "", "use", "number of factorisations"),
        _q("worst_residual", "", "1", "use", "largest relative residual of a solve"),
        _q("peak_memory", "", "B", "use", "largest memory of one factorisation"),
    ),
    "run/fallbacks": (
        _text("event", "fallback", "from which solver to which, and why"),
    ),
    "run/notices": (
        _text("where", "notice", "part of the computation or place on the blade"),
        _text("message", "notice", "what is noticed"),
        _q("value", "", "", "notice", "the value in SI units, or NaN"),
        _q("limit", "", "", "notice", "the limit that it is compared with, or NaN"),
        _text("remedy", "notice", "what can be done about it"),
    ),
    "alternatives": (
        _text("title", "", "what is compared"),
        _text("name", "alternative", "alternative"),
        _text("description", "alternative", "what it is"),
        _text("mode", "mode", "wet mode of the reference"),
        _q("frequency", "f_n", "Hz", "alternative mode", "natural frequency in the water",
           "of the mode that is most like that of the reference"),
        _q("loss_factor", "eta_n", "1", "alternative mode", "loss factor"),
        _q("assurance", "MAC", "1", "alternative mode", "similarity to the mode of the reference"),
        _q("peak_frequency", "f", "Hz", "alternative mode", "where its radiated power is largest"),
        _q("peak_level", "L_W", "dB", "alternative mode", "sound power level there",
           reference="1 pW"),
        _q("mean_level", "L_W", "dB", "alternative", "level of the mean power over the band",
           reference="1 pW"),
        _q("element_size", "h", "m", "", "edge length of the elements on the blade"),
        _text("content_key", "", "hash of the case and of the code that the table depends on"),
    ),
    "fields": (
        _q("displacement", "u_1", "m", "axis", "steady displacement from C0 to C1"),
        _q("film_shear_strain", "gamma", "1", "", "engineering shear strain of the film",
           "gamma = sqrt((2 E_13)^2 + (2 E_23)^2)"),
        _q("von_mises_stress", "sigma_vM", "Pa", "", "von Mises stress (Cauchy) of the region"),
        _q("largest_strain", "epsilon_1", "1", "", "largest principal logarithmic strain"),
        _q("failure_index", "", "1", "", "failure index, 1 is failure"),
        _q("pressure", "p_1", "Pa", "", "steady pressure above that far away"),
        _q("mode_shape", "phi_n", "1", "axis", "wet mode, scaled to a largest displacement of 1",
           kind="complex"),
        _q("response", "u_2", "m", "axis", "displacement amplitude at one frequency",
           kind="complex"),
        _q("sound_pressure", "p_2", "Pa", "", "sound pressure amplitude at one frequency",
           "p = -i omega rho psi", kind="complex"),
    ),
}
# fmt: on


def _register() -> dict[str, Quantity]:
    entries = [replace(q, group=group) for group, members in _GROUPS.items() for q in members]
    return {f"{q.group}/{q.name}".lstrip("/"): q for q in entries}


QUANTITIES: Mapping[str, Quantity] = MappingProxyType(_register())
"""The register, by ``group/name``."""
