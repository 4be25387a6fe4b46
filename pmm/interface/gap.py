"""The gap between rig and simulation: what ``pmm gap`` finds, for Python."""

from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from pmm.document.content import Document
from pmm.gap.examination import Options
from pmm.gap.report import GapReport, gap_report
from pmm.interface.result import FigureAxes, Result, Variable, dataset_of
from pmm.parallel import open_executor

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_VARIABLES: Final = {
    "probability": Variable("1", "probability of the answer"),
    "withheld_u": Variable("1", "gap left of withheld runs, in standard uncertainties"),
    "stage": Variable("", "where the answer acts along the chain"),
    "alike": Variable("", "effects that these runs cannot tell from it"),
}


@dataclass(frozen=True)
class GapResult(Result):
    """Where rig and simulation differ, which effect causes it, and how far the gap shrinks.

    Attributes
    ----------
    report
        Everything that is shown of the campaign.
    """

    report: GapReport

    @property
    def verdict(self) -> str:
        """``"none"``, ``"coefficients"``, ``"unknown"``, ``"odd-run"`` or ``"effect"``."""
        return self.report.conclusion.verdict

    @property
    def said(self) -> tuple[str, ...]:
        """Three sentences: what is wrong, how large it is, what to do next."""
        return self.report.said

    @cached_property
    def document(self) -> Document:
        """What ``pmm gap`` shows."""
        from pmm.gap.document import document

        return document(self.report)

    def to_dataframe(self) -> "pd.DataFrame":
        """Return a row for each answer, most probable first."""
        import pandas as pd

        return pd.DataFrame(
            {
                "answer": answer.answer,
                "probability": answer.probability,
                "withheld_u": answer.withheld_u,
                "stage": answer.stage,
                "alike": ", ".join(answer.alike),
            }
            for answer in self.report.ranking
        )

    def to_dataset(self) -> "xr.Dataset":
        """Return the same over the dimension answer, the verdict among the attributes."""
        attributes: dict[str, Any] = {
            "campaign": self.report.campaign,
            "verdict": self.verdict,
            "said": " ".join(self.said),
        }
        return dataset_of(self.to_dataframe(), ["answer"], _VARIABLES, attributes)

    def plot_ranking(self) -> FigureAxes:
        """Draw the answers with their probabilities."""
        return self.plot("ranking")

    def plot_walk(self) -> FigureAxes:
        """Draw the gap step by step along the chain."""
        return self.plot("walk")


def campaign_gap(path: Path, options: Options, jobs: int | None) -> GapResult:
    """Diagnose a campaign as ``pmm gap`` does."""
    from pmm.gap.examination import examine

    with nullcontext() if jobs == 1 else open_executor(jobs) as executor:
        return GapResult(gap_report(examine(path, options, executor, lambda _: None)))
