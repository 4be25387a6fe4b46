"""Uneven stamps with drop-outs against an integrator: how often the intervals hold the truth."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import numpy as np

from analysis.inertia.record import analyse_record
from analysis.inertia.series import Series
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel

_RECORDS: Final = 504  # of each test
_LOST: Final = 0.2  # of the samples
_JITTER: Final = 0.3  # of an interval, to either side
_BURST: Final = 0.3  # of a period, at most
_SAMPLES: Final = (12.0, 25.0, 60.0)  # a period, before any are lost
_PERIODS: Final = 30
_BODIES: Final = 8
_HARMONICS: Final = 2


def _stamps(samples: float, bursts: bool, rng: np.random.Generator) -> FloatArray:
    """Return times in periods: jittered, and a fifth lost singly or in bursts."""
    count = int(_PERIODS * samples)
    times = (np.arange(count) + 0.5 + rng.uniform(-_JITTER, _JITTER, count)) / samples
    if not bursts:
        return np.asarray(times[rng.random(count) > _LOST])
    kept = np.ones(count, dtype=bool)
    while kept.mean() > 1.0 - _LOST:
        start = rng.integers(count)
        kept[start : start + rng.integers(1, int(_BURST * samples) + 2)] = False
    return np.asarray(times[kept])


@dataclass(frozen=True)
class _Body:
    """A damped oscillator that an integrator has followed; times are in its damped periods.

    ``forced`` are the force's harmonics and, in closed form, those of the motion.
    """

    period_s: float
    decay_1_s: float
    motion: Callable[[FloatArray], FloatArray]
    forced: tuple[tuple[complex, complex], ...] = ()

    def force(self, time_s: FloatArray) -> FloatArray:
        turn = 2.0j * np.pi * np.outer(np.arange(1, len(self.forced) + 1), time_s / self.period_s)
        return np.asarray(([one[0] for one in self.forced] @ np.exp(turn)).real)


@cache
def _body(seed: int, forced: bool) -> _Body:
    """Integrate ``y'' + 2 l y' + w0^2 y = f`` from its release, or from the steady motion."""
    from scipy.integrate import solve_ivp

    rng = np.random.default_rng(seed)
    period_s, per_period = rng.uniform(0.8, 3.0), rng.uniform(0.01, 0.08)
    omega, decay = 2.0 * math.pi / period_s, per_period / period_s
    stiffness = (omega**2 + decay**2) * (rng.uniform(1.5, 3.0) if forced else 1.0)
    body, start = _Body(period_s, decay, np.sin), [0.2, 0.0]
    if forced:
        turns = omega * np.arange(1, _HARMONICS + 1)
        force = rng.standard_normal((2, 2)) @ [1.0, 1j] * [stiffness, 0.2 * stiffness]
        answer = force / (stiffness - turns**2 + 2j * decay * turns)
        body = _Body(period_s, decay, np.sin, tuple(zip(force, answer, strict=True)))
        start = [float(answer.real.sum()), float((1j * turns * answer).real.sum())]

    def slope(time_s: float, state: FloatArray) -> list[float]:
        push = float(body.force(np.array([time_s]))[0]) if forced else 0.0
        return [state[1], push - stiffness * state[0] - 2.0 * decay * state[1]]

    end_s = (_PERIODS + 1) * period_s
    found = solve_ivp(slope, (0.0, end_s), start, "DOP853", rtol=1e-10, atol=1e-12,
                      dense_output=True)  # fmt: skip
    solution: Any = found.sol
    return _Body(period_s, decay, lambda time_s: solution(time_s)[0], body.forced)


def _decay(seed: int, samples: float, bursts: bool) -> list[bool]:
    """Whether the intervals of period, decay rate and period at no amplitude hold."""
    rng, body = np.random.default_rng(seed), _body(seed % _BODIES, False)
    time_s = body.period_s * _stamps(samples, bursts, rng)
    values = body.motion(time_s) + rng.normal(0.0, 0.004, time_s.size)
    rate_hz = (time_s.size - 1) / float(np.ptp(time_s))
    series = Series("uneven", "y", "m", rate_hz, float(time_s[0]), values, stamps_s=time_s)
    found = analyse_record(series)
    mode, spread = found.fit.modes[0], np.sqrt(np.diag(found.fit.covariance))
    none = found.period()
    return [
        abs(mode.period_s - body.period_s) <= 1.96 * spread[0],
        abs(mode.decay_1_s - body.decay_1_s) <= 1.96 * spread[1],
        abs(none.value - body.period_s) <= none.half_width(),
    ]


