"""The jobs of pendulum tests, by name: which function does what a file of that kind says."""

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pmm.inertia.outcome import Outcome

JOBS: Final = {
    "swing": "swing:run",
    "bifilar": "bifilar:run",
    "pendulum": "pendulum:run",
    "incline": "incline:run",
    "combine": "parts:run_combine",
    "ballast": "parts:run_ballast",
    "plan": "plan:run",
}


def do_job(job: str, file: str) -> "Outcome":
    """Do what a job's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or the data do not carry what is asked.
    """
    module, _, function = JOBS[job].partition(":")
    run = getattr(import_module(f"pmm.inertia.{module}"), function)
    outcome: Outcome = run(file)
    return outcome
