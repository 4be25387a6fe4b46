"""Propeller and rudder: do the intervals of the MMG parameters hold what runs were made of."""

import numpy as np

from analysis.steering.identification import identified
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.analysis.manoeuvring.published import Published, kcs, kvlcc2
from tests.analysis.steering.captive import known, runs, truth

_CAMPAIGNS, _QUICK = 2000, 8
_NORMAL_95 = 1.959963984540054
_POINT = "self-propulsion, 1/s"


def run(quick: bool, report: Report) -> Outcome:
    """Count the intervals of 2,000 campaigns of each ship that hold the truth."""
    count = _QUICK if quick else _CAMPAIGNS
    tables: dict[str, list[Row]] = {}
    measured: dict[str, float] = {}
    for name, ship in (("KVLCC2", kvlcc2), ("KCS", kcs)):
        report(name)
        prefix = "" if ship is kvlcc2 else "kcs_"
        rows = _ship(ship, count, report)
        tables[f"Part of 95 % intervals that hold the truth, {name}"] = rows
        shares = [float(str(row["inside"])) for row in rows]
        measured |= {f"{prefix}least": min(shares), f"{prefix}greatest": max(shares)}
    notes = (
        f"{count} campaigns of each by the MMG paper's equations, written out in "
        "tests/analysis/manoeuvring/published.py with both ships' numbers and their sources: 15 "
        "static rudder, 20 oblique and 20 turning runs, errors drawn for every gauge and for the "
        "zero runs that all share.",
    )
    return Outcome(tables, {} if quick else measured, notes)


def _ship(ship: Published, count: int, report: Report) -> list[Row]:
    rng, expected = np.random.default_rng(2015), truth(ship)
    exact = np.array([*expected.values(), ship.N])
    off = np.empty((count, len(exact)))
    for k in range(count):
        if k % 500 == 0:
            report(f"campaign {k}")
        found = identified(runs(rng, ship=ship), known(ship))
        (point,) = found.self_propulsion
        values = np.append(found.values, point.rate_hz)
        off[k] = (values - exact) / np.append(found.standard_uncertainty, point.rate_u)
    shares = (np.abs(off) < _NORMAL_95).mean(axis=0)
    return [
        {"parameter": name, "inside": float(share), "mean error over u": float(mean)}
        for name, share, mean in zip((*expected, _POINT), shares, off.mean(axis=0), strict=True)
    ]


BENCHMARK = Benchmark("steering", "Propeller and rudder", run)
