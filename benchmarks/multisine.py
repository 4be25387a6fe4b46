"""Many frequencies at once: the same coefficients as single sines, at what variance and tank time.

Eight lines in two runs, sway and yaw, against sixteen runs of single sines of the same stroke and,
together, the same gated time. The recordings are simulated once without noise; noise is added.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit, fit_cycles
from analysis.coefficients.line_cycles import by_lines
from analysis.coefficients.strut_cycle import measured_cycle
from analysis.readers import from_dataset
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from analysis.response.distortion import Degree, distortions
from analysis.response.frequency_response import frequency_response
from analysis.response.multisine import multisine, odd_lines_with_gaps
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrays import FloatArray
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.setpoint import SetPoint
from sim.model.law_point import Acting, Point
from sim.model.laws import Cubic
from sim.rig import SimulatedRig, horizontal_rig
from sim.run import simulate

_SEEDS, _QUICK = 60, 2
_BASE_HZ, _ORDERS, _PERIODS = 0.1, (3, 5, 7, 9, 11, 13, 15, 17), 6
_STROKE_M, _RATE_HZ = 0.04, 50.0  # amplitude: the peak of all lines, and that of a single sine
_NOISE = (2e-5, 2e-5, 0.05, 0.05)  # of displacements, m, and forces, N
_WAITING_S, _SETTLING = 180.0, 3.0  # before each run; periods of a single sine, one of the lines
_CUBIC, _GATED_S = 800.0, 7.5  # N/(m/s)^3; of a single sine, to the nearest whole period
_LINEAR = {
    "Y_vdot": -62.0, "Y_v": -120.0, "N_vdot": -2.0, "N_v": -40.0,
    "Y_rdot": -2.0, "Y_r": 15.0, "N_rdot": -18.0, "N_r": -35.0,
}  # fmt: skip
_SWAY = {name: one for name, one in _LINEAR.items() if name[2] == "v"}
_CURVED = {**_SWAY, "Y_vvv": -_CUBIC, "N_vvv": 0.0}
_CHANNELS = (*DISPLACEMENTS, *FORCES)


def run(quick: bool, report: Report) -> Outcome:
    """Compare coefficients, variance and tank time, then the distortions of a cubic damping."""
    seeds = _QUICK if quick else _SEEDS
    report("linear hull")
    by_line, linear = _linear(seeds)
    report("nonlinear hull")
    joint, curved = _joint(seeds)
    report("distortions")
    levels, off = _distortions(seeds)
    notes = (
        f"Lines at {_BASE_HZ:g} Hz times {', '.join(map(str, _ORDERS))}, amplitudes as one over "
        f"the order, Schroeder's phases, {1e3 * _STROKE_M:g} mm peak; {_PERIODS} base periods. "
        f"Single sines of {1e3 * _STROKE_M:g} mm at the same frequencies, {_GATED_S:g} s each to "
        "the nearest whole period, variances brought to the same gated time.",
        f"Tank time: {_WAITING_S:g} s of waiting before each run, {_SETTLING:g} periods of "
        "settling of a single sine and one base period of the lines; runs of lines are gated as "
        "long as sixteen (in sway alone eight) runs of single sines take.",
        f"White noise of {1e3 * _NOISE[0]:g} mm and {_NOISE[2]:g} N in samples at {_RATE_HZ:g} Hz; "
        f"{seeds} draws.",
    )
    tables = {
        "Linear hull: variance of the lines over single sines of the same stroke": by_line,
        "Nonlinear hull in sway, all harmonics fitted jointly": joint,
        "Odd distortions of the cubic damping": levels,
    }
    return Outcome(tables, {} if quick else {**linear, **curved, **off}, notes)


def _rig(cubic: float = 0.0) -> SimulatedRig:
    rig = horizontal_rig().ideal()
    law = Acting(Cubic(cubic_n_s3_m3=cubic), Point.THROUGH_WATER, in_water=True)
    return replace(rig, forces=(law,) if cubic else ())


def _exact(rig: SimulatedRig, name: str, point: SetPoint, periods: int) -> Recording:
    made = simulate(
        rig, point, periods=periods, settling_periods=1, sample_rate_hz=_RATE_HZ, seed=1, name=name
    )
    return from_dataset(made)


def _noisy(exact: Recording, generator: np.random.Generator) -> Recording:
    samples = np.array(exact.samples[list(range(len(exact.channels))), :])
    for name, size in zip(_CHANNELS, _NOISE, strict=True):
        row = exact.index(name)
        samples[row] += size * generator.standard_normal(samples.shape[1])
    return replace(exact, samples=samples)


def _cycle(rig: SimulatedRig, recording: Recording, harmonics: int) -> BodyCycle:
    settings = ResolverSettings(channels=_CHANNELS, harmonics=harmonics, take_out_drift=False)
    found = analyse(recording, settings=settings)
    return measured_cycle(found, rig.oscillator).model().without(rig.body)


def _lines(phase_rad: float) -> SetPoint:
    lines = multisine(_ORDERS, 1.0 / np.array(_ORDERS), (phase_rad,))
    return SetPoint(_BASE_HZ, _STROKE_M, lines=lines)


def _periods(order: int) -> int:
    return max(2, round(_GATED_S * order * _BASE_HZ))


def _singles(rig: SimulatedRig, phases: Sequence[float]) -> list[Recording]:
    return [
        _exact(rig, f"{n}-{phase:.1f}", SetPoint(n * _BASE_HZ, _STROKE_M, phase), _periods(n))
        for n in _ORDERS
        for phase in phases
    ]


def _tank_s() -> float:
    """Gated time that a run of lines has in the tank time of the single sines in its motion."""
    single = sum(_WAITING_S + (_SETTLING + _periods(n)) / (n * _BASE_HZ) for n in _ORDERS)
    return single - _WAITING_S - 1.0 / _BASE_HZ


def _per_gated_s() -> FloatArray:
    """Gated time of each single sine over its share of the gated time of the lines."""
    own = np.array([_periods(n) / (n * _BASE_HZ) for n in _ORDERS])
    return own / (_PERIODS / _BASE_HZ / len(_ORDERS))


def _linear(seeds: int) -> tuple[list[Row], dict[str, float]]:
    rig, phases = _rig(), (0.0, math.pi)
    many = [_exact(rig, f"lines {k}", _lines(phase), _PERIODS) for k, phase in enumerate(phases)]
    single = _singles(rig, phases)
    fits: dict[str, list[list[CycleFit]]] = {"many": [], "single": []}
    for seed in range(seeds):
        generator = np.random.default_rng(np.random.SeedSequence(41, spawn_key=(seed,)))
        sway, yaw = (
            by_lines(_cycle(rig, _noisy(one, generator), 2 * max(_ORDERS))) for one in many
        )
        own = [_cycle(rig, _noisy(one, generator), 7) for one in single]
        fits["many"].append([_fit(pair) for pair in zip(sway, yaw, strict=True)])
        fits["single"].append([_fit(own[k : k + 2]) for k in range(0, len(own), 2)])
    truth = np.array(list(_LINEAR.values()))
    values = {key: _values(each) for key, each in fits.items()}
    # Of each line, the coefficients' mean on a logarithmic scale.
    ratio = values["many"].var(axis=0) / values["single"].var(axis=0)
    gated = np.exp(np.log(ratio).mean(axis=1)) / _per_gated_s()
    share = np.array([one.share for one in _lines(0.0).lines])
    asked = 1.0 / (len(_ORDERS) * share**2)
    tank = gated * _PERIODS / _BASE_HZ / _tank_s()
    held = {
        key: np.abs(values[key] - truth)
        <= np.array([[one.uncertain.half_width() for one in row] for row in fits[key]])
        for key in fits
    }
    rows: list[Row] = [
        {
            "line": n,
            "Hz": n * _BASE_HZ,
            "part of the stroke": float(share[k]),
            "same gated time": float(gated[k]),
            "by the amplitudes": float(asked[k]),
            "same tank time": float(tank[k]),
            "lines' intervals that hold": float(held["many"][:, k].mean()),
            "single sines'": float(held["single"][:, k].mean()),
        }
        for k, n in enumerate(_ORDERS)
    ]
    measured = {
        "held": float(held["many"].mean()),
        "held_not_too_often": float(held["many"].mean()),
        "as_the_amplitudes_say": float(np.exp(np.abs(np.log(gated / asked)).mean())),
        "same_tank_time": float(tank.max()),
    }
    return rows, measured


def _fit(cycles: Sequence[BodyCycle]) -> CycleFit:
    return fit_cycles(cycles, tuple(_LINEAR), (1,))


def _values(fits: Sequence[Sequence[CycleFit]]) -> FloatArray:
    return np.array([[one.values for one in row] for row in fits])


def _joint(seeds: int) -> tuple[list[Row], dict[str, float]]:
    rig = _rig(_CUBIC)
    many = _exact(rig, "lines", _lines(0.0), _PERIODS)
    single = _singles(rig, (0.0,))
    found: dict[str, list[CycleFit]] = {"many": [], "single": []}
    for seed in range(seeds):
        generator = np.random.default_rng(np.random.SeedSequence(42, spawn_key=(seed,)))
        whole = _cycle(rig, _noisy(many, generator), 2 * max(_ORDERS))
        own = [_cycle(rig, _noisy(one, generator), 7) for one in single]
        found["many"].append(fit_cycles([whole], tuple(_CURVED)))
        found["single"].append(fit_cycles(own, tuple(_CURVED)))
    truth = np.array(list(_CURVED.values()))
    values = {key: np.array([one.values for one in each]) for key, each in found.items()}
    half = {
        key: np.array([one.uncertain.half_width() for one in each]) for key, each in found.items()
    }
    gated = values["many"].var(axis=0) / values["single"].var(axis=0) / _per_gated_s().mean()
    tank = gated * _PERIODS / _BASE_HZ / _tank_s()
    held = {key: np.abs(values[key] - truth) <= half[key] for key in found}
    off = np.abs(values["many"].mean(axis=0) - truth) / values["many"].std(axis=0)
    rows: list[Row] = [
        {
            "coefficient": name,
            "put in": float(truth[k]),
            "lines": float(values["many"][:, k].mean()),
            "standard deviation": float(values["many"][:, k].std()),
            "single sines'": float(values["single"][:, k].std()),
            "variance, same gated time": float(gated[k]),
            "same tank time": float(tank[k]),
            "lines' intervals that hold": float(held["many"][:, k].mean()),
        }
        for k, name in enumerate(_CURVED)
    ]
    return rows, {"joint_held": float(held["many"].mean()), "joint_off": float(off.max())}


def _distortions(seeds: int) -> tuple[list[Row], dict[str, float]]:
    rig = _rig(_CUBIC)
    orders = odd_lines_with_gaps(1, 19, 3, seed=2)
    lines = multisine(orders, 1.0 / np.array(orders))
    point = SetPoint(_BASE_HZ, 2.0 * _STROKE_M, lines=lines)
    exact, highest = _exact(rig, "odd", point, 2 * _PERIODS), max(orders)
    free = [n for n in range(1, highest + 1) if n not in orders]
    put_in = _level(point, [n for n in free if n % 2])
    levels, even = [], []
    for seed in range(seeds):
        generator = np.random.default_rng(np.random.SeedSequence(43, spawn_key=(seed,)))
        settings = ResolverSettings(channels=_CHANNELS, harmonics=highest, take_out_drift=False)
        reading = analyse(_noisy(exact, generator), settings=settings).readings[0]
        response = frequency_response(reading, DISPLACEMENTS[0], FORCES[0], orders)
        told = {one.degree: one for one in distortions(reading, response)}
        levels.append(told[Degree.ODD])
        even.append(told[Degree.EVEN].is_significant)
    size = np.array([one.level for one in levels])
    row: Row = {
        "put in, N": put_in,
        "found, N": float(size.mean()),
        "standard deviation": float(size.std()),
        "as told": float(np.mean([one.uncertainty for one in levels])),
        "over the lines": float(np.mean([one.relative for one in levels])),
        "told from noise": float(np.mean([one.is_significant for one in levels])),
        "even ones told": float(np.mean(even)),
    }
    measured = {
        "distortion_off": float(abs(size.mean() / put_in - 1.0)),
        "distortion_worst": float(np.abs(size / put_in - 1.0).max()),
        "even_told": float(np.mean(even)),
    }
    return [row], measured


def _level(point: SetPoint, orders: Sequence[int]) -> float:
    """Root mean square amplitude at some harmonics of half the cubic force: by the motion alone."""
    theta = 2.0 * np.pi * np.arange(1024) / 1024
    omega = 2.0 * np.pi * point.frequency_hz
    speed = sum(
        point.eccentricity_m * one.share * one.order * omega
        * np.cos(one.order * theta + one.phase_rad)
        for one in point.lines
    )  # fmt: skip
    spectrum = 2.0 * np.abs(np.fft.rfft(0.5 * _CUBIC * speed**3)) / len(theta)
    return float(np.sqrt((spectrum[list(orders)] ** 2).mean()))


BENCHMARK = Benchmark("multisine", "Many frequencies at once", run)
