"""The runs that a plan's design chooses: what ``pmm plan design`` finds, for Python."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

from pmm.coefficients.request import campaign_folder
from pmm.design.design_file import DesignFile, read_design
from pmm.design.measured_runs import continued_design, read_measured_runs
from pmm.design.run_selection import Design, design
from pmm.document.content import Document
from pmm.interface.result import FigureAxes, Result, Variable, dataset_of
from pmm.parallel import open_executor

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_OWN: Final = ", in the unit of its entry"
_VARIABLES: Final = {
    "name": Variable("", "the coefficient"),
    "where": Variable("", "frequency that it is of; empty of slow motion"),
    "unit": Variable("", "unit of the entry"),
    "believed": Variable("", f"value that the design starts from{_OWN}"),
    "wanted": Variable("", f"standard uncertainty that is asked for{_OWN}; NaN without a target"),
    "standard_uncertainty": Variable("", f"standard uncertainty that is expected{_OWN}"),
    "met": Variable("", "whether the target is expected to be met"),
    "message": Variable("", "why nothing can be expected of it"),
}


@dataclass(frozen=True)
class DesignResult(Result):
    """Which runs to make, and how well each coefficient will be known by them.

    Attributes
    ----------
    file
        What was asked for.
    design
        The runs, most telling first.
    """

    file: DesignFile
    design: Design

    @property
    def met(self) -> bool:
        """Whether all targets are expected to be met."""
        return self.design.met

    @cached_property
    def document(self) -> Document:
        """What ``pmm plan design`` shows."""
        from pmm.report.design_document import design_document

        return design_document(self.file, self.design, None)

    def to_dataframe(self) -> "pd.DataFrame":
        """Return a row for each coefficient: believed, asked for, and expected after all runs."""
        import pandas as pd

        return pd.DataFrame(
            {name: getattr(coefficient, name) for name in _VARIABLES}
            for coefficient in self.design.expected_coefficients
        )

    def to_dataset(self) -> "xr.Dataset":
        """Return the same over the dimension entry."""
        frame = self.to_dataframe().rename_axis("entry").reset_index()
        signs = "axes and signs: docs/conventions.md"
        attributes = {"design": self.file.name, "conventions": signs}
        return dataset_of(frame, ["entry"], _VARIABLES, attributes)

    def plot_uncertainty(self) -> FigureAxes:
        """Draw what is expected of each coefficient against tank time."""
        return self.plot("uncertainty")


def designed(path: Path, campaigns: Sequence[str | Path]) -> DesignResult:
    """Choose runs as ``pmm plan design`` does, after those that campaigns' folders hold."""
    file = read_design(path)
    if campaigns:
        with open_executor(1) as executor:
            folders = [campaign_folder(str(campaign)) for campaign in campaigns]
            file = continued_design(
                file, [read_measured_runs(file, folder, executor) for folder in folders]
            )
    return DesignResult(file, design(file))
