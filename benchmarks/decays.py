"""Free decays: what their records say of what a body has, and of what nobody knows.

Its equation of motion is integrated by scipy, a hand lets go of it over a time of its own, and the
body that the simulation believes in is a linear one within stated tolerances.
"""

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from numpy.random import Generator

from analysis.gap.pendulum.causes import BEYOND_LINEAR, DAMPING, STIFFNESS
from analysis.gap.pendulum.problem import PendulumProblem
from benchmarks.outcome import Benchmark, Outcome, Report
from benchmarks.pendulum_answers import Bodies, Cause, answered
from tests.analysis.gap.pendulum.decaying_bodies import Released, written
from tests.pmm.gap.pendulum_problem import load_problem

_KNOWN: Final = {"inertia": 2e-3, "restoring": 2e-3, "damping": 0.02}
_HAND_S: Final = 0.6  # at most
_SWINGS: Final = (15.0, 40.0)
_RATES_HZ: Final = (10.0, 25.0, 50.0, 100.0)
_PERIODS: Final = ("inertia", "restoring", "wrong_clock")
_ZERO: Final = ("sensor_offset", "sensor_drift")
_CAUSES: Final = {
    "dry friction": Cause("dead_zone", 3e-5, 5e-4, ("bearing_friction",), DAMPING),
    "drag": Cause("loss", 0.1, 1.0, BEYOND_LINEAR, DAMPING),
    "cubic damping": Cause("cubic_loss", 1.0, 10.0, BEYOND_LINEAR, DAMPING),
    "softening": Cause(
        "softening", 0.1, 2.0, ("nonlinear_restoring", "amplitude_period"), STIFFNESS
    ),
    "restoring": Cause("restoring", 1.02, 1.2, _PERIODS),
    "zero offset": Cause("offset", 5e-4, 1e-2, ("sensor_offset",), _ZERO),
    "drifting zero": Cause("drift_per_s", 2e-5, 5e-4, ("sensor_drift",), _ZERO),
}
_NOTE: Final = (
    "A body of 1.8 s and 3 % of critical damping, let go from 10 degrees over up to 0.6 s, 15 to "
    "40 swings at 10 to 100 Hz, noise of 0.1 mrad; inertia and restoring known to 0.2 %, damping "
    "to 2 %, and each body off by as much. Sizes: friction that holds 0.03 to 0.5 mrad, drag that "
    "takes 0.1 to 1 of the amplitude's square a cycle, cubic damping 1 to 10 of its cube, "
    "softening by 0.1 to 2 of its square, restoring 2 to 20 % larger, a zero off by 0.5 to 10 "
    "mrad or drifting by 0.02 to 0.5 mrad/s."
)


def _drawn(generator: Generator, wrong: Mapping[str, float], seed: int) -> PendulumProblem:
    inertia, restoring, damping = generator.standard_normal(3) * list(_KNOWN.values())
    body = {
        "inertia": 1.0 + inertia,
        "restoring": 1.0 + restoring,
        "damping": 1.0 + damping,
        "hand_s": generator.uniform(0.05, _HAND_S),
    }
    swings, rate_hz = generator.uniform(*_SWINGS), float(generator.choice(_RATES_HZ))
    record = Released(**{**body, **wrong}).record(swings, rate_hz)
    with tempfile.TemporaryDirectory() as folder:
        return load_problem(written(Path(folder), *record, _KNOWN, seed=seed))


def run(quick: bool, report: Report) -> Outcome:
    """Draw bodies, and ask what is wrong with each."""
    return answered(Bodies(_CAUSES, _drawn), 47, _NOTE, quick, report)


BENCHMARK = Benchmark("decays", "Diagnosis of free decays", run)
