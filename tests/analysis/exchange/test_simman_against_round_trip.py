"""Deliverables out and in again are the same, and hold what theory says of the motion."""

from pathlib import Path

import numpy as np
import pytest

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors
from analysis.exchange.simman import (
    Deliverables,
    SimmanDescription,
    cycle_of,
    deliverables_of,
    fourier,
)
from analysis.exchange.simman_files import read_simman, write_simman
from analysis.kinematics.body_frame import CHANNELS, UNITS
from hardware.description.arrangement import Arrangement, DriftBy, Joint
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import struts_of
from tests.exact.rigs import exact_rig

ORDERS, SPEED, FREQUENCY = 3, 1.2, 0.2
ABOUT = SimmanDescription(
    "yaw-1", "autumn", 45.7, 7.0, 3085.0, 9700.0, -0.02, 17.5, 998.7, 200.0, 5
)  # fmt: skip


def cycle(
    plane: Plane = Plane.HORIZONTAL, *, drift_rad: float = 0.0, surge: bool = True
) -> BodyCycle:
    generator = np.random.default_rng(4)
    channels = CHANNELS if surge else CHANNELS[:-1]
    sizes = np.array([0.1, 0.15, 0.02, 0.3, 30.0, 12.0, 9.0])[: len(channels)]
    draws = generator.standard_normal((2, ORDERS + 1, len(channels)))
    draws[1, 0] = 0.0  # means are real
    values = (draws[0] + 1j * draws[1]) * sizes / (1 + np.arange(ORDERS + 1)[:, None]) ** 2
    values[0, 2] += SPEED
    units = UNITS[: len(channels)] * (ORDERS + 1)
    phasors = Phasors.of(labels(channels, ORDERS), units, values.ravel())
    return BodyCycle("yaw-1", plane, 0.5, FREQUENCY, SPEED, phasors, ORDERS, drift_rad=drift_rad)


def turned(drift_rad: float) -> BodyCycle:
    """A turntable that sways across the tank, exact to rounding."""
    table = Arrangement(Joint.YAW_TABLE, drift_by=DriftBy.STRUTS_OFFSET)
    rig = exact_rig(Plane.HORIZONTAL, table, rotation_rad=0.3, drift_rad=drift_rad, speed_m_s=SPEED)
    return struts_of(rig, "yaw-1", 25).model()


@pytest.mark.parametrize("plane", list(Plane))
@pytest.mark.parametrize("surge", [True, False])
def test_out_and_in_is_the_same(tmp_path: Path, plane: Plane, surge: bool) -> None:
    before = deliverables_of(cycle(plane, drift_rad=0.1, surge=surge), ABOUT)
    after = read_simman(write_simman(before, tmp_path / "yaw-1"))
    assert after.description == ABOUT
    assert (after.plane, after.speed_m_s, after.drift_rad) == (plane, SPEED, 0.1)
    assert after.frequency_hz == FREQUENCY
    assert list(after.columns) == [name for name in after.columns if name in before.columns]
    for name, values in before.columns.items():
        np.testing.assert_array_equal(after.columns[name], values)
    for name in before.mean:
        assert after.mean[name] == before.mean[name]
        np.testing.assert_array_equal(after.sine[name], before.sine[name])
        np.testing.assert_array_equal(after.cosine[name], before.cosine[name])


@pytest.mark.parametrize("plane", list(Plane))
def test_deliverables_give_the_cycle_back(plane: Plane) -> None:
    own = cycle(plane)
    found = cycle_of(deliverables_of(own, ABOUT))
    for name in own.phasors.names:
        expected = own.phasors.values[own.phasors.index(name)]
        assert found.phasors[name] == pytest.approx(expected, rel=1e-12, abs=1e-12), name


def test_the_loads_are_the_opposite_of_what_struts_exert() -> None:
    own = cycle()
    found = deliverables_of(own, ABOUT)
    force = own.phasors.values[own.phasors.index("force 1")]
    assert found.sine["Y"][0] == -force.real
    assert found.cosine["Y"][0] == -force.imag


def differences(one: Deliverables, name: str) -> np.ndarray:  # type: ignore[type-arg]
    """Slope of a periodic column, exact for its harmonics."""
    values, step = one.columns[name], one.columns["t"][1]
    waves = np.fft.rfft(values)
    return np.fft.irfft(2j * np.pi * np.fft.rfftfreq(len(values), step) * waves, len(values))


