"""Oracles: changes of axes and scale by hand, and files against what was written into them."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from sim.model.water.memory import fit_memory
from sim.model.water.table_files import read_capytaine, read_heave_csv, read_hull_csv
from sim.model.water.tables import RadiationTable

OMEGA = np.array([0.5, 1.0, 2.0, 4.0])
# The dofs in an order of their own, as a dataset may have them.
DOFS = ["Yaw", "Heave", "Sway", "Pitch", "Roll"]


def table(plane: Plane = Plane.VERTICAL) -> RadiationTable:
    a = np.array([[[10.0 + w, 1.0], [1.0, 4.0]] for w in OMEGA])
    b = np.array([[[2.0 * w, 0.5], [0.5, 1.0]] for w in OMEGA])
    return RadiationTable(plane, OMEGA, a, b, name="made up")


def capytaine_dataset(omega: list[float]) -> xr.Dataset:
    """Number every coefficient by its indices: 100 radiating + 10 influenced + frequency."""
    n = len(DOFS)
    radiating = 100.0 * np.arange(n)[None, :, None] + 10.0 * np.arange(n)[None, None, :]
    values = radiating + np.arange(len(omega))[:, None, None]
    dims = ("omega", "radiating_dof", "influenced_dof")
    return xr.Dataset(
        {"added_mass": (dims, values), "radiation_damping": (dims, values + 0.5)},
        coords={
            "omega": omega,
            "radiating_dof": DOFS,
            "influenced_dof": DOFS,
            "water_depth": np.inf,
            "rho": 1000.0,
            "forward_speed": 0.0,
        },
    )


@pytest.mark.parametrize("plane", list(Plane))
def test_capytaine_columns_are_radiating_and_rows_influenced(tmp_path: Path, plane: Plane) -> None:
    path = tmp_path / "hull.nc"
    capytaine_dataset([2.0, 1.0, np.inf]).to_netcdf(path, engine="h5netcdf")
    read = read_capytaine(path, plane)
    first, second = (
        DOFS.index(d) for d in {Plane.VERTICAL: ("Heave", "Pitch")}.get(plane, ("Sway", "Yaw"))
    )
    expected = np.array(
        [
            [100.0 * first + 10.0 * first, 100.0 * second + 10.0 * first],
            [100.0 * first + 10.0 * second, 100.0 * second + 10.0 * second],
        ]
    )
    np.testing.assert_array_equal(read.omega_rad_s, [1.0, 2.0])
    np.testing.assert_array_equal(read.added_mass, [expected + 1.0, expected])
    np.testing.assert_array_equal(read.damping, [expected + 1.5, expected + 0.5])
    np.testing.assert_array_equal(read.added_mass_infinite, expected + 2.0)


def test_half_a_turn_about_x_leaves_every_matrix_of_a_plane_as_it_is() -> None:
    """x forward, y port, z up to x forward, y starboard, z down: Q (6 x 6) from the rotation."""
    turn = np.diag([1.0, -1.0, -1.0])
    q = np.kron(np.eye(2), turn)  # vectors and axial vectors turn alike
    matrix = np.random.default_rng(1).normal(size=(6, 6))
    ours = q @ matrix @ q.T
    for plane in ([2, 4], [1, 5]):
        np.testing.assert_array_equal(ours[np.ix_(plane, plane)], matrix[np.ix_(plane, plane)])


def test_rotation_sign_changes_the_coupling_alone(tmp_path: Path) -> None:
    path = tmp_path / "hull.nc"
    capytaine_dataset([1.0]).to_netcdf(path, engine="h5netcdf")
    as_is, turned = (read_capytaine(path, Plane.VERTICAL, sign) for sign in (1, -1))
    signs = [[1.0, -1.0], [-1.0, 1.0]]
    np.testing.assert_array_equal(turned.added_mass, as_is.added_mass * signs)
    with pytest.raises(DataError, match="rotation_sign = 2"):
        read_capytaine(path, Plane.VERTICAL, 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.drop_vars("added_mass"), "added_mass missing from what Capytaine writes"),
        (lambda d: d.assign_coords(forward_speed=1.2), r"forward_speed is 1\.2 m/s"),
        (lambda d: d.sel(radiating_dof=["Sway", "Yaw"]), "radiating_dof 'Heave' is not one of"),
        (lambda d: d.expand_dims(water_depth=[1.0, 2.0]), "water_depth"),
    ],
)
def test_capytaine_files_that_do_not_serve(tmp_path: Path, change, message: str) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "hull.nc"
    dataset = capytaine_dataset([1.0, 2.0])
    if "water_depth" in message:
        dataset = dataset.drop_vars("water_depth")
    change(dataset).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(DataError, match=message):
        read_capytaine(path, Plane.VERTICAL)


HEADING = "body,freq_hz,omega_rad_s,radiating_dof,influenced_dof,added_mass_SI,damping_SI\n"


def rows(body: str, values: str = "{a},{b}") -> str:
    text = ""
    for w in (1.0, 2.0):
        for i, motion in enumerate(("Heave", "Pitch")):
            for j, force in enumerate(("Heave", "Pitch")):
                both = values.format(a=1 + i + j * (i + 1) + w, b=0.5 * (i == j))
                text += f"{body},{w / 6.28},{w},{motion},{force},{both}\n"
    return text


def test_hull_csv_against_what_was_written(tmp_path: Path) -> None:
    path = tmp_path / "hulls.csv"
    path.write_text(HEADING + rows("one") + rows("two", "7,1"))
    read = read_hull_csv(path, Plane.VERTICAL, "one")
    np.testing.assert_array_equal(read.added_mass[0], [[2.0, 3.0], [3.0, 5.0]])
    with pytest.raises(DataError, match="body None is not one of one, two"):
        read_hull_csv(path, Plane.VERTICAL)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("damping_SI", "damping", "no column damping_SI"),
        ("one,0.3184713375796178,2.0,Pitch,Pitch,6,0.5\n", "", "miss at 2 rad/s"),
        ("2.0,Pitch,Heave", "1.0,Pitch,Heave", "line 8: Pitch, Heave at 1 rad/s is there twice"),
        ("Heave,Heave,2.0,0.5", "Heave,Heave,nan,0.5", "line 2: added_mass_SI is 'nan'"),
        ("Heave,Heave,2.0,0.5", "Heave,Heave,2.0,-0.5", r"damping of the translation is -0\.5"),
    ],
)
def test_hull_csv_that_does_not_serve(tmp_path: Path, old: str, new: str, message: str) -> None:
    path, text = tmp_path / "hulls.csv", HEADING + rows("one")
    if old.startswith("one,"):
        old = next(line + "\n" for line in text.splitlines() if "2.0,Pitch,Pitch" in line)
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(DataError, match=message):
        read_hull_csv(path, Plane.VERTICAL)


def test_heave_csv_with_comments(tmp_path: Path) -> None:
    path = tmp_path / "sphere.csv"
    path.write_text("# R = 1 m\nomega_rad_s,a,b\n1.0,10,2\n2.0,8,3\n")
    read = read_heave_csv(path, "a", "b")
    np.testing.assert_array_equal(read.added_mass[:, 0, 0], [10.0, 8.0])
    assert not read.damping[:, 1].any()
    with pytest.raises(DataError, match="no column a33_analytic_kg"):
        read_heave_csv(path)


def test_froude_scaling() -> None:
    """Model to ship, 1 to 25 in salt water: masses 25^3, moments 25^4 and 25^5, w 1/5."""
    ship = table().froude_scaled(25.0, 1.025)
    powers = np.array([[3.0, 4.0], [4.0, 5.0]])
    np.testing.assert_allclose(ship.omega_rad_s, OMEGA / 5.0)
    np.testing.assert_allclose(ship.added_mass, table().added_mass * 1.025 * 25.0**powers)
    np.testing.assert_allclose(ship.damping, table().damping * 1.025 * 25.0 ** (powers - 0.5))
    with pytest.raises(ConfigurationError, match="length_ratio = 0"):
        table().froude_scaled(0.0)


def test_asymmetry_is_measured_averaged_or_refused() -> None:
    made = table()
    lopsided = RadiationTable(
        made.plane,
        OMEGA,
        made.added_mass + 0.1 * np.eye(2)[:, ::-1] * np.tri(2).T,
        made.damping,
        name="lopsided",
    )
    assert lopsided.asymmetry() == pytest.approx(0.1 / np.sqrt(14.0 * 4.0))
    np.testing.assert_allclose(lopsided.symmetrised().added_mass[:, 0, 1], 1.05)
    with pytest.raises(DataError, match=r"lopsided: .* differ by 1\.34% .*limit 1\.00%"):
        lopsided.symmetrised(0.01)


def test_tables_that_cannot_be() -> None:
    a, b = table().added_mass, table().damping
    with pytest.raises(DataError, match="have to rise"):
        RadiationTable(Plane.VERTICAL, OMEGA[::-1], a, b)
    with pytest.raises(DataError, match=r"damping has shape \(3, 2, 2\); \(4, 2, 2\)"):
        RadiationTable(Plane.VERTICAL, OMEGA, a, b[:3])
    with pytest.raises(DataError, match="4 of 16 values of added_mass are not finite"):
        RadiationTable(Plane.VERTICAL, OMEGA, np.where(a == 4.0, np.nan, a), b)
    with pytest.raises(DataError, match="4 frequencies above 0, too few for 6 states"):
        fit_memory(table(), 6)
    with pytest.raises(ConfigurationError, match="states = 13 must be 2 to 12"):
        fit_memory(table(), 13)
