"""The rig behind ``simulated.toml``: what ``rig.toml`` states, and only then something nominal."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import VERTICAL_1963
from sim.devices.bench_file import read_bench
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from tests.sim.devices.benches import ROOT

EXAMPLES = ROOT / "examples"
RIG = (EXAMPLES / "vertical" / "rig.toml").read_text(encoding="utf-8")
FORCE_X = """
[[forces]]
driver = "cia404-amplifier"
node = 6
channels = [{ name = "force_x", object = "9130:1", scale = 1e-3, full_scale = 200.0 }]
"""


def simulated(folder: Path, rig: str = RIG, own: str = "") -> SimulatedRig:
    (folder / "rig.toml").write_text(rig, encoding="utf-8")
    (folder / "simulated.toml").write_text(f'rig = "rig.toml"\n{own}', encoding="utf-8")
    return read_bench(folder / "simulated.toml").scene.rig


@pytest.mark.parametrize("name", ["vertical", "manual", "horizontal"])
def test_the_examples_state_the_nominal_rigs(name: str) -> None:
    nominal = horizontal_rig() if name == "horizontal" else vertical_rig()
    assert read_bench(EXAMPLES / name / "simulated.toml").scene.rig == nominal


positive = st.floats(0.1, 100.0)


@given(
    mass=positive,
    inertia=positive,
    spacing=st.floats(0.1, 2.0),
    rod=st.floats(0.2, 3.0),
    heave=st.floats(0.0, 1e4),
    full_scale=st.floats(1.0, 1e4),
    mark=st.floats(-3.0, 3.0),
)
def test_what_the_file_states_is_simulated(
    tmp_path_factory: pytest.TempPathFactory,
    mass: float,
    inertia: float,
    spacing: float,
    rod: float,
    heave: float,
    full_scale: float,
    mark: float,
) -> None:
    text = RIG[: RIG.index("[model]")].replace("full_scale = 500.0", f"full_scale = {full_scale!r}")
    text = text.replace("[oscillator]", f"[oscillator]\nhalf_spacing_m = {spacing!r}")
    text = text.replace("half_spacing_m", f"rod_length_m = {rod!r}\nhalf_spacing_m")
    text += f"[model]\nmass_kg = {mass!r}\ninertia_kg_m2 = {inertia!r}\n"
    text += f"[hull]\nrestoring = [[{heave!r}, 0.0], [0.0, 0.0]]\n"
    text += f"[reference]\nangle_offset_rad = {mark!r}\nlatency_s = 0.002\n"
    rig = simulated(tmp_path_factory.mktemp("rig"), text)
    assert (rig.body.mass_kg, rig.body.inertia_kg_m2, rig.body.cg_x_m) == (mass, inertia, 0.0)
    wanted = replace(VERTICAL_1963, half_spacing_m=spacing, rod_length_m=rod)
    assert rig.oscillator == wanted
    assert rig.water.restoring == ((heave, 0.0), (0.0, 0.0))
    assert not np.any(rig.water.added_mass), "not the nominal hull's: the file has a [hull]"
    assert rig.dynamometers.aft.full_scale_n == full_scale
    assert rig.acquisition.force_fore is not None
    assert rig.acquisition.force_fore.full_scale == full_scale
    assert rig.photocell is not None
    assert (rig.photocell.mark_angle_rad, rig.photocell.latency_s) == (mark, 0.002)


def test_its_own_tables_go_before_key_by_key(tmp_path: Path) -> None:
    own = (
        "[model]\nmass_kg = 80.0\n[acquisition.force_aft]\nnoise_rms = 0.2\n[surge]\nx_uu = -8.0\n"
    )
    rig = simulated(tmp_path, RIG + FORCE_X, own)
    assert (rig.body.mass_kg, rig.body.inertia_kg_m2) == (80.0, 27.5)
    assert rig.acquisition.force_aft is not None
    assert (rig.acquisition.force_aft.noise_rms, rig.acquisition.force_aft.full_scale) == (0.2, 500)
    assert rig.acquisition.force_x is not None, "the rig's amplifier has such a channel"
    assert rig.surge is not None
    assert rig.surge.x_uu == -8.0


def test_what_the_file_hands_on_is_simulated_too(tmp_path: Path) -> None:
    text = "[campaign.drive]\nspeed_error = 0.01\n[campaign.dynamometers.aft]\ngain = 1.02\n"
    text += "[campaign.acquisition]\nforce_fore = { noise_rms = 0.3 }\ncarriage_speed = false\n"
    rig = simulated(tmp_path, RIG + text)
    assert rig.drive.speed_error == 0.01
    assert (rig.dynamometers.aft.gain, rig.dynamometers.aft.full_scale_n) == (1.02, 500.0)
    assert rig.acquisition.force_fore is not None
    assert rig.acquisition.force_fore.noise_rms == 0.3
    assert rig.acquisition.force_fore.full_scale is None, "a sensor that is stated is stated whole"
    assert rig.acquisition.carriage_speed is None


def test_a_table_of_added_mass_is_fitted(tmp_path: Path) -> None:
    omega = np.linspace(0.5, 15.0, 60)
    rows = "\n".join(
        f"{w},{60.0 + 40.0 / (1.0 + w**2)},{40.0 * w**2 / (1.0 + w**2)}" for w in omega
    )
    text = f"omega_rad_s,a33_analytic_kg,b33_analytic_kg_s\n{rows}\n"
    (tmp_path / "heave.csv").write_text(text, encoding="utf-8")
    rig = simulated(tmp_path, RIG + '[campaign.radiation]\nfile = "heave.csv"\n')
    assert rig.radiation is not None
    added = rig.radiation.added_mass_infinite[0][0]
    assert added == pytest.approx(60.0, rel=0.02), "of K(t) = 40 exp(-t)"
    with pytest.raises(ConfigurationError, match="no such file"):
        simulated(tmp_path, RIG + '[campaign.radiation]\nfile = "none.csv"\n')


def test_without_an_oscillator_the_own_one_says_which_plane(tmp_path: Path) -> None:
    devices = RIG[RIG.index("[bus]") : RIG.index("[model]")]
    assert simulated(tmp_path, devices) == vertical_rig()
    own = '[oscillator]\npreset = "horizontal-1963"\n'
    assert simulated(tmp_path, devices, own) == horizontal_rig()


def test_a_wrong_key_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r"simulated.toml: model.mass is not a known key"):
        simulated(tmp_path, own="[model]\nmass = 3.0\n")
