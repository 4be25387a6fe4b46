"""The problem that a pendulum's file poses."""

from pathlib import Path

from analysis.gap.pendulum.problem import PendulumProblem
from pmm.gap.pendulum import problem_of
from pmm.gap.pendulum_file import read_case


def load_problem(path: Path) -> PendulumProblem:
    """Read a file and its records."""
    return problem_of(read_case(path), path)
