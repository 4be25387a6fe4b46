"""Coefficients of exact rigs: bias without noise, and how often intervals hold the truth with it.

The rigs are those of ``tests/exact``, which share no code with simulator or analysis.
"""

import math
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from analysis.coefficients.cycle_fit import CycleFit, fit_cycles
from analysis.coefficients.phasors import interleaved
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.uncertainty.values import UncertainValues
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrangement import Arrangement
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import HULLS, afloat, less_known, struts_of
from tests.analysis.coefficients.sources import of_draws
from tests.exact.rig import ExactRig
from tests.exact.rigs import ARRANGEMENTS, exact_rig

_DRAWS: Final = 80
_ORDERS: Final = 7  # what ``pmm coefficients`` resolves
_FITTED: Final = (0, 1, 2, 3)
_PERIODS: Final = 10
_FORCE_N, _MOTION_M = 0.05, 1e-5  # of one period's harmonics, standard deviation
_LARGEST_DEG = {Plane.HORIZONTAL: 25.0, Plane.VERTICAL: 15.0}
_RUNS: Final = 7


def run(quick: bool, report: Report) -> Outcome:
    """Fit campaigns of both planes, each arrangement in turn, without noise and with it."""
    rows: list[Row] = []
    measured: dict[str, float] = {}
    for plane in Plane:
        names, held, biases = tuple(HULLS[plane]), [], []
        for k, arrangement in enumerate(ARRANGEMENTS[: 2 if quick else None]):
            report(f"{plane}, campaign {k}")
            generator = np.random.default_rng((20261124, list(Plane).index(plane), k))
            rigs = _campaign(plane, arrangement, generator)
            struts = [struts_of(rig, f"run {n}", _ORDERS) for n, rig in enumerate(rigs)]
            truth = np.array(list(HULLS[plane].values()))
            exact = _fit(rigs, [_scattered(one, generator, noisy=False) for one in struts], names)
            widths = exact.uncertain.half_width(0.95)
            biases.append(np.abs(exact.values - truth) / widths)
            for _ in range(4 if quick else _DRAWS):
                found = _fit(rigs, [_scattered(one, generator) for one in struts], names)
                held.append(np.abs(found.values - truth) <= found.uncertain.half_width(0.95))
        rates, bias = np.mean(held, axis=0), np.max(biases, axis=0)
        rows += [
            {"plane": str(plane), "coefficient": name, "held": float(rate), "bias": float(off)}
            for name, rate, off in zip(names, rates, bias, strict=True)
        ]
        measured |= {
            f"{plane}_least": float(rates.min()),
            f"{plane}_greatest": float(rates.max()),
            f"{plane}_bias": float(bias.max()),
        }
    notes = (
        f"{len(ARRANGEMENTS)} campaigns a plane of {_RUNS} runs, one for each arrangement: yaw 1 "
        "to 25 and pitch to 15 degrees, drift (trim) to 10, in the vertical plane with a surface "
        f"ship's restoring; {_DRAWS} draws of the harmonics' scatter over "
        f"{_PERIODS} periods, from which its covariance is estimated. `bias` is the largest "
        "difference from the truth without noise, over the half-width of the 95 % interval.",
    )
    return Outcome({"Exact rigs": rows}, {} if quick else measured, notes)


def _campaign(plane: Plane, arrangement: Arrangement, generator: Generator) -> list[ExactRig]:
    """Return runs in sway, yaw and both, three of them with drift."""
    largest = math.radians(_LARGEST_DEG[plane])
    rigs = []
    for n in range(_RUNS):
        turn = 0.0 if n == 0 else largest * generator.uniform(0.04, 1.0)
        rig = exact_rig(
            plane,
            arrangement,
            rotation_rad=turn,
            drift_rad=math.radians(generator.uniform(-10.0, 10.0)) if n > 3 else 0.0,
            sway_m=0.0 if n == 1 else generator.uniform(0.05, 0.15),
            frequency_hz=generator.uniform(0.15, 0.3),
        )
        rigs.append(afloat(rig))
    return rigs


def _scattered(struts: StrutCycle, generator: Generator, *, noisy: bool = True) -> StrutCycle:
    """Return the mean of noisy periods with the covariance that they show, or of exact ones."""
    exact = interleaved(struts.phasors.values)
    spread = _spread(struts, len(exact))
    draws = spread * generator.standard_normal((_PERIODS, len(exact)))
    source = of_draws(f"scatter of {struts.name}", draws)
    values = exact + draws.mean(axis=0) if noisy else exact
    phasors = replace(struts.phasors, real=UncertainValues(values, (source,)))
    return replace(struts, phasors=phasors)


def _spread(struts: StrutCycle, count: int) -> NDArray[np.float64]:
    moved = [name.startswith("displacement") for name in struts.phasors.names]
    spread = np.repeat(np.where(moved, _MOTION_M, _FORCE_N), 2)
    spread[1 : 2 * count // (2 * (struts.orders + 1)) : 2] = 0.0  # a mean has no quadrature
    return np.asarray(spread)


def _fit(rigs: list[ExactRig], struts: list[StrutCycle], names: tuple[str, ...]) -> CycleFit:
    cycles = [less_known(one, rig) for rig, one in zip(rigs, struts, strict=True)]
    return fit_cycles(cycles, names, _FITTED)


BENCHMARK = Benchmark("exact", "Coefficients of exact rigs", run)
