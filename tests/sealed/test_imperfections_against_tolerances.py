"""World C: what is always on is within its tolerance, and is what it says in each channel."""

from dataclasses import replace

import numpy as np
import pytest

from tests.sealed.closed_forms import AMPLITUDE, HEAVE, RIG, change, still
from tests.sealed.generator.case import make
from tests.sealed.generator.design import design
from tests.sealed.generator.features import density, harmonics, reference, resampled
from tests.sealed.generator.imperfect import LARGEST, Tolerance, tolerated
from tests.sealed.generator.mechanism import happen, set_run
from tests.sealed.generator.rig import Noise
from tests.sealed.generator.sensing import record, sense
from tests.sealed.generator.wider import working
from tests.sealed.generator.worlds import world

pytestmark = pytest.mark.slow  # the time loop takes 20 s to compile

KNOWN = {one.effect.name: one for one in tolerated(world("C"), np.random.default_rng(1))}


def test_each_is_within_two_deviations_and_seen() -> None:
    seen, cases = 0, [make(3, index, null=True, where="C") for index in (1, 2)]
    for case in cases:
        for one in case.always:
            own = next(t for t in case.campaign.tolerances if t.effect is one.effect)  # type: ignore[union-attr]
            assert abs(one.size) <= LARGEST * own.sigma * (1.0 + 1e-12)
            assert one.snr <= 5.0 * 1.001
            seen += one.snr >= 1.0
    assert seen >= len(cases)


def test_hum_of_two_tolerances_is_no_gap_at_any_phase() -> None:
    """A Gaussian of that width explains it: what is left is below the tolerances that it is."""
    case = next(
        one
        for one in (make(3, index, null=True, where="C") for index in range(1, 9))
        if "force_aft" in one.campaign.rig.sensors
    )
    own = next(
        one
        for one in case.campaign.tolerances
        if isinstance(one, Tolerance) and one.effect.name == "mains"
    )
    for turn in (0.0, 0.7, 2.0):
        drawn = {place: value + turn for place, value in own.drawn.items()}
        hum = case.situation.signature(own.effect, LARGEST * own.sigma, drawn)
        assert np.linalg.norm(hum) > 4.0 * LARGEST
        assert case.projection.snr(hum) < 1.1 * LARGEST


def test_campaigns_vary_as_the_table_has_it() -> None:
    draws = world("C").draws
    every = [design(np.random.default_rng([3, index, 0]), world("C")) for index in range(1, 13)]
    for campaign in every:
        rig, runs = campaign.rig, campaign.runs
        assert draws["runs"][0] <= len(runs) <= draws["runs"][1]
        assert draws["rate_hz"][0] <= rig.sample_rate_hz <= draws["rate_hz"][1]
        assert all(draws["loud"][0] <= run.loud <= draws["loud"][1] for run in runs)
        assert len({run.loud for run in runs}) == len(runs)
        assert {"photocell", "shaft_angle", "displacement_aft"} & set(rig.sensors)
        assert rig.noise.step_n <= 2.0 * rig.noise.white_n
        assert working(rig).sample_rate_hz <= 200.0
    assert len({campaign.rig.sensors for campaign in every}) > 3
    assert {campaign.rig.arrangement is None for campaign in every} == {True, False}


@pytest.mark.parametrize("order", [1, 2])
def test_ripple_moves_the_strut_by_its_half(order: int) -> None:
    ripple = 1e-3
    found = change(KNOWN[f"ripple-{order}-sine"].effect, ripple).of["displacement_aft"]
    # theta + (rho/n) sin(n theta): sidebands of rho a / 2 n
    side = AMPLITUDE * ripple / (2.0 * order)
    assert abs(found[order + 1]) == pytest.approx(side, rel=0.01)


def test_a_shaft_under_load_gives_its_third_harmonic() -> None:
    from tests.sealed.closed_forms import OMEGA, impedance, phasors
    from tests.sealed.generator.effect import heavier

    p = still()
    heavier(p, 1e5)
    turning = 5e-3
    q = KNOWN["shaft-under-load"].effect.put(p, turning)
    run = replace(HEAVE, periods=8)
    third = abs(phasors(q, run, settling=8.0).of["displacement_aft"][3])
    free = AMPLITUDE**3 * abs(impedance(1)) * turning / (16.0 * OMEGA**2)
    assert 0.0 < third < 1.1 * free  # a loop holds it back


