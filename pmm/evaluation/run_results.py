"""What a campaign's folder holds of each run, as far as the evaluations of its tests need it."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analysis.readers import read_recording
from analysis.readers.damage import check_whole
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.harmonics import Harmonics
from hardware.description.errors import DataError
from pmm.recorder.files import EVENTS, HARMONICS, HEADER, RECORDING
from pmm.recorder.header import RunHeader
from pmm.recorder.line_shapes import read_lines, read_marker

_FORCE_UNITS = ("N", "N m")


@dataclass(frozen=True)
class RunResult:
    """A run as it was recorded.

    Attributes
    ----------
    plan
        The run's plan, as it was kept with it.
    first
        Complex first harmonic ``S1 + i C1`` of each channel over the gate; empty at rest.
    """

    folder: Path
    header: RunHeader
    plan: dict[str, Any]
    first: dict[str, complex]

    @property
    def name(self) -> str:
        """The run's name."""
        return self.header.run_name

    @property
    def forces(self) -> tuple[str, ...]:
        """Names of the force channels."""
        return tuple(
            channel.name for channel in self.header.channels if channel.unit in _FORCE_UNITS
        )

    def recording(self) -> Recording:
        """Read the samples.

        Raises
        ------
        DataError
            If they are not those that were recorded.
        """
        return check_whole(read_recording(self.folder / RECORDING))

    def gate_samples(self) -> tuple[Recording, slice]:
        """Return the recording and the samples of its gate, by the states that were written.

        Raises
        ------
        DataError
            If the gate was never open.
        """
        recording = self.recording()
        events, _ = read_lines(self.folder / EVENTS)
        states = [(event["time_s"], event["text"]) for event in events if event["kind"] == "state"]
        opened = next((time_s for time_s, text in states if text == "gate open"), None)
        closed = next((time_s for time_s, text in states if text == "hold"), None)
        if opened is None or closed is None:
            raise DataError(f"{self.folder}: the gate was not open; make the run again")
        edges = np.ceil(recording.sample_number(np.array([opened, closed]))).astype(int)
        return recording, slice(max(int(edges[0]), 0), min(int(edges[1]), recording.sample_count))

    def resolved(self) -> Harmonics:
        """Return the harmonics of the recorded gate with their uncertainties.

        Raises
        ------
        DataError
            If the samples are not those that were recorded, or tell no harmonics.
        """
        return analyse(self.recording()).readings[0]

    def means(self) -> dict[str, float]:
        """Return the mean of each force channel over the gate."""
        recording, gate = self.gate_samples()
        return {name: float(np.nanmean(recording.values(name)[gate])) for name in self.forces}


def read_results(folder: Path) -> tuple[RunResult, ...]:
    """Return the complete runs of a campaign, in the order in which they were made.

    Raises
    ------
    DataError
        If the folder holds none.
    """
    results = list(_results(folder))
    if not results:
        raise DataError(
            f"{folder}: no complete run that `pmm run` made; recordings of another system are for "
            "`pmm analyse` and `pmm coefficients`"
        )
    return tuple(sorted(results, key=lambda result: result.header.order))


def of_kind(results: Sequence[RunResult], *kinds: str) -> tuple[RunResult, ...]:
    """Return the runs of some kinds."""
    return tuple(result for result in results if result.header.kind in kinds)


def _results(folder: Path) -> Iterator[RunResult]:
    for marker in sorted(folder.glob("*/complete.json")):
        run_folder = marker.parent
        outcome = (read_marker(run_folder) or {}).get("outcome")
        if (
            outcome != "complete"
            or not (run_folder / RECORDING).exists()
            or ".try" in run_folder.name
        ):
            continue
        header = RunHeader.read(run_folder / HEADER)
        yield RunResult(
            run_folder, header, json.loads(header.plan_json), _first_harmonics(run_folder)
        )


def _first_harmonics(folder: Path) -> dict[str, complex]:
    """Return the first harmonics of the gate: the last reading that was written."""
    readings, _ = read_lines(folder / HARMONICS)
    if not readings:
        return {}
    last = readings[-1]
    rows = zip(last["channels"], last["coefficients"], strict=True)
    return {name: complex(row[1], row[2]) for name, row in rows}
