"""The evidence of the gap diagnosis, by Laplace, against nested sampling of the same integral."""

import math
import warnings
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import null_evidence, scales
from analysis.gap.search.engine import Engine, fit_leading, looked_at
from analysis.gap.search.fit import Fit
from analysis.gap.search.slopes import bounds
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError
from pmm.gap.load import unlimited
from sim.effects.catalogue import build, find
from sim.rig import vertical_rig

# Each effect at a size that shows, and at one that hardly does.
_EFFECTS = (
    ("coulomb-friction:friction_n={:g}", (0.5, 0.05)),
    ("viscous-guides:viscous_n_s_m={:g}", (3.0, 0.3)),
    ("quadratic-damping:translation_n_s2_m2={:g}", (400.0, 40.0)),
    ("cubic-damping:translation_n_s3_m3={:g}", (4000.0, 400.0)),
    ("gain-error:aft={:g}", (0.01, 0.001)),
    ("cross-talk:aft={:g}", (0.01, 0.001)),
    ("amplifier-lag:cutoff_hz={:g}", (20.0, 200.0)),
    ("speed-ripple:relative={:g}", (5e-3, 5e-4)),
    ("eccentricity-error:error_aft_m={:g}", (2e-4, 2e-5)),
    ("mass-error:relative={:g}", (0.02, 0.002)),
)
_CALLS = 200_000
_WIDEST = 6.0  # of a prior's widths, beyond which nothing is left of it


def run(quick: bool, report: Report) -> Outcome:
    """Integrate over each effect's parameters in both ways, on campaigns that have the effect."""
    from tests.analysis.gap.small import problem_of, record

    rig = unlimited(vertical_rig())
    rows: list[Row] = []
    every = [(text, size) for text, sizes in _EFFECTS for size in sizes]
    for number, (text, size) in enumerate(every[:1] if quick else every):
        effect = build(text.format(size))
        report(f"{effect.name}: {number + 1} of {len(every)}")
        problem = problem_of(rig, record(rig, [effect], 900 + number))
        rows.append(_row(problem, effect.name, size, quick))
    told = [row for row in rows if float(row["parameters"]) <= 3]
    off = np.abs([float(row["Laplace - nested"]) for row in told])
    measured = {"median_nats": float(np.median(off)), "worst_nats": float(off.max())}
    return Outcome(
        {"Log evidence over that of no gap": rows},
        measured,
        (
            "Nested sampling (dynesty, static, 200 live points) calls the simulator for each "
            "sample; coefficients, settings and noise are integrated in closed form by both.",
        ),
    )


def _row(problem: Problem, name: str, size: float, quick: bool) -> Row:
    none = null_evidence(problem.residual, problem.nuisances)
    seen = looked_at(problem, [find(name)], Engine())
    fit = fit_leading(problem, seen, none, Engine())[0]
    found, error, calls = _nested(problem, fit, 20 if quick else 200)
    return {
        "effect": name,
        "size": size,
        "parameters": len(fit.units),
        "Laplace": fit.log_evidence - none,
        "nested": found - none,
        "its error": error,
        "Laplace - nested": fit.log_evidence - found,
        "calls": calls,
    }


def _nested(problem: Problem, fit: Fit, live: int) -> tuple[float, float, int]:
    """Return the log evidence by nested sampling, its standard error and the calls it took."""
    from dynesty import NestedSampler

    widths = _widths(fit)
    reach = _WIDEST * widths.max(axis=0)
    low, high = np.clip(bounds(fit.candidates), -reach, reach)
    log_volume = float(np.sum(np.log(high - low)))
    sampler = NestedSampler(
        partial(_log_density, problem, fit, widths),
        partial(_stretched, low, high),
        len(fit.units),
        nlive=live,
        rstate=np.random.default_rng(1977),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sampler.run_nested(dlogz=0.05, maxcall=_CALLS, print_progress=False)
    found: Any = sampler.results
    return float(found.logz[-1]) + log_volume, float(found.logzerr[-1]), int(np.sum(found.ncall))


def _stretched(low: FloatArray, high: FloatArray, share: FloatArray) -> FloatArray:
    return low + share * (high - low)


def _widths(fit: Fit) -> FloatArray:
    """Return the widths of each parameter's prior in the mixture, ``(priors, p)``."""
    told = np.diagonal(fit.posterior.precision) - 1.0
    groups = fit.sizes
    each = [scales(told[group], reach) for group, reach in zip(groups, fit.reaches, strict=True)]
    return np.array(
        [
            np.prod([np.where(g, width, 1.0) for g, width in zip(groups, one, strict=True)], axis=0)
            for one in product(*each)
        ]
    )


def _log_density(problem: Problem, fit: Fit, widths: FloatArray, units: FloatArray) -> float:
    """Return the log of likelihood times prior."""
    try:
        change = problem.signature(fit.candidates, units)
    except PmmError:
        return -1e300
    prior = -0.5 * np.sum((units / widths) ** 2, axis=1) - np.sum(np.log(widths), axis=1)
    log_prior = float(np.logaddexp.reduce(prior)) - math.log(len(prior))
    log_prior -= 0.5 * len(units) * math.log(2.0 * math.pi)
    return null_evidence(problem.residual - change, problem.nuisances) + log_prior


BENCHMARK = Benchmark("evidence", "Evidence against nested sampling", run)
