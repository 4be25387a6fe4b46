"""SIMMAN's ships: do the intervals of propeller, rudder and hull hold what runs were made of."""

import numpy as np

from analysis.coefficients.normalisation import mmg
from analysis.coefficients.terms import term_of
from analysis.steering.identification import identified
from benchmarks.coefficients_coverage import cubic_rates
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.oscillator import Plane
from tests.analysis.manoeuvring.published import Published, kcs, kvlcc2
from tests.analysis.steering.captive import known, runs, truth

_CAMPAIGNS, _QUICK = 2000, 40
_NORMAL_95 = 1.959963984540054
_LENGTH_M, _SPEED_M_S = 2.9091, 1.2  # of the hull's model and its carriage
_POINT = "self-propulsion, 1/s"


def run(quick: bool, report: Report) -> Outcome:
    """Count the intervals of 2,000 campaigns of each ship that hold the truth."""
    count = _QUICK if quick else _CAMPAIGNS
    tables: dict[str, list[Row]] = {}
    measured: dict[str, float] = {}
    for name, ship in (("KVLCC2", kvlcc2), ("KCS", kcs)):
        report(name)
        prefix = "" if ship is kvlcc2 else "kcs_"
        for part, rows in (
            ("", _behind(ship, count, report)),
            ("hull_", _hull(ship, count, report)),
        ):
            what = "hull" if part else "propeller and rudder"
            tables[f"Part of 95 % intervals that hold the truth: {name}, {what}"] = rows
            shares = [float(str(row["inside"])) for row in rows]
            key = f"{prefix}{part}"
            measured |= {f"{key}least": min(shares), f"{key}greatest": max(shares)}
    notes = (
        f"{count} campaigns of each by the MMG paper's equations, written out in "
        "tests/analysis/manoeuvring/published.py with both ships' numbers and their sources: 15 "
        "static rudder, 20 oblique and 20 turning runs, errors drawn for every gauge and for the "
        "zero runs that all share.",
        f"The hull: {count} campaigns of sway, yaw and static drift of a model of {_LENGTH_M:g} m "
        f"at {_SPEED_M_S:g} m/s with the table's derivatives of sway and yaw, linear and cubic, "
        "errors of every period and of mass, inertia, lag, gauges and amplitude. A table in the "
        "Abkowitz form has the same intervals times a number.",
    )
    return Outcome(tables, {} if quick else measured, notes)


def _behind(ship: Published, count: int, report: Report) -> list[Row]:
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


def _hull(ship: Published, count: int, report: Report) -> list[Row]:
    system = mmg(_LENGTH_M, ship.D * _LENGTH_M / ship.L, _SPEED_M_S, ship.RHO)
    own = {name: one for name, one in ship.HULL.items() if name[0] in "YN"}
    own |= {"Y_vdot": -ship.M_Y, "N_rdot": -ship.J_Z}
    put_in = {
        name: one * system.term_factor(term_of(name, Plane.HORIZONTAL)) for name, one in own.items()
    }
    rates = cubic_rates(count, report, put_in)
    return [{"parameter": name, "inside": share} for name, share in rates.items()]


BENCHMARK = Benchmark("steering", "Hull, propeller and rudder of SIMMAN's ships", run)