def _spectrum(values: np.ndarray, rate: float) -> tuple[np.ndarray, np.ndarray]:
    frequency = np.fft.rfftfreq(len(values), 1.0 / rate)
    return frequency, np.abs(np.fft.rfft(values)) ** 2 / len(values)


def test_hum_has_the_mains_lines() -> None:
    p = KNOWN["mains"].effect.put(still(), 0.1, KNOWN["mains"].drawn)
    run = replace(HEAVE, kind="rest")
    force = record(p, run, RIG).channels[3] - record(still(), run, RIG).channels[3]
    frequency, power = _spectrum(force, RIG.sample_rate_hz)
    amplitude = np.sqrt(4.0 * power / len(force))
    for line, expected in ((50.0, 0.1), (150.0, 0.02)):
        assert amplitude[np.argmin(np.abs(frequency - line))] == pytest.approx(expected, rel=1e-3)
    away = np.abs(frequency[:, None] - [50.0, 150.0]).min(axis=1) > 0.2
    assert amplitude[away].max() < 1e-6


def test_quantisation_is_white_and_a_twelfth_of_a_square() -> None:
    step, white = 0.2, 0.15
    rig = replace(RIG, noise=Noise(white, 0.0, 0.1, step, 1e-5))
    run = replace(HEAVE, kind="rest")
    values = record(still(), run, rig, np.random.default_rng(4)).channels[3]
    assert values / step == pytest.approx(np.round(values / step), abs=1e-9)
    frequency, power = _spectrum(values - values.mean(), rig.sample_rate_hz)
    expected = white**2 + step**2 / 12.0
    for low in (1.0, 70.0, 140.0):
        band = (frequency > low) & (frequency < low + 60.0)
        assert power[band].mean() == pytest.approx(expected, rel=0.12)


def test_wander_and_loudness_have_the_density_that_the_matcher_knows() -> None:
    noise = Noise(0.1, 0.1, 0.2, 1e-4, 1e-5, wander_n=0.3, wander_s=1.0)
    rig, run = replace(RIG, sample_rate_hz=50.0, noise=noise), replace(HEAVE, kind="rest", loud=2.0)
    rows = [record(still(), run, rig, np.random.default_rng(i)).channels[3] for i in range(60)]
    power = np.mean([_spectrum(row, 50.0)[1] for row in rows], axis=0)
    frequency = np.fft.rfftfreq(len(rows[0]), 0.02)
    for low, high in ((0.4, 1.0), (2.0, 4.0), (10.0, 20.0)):
        band = (frequency > low) & (frequency < high)
        expected = density(rig, 3, frequency[band], run.loud).mean()
        assert power[band].mean() == pytest.approx(expected, rel=0.15)


def test_a_lower_working_rate_keeps_harmonics_and_their_sigma() -> None:
    from tests.sealed.generator.features import line_sigma

    fast = replace(RIG, sample_rate_hz=1000.0)
    slow = working(fast)
    assert slow.sample_rate_hz == 200.0
    found = []
    for rig in (fast, slow):
        made = sense(set_run(still(), HEAVE), happen(still(), HEAVE, rig), HEAVE, rig, None)
        ref = reference(made, HEAVE, rig.sensors)
        found.append(np.array(harmonics(resampled(made, ref, HEAVE.periods), HEAVE.periods)[1:]))
    assert np.abs(found[0] - found[1])[:, 1:].max() < 1e-4 * np.abs(found[0]).max()
    sigma = [line_sigma(rig, HEAVE, 3)[1:20] for rig in (fast, slow)]
    assert sigma[0] == pytest.approx(sigma[1], rel=0.02)


def test_an_encoder_alone_tells_the_same_phase_as_the_photocell() -> None:
    p = still()
    made = sense(set_run(p, HEAVE), happen(p, HEAVE, RIG), HEAVE, RIG, None)
    ours = [reference(made, HEAVE, sensors) for sensors in (("photocell",), ("shaft_angle",))]
    assert ours[0].period_s == pytest.approx(ours[1].period_s, rel=1e-7)
    late = (ours[1].opens_s - ours[0].opens_s) / ours[0].period_s
    assert late - round(late) == pytest.approx(0.0, abs=1e-5)