@pytest.mark.parametrize(
    ("plane", "pairs"),
    [
        (Plane.HORIZONTAL, [("psi", "r"), ("v", "dv/dt"), ("r", "dr/dt"), ("u", "du/dt")]),
        (Plane.VERTICAL, [("theta", "q"), ("w", "dw/dt"), ("q", "dq/dt"), ("u", "du/dt")]),
    ],
)
def test_rates_are_the_slopes(plane: Plane, pairs: list[tuple[str, str]]) -> None:
    one = deliverables_of(cycle(plane, drift_rad=0.15), ABOUT, samples=512)
    for name, rate in pairs:
        size = np.abs(one.columns[rate]).max()
        np.testing.assert_allclose(one.columns[rate], differences(one, name), atol=1e-9 * size)


def test_velocities_are_those_through_the_water() -> None:
    """u = U cos psi + y' sin psi, v = -U sin psi + y' cos psi, psi with the drift."""
    one = deliverables_of(turned(0.12), ABOUT)
    heading, pace = 0.12 + one.columns["psi"], differences(one, "y")
    along = SPEED * np.cos(heading) + pace * np.sin(heading)
    across = pace * np.cos(heading) - SPEED * np.sin(heading)
    np.testing.assert_allclose(one.columns["u"], along, atol=1e-12)
    np.testing.assert_allclose(one.columns["v"], across, atol=1e-12)


def test_another_tanks_cycle_without_fourier_file(tmp_path: Path) -> None:
    before = deliverables_of(cycle(), ABOUT)
    folder = write_simman(before, tmp_path / "run")
    (folder / "fourier.dat").unlink()
    after = read_simman(folder)
    for name, own in before.sine.items():
        size = max(1e-12, float(np.abs(own).max()))
        np.testing.assert_allclose(after.sine[name][:ORDERS], own, atol=1e-12 * max(1, size))
        np.testing.assert_allclose(after.sine[name][ORDERS:], 0.0, atol=1e-11 * max(1, size))
    mean, _, _ = fourier(before.columns)
    assert mean["Y"] == pytest.approx(before.mean["Y"])


def spoiled(folder: Path, file: str, old: str, new: str) -> None:
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        ("description.txt", "frequency_hz = 0.2", "", r"description\.txt: frequency_hz is missing"),
        ("description.txt", "speed_m_s = 1.2", "speed_m_s = fast", "'fast' is not a number"),
        ("description.txt", "horizontal", "sideways", "plane = 'sideways'; it is"),
        ("cycle.dat", "  psi", "  phi", "no column psi"),
        ("cycle.dat", "0.0000000000000000e+00", "nan", "line 4: a value is not finite"),
        ("cycle.dat", "0.0000000000000000e+00", "one", "line 4: not all of"),
        ("cycle.dat", "0.0000000000000000e+00", "", "row 2: 1[0-9] values, "),
    ],
)
def test_spoiled_files_are_named(
    tmp_path: Path, file: str, old: str, new: str, message: str
) -> None:
    folder = write_simman(deliverables_of(cycle(), ABOUT), tmp_path / "run")
    spoiled(folder, file, old, new)
    with pytest.raises(DataError, match=message):
        read_simman(folder)


@pytest.mark.parametrize("name", ["u", "v"])
def test_a_cycle_without_a_velocity_is_refused(tmp_path: Path, name: str) -> None:
    folder = write_simman(deliverables_of(cycle(), ABOUT), tmp_path / "run")
    (folder / "fourier.dat").unlink()
    spoiled(folder, "cycle.dat", f" {name} ", f" {name}2 ")
    with pytest.raises(DataError, match=f"yaw-1: {name} is not among the deliverables"):
        cycle_of(read_simman(folder))


def test_nothing_is_lost(tmp_path: Path) -> None:
    one = deliverables_of(cycle(), ABOUT)
    write_simman(one, tmp_path)
    with pytest.raises(DataError, match=r"cycle\.dat, fourier\.dat, description\.txt there"):
        write_simman(one, tmp_path)
    write_simman(one, tmp_path, overwrite=True)
    with pytest.raises(DataError, match="no such file"):
        read_simman(tmp_path / "elsewhere")
