"""Struts that follow lines: sums of sines written out, and the steady state against a whole run."""

import math

import numpy as np
import pytest

from analysis.response.multisine import chirp, lines_of, multisine
from hardware.description.errors import ConfigurationError
from hardware.description.lines import Line, peak_of
from hardware.description.setpoint import SetPoint
from sim.rig import horizontal_rig
from sim.run import simulate, steady_run

LINES = multisine((1, 3, 5, 9), np.array([1.0, 0.6, 0.4, 0.2]), (0.0, math.pi))
POINT = SetPoint(0.1, 0.08, lines=LINES)


def test_displacement_velocity_and_acceleration() -> None:
    chain = horizontal_rig().chain(POINT)
    _, run = chain.run(chain.start(50.0, seed=1), 600)
    omega, angle = 2.0 * math.pi * POINT.frequency_hz, run["shaft_angle"]
    for strut, fore in (("aft", 0.0), ("fore", 1.0)):
        for times, name in enumerate(("displacement", "velocity", "acceleration")):
            expected = sum(
                0.08
                * line.share
                * (line.order * omega) ** times
                * np.sin(
                    line.order * angle
                    + line.phase_rad
                    + fore * line.strut_phase_rad
                    + times * math.pi / 2.0
                )
                for line in LINES
            )
            assert run[f"{name}_{strut}"] == pytest.approx(expected, abs=1e-12)
    assert np.abs(run["displacement_aft"]).max() <= 0.08 * 1.01


@pytest.mark.slow
def test_steady_state_is_that_of_a_long_run() -> None:
    rig = horizontal_rig().ideal()
    steady = steady_run(rig, POINT)
    run = simulate(rig, POINT, periods=1, settling_periods=2, sample_rate_hz=200.0, seed=1)
    force = run["force_aft"].values[: int(200.0 / POINT.frequency_hz)]
    spectrum = np.abs(np.fft.rfft(force))[:12] * 2.0 / len(force)
    own = np.abs(steady.spectra["recorded_force_aft"][:12])
    assert spectrum[1:] == pytest.approx(own[1:], abs=2e-3 * own.max())


def test_one_line_is_a_single_sine() -> None:
    rig = horizontal_rig()
    one = steady_run(rig, SetPoint(0.5, 0.05, lines=(Line(1, strut_phase_rad=0.4),)))
    other = steady_run(rig, SetPoint(0.5, 0.05, strut_phase_rad=0.4))
    for name in ("force_aft", "force_fore"):
        assert one.spectra[name][:4] == pytest.approx(other.spectra[name][:4], abs=1e-12)


def test_any_period_is_its_lines() -> None:
    theta = 2.0 * np.pi * np.arange(200) / 200
    wave = np.sin(2.0 * theta + 0.3) + 0.25 * np.sin(7.0 * theta - 1.0)
    found = lines_of(wave, 20)
    assert [line.order for line in found] == [2, 7]
    assert found[1].share / found[0].share == pytest.approx(0.25)
    assert [line.phase_rad for line in found] == pytest.approx([0.3, -1.0])
    assert peak_of(found) == pytest.approx(1.0)


def test_a_chirp_covers_its_band() -> None:
    found = {line.order: line.share for line in chirp(2, 20)}
    within = sum(share**2 for n, share in found.items() if 2 <= n <= 20)
    assert within / sum(share**2 for share in found.values()) > 0.95
    assert min(found.get(n, 0.0) for n in range(4, 17)) > 0.5 * max(found.values())


@pytest.mark.parametrize(
    ("rig", "point", "words"),
    [
        (horizontal_rig(rod_length_m=1.0), POINT, "not by a crank"),
        (horizontal_rig(), SetPoint(0.1, 0.08, lines=(Line(1), Line(3))), "1.5"),
        (horizontal_rig(), SetPoint(0.5, 0.08, lines=(Line(9),)), "line 9"),
    ],
)
def test_what_no_strut_follows_is_refused(rig, point, words) -> None:
    with pytest.raises(ConfigurationError, match=words):
        rig.chain(point)
