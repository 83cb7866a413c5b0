# SPDX-License-Identifier: LGPL-2.1-or-later
"""Complex moduli of a case: models, files, temperature, static shear, and what is said of them."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quietblade.case import Case, InvalidCaseError
from quietblade.case.presets import preset_text
from quietblade.materials.viscoelastic import FractionalZener, WlfShift, modulus_ratio
from quietblade.propulsion.tangent import compute_tangent
from quietblade.study.losses import (
    Modulus,
    loss_parts,
    moduli,
    moduli_notices,
    modulus_table,
    region_of,
)
from quietblade.study.modulus_files import read_moduli
from quietblade.study.preflight import preflight
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.loss import Lossy
from quietblade.vibroacoustics.modes import dry_modes
from quietblade.vibroacoustics.vacuum import dry_operators
from tests.propulsion.solid_models import bent_plate, plate

SHEAR_MODULUS = 1.522e6  # of the preset's film [Pa]
RUBBER = FractionalZener(stiffening=12.0, tau=2e-4, alpha=0.7)
ZENER = {
    "model": "fractional-zener", "stiffening": 12.0, "relaxation_time": "0.2 ms", "exponent": 0.7,
}  # fmt: skip
WLF = {"law": "wlf", "c1": 8.86, "c2": "101.6 K", "reference": "20 degC"}
BAND = np.array([100.0, 220.0])


@pytest.fixture
def said(tmp_path: Path) -> Callable[..., Case]:
    (tmp_path / "blade.toml").write_text(preset_text("paper-composite"))

    def varied(loss: Any, text: str = "") -> Case:
        (tmp_path / "rubber.csv").write_text(text)
        return Case.load(tmp_path / "blade.toml").varied({"materials.polymer.loss_factor": loss})

    return varied


def table(scale: float = 1.0, shears: tuple[float, ...] = (), *, low: float = 1.0) -> str:
    """Points of the rubber in MPa, of `scale` times its modulus and 1 + 3 shear that."""
    f = np.geomspace(low, 1e4, 41)
    g = scale * SHEAR_MODULUS / 1e6 * modulus_ratio(RUBBER, f)
    if not shears:
        rows = [f"{a:.8g}, {b.real:.8g}, {b.imag:.8g}" for a, b in zip(f, g, strict=True)]
        return "\n".join(
            ["# a rubber", "Frequency [Hz], storage_modulus [MPa], loss modulus [MPa]", *rows]
        )
    rows = [
        f"{s}, {1e-3 * a:.8g}, {(1 + 3 * s) * b.real:.8g}, {b.imag / b.real:.8g}"
        for s in shears
        for a, b in zip(f, g, strict=True)
    ]
    return "\n".join(["static shear, frequency [kHz], storage modulus [MPa], loss factor", *rows])


TABLE = {"model": "table", "file": "rubber.csv"}


def test_numbers_need_no_model(said) -> None:
    assert moduli(said(0.2)) == ()


def test_zener_at_a_temperature(said) -> None:
    (rubber,) = moduli(said(ZENER | {"temperature": "10 degC", "shift": WLF}))
    factor = WlfShift(8.86, 101.6, 293.15).factor(283.15)
    assert (rubber.name, rubber.model, rubber.static) == ("film", "fractional-zener", SHEAR_MODULUS)
    assert (rubber.temperature, rubber.shift) == pytest.approx((283.15, factor))
    assert rubber.at(BAND) == pytest.approx(modulus_ratio(RUBBER, factor * BAND))


def test_a_table_made_from_a_model_returns_it(said) -> None:
    (rubber,) = moduli(said(TABLE, table()))
    wanted = modulus_ratio(RUBBER, np.geomspace(3.0, 3e3, 9))
    assert rubber.at(np.geomspace(3.0, 3e3, 9)) == pytest.approx(wanted, rel=3e-3)
    assert rubber.fit.error < 3e-3
    assert not list(moduli_notices(said(TABLE, table()), (rubber,)))


def test_measured_points_are_moved_to_the_temperature(said) -> None:
    (rubber,) = moduli(said(TABLE | {"temperature": "10 degC", "shift": WLF}, table()))
    f, points = rubber.measured
    assert f[0] == pytest.approx(1.0 / rubber.shift)
    assert rubber.at(f) == pytest.approx(points, rel=3e-3)
    rows = modulus_table((rubber,), (100.0, 220.0))
    assert rows.measured_frequency.tolist() == f.tolist()
    assert rows.frequency[0] <= f[0]
    assert rows.band_ratio[0] == pytest.approx(rubber.at(BAND))


def test_vibrations_have_the_measured_moduli_whatever_the_steady_load_has(said) -> None:
    case = said(TABLE, table(scale=1.3))
    (rubber,) = moduli(case)
    assert rubber.at(BAND) == pytest.approx(1.3 * modulus_ratio(RUBBER, BAND), rel=3e-3)
    (notice,) = moduli_notices(case, (rubber,))
    assert "under the steady load" in notice.message
    assert notice.value == pytest.approx(0.3, abs=0.01)


def test_poor_fits_and_extrapolation_are_noticed(said) -> None:
    f = np.geomspace(50.0, 150.0, 12)
    rows = [f"{a:.5g}, {1.5 + k % 2}, 0.1" for k, a in enumerate(f)]
    case = said(TABLE, "\n".join(["frequency [Hz], storage modulus [MPa], loss factor", *rows]))
    text = "\n".join(map(str, preflight(case).notices))
    assert "the fit is far from a measured point" in text
    assert "no modulus was measured at 220 Hz" in text
    assert "no modulus was measured at 100 Hz" not in text


def test_shears_of_a_list_and_of_a_file(said) -> None:
    entries = [
        {"shear": 0.05, "factor": 1.15},
        {"shear": 0.1, "loss_factor": {"model": "constant", "value": 0.3}, "factor": 1.3},
    ]
    rest, some, more = moduli(said(ZENER | {"prestrain": entries}))
    assert [m.shear for m in (rest, some, more)] == [0.0, 0.05, 0.1]
    assert some.at(BAND) == pytest.approx(1.15 * rest.at(BAND))
    assert more.at(BAND) == pytest.approx(1.3 * (1.0 + 0.3j) * np.ones(2))
    assert (some.name, region_of(some.name)) == ("film at shear 0.05", "film")
    rest, some, more = moduli(said(TABLE, table(shears=(0.0, 0.05, 0.1))))
    assert [m.shear for m in (rest, some, more)] == [0.0, 0.05, 0.1]
    assert more.at(BAND) == pytest.approx(1.3 * rest.at(BAND), rel=1e-6)
    assert not list(moduli_notices(said(TABLE, table(shears=(0.0, 0.1))), (rest, some, more)))


def test_structural_loss_of_the_blade(said) -> None:
    maxwell = {"model": "maxwell", "strengths": [0.02], "relaxation_times": ["1 ms"]}
    case = said(0.2).varied({"materials.woven-carbon.loss_factor": maxwell})
    (weave,) = moduli(case)
    assert weave.name == "blade"
    assert np.isnan(weave.static)
    assert weave.at(BAND).imag.min() > 0.001
    unused = case.varied({"blade.material": "aluminium-paper"})
    assert moduli(unused) == ()


STACK = {
    "law": "laminate",
    "model": "homogenised",
    "plies": [
        {"material": "first", "angle": "0 deg", "fraction": 0.5},
        {"material": "second", "angle": "0 deg", "fraction": 0.5},
    ],
}
PLY = {"law": "isotropic", "density": "1 g/cm^3", "E": "10 GPa", "nu": 0.3}


def laminate(said: Callable[..., Case], first: Any, second: Any, **own: Any) -> Case:
    return said(0.2).varied(
        {
            "materials.first": PLY | {"loss_factor": first},
            "materials.second": PLY | {"loss_factor": second},
            "materials.stack": STACK | own,
            "blade.material": "stack",
        }
    )


def test_plies_have_one_model_or_the_laminate_has_its_own(said) -> None:
    (stack,) = moduli(laminate(said, ZENER, ZENER))
    assert (stack.region, stack.model) == ("blade", "fractional-zener")
    with pytest.raises(InvalidCaseError, match="the plies have different models of the loss"):
        preflight(laminate(said, ZENER, 0.1))
    assert moduli(laminate(said, ZENER, 0.1, loss_factor=0.01)) == ()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file has no table"),
        ("frequency [Hz], storage modulus [Pa], loss factor", "no row below the header"),
        ("f [Hz], storage modulus [Pa], loss factor\n1, 1, 1", 'has a column "f \\[Hz\\]"'),
        ("frequenzy [Hz], storage modulus [Pa], loss factor", 'Did you mean "frequency"'),
        ("frequency, storage modulus [Pa], loss factor\n1, 1, 1", "has no unit; write"),
        ("frequency [mm], storage modulus [Pa], loss factor\n1, 1, 1", "a length where"),
        ("frequency [Hz], loss factor\n1, 1", "exactly one storage modulus is needed"),
        (
            "frequency [Hz], storage modulus [Pa], loss factor, loss modulus [Pa]\n1, 1, 1, 1",
            "exactly one loss factor or loss modulus",
        ),
        ("frequency [Hz], frequency [Hz], storage modulus [Pa], loss factor", "stands twice"),
        ("frequency [Hz], storage modulus [Pa], loss factor [Pa]\n1, 1, 1", "a plain number"),
        ("frequency [Hz], storage modulus [Pa], loss factor\n1, 1", "line 2 has 2 values for 3"),
        ("frequency [Hz], storage modulus [Pa], loss factor\n1, x, 1", 'line 2: .* is "x"'),
        ("frequency [Hz], storage modulus [Pa], loss factor\n0, 1, 1", "must be positive"),
        ("frequency [Hz], storage modulus [Pa], loss factor\n1, 1, -1", "must be zero or pos"),
        ("frequency [Hz], storage modulus [Pa], loss factor\n1, inf, 1", "must be positive"),
        ("frequency [Hz], storage modulus [Pa], loss factor\n1, 1, 1", "fewer than two points"),
    ],
)
def test_files_that_are_no_tables(said, text: str, message: str) -> None:
    with pytest.raises(InvalidCaseError, match=message) as caught:
        preflight(said(TABLE, text))
    (problem,) = caught.value.problems
    assert problem.key == "materials.polymer.loss_factor.file"
    assert "frequency [Hz], storage modulus [MPa]" in problem.remedy


def test_other_files_that_cannot_be(said, tmp_path: Path) -> None:
    with pytest.raises(InvalidCaseError, match="no such file"):
        preflight(said(TABLE | {"file": "none.csv"}))
    (tmp_path / "noise.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InvalidCaseError, match="not a table of text"):
        preflight(said(TABLE | {"file": "noise.csv"}))
    sheared = table(shears=(0.0, 0.1))
    with pytest.raises(InvalidCaseError, match="is given twice"):
        preflight(said(TABLE | {"prestrain": [{"shear": 0.1}]}, sheared))
    with pytest.raises(InvalidCaseError, match="this modulus is for one of them"):
        preflight(said(ZENER | {"prestrain": [{"shear": 0.1, "loss_factor": TABLE}]}, sheared))
    with pytest.raises(InvalidCaseError, match="only the loss of a film"):
        case = said(0.2, sheared).varied({"materials.woven-carbon.loss_factor": TABLE})
        preflight(case)
    hot = {"temperature": "-90 degC", "shift": WLF}
    with pytest.raises(InvalidCaseError, match="the WLF shift ends at"):
        preflight(said(ZENER | hot))
    for law in (
        WLF | {"c1": 900.0},
        {"law": "arrhenius", "energy": "9 MJ/mol", "reference": "0 degC"},
    ):
        with pytest.raises(InvalidCaseError, match=r"loss_factor\.temperature.*shifts"):
            preflight(said(ZENER | {"temperature": "-80 degC", "shift": law}))


def test_columns_in_any_order_and_unit(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text(
        "loss modulus [kPa],storage modulus [MPa],frequency [kHz]\n200,1,0.1\n100,2,0.01\n"
    )
    (found,) = read_moduli(file)
    assert found.frequency.tolist() == [10.0, 100.0]
    assert found.modulus == pytest.approx(np.array([2e6 + 1e5j, 1e6 + 2e5j]))


# --- in a system, on a plate with a film ----------------------------------------------------------


def plate_modes(found: tuple[Modulus, ...], case: Case) -> np.ndarray:
    """Complex frequencies [rad/s] of the damped modes of the bent plate in vacuo."""
    structure, state = plate(), bent_plate()
    tangent = compute_tangent(structure, state)
    operators = dry_operators(
        stiffness=tangent.stiffness(),
        mass=tangent.mass,
        free=tangent.free,
        displacements=structure.forms.n_displacement,
        loss=dict(loss_parts(case, found, structure, state, tangent)),
    )
    real = dry_modes(operators, 250.0, moduli_at=160.0)
    damped = complex_modes(operators, real, (1.0, 250.0), tolerance=1e-6)
    assert damped.converged.all()
    return np.asarray(damped.omega)


def test_modes_have_the_modulus_of_their_own_frequency(said) -> None:
    case = said(ZENER)
    omega = plate_modes(moduli(case), case)
    k = 1  # its frequency is not that of the real modes' moduli
    g = RUBBER(complex(omega[k]))
    fixed = plate_modes((Modulus("film", "constant", lambda _: g),), case)
    assert fixed[k] == pytest.approx(omega[k], rel=1e-6)
    assert fixed[0] != pytest.approx(omega[0], rel=1e-2)
    # with the modulus of the real frequency the loss is less by the dispersion, 2 % here
    g = RUBBER(complex(omega[k].real))
    fixed = plate_modes((Modulus("film", "constant", lambda _: g),), case)
    assert fixed[k].imag == pytest.approx(omega[k].imag, rel=0.03)


def test_the_same_model_at_all_shears_is_no_shear_at_all(said) -> None:
    case = said(ZENER)
    whole = plate_modes(moduli(case), case)
    entries = [{"shear": 0.01}, {"shear": 0.02}, {"shear": 0.05}]
    split = plate_modes(moduli(said(ZENER | {"prestrain": entries})), case)
    np.testing.assert_allclose(split, whole, rtol=1e-9)
    stiffer = [entry | {"factor": 1.5} for entry in entries]
    other = plate_modes(moduli(said(ZENER | {"prestrain": stiffer})), case)
    assert np.all(other.real > whole.real)


def test_parts_where_no_shear_is_are_left_out(said) -> None:
    structure = plate()
    found = moduli(said(ZENER | {"prestrain": [{"shear": 0.5}]}))
    state = structure.rest()
    tangent = compute_tangent(structure, state)
    parts = loss_parts(said(ZENER), found, structure, state, tangent)
    assert set(parts) == {"film at shear 0"}
    (part,) = parts.values()
    assert isinstance(part, Lossy)
    assert abs(part.matrix - tangent.film_isochoric_material).max() == 0.0
