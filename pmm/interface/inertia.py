"""Mass properties from a pendulum test: what ``pmm inertia`` finds, for Python."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from pmm.document.content import Document
from pmm.inertia.outcome import Outcome
from pmm.interface.result import FigureAxes, Result, Variable, dataset_of

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_VARIABLES: Final = {
    "value": Variable("", "value, in the unit of its finding"),
    "standard_uncertainty": Variable("", "standard uncertainty, in the unit of its finding"),
    "degrees_of_freedom": Variable("1", "effective, by Welch and Satterthwaite"),
    "half_width": Variable("", "half-width of the 95 % interval, in the unit of its finding"),
    "unit": Variable("", "unit of the finding"),
    "what": Variable("", "the finding in words"),
}


@dataclass(frozen=True)
class InertiaResult(Result):
    """Findings of a pendulum test with their budgets.

    Attributes
    ----------
    outcome
        Findings, periods, checks, and the body where all of it is known.
    """

    outcome: Outcome

    @cached_property
    def document(self) -> Document:
        """What ``pmm inertia`` shows."""
        from pmm.report.inertia_document import document

        return document(self.outcome)

    def to_dataframe(self) -> "pd.DataFrame":
        """Return a row for each finding, in the unit of the column ``unit``."""
        import pandas as pd

        return pd.DataFrame(
            {
                "name": finding.name,
                "what": finding.what,
                "value": finding.estimate.value,
                "standard_uncertainty": finding.estimate.uncertainty,
                "degrees_of_freedom": finding.estimate.degrees_of_freedom,
                "half_width": finding.estimate.half_width(),
                "unit": finding.estimate.unit,
            }
            for finding in self.outcome.findings
        )

    def to_dataset(self) -> "xr.Dataset":
        """Return the same over the dimension name."""
        attributes = {
            "job": self.outcome.job,
            "title": self.outcome.name,
            "level": 0.95,
            "conventions": "axes and signs: docs/conventions.md",
        }
        return dataset_of(self.to_dataframe(), ["name"], _VARIABLES, attributes)

    def plot_budget(self) -> FigureAxes:
        """Draw where the uncertainty of each finding comes from."""
        return self.plot("budget")

    def plot_records(self) -> dict[str, FigureAxes]:
        """Draw the fit over each source's records; axes by the figure's name."""
        return self._plot_kind("record")
