"""What a rig does by itself is no spike: corners, impacts, pulses, steps, wraps, every effect."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from analysis.spikes import find_spikes
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import in_order
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig, vertical_rig
from sim.run import simulate

ROOT = Path(__file__).parents[3]
Shape = Callable[[FloatArray, FloatArray, float], FloatArray]


def since_reversal(phase: FloatArray) -> FloatArray:
    """Return the part of half a period since the last reversal."""
    return np.asarray(np.mod(phase / np.pi, 1.0))


def from_third(t: FloatArray) -> FloatArray:
    return t - t[-1] / 3.0


# Each of the time, the phase and the sampling rate; forces of about 40.
SHAPES: dict[str, Shape] = {
    "sine": lambda t, p, r: 40.0 * np.sin(p),
    "coulomb friction": lambda t, p, r: 40.0 * np.sin(p) + 3.0 * np.sign(np.cos(p)),
    "stribeck": lambda t, p, r: (
        40.0 * np.sin(p) + np.sign(np.cos(p)) * (3.0 + 2.0 * np.exp(-((np.cos(p) / 0.05) ** 2)))
    ),
    "play": lambda t, p, r: np.sign(np.sin(p)) * np.maximum(np.abs(40.0 * np.sin(p)) - 10.0, 0.0),
    "impact of a sample or two": lambda t, p, r: (
        40.0 * np.sin(p) + 15.0 * (since_reversal(p) * np.pi / np.gradient(p, t) < 1.5 / r)
    ),
    "clipped": lambda t, p, r: np.clip(40.0 * np.sin(p), -25.0, 25.0),
    "square": lambda t, p, r: 10.0 * np.sign(np.sin(p)),
    "photocell": lambda t, p, r: 5.0 * (np.mod(p / 2.0 / np.pi, 1.0) < 0.01),
    "angle in radians": lambda t, p, r: np.mod(p, 2.0 * np.pi),
    "angle in degrees": lambda t, p, r: np.degrees(np.mod(p, 2.0 * np.pi)),
    "angle that trembles at its wrap": lambda t, p, r: np.mod(
        p + 0.05 * np.sin(1e4 * p), 2 * np.pi
    ),
    "start": lambda t, p, r: np.where(from_third(t) > 0, 40.0 * np.sin(p - p[t.size // 3]), 0.0),
    "start with a jerk": lambda t, p, r: np.where(
        from_third(t) > 0, 30.0 * np.exp(-np.maximum(from_third(t), 0.0) * r / 5.0), 0.0
    ),
    "start that rings": lambda t, p, r: np.where(
        from_third(t) > 0,
        30.0
        * np.exp(-np.maximum(from_third(t), 0.0) * r / 10.0)
        * np.sin(2.0 * np.pi * r / 6.0 * from_third(t)),
        0.0,
    ),
    "one step": lambda t, p, r: np.where(from_third(t) > 0, 30.0, 0.0),
    "ramp": lambda t, p, r: np.clip(from_third(t), 0.0, t[-1] / 3.0),
    "at rest": lambda t, p, r: np.zeros_like(t),
    "laplace noise": lambda t, p, r: np.random.default_rng(t.size).laplace(size=t.size),
    "random walk": lambda t, p, r: np.cumsum(np.random.default_rng(t.size).normal(size=t.size)),
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", SHAPES)
def test_shapes(name: str) -> None:
    """In any sampling, phase, noise and quantisation."""
    rng = np.random.default_rng(1955)
    for _ in range(60):
        rate, frequency = (
            rng.choice([20.0, 50.0, 100.0, 200.0, 1000.0]),
            rng.choice([0.2, 0.5, 2.0]),
        )
        time = np.arange(rng.choice([3.2, 5.0, 12.0]) * rate / frequency) / rate
        phase = 2.0 * np.pi * (frequency * time + rng.uniform())
        values = SHAPES[name](time, phase, rate)
        values = values + rng.choice([0.0, 1e-3, 0.4]) * rng.normal(size=time.size)
        step = rng.choice([1e-6, 0.0153, 0.5])
        assert find_spikes(np.round(values / step)[None] * step) == ((),), (rate, frequency, step)


@pytest.mark.sample(12)
@pytest.mark.parametrize("kind", catalogue().values(), ids=lambda kind: kind.code)
@pytest.mark.parametrize("rate_hz", [40.0, 200.0])
def test_every_effect_of_the_catalogue(kind: type[Effect], rate_hz: float) -> None:
    """As it is usual and at its largest, with noise and without, where the rig can carry it."""
    usual, largest = kind(), kind(**{one.name: one.high for one in kind.parameters()})
    records = [
        channels_of(effect, rig, rate_hz)
        for rig in (vertical_rig(), vertical_rig().ideal())
        for effect in (usual, largest)
    ]
    assert sum(len(one) > 0 for one in records) >= 2
    assert not any(any(find_spikes(one)) for one in records)


def channels_of(effect: Effect, rig: SimulatedRig, rate_hz: float) -> FloatArray:
    """Return all channels of a run; none where the rig refuses it."""
    set_point = SetPoint(0.8, 0.005, 1.2, 1.6)
    real = switch_on([effect], rig, set_point, in_order([set_point] * 3, 60.0, 300.0)[-1])
    try:
        run = simulate(*real, periods=5, settling_periods=0, sample_rate_hz=rate_hz, seed=3)
    except ConfigurationError:
        return np.zeros((0, 0))
    return np.array([one.values for one in run.data_vars.values() if one.dims == ("time",)])


def test_every_example() -> None:
    paths = [*ROOT.glob("examples/**/*.csv.gz"), *ROOT.glob("examples/recordings/**/*.csv")]
    assert len(paths) >= 9
    for path in paths:
        codes = {flag.code for flag in read_recording(path).flags}
        assert "spike" not in codes, path
