"""A simulated model that heels, set or free, against point masses in the tank's frame."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.heel import Heel, HeelGauges, RollConstraint
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Acquisition, Digitiser
from sim.drive.prescribed_drive import DriveSettings
from sim.model.hull import HullCoefficients
from sim.rest import state_at_rest
from sim.rig import SimulatedRig, horizontal_rig
from sim.run import simulate, steady_run
from tests.exact.heeled import HeeledModel, HeeledRun

# Terms of each kind; magnitudes of a container ship's model of 3 m at 1.5 m/s.
TERMS = {
    "Y_phi": 6.0, "N_phi": -4.0, "K_phi": -3.0, "K_v": 18.0, "K_r": -5.0, "K_p": -2.5,
    "K_vdot": 6.0, "K_rdot": 1.0, "K_pdot": -0.8, "Y_p": 3.0, "Y_pdot": 5.0, "N_p": 0.7,
    "K_vvphi": -40.0, "Y_vphiphi": 90.0, "N_rphiphi": 20.0, "X_vphi": 7.0, "X_phiphi": -6.0,
    "K_vvv": 50.0, "K_rrr": -3.0,
}  # fmt: skip
MODEL = HeeledModel(
    np.array([20.0, 15.0, 15.0, 12.0, 8.0, 8.0]),
    np.array([
        [1.0, 0.0, 0.05], [-0.9, 0.15, 0.02], [-0.9, -0.15, 0.02],
        [0.1, 0.0, 0.12], [0.4, 0.2, -0.1], [0.4, -0.2, -0.1],
    ]),
    TERMS, gm_m=0.03, bm_m=0.06,
)  # fmt: skip
_MASS = MODEL.integral(0, 0, 0)
BODY = Body(
    _MASS,
    MODEL.integral(2, 0, 0) + MODEL.integral(0, 2, 0),
    MODEL.integral(1, 0, 0) / _MASS,
    MODEL.integral(0, 0, 1) / _MASS,
)
HEEL = Heel(
    RollConstraint.SET,
    inertia_kg_m2=MODEL.integral(0, 2, 0) + MODEL.integral(0, 0, 2),
    product_kg_m2=MODEL.integral(1, 0, 1),
    spread_kg_m2=MODEL.integral(0, 2, 0) - MODEL.integral(0, 0, 2),
    gm_m=MODEL.gm_m,
    bm_m=MODEL.bm_m,
)
CHANNELS = ("roll_moment", "heel_angle", "force_x")
POINT = SetPoint(0.25, 0.15, 2.0, 1.5, drift_rad=0.1, heel_rad=0.2)


def rig(heel: Heel | None = HEEL, **terms: float) -> SimulatedRig:
    perfect = {} if heel is None else {name: Digitiser() for name in CHANNELS}
    return replace(
        horizontal_rig(),
        drive=DriveSettings(initial_angle_rad=0.0),
        body=BODY,
        water=HullCoefficients(),
        acquisition=Acquisition(**perfect),
        heel=heel,
        heel_loads=TERMS | terms if heel is not None else {},
    )


def run_of(point: SetPoint, half_spacing_m: float) -> HeeledRun:
    omega = 2.0 * math.pi * point.frequency_hz

    def strut(phase: float):
        return lambda time: point.eccentricity_m * np.sin(omega * time + phase)

    return HeeledRun(
        MODEL, strut(0.0), strut(point.strut_phase_rad), half_spacing_m, point.carriage_speed_m_s,
        point.drift_rad, lambda time: point.heel_rad + 0.0 * np.asarray(time),
    )  # fmt: skip


def values(made: SimulatedRig, point: SetPoint, names: tuple[str, ...]) -> np.ndarray:
    spectra = steady_run(made, point, orders=24, points=256).spectra
    waves = np.exp(1j * np.outer(np.linspace(0, 2 * math.pi, 48, endpoint=False), np.arange(25)))
    return np.stack([(waves @ spectra[name]).real for name in names])


READ = ("force_x", "force_aft", "force_fore", "roll_moment", "heel_angle")


def loads_of(read: np.ndarray, exact: HeeledRun, time: np.ndarray, factor: float) -> np.ndarray:
    """Gauges of the model on its line; the fore attachment slides along it: its lever is longer."""
    half = exact.half_spacing_m
    x, aft, fore, roll, _ = read
    lever = 2.0 * half / np.cos(exact.heading(time) - exact.drift_rad) - half
    aft, fore = aft / factor, fore / factor
    return np.stack((x, aft + fore, lever * fore - half * aft, roll))


@pytest.mark.parametrize("gauges", list(HeelGauges))
def test_a_set_heel_asks_what_the_masses_ask(gauges: HeelGauges) -> None:
    made = rig(replace(HEEL, gauges=gauges))
    exact = run_of(POINT, made.oscillator.half_spacing_m)
    time = np.linspace(0.0, 4.0, 48, endpoint=False)
    factor = math.cos(0.2) if gauges is HeelGauges.HEELED else 1.0
    found = loads_of(values(made, POINT, READ), exact, time, factor)
    told = exact.struts(time)
    told[3] -= float(MODEL.righting(0.2))  # tared at rest there
    np.testing.assert_allclose(found, told, atol=2e-6 * np.abs(told).max())


def test_a_free_model_rolls_as_the_masses_do() -> None:
    free = replace(HEEL, held=RollConstraint.FREE)
    made, point = rig(free), replace(POINT, heel_rad=0.05)
    exact = run_of(point, made.oscillator.half_spacing_m)
    run = simulate(made, point, periods=1, settling_periods=0, sample_rate_hz=100.0, seed=1)
    times = np.arange(0.0, 1.01, 0.25)
    rolled = exact.rolled(0.05, 1.01, times)
    heel = run["heel_angle"].values[(times * 100).round().astype(int)]
    assert np.ptp(rolled) > 0.02
    np.testing.assert_allclose(heel, rolled, atol=1e-4)
    assert not run["roll_moment"].values.any()


def test_a_free_models_period_is_where_its_records_end() -> None:
    made = rig(replace(HEEL, held=RollConstraint.FREE), K_p=-25.0)
    point = replace(POINT, heel_rad=0.05, drift_rad=0.0)
    run = simulate(made, point, periods=1, settling_periods=6, sample_rate_hz=100.0, seed=1)
    heel = run["heel_angle"].values[:400]
    spectrum = np.fft.rfft(heel) / 400
    steady = steady_run(made, point, orders=24, points=256).spectra["heel_angle"]
    assert abs(spectrum[0] - steady[0].real) < 1e-4
    assert 2 * abs(spectrum[1]) == pytest.approx(abs(steady[1]), rel=1e-3)
    force = steady_run(made, point).spectra["force_aft"]
    assert 2 * abs(np.fft.rfft(run["force_aft"].values[:400])[1]) / 400 == pytest.approx(
        abs(force[1]), rel=1e-3
    )


def test_blocks_are_the_whole_run() -> None:
    chain = rig(replace(HEEL, held=RollConstraint.FREE)).chain(POINT)
    _, whole = chain.run(chain.start(50.0, 1), 120)
    state = chain.start(50.0, 1)
    parts = []
    for count in (1, 7, 112):
        state, part = chain.run(state, count)
        parts.append(part["recorded_heel_angle"])
    np.testing.assert_array_equal(np.concatenate(parts), whole["recorded_heel_angle"])


def test_a_tow_that_is_heeled_reads_its_terms() -> None:
    point = SetPoint(0.5, 0.0, carriage_speed_m_s=1.5, heel_rad=-0.1)
    found = state_at_rest(rig(), point).spectra
    mean = {name: float(found[name][0].real) for name in READ}
    assert mean["roll_moment"] == pytest.approx(-TERMS["K_phi"] * -0.1, rel=1e-9)
    total = mean["force_aft"] + mean["force_fore"]
    assert total == pytest.approx(-TERMS["Y_phi"] * -0.1, rel=1e-9)
    assert mean["heel_angle"] == -0.1


def test_what_is_missing_is_said() -> None:
    with pytest.raises(ConfigurationError, match=r"a heel angle, but \[heel\] is missing"):
        rig(None).chain(POINT)
    with pytest.raises(ConfigurationError, match=r"acquisition.roll_moment, but \[heel\] is miss"):
        replace(rig(), heel=None, heel_loads={}).chain(replace(POINT, heel_rad=0.0))
    with pytest.raises(ConfigurationError, match="K_phy means no term"):
        rig(K_phy=1.0).chain(POINT)
    with pytest.raises(ConfigurationError, match="needs inertia_kg_m2 and gm_m"):
        Heel(RollConstraint.FREE)
