"""Oracle: the closed forms of scotch yoke and crank, their series, and exact differentiation."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import VERTICAL_1963, Plane
from hardware.description.setpoint import SetPoint
from hardware.description.struts import to_motion
from sim.mechanism.linkage import Mechanism, Setting
from sim.rig import horizontal_rig, vertical_rig
from sim.signals import Signals
from sim.stage import Block

E, L = 0.12, 0.6


def harmonics(values: FloatArray) -> np.ndarray:
    """Complex coefficients of a whole period: values = Re sum c_n exp(i n theta)."""
    spectrum = np.fft.rfft(values) / values.size
    spectrum[1:] *= 2.0
    return spectrum


def one_turn(samples: int = 512) -> FloatArray:
    return 2.0 * math.pi * np.arange(samples) / samples


@pytest.mark.parametrize("phase", [0.0, 0.7, math.pi])
def test_scotch_yoke_motion_is_a_pure_sine(phase: float) -> None:
    rig, set_point = vertical_rig(), SetPoint(0.8, 0.04, strut_phase_rad=phase)
    chain = rig.chain(set_point)
    _, run = chain.run(chain.start(200.0, seed=1), 1000)
    omega, angle = 2.0 * math.pi * 0.8, run["shaft_angle"]
    for strut, lead in (("aft", 0.0), ("fore", phase)):
        sine, cosine = np.sin(angle + lead), np.cos(angle + lead)
        np.testing.assert_allclose(run[f"displacement_{strut}"], 0.04 * sine, atol=1e-15)
        np.testing.assert_allclose(run[f"velocity_{strut}"], 0.04 * omega * cosine, atol=1e-14)
        np.testing.assert_allclose(
            run[f"acceleration_{strut}"], -0.04 * omega**2 * sine, atol=1e-13
        )


@pytest.mark.parametrize("plane", list(Plane))
def test_mean_and_difference_of_the_struts(plane: Plane) -> None:
    """mean = e cos(phi/2) sin(tau), (fore - aft)/2l = (e/l) sin(phi/2) cos(tau)."""
    rig = vertical_rig() if plane is Plane.VERTICAL else horizontal_rig()
    phi, e, half_spacing = 1.1, 0.05, rig.oscillator.half_spacing_m
    chain = rig.chain(SetPoint(0.5, e, strut_phase_rad=phi))
    _, run = chain.run(chain.start(100.0, seed=1), 400)
    translation, rotation = to_motion(
        run["displacement_aft"], run["displacement_fore"], half_spacing, plane
    )
    tau = run["shaft_angle"] + phi / 2.0
    bow = -1.0 if plane is Plane.VERTICAL else 1.0
    np.testing.assert_allclose(translation, e * math.cos(phi / 2) * np.sin(tau), atol=1e-15)
    expected = bow * (e / half_spacing) * math.sin(phi / 2) * np.cos(tau)
    np.testing.assert_allclose(rotation, expected, atol=1e-15)


def test_crank_has_the_second_harmonic_of_its_series() -> None:
    """Terms of sqrt(L^2 - e^2 cos^2 th) up to the sixth power of the cosine."""
    ratio = E / L
    c = harmonics(Mechanism(E, rod_length_m=L).displacement(one_turn())[0])
    assert c[1] == pytest.approx(-1j * E, abs=1e-15)
    second = -E * (ratio / 4 + ratio**3 / 16 + 15 * ratio**5 / 512)
    fourth = -E * (ratio**3 / 64 + 6 * ratio**5 / 512)
    assert c[2] == pytest.approx(second, abs=E * ratio**7)
    assert c[4] == pytest.approx(fourth, abs=E * ratio**7)
    assert np.abs(c[3]) < 1e-15


@pytest.mark.parametrize("rod", [10.0, 100.0])
def test_long_rod_tends_to_the_first_order_term(rod: float) -> None:
    c = harmonics(Mechanism(E, rod_length_m=rod).displacement(one_turn())[0])
    first_order = -(E**2) / (4.0 * rod)
    assert c[2].real == pytest.approx(first_order, rel=(E / rod) ** 2)
    assert c[0].real == pytest.approx(first_order, rel=(E / rod) ** 2)


def test_second_harmonic_of_acceleration_is_e_over_l() -> None:
    c = harmonics(Mechanism(E, rod_length_m=20.0).displacement(one_turn())[2])
    assert abs(c[2]) / abs(c[1]) == pytest.approx(E / 20.0, rel=1e-4)


def test_crank_derivatives_are_those_of_its_fourier_series() -> None:
    angle = one_turn()
    displacement, slope, curvature = Mechanism(E, rod_length_m=L).displacement(angle)
    orders = 1j * np.arange(angle.size // 2 + 1)
    spectrum = np.fft.rfft(displacement)
    np.testing.assert_allclose(slope, np.fft.irfft(orders * spectrum), atol=1e-12)
    np.testing.assert_allclose(curvature, np.fft.irfft(orders**2 * spectrum), atol=1e-11)


def test_chain_rule_holds_while_the_shaft_speeds_up() -> None:
    """Displacement against th = t^3: velocity and acceleration are exact, not differenced."""
    mechanism = Mechanism(E, strut_phase_rad=0.4, rod_length_m=L)
    t = np.linspace(0.0, 2.0, 50)
    step = 1e-30  # complex step: an exact derivative of an analytic function

    def strut(time: np.ndarray, lead: float) -> np.ndarray:
        th = time**3 + lead
        return E * np.sin(th) + np.sqrt(L**2 - (E * np.cos(th)) ** 2) - L

    def run(time: np.ndarray) -> Signals:
        shaft = {"shaft_angle": time**3, "shaft_speed": 3 * time**2, "shaft_acceleration": 6 * time}
        return mechanism.run(None, Block(0, time.size, 25.0), shaft)[1]

    out, beside = run(t), run(t + 1j * step)
    for name, lead in (("aft", 0.0), ("fore", 0.4)):
        velocity = strut(t + 1j * step, lead).imag / step
        np.testing.assert_allclose(out[f"velocity_{name}"], velocity, atol=1e-13)
        acceleration = beside[f"velocity_{name}"].imag / step
        np.testing.assert_allclose(out[f"acceleration_{name}"], acceleration, atol=1e-11)


def test_rod_shorter_than_the_crank_is_refused() -> None:
    with pytest.raises(ConfigurationError, match=r"rod_length_m = 0\.1 .*0\.12"):
        Mechanism(0.12, rod_length_m=0.1)
    with pytest.raises(ConfigurationError, match=r"rod_offset_m = 0\.05: the crank could not turn"):
        Mechanism(0.12, rod_length_m=0.15, fore=Setting(rod_offset_m=-0.05))
    short = replace(vertical_rig(), oscillator=replace(VERTICAL_1963, rod_length_m=0.03))
    with pytest.raises(ConfigurationError, match="rod_length_m"):
        short.chain(SetPoint(1.0, 0.05))
