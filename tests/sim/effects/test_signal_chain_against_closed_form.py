"""Effects of the signal chain against closed forms: periodic where they are, else in time."""

import numpy as np
import pytest

from hardware.description.setpoint import Medium, SetPoint
from sim.effects.a1_amplifier_lag import AmplifierLag
from sim.effects.a2_channel_skew import ChannelSkew
from sim.effects.a3_photocell_angle import PhotocellAngle
from sim.effects.a4_photocell_delay import PhotocellDelay
from sim.effects.a5_trigger_jitter import TriggerJitter
from sim.effects.a6_missed_pulse import MissedPulse
from sim.effects.a7_late_gate import LateGate
from sim.effects.a8_hum import Hum
from sim.effects.effect import Effect, Signature
from sim.effects.situation import RECORDED_FORCES, Situation
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from tests.sim.effects.against_theory import mismatch
from tests.sim.effects.in_time import InTime, between, by_cycles, in_time, lines

VERTICAL = vertical_rig().ideal()
CRANK = horizontal_rig(rod_length_m=1.5).ideal()
SET_POINTS = [
    SetPoint(frequency, amplitude, phase, speed, medium)
    for frequency in (0.4, 0.9)
    for amplitude in (0.01, 0.03)
    for phase in (0.0, np.pi / 2.0, np.pi)
    for speed, medium in ((0.0, Medium.WATER), (1.2, Medium.WATER), (0.0, Medium.AIR))
]
IN_TIME = [*((VERTICAL, one) for one in SET_POINTS[::7]), (CRANK, SET_POINTS[10])]


@pytest.mark.parametrize("rig", [VERTICAL, CRANK])
@pytest.mark.parametrize(
    "effect",
    [
        AmplifierLag(10.0),
        AmplifierLag(10.0, poles=4.0),
        ChannelSkew(0.0, 2e-3),
        ChannelSkew(5e-4, 1e-3),
        ChannelSkew(-3e-3, 0.0),
        ChannelSkew(-1e-3, 2e-3),
        PhotocellAngle(0.02),
        PhotocellAngle(-0.02),
        PhotocellDelay(2e-3),
        PhotocellDelay(-2e-3),
    ],
)
def test_signature(effect: Effect, rig: SimulatedRig) -> None:
    assert mismatch(effect, rig, SET_POINTS) < 1e-9


@pytest.mark.parametrize("late", [1, -1])
def test_first_order_of_lag_and_delay(late: int) -> None:
    """In the table's words: tau B w^2 a in phase, (M w^2 - C) tau w a in quadrature."""
    tau, set_point = 1e-4, SetPoint(0.9, 0.03)
    situation = Situation.of(VERTICAL, set_point)
    effect = AmplifierLag(1.0 / (2 * np.pi * tau)) if late == 1 else PhotocellDelay(tau)
    impedance = np.sum(situation.impedance(1), axis=1)  # of both struts in phase
    in_phase = impedance.imag * tau * situation.omega * 0.03
    quadrature = -impedance.real * tau * situation.omega * 0.03
    found = [effect.signature(situation)[name, 1] for name in RECORDED_FORCES]
    np.testing.assert_allclose(found, late * (in_phase + 1j * quadrature), rtol=2e-3)


def relative_gap(theory: Signature, nominal: InTime, found: dict[str, np.ndarray]) -> float:
    """Largest distance of cycle averages from the theory, forces and displacements apart."""
    worst = 0.0
    for quantity in ("force", "displacement"):
        own = {key: value for key, value in theory.items() if quantity in key[0]}
        gap = [
            found[name][order] - by_cycles(nominal, name)[order] - value
            for (name, order), value in own.items()
        ]
        worst = max(worst, float(np.linalg.norm(gap) / np.linalg.norm(list(own.values()))))
    return worst


@pytest.mark.sample(2)
@pytest.mark.parametrize("every", [3, 5, 20])
@pytest.mark.parametrize(("rig", "set_point"), IN_TIME)
def test_missed_pulses_in_the_time_domain(
    rig: SimulatedRig, set_point: SetPoint, every: int
) -> None:
    """Two rounds of pulses; on samples that fit the period the trapezoid rule is exact."""
    effect = MissedPulse(float(every))
    theory = effect.signature(Situation.of(rig, set_point))
    nominal = in_time(rig, set_point, 1, 64)
    run = in_time(effect.change(rig, set_point), set_point, 2 * every, 64)
    assert run.edges.size == 2 * (every - 1) + 1
    found = {name: by_cycles(run, name) for name, _ in theory}
    assert relative_gap(theory, nominal, found) < 1e-9


