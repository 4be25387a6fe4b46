"""Coefficients of a campaign: what ``pmm coefficients`` finds, for Python."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from analysis.coefficients.exchange import to_dataset
from analysis.coefficients.recommendation import table
from pmm.coefficients.request import finished, requested
from pmm.coefficients.workflow import CampaignOutcome, coefficients_of
from pmm.document.content import Document
from pmm.interface.result import FigureAxes, Result
from pmm.parallel import open_executor

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_MEANINGS: Final = {
    "value": "value, in the unit of its entry",
    "standard_uncertainty": "standard uncertainty, in the unit of its entry",
    "half_width": "half-width of the interval, in the unit of its entry",
    "frequency_hz": "frequency of the motion; 0 for slow motion",
    "speed_m_s": "carriage speed",
    "translation_amplitude_m": "amplitude of heave or sway",
    "rotation_amplitude_rad": "amplitude of pitch or yaw",
    "recommended": "whether this is the value to use of those of its name",
}
_UNITS: Final = {
    "frequency_hz": "Hz",
    "speed_m_s": "m/s",
    "translation_amplitude_m": "m",
    "rotation_amplitude_rad": "rad",
}


@dataclass(frozen=True)
class CoefficientsResult(Result):
    """Added mass, damping and derivatives of a campaign, with intervals and budgets.

    Attributes
    ----------
    outcome
        The coefficients and all that they rest on.
    """

    outcome: CampaignOutcome

    @cached_property
    def document(self) -> Document:
        """What ``pmm coefficients`` shows, and its figures."""
        from dataclasses import replace

        from pmm.document.content import Section
        from pmm.report.coefficient_plots import figures
        from pmm.report.coefficients_document import coefficients_document
        from pmm.report.memory_figure import memory_figures

        content = coefficients_document(self.outcome)
        figure_section = Section(
            "Figures", (*figures(self.outcome.result), *memory_figures(self.outcome))
        )
        return replace(content, sections=(*content.sections, figure_section))

    def to_dataframe(self) -> "pd.DataFrame":
        """Return a row for each coefficient by each method; ``recommended`` marks those to use."""
        import pandas as pd

        return pd.DataFrame([dict(row) for row in table(self.outcome.result)])

    def to_dataset(self) -> "xr.Dataset":
        """Return all of it, every input's contribution included, as ``--netcdf`` writes it."""
        dataset = to_dataset(self.outcome.result)
        for name, meaning in _MEANINGS.items():
            dataset[name].attrs["long_name"] = meaning
        for name, unit in _UNITS.items():
            dataset[name].attrs["units"] = unit
        return dataset.assign_attrs(conventions="axes and signs: docs/conventions.md")

    def plot_frequency(self) -> dict[str, FigureAxes]:
        """Draw coefficients over frequency, a figure for each speed; axes by the figure's name."""
        return self._plot_kind("frequency")

    def plot_amplitude(self) -> dict[str, FigureAxes]:
        """Draw coefficients over amplitude, where the campaign has several."""
        return self._plot_kind("amplitude")

    def plot_budget(self) -> dict[str, FigureAxes]:
        """Draw where the uncertainty of each coefficient comes from."""
        return self._plot_kind("budget")


def campaign_coefficients(
    folder: Path, options: Mapping[str, Any], jobs: int | None
) -> CoefficientsResult:
    """Find coefficients as ``pmm coefficients`` does; its options have the same names."""
    settings, _ = requested(folder, options)
    with open_executor(jobs) as executor:
        outcome = coefficients_of([folder], settings, executor, lambda *_: None)
    return CoefficientsResult(finished(outcome, settings))
