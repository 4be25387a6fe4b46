"""Harmonics of recordings: what ``pmm analyse`` finds, for Python."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from hardware.description.errors import ConfigurationError, DataError
from pmm.document.content import Document
from pmm.harmonics.request import HarmonicsRequest
from pmm.harmonics.resolving import Failure, Resolved, doubts, resolve
from pmm.harmonics.rows import ChannelRows, GateRows, RunRows
from pmm.harmonics.sources import Source, SourceList
from pmm.interface.result import CONVENTIONS, FigureAxes, Result, Variable, dataset_of

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from analysis.resolver.analysis import Analysis

_HALF: Final = "half-width of its interval"
_OWN: Final = "that of the coordinate unit"
_VARIABLES: Final = {
    "in_phase": Variable(_OWN, "part that goes with the sine of the phase; of order 0 the mean"),
    "in_phase_half_width": Variable(_OWN, _HALF),
    "quadrature": Variable(_OWN, "part that goes with the cosine of the phase"),
    "quadrature_half_width": Variable(_OWN, _HALF),
    "amplitude": Variable(_OWN, "amplitude A of A sin(n theta + phase)"),
    "amplitude_half_width": Variable(_OWN, _HALF),
    "phase_deg": Variable("deg", "phase of A sin(n theta + phase)"),
    "phase_half_width_deg": Variable("deg", _HALF),
    "frequency_hz": Variable("Hz", "frequency of the motion in the gate"),
    "periods": Variable("1", "whole periods of the gate"),
}


@dataclass(frozen=True)
class HarmonicsResult(Result):
    """Mean and harmonics of one recording or of all runs of a campaign.

    Attributes
    ----------
    resolved
        Each recording with its rows.
    failed
        What could not be resolved, and why.
    not_recorded
        Where the recordings of a campaign's other runs would lie.
    request
        What was asked.
    """

    resolved: tuple[Resolved, ...]
    failed: tuple[Failure, ...]
    not_recorded: tuple[Path, ...]
    request: HarmonicsRequest

    @property
    def runs(self) -> tuple[RunRows, ...]:
        """The rows of each recording, as ``pmm analyse`` has them."""
        return tuple(run.rows for run in self.resolved)

    @property
    def level(self) -> float:
        """Probability of the intervals."""
        return self.request.level

    @cached_property
    def document(self) -> Document:
        """What ``pmm analyse`` shows."""
        from pmm.report.harmonics_document import analysis_document

        flagged_files = tuple(doubts(self.resolved))
        return analysis_document(
            self.runs, self.failed, self.not_recorded, flagged_files, self.level
        )

    def to_dataframe(self) -> "pd.DataFrame":
        """Return a row for each run, gate, channel and order; order 0 is the mean, in ``in_phase``.

        Values are in the unit of the column ``unit``, SI; half-widths are those of :attr:`level`.
        """
        import pandas as pd

        return pd.DataFrame(
            row
            for run in self.runs
            for gate in run.gates
            for channel in gate.channels
            for row in _rows(run, gate, channel)
        )

    def to_dataset(self) -> "xr.Dataset":
        """Return the same over the dimensions run, gate, channel and order; NaN where none is.

        Raises
        ------
        DataError
            If a channel is in several units.
        """
        frame = self.to_dataframe()
        units = frame.groupby("channel")["unit"].unique()
        if mixed_names := [
            str(name) for name, channel_units in units.items() if len(channel_units) > 1
        ]:
            raise DataError(
                f"{', '.join(mixed_names)}: in several units, by run; open the recordings one by "
                "one, or put the units right in the campaign's column map"
            )
        index = ["run", "gate", "channel", "order"]
        attributes = {"conventions": CONVENTIONS, "level": self.level}
        dataset = dataset_of(frame.drop(columns="unit"), index, _VARIABLES, attributes)
        of_gate = {
            name: dataset[name].max(["channel", "order"], keep_attrs=True)
            for name in ("frequency_hz", "periods")
        }
        unit = [units[name][0] for name in dataset["channel"].values]
        return dataset.assign(of_gate).assign_coords(unit=("channel", unit))

    @property
    def figures(self) -> tuple[str, ...]:
        """Names of the figures that :meth:`plot` draws."""
        from pmm.report.plots import FIGURES

        return tuple(FIGURES)

    def plot(self, name: str, run: str | None = None) -> FigureAxes:
        """Draw a figure of one run's first gate and return its axes.

        Parameters
        ----------
        run
            Of which run; needed where there are several. Its recording is read again.

        Raises
        ------
        ConfigurationError
            If there is no such figure or run.
        """
        from pmm.report.plots import FIGURES

        if name not in FIGURES:
            raise ConfigurationError(f"no figure {name!r}; there are: {', '.join(FIGURES)}")
        return self._draw(FIGURES[name], self._source(run))

    def plot_gate(self, run: str | None = None) -> FigureAxes:
        """Draw the record, its window and gate, and the fit; see :meth:`plot`."""
        return self.plot("gate", run)

    def plot_phasors(self, run: str | None = None) -> FigureAxes:
        """Draw the harmonics as phasors with their regions; see :meth:`plot`."""
        return self.plot("phasors", run)

    def plot_spectrum(self, run: str | None = None) -> FigureAxes:
        """Draw the spectrum over the gate; see :meth:`plot`."""
        return self.plot("spectrum", run)

    def _source(self, run: str | None) -> Source:
        names = [recording.rows.run for recording in self.resolved]
        if run is None and len(names) == 1:
            return self.resolved[0].source
        if run not in names:
            hint = "say which run" if run is None else f"no run {run!r}"
            raise ConfigurationError(f"{hint}; there are: {', '.join(names)}")
        return self.resolved[names.index(run)].source

    def _draw(self, draw: "Callable[[Analysis], Figure]", source: Source) -> FigureAxes:
        figures: list[Figure] = []
        resolved_again = resolve(
            source,
            self.request,
            self.request.chosen_columns(),
            lambda analysis, _: figures.append(draw(analysis)),
        )
        if isinstance(resolved_again, Failure):
            raise DataError(resolved_again.full_message)
        return FigureAxes(figures[0].axes)


def harmonics_of(source_list: SourceList, request: HarmonicsRequest) -> HarmonicsResult:
    """Resolve recordings as ``pmm analyse`` does.

    Raises
    ------
    ConfigurationError
        If what is asked cannot go together.
    DataError
        If none of them can be resolved; the message is the first one's.
    """
    request.check(source_list.sources)
    columns = request.chosen_columns()
    outcomes = [resolve(source, request, columns, None) for source in source_list.sources]
    failures = tuple(outcome for outcome in outcomes if isinstance(outcome, Failure))
    resolved = tuple(outcome for outcome in outcomes if isinstance(outcome, Resolved))
    if not resolved:
        first = failures[0]
        kind = DataError if first.exit_status == DataError.exit_status else ConfigurationError
        raise kind(first.full_message)
    return HarmonicsResult(resolved, failures, source_list.not_recorded, request)


def _rows(run: RunRows, gate: GateRows, channel: ChannelRows) -> Iterator[dict[str, Any]]:
    run_columns = {"run": run.run, "gate": gate.number, "channel": channel.name}
    gate_columns = {
        "unit": channel.unit,
        "frequency_hz": gate.frequency_hz,
        "periods": gate.periods,
    }
    mean = (channel.mean.value, channel.mean.half_width, *[math.nan] * 6)
    yield {**run_columns, "order": 0, **_variables(mean), **gate_columns}
    for harmonic in channel.harmonics:
        parts = (harmonic.in_phase, harmonic.quadrature, harmonic.amplitude, harmonic.phase_deg)
        numbers = [number for part in parts for number in (part.value, part.half_width)]
        yield {**run_columns, "order": harmonic.order, **_variables(numbers), **gate_columns}


def _variables(numbers: Sequence[float]) -> dict[str, float]:
    return dict(zip(list(_VARIABLES)[:8], numbers, strict=True))
