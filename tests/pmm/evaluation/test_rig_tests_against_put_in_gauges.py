"""Zeros and known masses against zeros, gains, lags and noise that were put in."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.recording import Recording
from hardware.description.channels import Channel
from pmm.evaluation.rig_tests import known_mass_responses, zero_drifts
from pmm.evaluation.run_results import RunResult
from pmm.recorder.header import RunHeader

RATE_HZ, FREQUENCY_HZ, E_M, HALF_SPACING_M = 100.0, 1.0, 0.02, 0.5
MASS_KG, GAIN, LAG_S, NOISE_N = 5.0, -1.03, 2e-3, 0.02
FORCE_N = -MASS_KG * (2.0 * math.pi * FREQUENCY_HZ) ** 2 * E_M  # in phase with the heave
CHANNELS = (
    Channel("shaft_angle", "rad"), Channel("displacement_aft", "m"),
    Channel("displacement_fore", "m"), Channel("force_aft", "N"), Channel("force_fore", "N"),
)  # fmt: skip


class MadeRun(RunResult):
    """A run whose samples are made, not read."""

    samples: np.ndarray

    def recording(self) -> Recording:
        return Recording(self.name, CHANNELS, self.samples, RATE_HZ)

    def means(self) -> dict[str, float]:
        return {name: float(self.samples[0, 0]) for name in self.forces}


def made(name: str, samples: np.ndarray, mass: dict[str, float] | None, **point: Any) -> RunResult:
    told = {
        "frequency_hz": FREQUENCY_HZ, "eccentricity_m": E_M, "strut_phase_rad": 0.0,
        "medium": "air", **point,
    }  # fmt: skip
    plan = {"set_point": told, "known_mass": mass}
    header = RunHeader(
        run_name=name, channels=CHANNELS, sample_rate_hz=RATE_HZ, started_utc="", kind="dry",
        plan_json=json.dumps(plan),
    )  # fmt: skip
    run = MadeRun(Path(name), header, plan, {})
    object.__setattr__(run, "samples", samples)
    return run


def _samples(rng: np.random.Generator, aft_n: float, fore_n: float) -> np.ndarray:
    """Heave for eight turns; forces of these amplitudes in phase with it, through both gauges."""
    time_s = np.arange(0.0, 8.0, 1.0 / RATE_HZ)
    turn = 2.0 * np.pi * FREQUENCY_HZ
    heave_m = E_M * np.sin(turn * time_s)
    late = np.sin(turn * (time_s - LAG_S))
    noise = NOISE_N * rng.standard_normal((2, time_s.size))
    gauges = [GAIN * aft_n * late + noise[0], GAIN * fore_n * late + noise[1]]
    return np.array([turn * time_s, heave_m, heave_m, *gauges])


def _pair(rng: np.random.Generator, x_m: float) -> tuple[RunResult, RunResult]:
    """A run with the mass at a place, the force shared by the levers' law, and one without."""
    fore = 0.5 + x_m / (2.0 * HALF_SPACING_M)
    mass = {"mass_kg": MASS_KG, "x_m": x_m, "own_inertia_kg_m2": 0.0}
    loaded = _samples(rng, 7.0 + (1.0 - fore) * FORCE_N, 9.0 + fore * FORCE_N)
    return made("loaded", loaded, mass), made("bare", _samples(rng, 7.0, 9.0), None)


def test_intervals_of_gain_and_lag_hold() -> None:
    rng = np.random.default_rng(3)
    off = []
    for _ in range(150):
        run, bare = _pair(rng, 0.1)
        off += [
            (
                abs(found.gain - GAIN) / found.gain_half_width,
                abs(found.lag_s - LAG_S) / found.lag_half_width_s,
            )
            for found in known_mass_responses([run], [bare], HALF_SPACING_M)
        ]
    assert len(off) == 300
    for within in np.mean(np.array(off) < 1.0, axis=0):
        assert 0.92 <= within <= 0.99


def test_a_gauge_that_gets_nothing_of_the_force_shows_nothing() -> None:
    """The mass hangs at the fore strut: the aft gauge's share is rounding alone."""
    run, bare = _pair(np.random.default_rng(4), HALF_SPACING_M)
    (found,) = known_mass_responses([run], [bare], HALF_SPACING_M)
    assert found.channel == "force_fore"
    assert found.gain == pytest.approx(GAIN, abs=2.0 * found.gain_half_width)


def test_only_zeros_of_one_state_are_compared() -> None:
    """Zeros by hand: a change of medium, heel or mass is none of the gauge."""
    mass = {"mass_kg": 3.0, "x_m": 0.35, "own_inertia_kg_m2": 0.0}
    zeros = [
        (0.10, None, {"medium": "air"}),
        (5.00, None, {"medium": "water"}),
        (5.02, None, {"medium": "water"}),
        (7.00, None, {"medium": "water", "heel_rad": math.radians(10.0)}),
        (9.00, mass, {"medium": "air"}),
        (0.15, None, {"medium": "air"}),
        (4.99, None, {"medium": "water"}),
    ]  # fmt: skip
    runs = [made(f"zero-{k}", np.full((1, 1), zero), with_mass, **point)
            for k, (zero, with_mass, point) in enumerate(zeros)]  # fmt: skip
    found = {one.state: one for one in zero_drifts(runs) if one.channel == "force_aft"}
    wanted = {
        "air": (0.10, 0.15, 0.05), "water": (5.00, 4.99, 0.03),
        "water, heel 10 deg": (7.00, 7.00, math.nan),
        "air, 3 kg at 0.35 m": (9.00, 9.00, math.nan),
    }  # fmt: skip
    assert found.keys() == wanted.keys()
    for state, values in wanted.items():
        one = found[state]
        told = (one.first_n, one.last_n, one.largest_change_n)
        assert told == pytest.approx(values, abs=1e-12, nan_ok=True)
