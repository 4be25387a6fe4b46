"""Files in WAMIT's layout against the closed form of the memory that they were written from.

A kernel ``c exp(-alpha t)`` has the damping ``c alpha/(alpha² + w²)`` and takes ``c/(alpha² + w²)``
off the added mass at infinite frequency.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane
from sim.model.water.radiation_file import RadiationFile
from sim.model.water.wamit_file import FirstColumn

DENSITY_KG_M3, LENGTH_M, ALPHA = 1025.0, 2.0, 3.0
INFINITE = np.array([[60.0, -4.0], [6.0, 20.0]])  # no symmetry: rows are forces
STRENGTH = np.array([[900.0, 30.0], [-50.0, 200.0]])
OMEGA = np.array([0.0, *np.linspace(0.5, 12.0, 24)])
POWERS = np.array([[3, 4], [4, 5]])


def added_mass(omega: float) -> FloatArray:
    return np.asarray(INFINITE - STRENGTH / (ALPHA**2 + omega**2))


def damping(omega: float) -> FloatArray:
    return np.asarray(STRENGTH * ALPHA / (ALPHA**2 + omega**2))


def written(
    folder: Path,
    modes: tuple[int, int] = (3, 5),
    first: FirstColumn = FirstColumn.PERIOD,
    rows: tuple[str, ...] = (),
) -> Path:
    """Write it as by hand: both limits first, periods falling, surge beside."""
    unit = DENSITY_KG_M3 * LENGTH_M**POWERS
    lines = []
    for omega in (0.0, math.inf, *OMEGA[1:]):
        limit = omega == 0.0 or math.isinf(omega)
        period = (0.0 if omega else -1.0) if limit else 2.0 * math.pi / omega
        told = f"{period:.9E}"
        if first is FirstColumn.FREQUENCY:
            if math.isinf(omega):
                continue
            told = f"{omega:.9E}"
        lines.append(f" {told}     1     1   9.9E+00   9.9E+00")
        added = INFINITE if math.isinf(omega) else added_mass(omega)
        for i in range(2):
            for j in range(2):
                row = f" {told} {modes[i]:5d} {modes[j]:5d} {added[i, j] / unit[i, j]:.9E}"
                b = 0.0 if limit else damping(omega)[i, j] / unit[i, j] / omega
                lines.append(row if limit else f"{row} {b:.9E}")
    path = folder / "hull.1"
    path.write_text("\n".join([*lines, *rows]) + "\n")
    return path


def source(path: Path, **keys: object) -> RadiationFile:
    given = {"density_kg_m3": DENSITY_KG_M3, "length_m": LENGTH_M} | keys
    return RadiationFile(str(path), **given)  # type: ignore[arg-type]


def test_added_mass_and_damping_come_back(tmp_path: Path) -> None:
    table = source(written(tmp_path)).table(Plane.VERTICAL)
    assert table.omega_rad_s == pytest.approx(OMEGA, rel=1e-8)
    for at, omega in enumerate(OMEGA):
        assert table.added_mass[at] == pytest.approx(added_mass(omega), rel=1e-7)
        expected = damping(omega) if omega else np.zeros((2, 2))
        assert table.damping[at] == pytest.approx(expected, rel=1e-7)
    assert table.added_mass_infinite == pytest.approx(INFINITE, rel=1e-7)


def test_the_other_sense_of_rotation_turns_the_coupling(tmp_path: Path) -> None:
    table = source(written(tmp_path), rotation_sign=-1).table(Plane.VERTICAL)
    signs = np.array([[1.0, -1.0], [-1.0, 1.0]])
    assert table.added_mass_infinite == pytest.approx(INFINITE * signs, rel=1e-7)


def test_a_second_body_and_frequencies_for_periods(tmp_path: Path) -> None:
    path = written(tmp_path, (8, 12), FirstColumn.FREQUENCY)
    two = source(path, body="2", first_column=FirstColumn.FREQUENCY)
    table = two.table(Plane.HORIZONTAL)
    assert table.added_mass[0] == pytest.approx(added_mass(0.0), rel=1e-7)
    assert table.damping[5] == pytest.approx(damping(OMEGA[5]), rel=1e-7)
    assert table.added_mass_infinite is None
    with pytest.raises(DataError, match=r"no added mass of modes 2 and 6; .* modes 1, 8, 12"):
        source(path, first_column=FirstColumn.FREQUENCY).table(Plane.HORIZONTAL)


def test_what_symmetry_leaves_out_is_nothing(tmp_path: Path) -> None:
    path = tmp_path / "ship.1"
    path.write_text(
        "2.0 3 3 0.5 0.1\n1.0 3 3 0.4 0.2\n"
        "2.0 5 5 0.25 0.01\n1.0 5 5 0.2 0.02\n1.0 5 3 2e-17 1e-20\n"
    )
    table = RadiationFile(str(path), density_kg_m3=1000.0).table(Plane.VERTICAL)
    assert table.omega_rad_s == pytest.approx([math.pi, 2.0 * math.pi])
    assert table.added_mass[0] == pytest.approx(np.diag([500.0, 250.0]))
    assert table.added_mass[1, 1, 0] == 0.0
    assert table.damping[1] == pytest.approx(2.0 * math.pi * np.diag([200.0, 20.0]))


def test_the_memory_is_that_of_the_kernel(tmp_path: Path) -> None:
    """A passive one: the coupling of the file above has no energy to give."""
    path = tmp_path / "heave.1"
    rows = []
    for omega in OMEGA[1:]:
        a, b = added_mass(omega)[0, 0], damping(omega)[0, 0]
        told = 2.0 * math.pi / omega
        rows.append(f"{told:.9E} 3 3 {a / DENSITY_KG_M3:.9E} {b / DENSITY_KG_M3 / omega:.9E}")
    path.write_text("\n".join(rows) + "\n")
    memory = RadiationFile(str(path), density_kg_m3=DENSITY_KG_M3).fitted(Plane.VERTICAL)
    assert memory.error < 0.01


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (("1.0 3 3 0.5 0.1",) * 2, "line 132: modes 3 and 3 at 6.28319 rad/s are there twice"),
        (("1.0 3 heave 0.5 0.1",), r"line 131: '1.0 3 heave 0.5 0.1' is no row of a WAMIT .1"),
        (("1.0 3 5 ***** 0.1",), "line 131.*period, two modes, added mass and damping"),
        (("1.0 3",), "line 131"),
        (("1.0 3 3 0.5",), "line 131"),
    ],
)
def test_wrong_rows_are_named(tmp_path: Path, rows: tuple[str, ...], said: str) -> None:
    path = written(tmp_path, rows=rows)
    with pytest.raises(DataError, match=said):
        source(path).table(Plane.VERTICAL)


def test_what_has_to_be_stated_is_asked_for(tmp_path: Path) -> None:
    path = written(tmp_path)
    with pytest.raises(DataError, match="state density_kg_m3, of the water"):
        RadiationFile(str(path)).table(Plane.VERTICAL)
    with pytest.raises(DataError, match="body 'hull'; bodies of a WAMIT file are counted from 1"):
        source(path, body="hull").table(Plane.VERTICAL)
