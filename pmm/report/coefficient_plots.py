"""The figures of a campaign's coefficients, and writing them to files.

Over frequency and over amplitude, with intervals and reference tables, and where the uncertainty of
each comes from.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from analysis.coefficients.campaign_result import CampaignCoefficients
from pmm.document.style import write_figure
from pmm.report.coefficient_amplitude import amplitude_figure, has_amplitudes
from pmm.report.coefficient_budget import budget_figure, budget_rows
from pmm.report.coefficient_frequency import frequency_figure, panels_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_CAPTIONS = {
    "frequency": "Coefficients over frequency with their intervals: the recommended value, shaded "
    "across where it is that of slow motion, beside each frequency's own. Dashed lines are "
    "reference tables, where they were given.",
    "terms": "Non-linear terms, drawn alike.",
    "amplitude": "Linear coefficients over the amplitude of the motion: what does not lie on a "
    "level line is not linear.",
    "budget": "Left: the interval of each recommended value in per cent of it, hatched where it is "
    "as large as the value. Right: where it comes from, by kind of input.",
}


def figures(
    found: CampaignCoefficients,
) -> Iterator[tuple[str, str, Callable[[], "Figure"]]]:
    """Yield name, caption and drawing of every figure that the campaign allows."""
    for number, speed in enumerate(sorted({entry.speed_m_s for entry in found.entries}), 1):
        end = f"-{number}"
        for kind, names in panels_of(found, speed).items():
            yield (
                f"{kind}{end}",
                f"{speed:g} m/s. {_CAPTIONS[kind.partition('-')[0]]}",
                _frequency(found, speed, names),
            )
        if has_amplitudes(found, speed):
            yield (
                f"amplitude{end}",
                f"{speed:g} m/s. {_CAPTIONS['amplitude']}",
                _amplitude(found, speed),
            )
        rows = budget_rows(found, speed)
        if rows:
            yield (
                f"budget{end}",
                f"{speed:g} m/s. {_CAPTIONS['budget']}",
                _budget(found, rows, speed),
            )


def _frequency(
    found: CampaignCoefficients, speed: float, names: Sequence[str]
) -> Callable[[], "Figure"]:
    return lambda: frequency_figure(found, speed, names)


def _amplitude(found: CampaignCoefficients, speed: float) -> Callable[[], "Figure"]:
    return lambda: amplitude_figure(found, speed)


def _budget(
    found: CampaignCoefficients, rows: Sequence[int], speed: float
) -> Callable[[], "Figure"]:
    return lambda: budget_figure(found, rows, speed)


def save_figures(
    found: CampaignCoefficients,
    folder: Path,
    stem: str = "coefficients",
    formats: Sequence[str] = ("svg", "png"),
) -> list[Path]:
    """Write the figures as ``<stem>-frequency-1.svg``, ``<stem>-budget-1.svg`` ...

    Parameters
    ----------
    folder
        Made if it is not there.
    formats
        Any of ``svg``, ``png`` and ``pdf``.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ConfigurationError
        If a format is not known.
    """
    written = []
    for name, _, draw in figures(found):
        written += write_figure(draw(), folder, f"{stem}-{name}", formats)
    return written
