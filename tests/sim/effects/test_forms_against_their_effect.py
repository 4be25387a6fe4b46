"""Oracle: the effect itself, as large; and each form run in time, against its steady state."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import signal

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import SetPoint
from sim.effects import typical
from sim.effects.a1_amplifier_lag import AmplifierLag
from sim.effects.catalogue import catalogue
from sim.effects.d4_gear_backlash import GearBacklash
from sim.effects.effect import Effect, parameter
from sim.effects.k6b_free_play import FreePlay
from sim.effects.switching import switch_on
from sim.rig import horizontal_rig
from sim.run import steady_run
from tests.sim.effects.in_time import in_time

RIG = horizontal_rig().ideal()
TYPICAL = SetPoint(typical.omega_rad_s(RIG) / (2.0 * math.pi), typical.amplitude_m(RIG), 0.4, 1.0)
ORDERS, POINTS = 8, 64
CHANNELS = ("recorded_displacement_aft", "recorded_force_aft", "recorded_force_fore")
FORMED = [kind() for kind in catalogue().values() if kind().forms()]
# Where a typical motion asks more of an effect than its typical size is made for.
LARGER: dict[str, dict[str, float]] = {
    "stribeck-friction": {"stribeck_speed_m_s": 0.1},
    "tank-walls": {"breadth_m": 1.756},  # whose first mode is at the typical frequency
    "ground-suction": {"clearance_m": 0.5},
    "saturation": {"upper_n": 90.0, "lower_n": 90.0},
}
# The same at the speed or hour that they are matched at; they differ over a campaign.
OVER_A_CAMPAIGN = ("carriage-speed", "dynamic-trim", "temperature")
# Periods until they repeat, where that takes more than a dozen.
SETTLED = {"load-ripple": 120, "tank-walls": 120}
# What bounces is run on until it repeats, and has a test of its own.
BOUNCING = ("free-play", "gear-backlash")
REPEATING = [
    (effect, form)
    for effect in FORMED
    if effect.repeats and effect.name not in BOUNCING
    for form in effect.forms()
]


def name_of(one: object) -> str:
    """Return the parameters in which a form is not typical."""
    assert isinstance(one, Effect)
    own = [two for two in one.parameters() if getattr(one, two.name) != two.typical]
    settings = ",".join(f"{two.name}={getattr(one, two.name):.3g}" for two in own)
    return f"{one.name}:{settings}" if own else one.name


def periodic(effect: Effect | None, set_point: SetPoint = TYPICAL) -> ComplexArray:
    """Harmonics of the recorded channels, ``(3, orders + 1)``, in S + i C."""
    rig, really = switch_on([effect], RIG, set_point) if effect else (RIG, set_point)
    steady = steady_run(rig, really, orders=ORDERS, points=POINTS)
    return np.array([1j * steady.referred(name) for name in CHANNELS])


def signature(effect: Effect) -> ComplexArray:
    return periodic(effect) - periodic(None)


@pytest.mark.parametrize("effect", FORMED, ids=name_of)
def test_forms_are_the_effect_in_other_forms(effect: Effect) -> None:
    forms = effect.forms()
    assert 1 <= len(forms) <= 6
    assert len({effect, *forms}) == len(forms) + 1
    assert {type(form) for form in forms} == {type(effect)}


@pytest.mark.parametrize(("effect", "form"), REPEATING, ids=name_of)
def test_form_is_as_large(effect: Effect, form: Effect) -> None:
    """At its leading order, or in the loss per cycle, within a fifth; and it is another one."""
    larger = LARGER.get(effect.name, {})
    own, other = signature(replace(effect, **larger)), signature(replace(form, **larger))
    if not own.any():
        assert not other.any()  # nothing measures it here
        return
    order = int(np.argmax(np.linalg.norm(own, axis=0)))
    sizes = [float(np.linalg.norm(one[:, order])) for one in (other, own)]
    lost = [float(one[1:, 1].imag.sum()) for one in (other, own)]
    pairs = [pair for pair in (sizes, lost) if pair[1]]
    assert min(abs(math.log(abs(pair[0] / pair[1]))) for pair in pairs) < math.log(1.2)
    another = np.linalg.norm(other - own) > 1e-4 * np.linalg.norm(own)
    assert another != (effect.name in OVER_A_CAMPAIGN)


@pytest.mark.sample(18)
@pytest.mark.parametrize(("effect", "form"), REPEATING, ids=name_of)
def test_form_runs_in_time_as_in_the_steady_state(effect: Effect, form: Effect) -> None:
    """Within 3 % of the effect, or of rounding: what 200 samples a period see of corners."""
    expected = signature(form)
    settled = SETTLED.get(effect.name, 12)
    found = late(form, settled) - late(None, settled)
    size = max(np.linalg.norm(expected), 1e-6 * np.linalg.norm(periodic(None)))
    assert np.linalg.norm((found - expected)[:, 1:4]) < 0.03 * size


def late(effect: Effect | None, settled: int, per_period: int = 200) -> ComplexArray:
    """Harmonics of a late period in time, as :func:`periodic`."""
    rig, set_point = switch_on([effect], RIG, TYPICAL) if effect else (RIG, TYPICAL)
    run = in_time(rig, set_point, settled + 1, per_period)
    whole = run.edges[run.edges <= run.time_s[-per_period]]
    edge_s = whole[-1]
    first = math.floor(edge_s * run.sample_rate_hz)
    values = np.array([run.signals[name][first : first + per_period] for name in CHANNELS])
    waves = np.fft.rfft(values)[:, : ORDERS + 1] * 2.0 / per_period
    waves[:, 0] /= 2.0
    # Time counts from the pulse, which may fall between samples.
    late_by = first / run.sample_rate_hz - edge_s
    omega = 2.0 * math.pi / (whole[-1] - whole[-2])
    waves = waves * np.exp(-1j * omega * late_by * np.arange(ORDERS + 1))
    return np.asarray(1j * waves)


def test_an_effect_without_a_family_has_no_forms() -> None:
    assert catalogue()["zero-offset"]().forms() == ()


def test_a_form_of_a_form_is_the_nominal_one_too() -> None:
    """What another form leaves is the one value of its parameter that was stated first."""
    friction = catalogue()["coulomb-friction"]()
    for form in friction.forms():
        assert all(other != form for other in form.forms())


def test_a_form_outside_its_range_is_refused() -> None:
    with pytest.raises(Exception, match="its form 2 is outside"):
        parameter(0.0, 0.0, 1.0, "1", "of no use", forms=(2.0,))


@pytest.mark.parametrize("poles", [1, 2, 4])
def test_filters_are_as_late_at_low_frequencies(poles: int) -> None:
    """By scipy's filters: their phase at a thousandth of the cutoff."""
    effect = AmplifierLag(cutoff_hz=7.0, poles=poles)
    lags = []
    for one in (effect, *effect.forms()):
        assert isinstance(one, AmplifierLag)
        low = 2.0 * math.pi * 7e-3
        b, a = signal.butter(one.order, 2.0 * math.pi * one.cutoff_hz, analog=True)
        filtered = -float(np.angle(signal.freqs(b, a, [low])[1][0])) / low
        lags.append(one.pure * one.lag_s + (1.0 - one.pure) * filtered)
    np.testing.assert_allclose(lags, lags[0], rtol=1e-5)
    assert len(lags) >= 3


def test_a_plain_delay_turns_and_does_not_weaken() -> None:
    """S + i C of order n is turned by n w tau."""
    effect = AmplifierLag(cutoff_hz=7.0, pure=1.0)
    omega = 2.0 * math.pi * TYPICAL.frequency_hz
    ratio = periodic(effect)[1:, 1] / periodic(None)[1:, 1]
    np.testing.assert_allclose(ratio, np.exp(-1j * omega * effect.lag_s), rtol=1e-9)


@pytest.mark.parametrize(
    "effect",
    [FreePlay(2e-4), GearBacklash(3e-4, 20.0, 1e7, 2e3)],
    ids=name_of,
)
def test_what_bounces_is_as_large(effect: Effect) -> None:
    """At the largest of the first three orders, within a fifth; each of them another one."""
    own = signature(effect)
    order = int(np.argmax(np.linalg.norm(own[:, :4], axis=0)))
    for form in effect.forms():
        other = signature(form)
        ratio = np.linalg.norm(other[:, order]) / np.linalg.norm(own[:, order])
        assert abs(math.log(float(ratio))) < math.log(1.2)
        assert np.linalg.norm(other - own) > 1e-4 * np.linalg.norm(own)
