"""Roll and heel: do the intervals of their terms hold what heeled runs were made of."""

import math
from dataclasses import replace

import numpy as np

from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.strut_cycle import StrutCycle
from benchmarks.coefficients_campaigns import Scatter, scattered
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.heel import HeelGauges, RollConstraint
from tests.analysis.coefficients.test_heel_against_point_masses import (
    MATRIX,
    TERMS,
    body_and_heel,
    struts_of,
)

_CAMPAIGNS, _QUICK = 300, 3
_SEEDS = (175, 2029, 4096)  # the first 300 campaigns showed what was to be mended
_STATED = StatedUncertainties(
    heel_rad=math.radians(0.1), roll_gauge_relative=2e-3, force_gain_relative=1e-3, cg_z_m=5e-4
)
_SCATTER = Scatter(periods=12)


def run(quick: bool, report: Report) -> Outcome:
    """Count the intervals of three times 300 campaigns that hold the truth."""
    count = _QUICK if quick else _CAMPAIGNS
    exact = [
        struts_of(str(one), TERMS, one[1], one[2], (one[0], 0j), drift=one[3]) for one in MATRIX
    ]
    inside = np.zeros((len(_SEEDS), count, len(TERMS)), dtype=bool)
    for which, seed in enumerate(_SEEDS):
        for k in range(count):
            if k % 50 == 0:
                report(f"campaign {k} of seed {seed}")
            generator = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(k,)))
            inside[which, k] = _inside(exact, generator)
    shares = np.vstack((inside.mean(axis=1), inside.mean(axis=(0, 1))))
    rows: list[Row] = [
        _row(name, share) for name, share in zip(TERMS, shares.T.tolist(), strict=True)
    ]
    names = np.array(list(TERMS))
    kinds = {
        "all": names != "",
        "K": np.char.startswith(names, "K"),
        "heel": np.char.find(names, "phi") > 0,
    }
    means = {kind: shares[:, rows_of].mean(axis=1).tolist() for kind, rows_of in kinds.items()}
    measured = {
        "lower": min(one[-1] for one in means.values()),
        "upper": max(one[-1] for one in means.values()),
        "least": float(shares[-1].min()),
    }
    rows += [_row(f"mean of {kind}", every) for kind, every in means.items()]
    notes = (
        f"{len(_SEEDS)} times {count} campaigns of {len(MATRIX)} runs of point masses "
        "(tests/exact/heeled.py), three heels, sway, yaw and mixed, straight and at drift; 12 "
        "periods of scatter each, and one error of heel, roll gauge, force gauges and centre of "
        "gravity for all its runs.",
    )
    tables = {"Part of 95 % intervals that hold the truth": rows}
    return Outcome(tables, {} if quick else measured, notes)


def _row(name: str, shares: list[float]) -> Row:
    heads = (*(f"seed {one}" for one in _SEEDS), "all")
    return {"term": name, **dict(zip(heads, shares, strict=True))}


def _inside(exact: list[StrutCycle], generator: np.random.Generator) -> np.ndarray:
    """Return which intervals of one campaign hold the truth, shape ``(terms,)``."""
    off = generator.standard_normal(4)
    body, heel = body_and_heel(RollConstraint.SET, HeelGauges.UPRIGHT)
    body = replace(body, cg_z_m=body.cg_z_m + off[0] * _STATED.cg_z_m)
    roll = 1.0 + off[1] * _STATED.roll_gauge_relative
    force = 1.0 + off[2] * _STATED.force_gain_relative
    cycles = []
    for struts in exact:
        factors = {"roll": roll, "force_aft": force, "force_fore": force}
        gains = [
            next((one for key, one in factors.items() if name.startswith(key)), 1.0)
            for name in struts.phasors.names
        ]
        read = replace(struts, phasors=struts.phasors.mapped(np.diag(gains)))
        point = struts.set_point
        tilted = replace(point, heel_rad=point.heel_rad + off[3] * _STATED.heel_rad)
        noisy = scattered(replace(read, set_point=tilted), generator, _SCATTER)
        cycles.append(noisy.heeled(heel).model().without(body))
    fit = fit_cycles(cycles, tuple(TERMS), (0, 1, 2, 3), stated=_STATED)
    truth = np.array(list(TERMS.values()))
    return np.asarray(np.abs(fit.values - truth) <= fit.uncertain.half_width())


BENCHMARK = Benchmark("roll", "Roll and heel", run)
