"""A fifth of the samples lost on jittered stamps: estimates lie within what they state.

The motions are integrated; 504 records of each kind stand in ``benchmarks/uneven.py``.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.inertia.record import analyse_record
from analysis.inertia.series import series_from_recording
from analysis.recording import Recording
from analysis.resolver.analysis import Analysis, analyse
from analysis.resolver.carrier import demodulate
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import Channel
from hardware.description.errors import DataError

OMEGA, DECAY = 2.0 * np.pi / 1.7, 0.02
DRIVE, FORCE = 2.0 * np.pi * 0.8, 3.0


def stamps(rng: np.random.Generator, rate_hz: float, seconds: float) -> np.ndarray:
    """Jittered, a fifth lost, and half a period of either motion without any."""
    time_s = (np.arange(1.0, seconds * rate_hz) + rng.uniform(-0.3, 0.3)) / rate_hz
    time_s += rng.uniform(-0.3, 0.3, time_s.size) / rate_hz
    kept = (rng.random(time_s.size) > 0.2) & ((time_s < 7.0) | (time_s > 7.7))
    return np.asarray(time_s[kept])


def recorded(time_s: np.ndarray, *values: np.ndarray) -> Recording:
    channels = tuple(Channel(name, "m") for name in ("y", "x")[: len(values)])
    rate_hz = (time_s.size - 1) / float(np.ptp(time_s))
    start_s = float(time_s[0])
    return Recording("run", channels, np.array(values), rate_hz, start_s, stamps_s=time_s)


def integrated(force: float, start: list[float], seconds: float) -> solve_ivp:
    def slope(time_s: float, state: np.ndarray) -> list[float]:
        push = force * np.cos(DRIVE * time_s)
        return [state[1], push - (OMEGA**2 + DECAY**2) * state[0] - 2.0 * DECAY * state[1]]

    return solve_ivp(
        slope, (0.0, seconds), start, "DOP853", rtol=1e-10, atol=1e-12, dense_output=True
    ).sol


@pytest.mark.slow
def test_period_and_decay_of_a_swing() -> None:
    rng, motion = np.random.default_rng(28), integrated(0.0, [0.1, 0.0], 41.0)
    off = []
    for _ in range(24):
        time_s = stamps(rng, 20.0, 40.0)
        record = recorded(time_s, motion(time_s)[0] + rng.normal(0.0, 0.002, time_s.size))
        found = analyse_record(series_from_recording(record, "y"))
        assert found.part.series.stamps_s is not None
        mode, spread = found.fit.modes[0], np.sqrt(np.diag(found.fit.covariance))
        off.append([(mode.period_s - 1.7) / spread[0], (mode.decay_1_s - DECAY) / spread[1]])
    assert (np.abs(off) < 1.96).mean() > 0.85
    assert 0.75 < np.std(off) < 1.25


def forced(rng: np.random.Generator, seconds: float = 30.0) -> tuple[Analysis, np.ndarray]:
    """Return an analysis by the reference channel, and the motion's true harmonic against it."""
    answer = FORCE / (OMEGA**2 + DECAY**2 - DRIVE**2 + 2j * DECAY * DRIVE)
    start = [answer.real, (1j * DRIVE * answer).real]
    time_s = stamps(rng, 12.0, seconds)
    motion = integrated(FORCE, start, seconds)(time_s)[0]
    push = np.cos(DRIVE * time_s)
    record = recorded(
        time_s,
        motion + rng.normal(0.0, 0.05, time_s.size),
        push + rng.normal(0.0, 0.02, time_s.size),
    )
    found = analyse(record, ReferenceChoice(channel="x"), ResolverSettings(harmonics=2))
    turned = answer * np.exp(-0.5j * np.pi)  # the push is a cosine, the phase that of a sine
    return found, np.array([-turned.imag, turned.real])


@pytest.mark.slow
def test_harmonics_of_a_forced_motion() -> None:
    rng, held = np.random.default_rng(8), []
    for _ in range(12):
        found, true = forced(rng)
        reading = found.readings[0]
        assert reading.periods in (21, 22)  # of 24: whole ones that the reference covers
        held.append(np.abs(reading.coefficients[0, 1:3] - true) <= reading.half_width()[0, 1:3])
        assert reading.half_width()[0, 1:3].max() < 0.02  # 0.05 sqrt(2/230), twice, and a half more
    assert np.mean(held) > 0.75


def test_a_carrier_needs_a_grid() -> None:
    found, _ = forced(np.random.default_rng(1))
    with pytest.raises(DataError, match=r"a carrier's low-pass needs evenly spaced samples"):
        demodulate(found.recording, ("y",), 3.0, bandwidth_hz=0.5)
