"""A body under a known force: what its runs say of what it has, and of what nobody knows.

Its equation of motion is integrated by scipy, and the body that the simulation believes in is a
linear one within stated tolerances. Each cause is diagnosed by the whole catalogue, and by one
without it and whatever acts alike.
"""

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator

from analysis.gap.pendulum.causes import causes_for
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import weigh
from analysis.gap.pendulum.verdict import CAUSE, judge
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.analysis.gap.pendulum.driven_bodies import DAMPING, STIFFNESS, Made, driven

_RUNS: Final = ((0.4, 30.0), (0.6, 30.0), (0.6, 10.0), (0.9, 30.0))  # Hz, N
_KNOWN: Final = {"restoring": 2e-3, "damping": 0.02, "force": 2e-3}
_NULLS: Final = 60
_EACH: Final = 10
_SURE: Final = 0.9
# Field of the body, sizes between which its logarithm is even, and what acts alike.
_CAUSES: Final = {
    "guide friction": ("friction_n", 0.3, 2.5, ("bearing_friction",)),
    "drag": ("quadratic", 20.0, 300.0, ("quadratic_drag", "cubic_damping", "power_drag")),
    "hardening": ("hardening", 300.0, 3e4, ("nonlinear_restoring", "amplitude_period")),
    "late sensor": ("delay_s", 0.01, 0.1, ("sensor_delay", "sensor_lag")),
    "clock rate": ("clock", 3e-4, 3e-3, ("wrong_clock",)),
}


def _body(generator: Generator) -> Made:
    """Return a body within what is known of it."""
    restoring, damping, force = generator.standard_normal(3) * list(_KNOWN.values())
    return Made(
        gain=1.0 + force,
        damping=DAMPING * (1.0 + damping),
        stiffness=STIFFNESS * (1.0 + restoring),
    )


def _said(problem: PendulumProblem, without: tuple[str, ...] = ()) -> tuple[str, set[str], float]:
    """Return what is said, the causes that are named, and how sure that is."""
    causes = [one for one in causes_for(problem.trials) if one.name not in without]
    verdict = judge(weigh(problem, causes, most=1))
    return verdict.outcome, set(verdict.best.names), verdict.probability


def _nulls(generator: Generator, count: int) -> Row:
    said = [_said(driven(_body(generator), _RUNS, at, _KNOWN)) for at in range(count)]
    right = sum(one == "none" for one, *_ in said)
    sure = sum(one != "none" and share > _SURE for one, _, share in said)
    return {"what": "nothing", "drawn": count, "right": right, "wrong and sure": sure}


def _caused(name: str, generator: Generator, count: int) -> tuple[Row, Row]:
    """Return how a cause is answered by the whole catalogue, and by one without it."""
    key, low, high, alike = _CAUSES[name]
    known: Row = {"what": name, "drawn": count, "right": 0, "wrong and sure": 0}
    withheld: Row = {"what": f"{name}, left out", "drawn": count, "right": 0, "wrong and sure": 0}
    for at in range(count):
        size = float(np.exp(generator.uniform(np.log(low), np.log(high))))
        problem = driven(replace(_body(generator), **{key: size}), _RUNS, 100 + at, _KNOWN)
        for row, without in ((known, ()), (withheld, alike)):
            said, names, share = _said(problem, without)
            named = said == CAUSE and names <= set(alike) and not without
            open_ = said in ("unknown", "untold")
            row["right"] = int(row["right"]) + (open_ if without else named)
            row["wrong and sure"] = int(row["wrong and sure"]) + (
                share > _SURE and not named and not open_
            )
    return known, withheld


def _share(rows: list[Row], key: str) -> float:
    return sum(int(row[key]) for row in rows) / sum(int(row["drawn"]) for row in rows)


def run(quick: bool, report: Report) -> Outcome:
    """Draw bodies, and ask what is wrong with each."""
    generator = np.random.default_rng(46)
    report("nothing")
    nulls = [_nulls(generator, 1 if quick else _NULLS)]
    known: list[Row] = []
    withheld: list[Row] = []
    for name in list(_CAUSES)[: 1 if quick else None]:
        report(name)
        with_it, without = _caused(name, generator, 1 if quick else _EACH)
        known.append(with_it)
        withheld.append(without)
    measured = {
        "nulls": _share(nulls, "right"),
        "named": _share(known, "right"),
        "sure": _share([*nulls, *known], "wrong and sure"),
        "withheld": _share(withheld, "wrong and sure"),
        "withheld_open": _share(withheld, "right"),
    }
    notes = (
        "Runs of 0.4, 0.6 and 0.9 Hz under 30 N and of 0.6 Hz under 10 N, 25 s at 20 Hz; restoring "
        "known to 0.2 %, damping to 2 %, force to 0.2 %, and each body off by as much. Sizes: "
        "friction 0.3 to 2.5 N, drag 20 to 300 N s2/m2, hardening 300 to 30,000 N/m3, delay 10 to "
        "100 ms, clock rate 0.03 to 0.3 %.",
        "Right is the cause itself or what acts alike; of one that is left out of the catalogue, "
        "with what acts alike, that something unknown is there or the cause cannot be told. Wrong "
        "and sure is any other answer at a probability above 0.9.",
    )
    return Outcome({"Answers": [*nulls, *known, *withheld]}, measured, notes)


BENCHMARK = Benchmark("forced", "Diagnosis of a body under a known force", run)