def _harmonics(seed: int, samples: float, bursts: bool) -> list[bool]:
    """Whether the intervals of in-phase and quadrature hold, of two harmonics each."""
    rng, body = np.random.default_rng(seed), _body(seed % _BODIES, True)
    time_s = body.period_s * _stamps(samples, bursts, rng)
    noisy = [clean + 0.02 * np.ptp(clean) * rng.standard_normal(time_s.size)
             for clean in (body.force(time_s), body.motion(time_s))]  # fmt: skip
    channels = (Channel("force", "N"), Channel("y", "m"))
    rate_hz = (time_s.size - 1) / float(np.ptp(time_s))
    record = Recording(
        "uneven", channels, np.array(noisy), rate_hz, float(time_s[0]), stamps_s=time_s
    )
    by_channel = seed % 2 == 0
    choice = (
        ReferenceChoice(channel="force")
        if by_channel
        else ReferenceChoice(frequency_hz=1.0 / body.period_s)
    )
    settings = ResolverSettings(channels=("y",), harmonics=_HARMONICS)
    reading = analyse(record, choice, settings).readings[0]
    order = np.arange(1, _HARMONICS + 1)
    if by_channel:  # whole cycles are where the force's fundamental passes zero upwards
        ahead = np.angle(body.forced[0][0]) + np.pi / 2.0
    else:
        ahead = -2.0 * np.pi * time_s[0] / body.period_s
    true = np.array([one[1] for one in body.forced]) * np.exp(-1j * order * ahead)
    expected = np.stack([-true.imag, true.real], axis=1).ravel()
    off = np.abs(reading.coefficients[0, 1:] - expected)
    return [bool(one) for one in off <= reading.half_width()[0, 1:]]


def run(quick: bool, report: Report) -> Outcome:
    """Draw records of either test, each sampling and kind of loss as often."""
    records = 6 if quick else _RECORDS
    cases = [(samples, bursts) for samples in _SAMPLES for bursts in (False, True)]
    held: dict[tuple[str, float, bool], list[list[bool]]] = {}
    for name, test in (("decay", _decay), ("harmonics", _harmonics)):
        for seed in range(records):
            if seed % 100 == 0:
                report(f"{name}, record {seed}")
            case = cases[seed % len(cases)]
            held.setdefault((name, *case), []).append(test(seed, *case))
    swings = np.concatenate([own for key, own in held.items() if key[0] == "decay"])
    lines = np.concatenate([own for key, own in held.items() if key[0] == "harmonics"])
    measured = {}
    parts = {"period": swings[:, 0], "damping": swings[:, 1], "harmonics": lines}
    for name, part in parts.items():
        measured[f"{name}_covered"] = measured[f"{name}_not_too_often"] = float(np.mean(part))
    rows = [_row(case, held["decay", *case], held["harmonics", *case]) for case in cases]
    notes = (
        f"{records} decays and {records} forced motions of {_PERIODS} periods, integrated by "
        "DOP853; the truth of a decay is its equation's own, that of a forced motion the closed "
        f"form. Stamps jitter by {_JITTER:g} intervals, {100 * _LOST:g} % of the samples are "
        f"lost, singly or in bursts of up to {_BURST:g} periods.",
        "The phase comes from the frequency or from the force's channel, in turn. The period at no "
        "amplitude is a mean over three laws and not judged: it is wider than one fit's.",
    )
    return Outcome({"Uneven stamps": rows}, measured, notes)


def _row(case: tuple[float, bool], swings: list[list[bool]], lines: list[list[bool]]) -> Row:
    period, damping, none = np.mean(swings, axis=0)
    return {
        "samples a period before the loss": case[0],
        "lost": "in bursts" if case[1] else "singly",
        "records of each test": len(swings),
        "period held": float(period),
        "damping held": float(damping),
        "period at no amplitude held": float(none),
        "harmonics held": float(np.mean(lines)),
    }


BENCHMARK = Benchmark("uneven", "Uneven stamps", run)
