"""What the simulation believes reaches the rig, and is refused where it is wrong."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.motor import Servo, ShuntMotor
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from sim.drive.carriage import CarriageSettings, Fluctuation
from sim.mechanism.linkage import Setting
from sim.model.friction import Coulomb
from sim.model.law_point import Acting, Point
from sim.model.laws import Quadratic
from sim.model.mounting import Mounting
from sim.model.water.force_laws import CrossFlow
from sim.run import steady_run

BASE = """
[oscillator]
preset = "{plane}-1963"

[model]
mass_kg = 70.0
inertia_kg_m2 = 27.5

[[runs]]
name = "one"
frequency_hz = 0.8
eccentricity_mm = 20.0
"""
EVERYTHING = """
[carriage]
speed_error = 0.01
fluctuations = [{ relative = 0.002, frequency_hz = 0.3 }]

[linkage_aft]
slot_tilt_rad = 0.01

[linkage_fore]
eccentricity_error_m = 1e-4

[mounting]
gauge_stiffness_n_m = 2e5

[cross_flow]
cubic = [[10.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 2.0]]

[[forces]]
law = { coulomb_n = 0.4 }
point = "aft"

[[forces]]
law = { quadratic_n_s2_m2 = 200.0 }
in_water = true
"""
# A memory of two states, i w G/(w_0^2 - w^2 + 2 i zeta w_0 w): B + i w (A - A_inf).
OMEGA = np.linspace(0.5, 15.0, 30)
DAMPING = 400.0 * OMEGA**2 * 2.0 * 0.7 * 4.0 / ((16.0 - OMEGA**2) ** 2 + (5.6 * OMEGA) ** 2)
ADDED = 60.0 + 400.0 * (16.0 - OMEGA**2) / ((16.0 - OMEGA**2) ** 2 + (5.6 * OMEGA) ** 2)


def write(folder: Path, text: str, plane: str = "vertical") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "campaign.toml"
    path.write_text(BASE.format(plane=plane) + text, encoding="utf-8")
    return path


def heave_table(folder: Path) -> None:
    rows = [f"{w},{a},{b}" for w, a, b in zip(OMEGA, ADDED, DAMPING, strict=True)]
    head = "omega_rad_s,a33_analytic_kg,b33_analytic_kg_s"
    (folder / "heave.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


def test_every_table_reaches_the_rig(tmp_path: Path) -> None:
    rig = read_campaign(write(tmp_path, EVERYTHING)).rig()
    assert rig.carriage == CarriageSettings(0.01, (Fluctuation(0.002, 0.3),))
    assert rig.linkage_aft == Setting(slot_tilt_rad=0.01)
    assert rig.linkage_fore == Setting(eccentricity_error_m=1e-4)
    assert rig.mounting == Mounting(gauge_stiffness_n_m=2e5)
    assert rig.cross_flow == CrossFlow(((10.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 2.0)))
    assert rig.forces == (
        Acting(Coulomb(0.4), Point.AFT),
        Acting(Quadratic(200.0), in_water=True),
    )
    assert np.isfinite(steady_run(rig, SetPoint(0.8, 0.02)).spectra["force_aft"]).all()


def test_a_motor_is_told_by_its_keys(tmp_path: Path) -> None:
    servo = read_campaign(write(tmp_path, "[drive.motor]\nconstant_n_m_a = 0.7\n"))
    shunt = read_campaign(write(tmp_path, "[drive.motor]\nresistance_ohm = 2.0\n"))
    assert servo.drive.motor == Servo(constant_n_m_a=0.7)
    assert shunt.drive.motor == ShuntMotor(resistance_ohm=2.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "[[forces]]\nlaw = { stifness_n_m = 5.0 }",
            r"forces\[1\]\.law\.stifness_n_m is not a known key; did you mean stiffness_n_m\?$",
        ),
        (
            '[[forces]]\nlaw = { coulomb_n = "much" }',
            r'forces\[1\]\.law\.coulomb_n = "much" should be a valid number$',
        ),
        (
            "[[forces]]\nlaw = { proximity_n = 1.0 }",
            r"forces\[1\]\.law\.clearance_m is missing$",
        ),
        (
            "[drive.motor]\nresistanc_ohm = 2.0",
            r"drive\.motor\.resistanc_ohm is not a known key; did you mean resistance_ohm\?$",
        ),
        (
            "[drive.motor]\nconstant_n_m_a = 1.0\nloop = { proportionl = 2.0 }",
            r"drive\.motor\.loop\.proportionl is not a known key; did you mean proportional\?$",
        ),
        (
            "[mounting]\ngauge_stiffness_n_m = -2.0",
            r"campaign\.toml: gauge_stiffness_n_m = -2 must be positive",
        ),
        (
            '[[effects]]\nname = "cable"\nparameters = { x = "y" }',
            r'effects\["cable"\]\.parameters\.x = "y" should be a valid number$',
        ),
        ("[simulation]\nwaiting_s = -1.0", r"simulation\.waiting_s = -1 should be 0 or more$"),
    ],
)
def test_a_wrong_key_is_one_clear_line(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=message) as refused:
        read_campaign(write(tmp_path, text))
    assert "\n" not in str(refused.value)


def test_a_table_of_added_mass_is_fitted_and_travels_along(tmp_path: Path) -> None:
    path = write(tmp_path / "a", '[radiation]\nfile = "heave.csv"\nstates = 4\n')
    with pytest.raises(ConfigurationError, match=r"heave\.csv.*no such file"):
        read_campaign(path).rig()
    heave_table(path.parent)
    rig = read_campaign(path).rig()
    assert rig.radiation is not None
    memory = rig.radiation.memory(OMEGA)[:, 0, 0]
    # B + i w (A - A_inf) of the table comes back.
    assert memory.real == pytest.approx(DAMPING, abs=0.01 * DAMPING.max())
    added = rig.radiation.added_mass_infinite[0, 0] + memory.imag / OMEGA
    assert added == pytest.approx(ADDED, rel=0.01)
    assert read_campaign(path).rig().radiation is rig.radiation
    out = tmp_path / "out"
    done = CliRunner().invoke(cli, ["simulate", str(path), "--output", str(out)])
    assert done.exit_code == 0, done.output
    assert (out / "heave.csv").read_bytes() == (path.parent / "heave.csv").read_bytes()
    again = ["simulate", str(out / "campaign.toml"), "--output", str(tmp_path / "again")]
    assert CliRunner().invoke(cli, again).exit_code == 0


def test_a_table_of_heave_is_of_no_use_in_sway(tmp_path: Path) -> None:
    path = write(tmp_path, '[radiation]\nfile = "heave.csv"\n', plane="horizontal")
    heave_table(tmp_path)
    with pytest.raises(DataError, match="heave alone is of no use to the horizontal"):
        read_campaign(path).rig()