@pytest.mark.sample(2)
@pytest.mark.parametrize(("cycles", "fraction"), [(1, 0.4), (10, 0.1), (3, 0.75)])
@pytest.mark.parametrize(("rig", "set_point"), IN_TIME)
def test_late_gate_in_the_time_domain(
    rig: SimulatedRig, set_point: SetPoint, cycles: int, fraction: float
) -> None:
    """By the trapezoid rule at 2000 samples a period: (2 pi n/2000)^2/12 of each order."""
    effect = LateGate(fraction, float(cycles))
    theory = effect.signature(Situation.of(rig, set_point))
    nominal = in_time(rig, set_point, 1, 2000)
    run = in_time(effect.change(rig, set_point), set_point, cycles + 1, 2000)
    gate = run.edges[0], run.edges[cycles + 1]
    assert (gate[1] - gate[0]) * set_point.frequency_hz == pytest.approx(cycles + fraction)
    found = {name: between(run, name, *gate, cycles + fraction) for name, _ in theory}
    assert relative_gap(theory, nominal, found) < 1e-3


def test_late_gate_of_a_tenth_in_ten() -> None:
    """A tenth of a cycle too much in ten: 0.7 % at the first order, 0.3 % in the mean."""
    situation = Situation.of(VERTICAL, SetPoint(0.9, 0.03))
    theory = LateGate(0.1, 10.0).signature(situation)
    name = "recorded_displacement_aft"
    assert abs(theory[name, 1].real) / 0.03 == pytest.approx(0.0075, abs=2e-4)
    assert abs(theory[name, 0]) / 0.03 == pytest.approx(0.003, abs=2e-4)


def test_jitter_by_the_pulses() -> None:
    """Means over 40 000 cycles, each referred to its own pulse.

    A channel with one frequency shows a cycle's order n turned by n times the pulse's error. The
    real part of the mean scatters by n^2 sigma^2/sqrt(2 N), 0.7 % of the signature: 3 % is 4 sigma.
    """
    sigma, cycles, set_point = 0.03, 40_000, SetPoint(0.9, 0.03)
    effect = TriggerJitter(sigma)
    situation = Situation.of(VERTICAL, set_point)
    chain = effect.change(VERTICAL, set_point).chain(set_point)
    shaft_only = type(chain)((chain.stage("drive"), chain.stage("photocell")))
    rate = 8 * set_point.frequency_hz
    run = shaft_only.run(shaft_only.start(rate, seed=11), 8 * cycles + 1)[1]
    edges = run["photocell_edge_time"] * set_point.frequency_hz
    late = 2.0 * np.pi * (edges - (np.arange(edges.size) + 0.5))
    assert edges.size == cycles
    assert np.std(late) == pytest.approx(sigma, rel=4.0 / np.sqrt(2 * cycles))
    theory = effect.signature(situation)
    for name in RECORDED_FORCES:
        nominal = situation.phasor(name, 1)
        found = np.mean(np.exp(1j * late)) - 1.0
        assert found.real == pytest.approx((theory[name, 1] / nominal).real, rel=0.03)
        assert abs(found.imag) < 4.0 * sigma / np.sqrt(cycles)
        assert theory[name, 1] / nominal == pytest.approx(np.expm1(-(sigma**2) / 2.0))


@pytest.mark.parametrize("per_period", [60, 256])
@pytest.mark.parametrize("set_point", SET_POINTS[::7])
def test_hum_in_the_time_domain(set_point: SetPoint, per_period: int) -> None:
    """Sampled at 24 to 230 Hz the line is where it folds to; its samples are those of 50 Hz."""
    effect = Hum(0.3, 50.0, 0.7)
    theory = effect.lines(Situation.of(VERTICAL, set_point))
    run = in_time(effect.change(VERTICAL, set_point), set_point, 7, per_period)
    more = run.less(in_time(VERTICAL, set_point, 7, per_period))
    for (name, frequency), value in theory.items():
        found = lines(more, name, [frequency])
        assert abs(found[frequency] - value) < 1e-9 * abs(value)
    assert effect.signature(Situation.of(VERTICAL, set_point)) == {}


def test_hum_that_folds_onto_the_third_order() -> None:
    """64 samples a period of 0.4 Hz: 50 Hz less twice the rate is -3 times the frequency."""
    set_point = SetPoint(0.4, 0.03)
    run = in_time(Hum(0.3).change(VERTICAL, set_point), set_point, 7, 64)
    found = by_cycles(run, RECORDED_FORCES[0])
    assert abs(found[3]) == pytest.approx(0.3, rel=1e-9)
    other = SetPoint(0.41, 0.03)
    run = in_time(Hum(0.3).change(VERTICAL, other), other, 7, 64)
    assert abs(by_cycles(run, RECORDED_FORCES[0], 7)[3]) < 0.15


@pytest.mark.parametrize(("poles", "lag_ms"), [(1.0, 15.9), (4.0, 41.6)])
def test_lag_of_usual_filters(poles: float, lag_ms: float) -> None:
    """10 Hz: 15.9 ms with one pole, 41.6 ms as a Butterworth filter with four, at low frequency."""
    situation = Situation.of(VERTICAL, SetPoint(0.1, 0.03))
    name = RECORDED_FORCES[0]
    relative = AmplifierLag(10.0, poles).signature(situation)[name, 1] / situation.phasor(name, 1)
    lag = -np.angle(1.0 + relative) / situation.omega
    assert 1e3 * lag == pytest.approx(lag_ms, abs=0.05)
