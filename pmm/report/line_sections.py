"""What a report says of runs of many lines: responses and distortions, a section each."""

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

from hardware.description.channels import DISPLACEMENTS
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Figure, Section
from pmm.harmonics.response_rows import response_rows
from pmm.report.response_figure import response_figure
from pmm.report.response_tables import response_tables

if TYPE_CHECKING:
    from analysis.resolver.harmonics import Harmonics

_CAPTION: Final = (
    "Gain, phase and coherence of each load, and its harmonics: excited ones, and beside noise "
    "those of distortions of odd and of even degree."
)


def line_sections(outcome: CampaignOutcome) -> Iterator[Section]:
    """Yield a section for each run of many lines whose motion was recorded."""
    for run in outcome.runs:
        if run.lines is not None and (motion := _moved(run.lines)) is not None:
            draw = partial(response_figure, run.lines, motion)
            rows = response_rows(run.lines, motion, (), outcome.result.level)
            figure = Figure(f"response-{run.name}", _CAPTION, draw)
            yield Section(f"Response by lines: {run.name}", (*response_tables(rows), figure))


def _moved(reading: "Harmonics") -> str | None:
    """Return the strut by whose motion the response is told: the first that was recorded."""
    return next((name for name in DISPLACEMENTS if name in reading.channel_names), None)
