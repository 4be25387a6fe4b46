"""A body under a known force: what its runs say of what it has, and of what nobody knows.

Its equation of motion is integrated by scipy, and the body that the simulation believes in is a
linear one within stated tolerances.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from numpy.random import Generator

from analysis.gap.pendulum.problem import PendulumProblem
from benchmarks.outcome import Benchmark, Outcome, Report
from benchmarks.pendulum_answers import Bodies, Cause, answered
from tests.analysis.gap.pendulum.driven_bodies import DAMPING, STIFFNESS, Made, driven

_RUNS: Final = ((0.4, 30.0), (0.6, 30.0), (0.6, 10.0), (0.9, 30.0))  # Hz, N
_KNOWN: Final = {"restoring": 2e-3, "damping": 0.02, "force": 2e-3}
_CAUSES: Final = {
    "guide friction": Cause("friction_n", 0.3, 2.5, ("bearing_friction",)),
    "drag": Cause("quadratic", 20.0, 300.0, ("quadratic_drag", "cubic_damping", "power_drag")),
    "hardening": Cause("hardening", 300.0, 3e4, ("nonlinear_restoring", "amplitude_period")),
    "late sensor": Cause("delay_s", 0.01, 0.1, ("sensor_delay", "sensor_lag")),
    "clock rate": Cause("clock", 3e-4, 3e-3, ("wrong_clock",)),
}
_NOTE: Final = (
    "Runs of 0.4, 0.6 and 0.9 Hz under 30 N and of 0.6 Hz under 10 N, 25 s at 20 Hz; restoring "
    "known to 0.2 %, damping to 2 %, force to 0.2 %, and each body off by as much. Sizes: "
    "friction 0.3 to 2.5 N, drag 20 to 300 N s2/m2, hardening 300 to 30,000 N/m3, delay 10 to "
    "100 ms, clock rate 0.03 to 0.3 %."
)


def _drawn(generator: Generator, wrong: Mapping[str, float], seed: int) -> PendulumProblem:
    restoring, damping, force = generator.standard_normal(3) * list(_KNOWN.values())
    body = Made(
        gain=1.0 + force,
        damping=DAMPING * (1.0 + damping),
        stiffness=STIFFNESS * (1.0 + restoring),
    )
    return driven(replace(body, **wrong), _RUNS, seed, _KNOWN)


def run(quick: bool, report: Report) -> Outcome:
    """Draw bodies, and ask what is wrong with each."""
    return answered(Bodies(_CAUSES, _drawn), 46, _NOTE, quick, report)


BENCHMARK = Benchmark("forced", "Diagnosis of a body under a known force", run)
