"""Runs in waves: loads per wave amplitude, and the figure of their lines."""

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

from analysis.coefficients.body_cycle import SURGE_FORCE, at_order
from analysis.response.waves import DIFFERENCE, ENCOUNTER, SUM, TWICE, InWaves, transfer
from hardware.description.channels import FORCE_AFT, FORCE_FORE, FORCE_X
from hardware.description.oscillator import Plane
from pmm.coefficients.wave_runs import WaveRun
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Figure, Table, data_only, word
from pmm.document.notation import NOT_KNOWN, rounded
from pmm.document.style import PALETTE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_CAPTION: Final = (
    "Loads of the waves on the model: amplitudes of the lines that were told from those of the "
    "shaft, with two standard uncertainties; e is the encounter frequency, f the shaft's."
)
_MEAN: Final = "mean"
_UNITS: Final = {"force": "N", "moment": "N m", "surge": "N"}
_ROWS: Final = {"force": "force", "moment": "moment", "surge": SURGE_FORCE}
_PER: Final = {ENCOUNTER: "/m", SUM: "/m", DIFFERENCE: "/m", TWICE: "/m2", _MEAN: "/m2"}


@dataclass(frozen=True)
class WaveRow:
    """One load of the water on the model at one line of a run.

    Attributes
    ----------
    value, value_u
        Per wave amplitude, squared where ``unit`` says so; an amplitude, and of a mean its sign
        too.
    lead_rad
        Over the crest at the probe (twice its phase for twice its frequency); NaN where it is none.
    """

    run: str
    encounter_hz: float
    expected_hz: float
    amplitude_m: float
    load: str
    line: str
    frequency_hz: float
    value: float
    value_u: float
    unit: str
    lead_rad: float = math.nan


def wave_rows(outcome: CampaignOutcome) -> tuple[WaveRow, ...]:
    """Return the loads of all runs in waves."""
    return tuple(row for run in outcome.waves for row in _rows(run))


def _rows(run: WaveRun) -> Iterator[WaveRow]:
    waves = run.waves
    head = (waves.run, waves.frequency_hz, waves.expected_hz, abs(waves.wave))
    for load, weights in _weights(run):
        for line in waves.lines:
            value, spread = transfer(waves, line.name, weights)
            lead = cmath.phase(value) if line.name in (ENCOUNTER, TWICE) else math.nan
            unit = _UNITS[load] + _PER[line.name]
            yield WaveRow(*head, load, line.name, line.frequency_hz, abs(value), spread, unit, lead)
        if run.calm is not None:
            yield WaveRow(*head, load, _MEAN, 0.0, *_mean(run, load), _UNITS[load] + _PER[_MEAN])


def _weights(run: WaveRun) -> Iterator[tuple[str, list[float]]]:
    """Yield each load of the water by the gauges, which read what the struts do."""
    half = run.cycle.half_spacing_m * (-1.0 if run.cycle.plane is Plane.VERTICAL else 1.0)
    shares = {
        "force": {FORCE_AFT.name: -1.0, FORCE_FORE.name: -1.0},
        "moment": {FORCE_AFT.name: half, FORCE_FORE.name: -half},
        "surge": {FORCE_X.name: -1.0},
    }
    for load, gauges in shares.items():
        if set(gauges) <= set(run.waves.channels):
            yield load, [gauges.get(name, 0.0) for name in run.waves.channels[1:]]


def _mean(run: WaveRun, load: str) -> tuple[float, float]:
    """Return what the waves add to a mean, and its uncertainty, per amplitude squared."""
    assert run.calm is not None  # noqa: S101 - the caller looks
    name = at_order(_ROWS[load], 0)
    means = [cycle.phasors.select([name]).real for cycle in (run.cycle, run.calm)]
    square = abs(run.waves.wave) ** 2
    spread = math.hypot(*(float(part.standard_uncertainty[0]) for part in means))
    return float(means[1].values[0] - means[0].values[0]) / square, spread / square


_COLUMNS: Final[tuple[Column[WaveRow], ...]] = (
    word("run", "run"),
    Column("e", lambda row: f"{row.encounter_hz:.4g}", unit="Hz", number=True),
    Column("e expected", lambda row: f"{row.expected_hz:.4g}", unit="Hz", number=True),
    Column("amplitude", lambda row: f"{1e3 * row.amplitude_m:.4g}", unit="mm", number=True),
    word("load", "load"),
    word("line", "line"),
    Column("load per wave", lambda row: rounded(row.value, row.value_u), number=True),
    word("unit", "unit"),
    Column("lead over the crest", lambda row: NOT_KNOWN if math.isnan(row.lead_rad)
           else f"{math.degrees(row.lead_rad):.1f}", unit="deg", number=True),
    *data_only("encounter_hz", "expected_hz", "amplitude_m", "frequency_hz", "value", "value_u",
               "lead_rad"),
)  # fmt: skip


def wave_table(outcome: CampaignOutcome) -> Table[WaveRow]:
    """Return the loads of the waves; empty where there were none."""
    title = "Loads of the waves on the model, by the probe, with one standard uncertainty"
    return Table(title, _COLUMNS, wave_rows(outcome), "waves", titled=True)


def wave_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield the figure where any run was made in waves."""
    if outcome.waves:
        yield Figure("waves", _CAPTION, partial(wave_figure, outcome.waves))


def wave_figure(runs: Sequence[WaveRun]) -> "Drawing":
    """Draw force and moment over the lines' frequencies, a colour for each run."""
    with new_figure(6.8, 5.2) as figure:
        panels = figure.subplots(2, 1, sharex=True)
        for k, run in enumerate(runs):
            weights = dict(_weights(run))
            for axes, load in zip(panels, ("force", "moment"), strict=True):
                _draw(axes, run.waves, weights[load], PALETTE[k % len(PALETTE)])
                axes.set_ylabel(f"{load} amplitude ({_UNITS[load]})")
        panels[0].legend(loc="best", fontsize=7.5)
        panels[1].set_xlabel("frequency (Hz)")
    return figure


def _draw(axes: "Axes", waves: InWaves, weights: Sequence[float], colour: str) -> None:
    for line in waves.lines:
        size = abs(sum(w * v for w, v in zip(weights, line.values[1:], strict=True)))
        spread = math.hypot(*(w * u for w, u in zip(weights, line.uncertainty[1:], strict=True)))
        label = waves.run if line.name == ENCOUNTER else None
        axes.errorbar(line.frequency_hz, size, 2.0 * spread, fmt="o", ms=4, color=colour,
                      capsize=2, label=label)  # fmt: skip
        axes.vlines(line.frequency_hz, 0.0, size, color=colour, lw=1.0)
        axes.annotate(line.name, (line.frequency_hz, size), (4, 2), textcoords="offset points",
                      fontsize=7.5)  # fmt: skip
