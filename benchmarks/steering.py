"""Propeller and rudder: do the intervals of the MMG parameters hold what runs were made of."""

import numpy as np

from analysis.steering.identification import identified
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.analysis.manoeuvring.kvlcc2 import N as SELF_PROPULSION_HZ
from tests.analysis.steering.captive import KNOWN, TRUTH, runs

_CAMPAIGNS, _QUICK = 2000, 40
_NORMAL_95 = 1.959963984540054
_POINT = "self-propulsion, 1/s"


def run(quick: bool, report: Report) -> Outcome:
    """Count the intervals of 2,000 campaigns that hold the truth."""
    count, rng = _QUICK if quick else _CAMPAIGNS, np.random.default_rng(2015)
    truth = np.array([*TRUTH.values(), SELF_PROPULSION_HZ])
    off = np.empty((count, len(truth)))
    for k in range(count):
        if k % 500 == 0:
            report(f"campaign {k}")
        found = identified(runs(rng), KNOWN)
        (point,) = found.self_propulsion
        values = np.append(found.values, point.rate_hz)
        off[k] = (values - truth) / np.append(found.standard_uncertainty, point.rate_u)
    shares = (np.abs(off) < _NORMAL_95).mean(axis=0)
    names = (*TRUTH, _POINT)
    rows: list[Row] = [
        {"parameter": name, "inside": float(share), "mean error over u": float(mean)}
        for name, share, mean in zip(names, shares, off.mean(axis=0), strict=True)
    ]
    measured = {"least": float(shares.min()), "greatest": float(shares.max())}
    notes = (
        f"{count} campaigns of KVLCC2's model of 7 m by the MMG paper's equations, written out in "
        "tests/analysis/manoeuvring/kvlcc2.py: 15 static rudder, 20 oblique and 20 turning runs, "
        "errors drawn for every gauge and for the zero runs that all share.",
    )
    tables = {"Part of 95 % intervals that hold the truth": rows}
    return Outcome(tables, {} if quick else measured, notes)


BENCHMARK = Benchmark("steering", "Propeller and rudder", run)
