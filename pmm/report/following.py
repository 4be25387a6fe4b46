"""How struts that are led by set-points followed them: a table of all runs, and a figure."""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from analysis.response.following import Following
from hardware.description.channels import DISPLACEMENTS
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Figure, Table, data_only, number, word
from pmm.document.notation import written
from pmm.document.style import PALETTE, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

_MILLIONTH: Final = 1e6
_DEGREES: Final = 180.0 / math.pi


def _in(factor: float, key: str) -> Callable[[Following], str]:
    return lambda row: f"{factor * getattr(row, key):.3g}"


_COLUMNS: Final[tuple[Column[Following], ...]] = (
    word("run", "run"),
    word("channel", "channel"),
    number("f", "frequency_hz", written(".4g"), "Hz"),
    Column("rms", _in(_MILLIONTH, "rms"), number=True),
    Column("peak", _in(_MILLIONTH, "peak"), number=True),
    Column("", lambda row: f"µ{row.unit}"),
    Column("amplitude error", _in(100.0, "amplitude_relative"), unit="%", number=True),
    Column("±", _in(100.0, "u_amplitude_relative"), unit="%", number=True),
    Column("phase", _in(_DEGREES, "phase_rad"), unit="deg", number=True),
    Column("±", _in(_DEGREES, "u_phase_rad"), unit="deg", number=True),
    *data_only(
        "unit",
        "rms",
        "peak",
        "amplitude_relative",
        "phase_rad",
        "u_amplitude_relative",
        "u_phase_rad",
    ),
)
_NOTE: Final = (
    "Displacement less set-point over the gate; amplitude and phase of the displacement over those "
    "of the set-point at the run's own frequency, a lag negative, ± standard uncertainty. Of a "
    "carriage that follows a path likewise its speed less the path's, at the path's largest line. "
    "Coefficients are taken from the displacements and the recorded speed."
)
_CAPTION: Final = (
    "Following error of struts that are led by set-points, over frequency: rms (filled) and peak "
    "(open), amplitude and phase of the displacement over those of the set-point, with two "
    "standard uncertainties."
)


def following_rows(outcome: CampaignOutcome) -> list[Following]:
    """Return struts and carriage of each run that were led and recorded, by frequency."""
    rows = [row for run in outcome.runs for row in (*run.following, *run.carriage)]
    return sorted(rows, key=lambda row: row.frequency_hz)


def following_table(outcome: CampaignOutcome) -> Table[Following]:
    """Return how struts and carriage followed what they were told in each run."""
    rows = following_rows(outcome)
    return Table("Following error", _COLUMNS, rows, "following", titled=True, notes=(_NOTE,))


def following_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield the figure where any run's set-points were recorded."""
    rows = [row for row in following_rows(outcome) if row.channel in DISPLACEMENTS]
    if rows:
        yield Figure("following", _CAPTION, partial(following_figure, rows))


def following_figure(rows: Sequence[Following]) -> "Drawing":
    """Draw rms and peak, amplitude error and phase over frequency, a colour for each strut."""
    with new_figure(10.0, 3.2) as figure:
        size, gain, phase = figure.subplots(1, 3)
        for name, colour in zip(DISPLACEMENTS, PALETTE, strict=False):
            strut_rows = [row for row in rows if row.channel == name]
            frequencies_hz = [row.frequency_hz for row in strut_rows]
            for key, face in (("rms", colour), ("peak", "none")):
                sizes = [_MILLIONTH * getattr(row, key) for row in strut_rows]
                size.plot(frequencies_hz, sizes, "o", color=colour, markerfacecolor=face)
            for axes, key, factor in (
                (gain, "amplitude_relative", 100.0), (phase, "phase_rad", _DEGREES),
            ):  # fmt: skip
                values = [factor * getattr(row, key) for row in strut_rows]
                widths = [2.0 * factor * getattr(row, f"u_{key}") for row in strut_rows]
                axes.errorbar(frequencies_hz, values, widths, fmt="o", color=colour, label=name)
        units = dict.fromkeys(f"µ{row.unit}" for row in rows)
        labels = (f"following error ({', '.join(units)})", "amplitude error (%)", "phase (°)")
        for axes, label in zip((size, gain, phase), labels, strict=True):
            axes.set_xlabel("frequency (Hz)")
            axes.set_ylabel(label)
        size.set_ylim(bottom=0.0)
        gain.legend()
    return figure
