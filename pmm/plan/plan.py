"""Reading ``plan.toml``: a plan with all its runs, in the order in which they are made."""

from dataclasses import dataclass
from pathlib import Path

from pmm.plan.run_plan import RunPlan


@dataclass(frozen=True)
class Plan:
    """A plan, read and expanded.

    Attributes
    ----------
    name
        What the campaign is called; its folder too.
    path, rig_path
        Where the plan and the rig's file lie.
    runs
        In the order in which they are made.
    operator
        Who runs it, for the recordings; empty where the file does not say.
    sha256
        Of the plan's file.
    """

    name: str
    path: Path
    rig_path: Path
    runs: tuple[RunPlan, ...]
    operator: str
    sha256: str


def read_plan(path: str | Path) -> Plan:
    """Read a plan and the rig that it names.

    Raises
    ------
    ConfigurationError
        With every error of both files.
    """
    raise NotImplementedError(path)
