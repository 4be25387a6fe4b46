"""Free decays of a campaign: a table of periods and damping, and the figure of their records."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from pmm.coefficients.decays import Decay
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Figure, Table
from pmm.document.notation import rounded
from pmm.document.style import PALETTE, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

_CAPTION: Final = (
    "Heel of the free decays over time, the part of each record that was used; lines are the "
    "amplitudes found along it."
)
_DEGREES: Final = 180.0 / math.pi


def _runs(decay: Decay) -> str:
    return ", ".join(run.name for run in decay.runs)


def _power(decay: Decay) -> str:
    """How fast the decay rate grows with amplitude: 0 for linear damping, 1 for quadratic."""
    return ", ".join(f"{record.modes[0].decay.beta:.2g}" for record in decay.records)


_COLUMNS: Final[tuple[Column[Decay], ...]] = (
    Column("runs", _runs),
    Column("U", lambda decay: f"{decay.speed_m_s:g}", unit="m/s", number=True),
    Column("damped period", lambda decay: rounded(decay.period.value, decay.period.uncertainty),
           unit="s", number=True),
    Column("damping ratio", lambda decay: rounded(decay.ratio.value, decay.ratio.uncertainty),
           number=True),
    Column("power of the decay", _power, number=True),
    Column(None, lambda decay: [run.name for run in decay.runs], "runs"),
    Column(None, lambda decay: decay.speed_m_s, "speed_m_s"),
    Column(None, lambda decay: decay.period.value, "period_s"),
    Column(None, lambda decay: decay.period.uncertainty, "u_period_s"),
    Column(None, lambda decay: decay.ratio.value, "damping_ratio"),
    Column(None, lambda decay: decay.ratio.uncertainty, "u_damping_ratio"),
)  # fmt: skip


def decay_table(decays: Sequence[Decay]) -> Table[Decay]:
    """Return period and damping ratio at each speed; empty without decays."""
    title = "Free decays in roll, one standard uncertainty"
    return Table(title, _COLUMNS, decays, "free_decays", titled=True)


def decay_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield the figure where any model was let go."""
    if outcome.decays:
        yield Figure("decays", _CAPTION, partial(decay_figure, outcome.decays))


def decay_figure(decays: Sequence[Decay]) -> "Drawing":
    """Draw a panel for each speed."""
    with new_figure(7.2, 0.8 + 2.2 * len(decays)) as figure:
        panels = figure.subplots(len(decays), 1, sharex=True, squeeze=False)[:, 0]
        for axes, decay in zip(panels, decays, strict=True):
            for k, (run, record) in enumerate(zip(decay.runs, decay.records, strict=True)):
                colour, series = PALETTE[k % len(PALETTE)], record.part.series
                local = record.modes[0].local
                start_s = series.time_s[0]
                axes.plot(series.time_s - start_s, _DEGREES * series.values, color=colour, lw=0.6)
                axes.plot(local.time_s - start_s, _DEGREES * local.amplitude, color=colour, lw=1.4,
                          label=run.name)  # fmt: skip
            axes.set_ylabel(f"heel (°), {decay.speed_m_s:g} m/s")
            axes.legend(loc="upper right", fontsize=7.5)
        panels[-1].set_xlabel("time (s)")
    return figure
