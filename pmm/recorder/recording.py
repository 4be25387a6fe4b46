"""A run's folder as a recording: what is whole of its journals, and the NetCDF of it."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analysis.readers.netcdf import write_recording
from analysis.recording import FloatArray, Recording
from hardware.description.dataset import GATE_OPENED, GATE_PERIODS
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from pmm.recorder.disk import DiskFullError, free_bytes
from pmm.recorder.files import (
    BUS,
    CYCLES,
    EVENTS,
    HARMONICS,
    HEADER,
    LINES,
    MARKER,
    PULSES,
    RECORDING,
    SAMPLES,
    sync_folder,
)
from pmm.recorder.header import RunHeader
from pmm.recorder.lateness import CycleStatistics
from pmm.recorder.samples import JournalSamples, counts, read_header, read_samples
from pmm.recorder.texts import read_lines


@dataclass(frozen=True)
class RunData:
    """What is whole of a run.

    Attributes
    ----------
    samples
        ``None`` if not one batch is whole.
    texts
        Values of each journal of text, by its file.
    tails
        Bytes behind what is whole, by file; none of a run that was closed.
    marker
        The completion marker; ``None`` of a run that was not closed.
    """

    folder: Path
    header: RunHeader
    samples: JournalSamples | None
    texts: Mapping[str, list[Any]]
    tails: Mapping[str, int]
    marker: Mapping[str, Any] | None

    @property
    def pulses_s(self) -> FloatArray:
        """Times of the photocell's pulses, in order."""
        return np.array([one[1] for one in self.texts[PULSES]], dtype=np.float64)

    @property
    def cycles(self) -> CycleStatistics | None:
        """How late the cycles were, as far as it was written."""
        lines = self.texts[CYCLES]
        return CycleStatistics(*(lines[-1][i] for i in range(5))) if lines else None


def read_run(folder: Path) -> RunData:
    """Read what is whole of a run's folder.

    Raises
    ------
    DataError
        If neither the header nor the beginning of the samples' journal is whole.
    """
    samples = read_samples(folder / SAMPLES)
    texts: dict[str, list[Any]] = {}
    tails: dict[str, int] = {}
    for name in (PULSES, EVENTS, HARMONICS, LINES, CYCLES):
        texts[name], tails[name] = read_lines(folder / name)
    if (folder / SAMPLES).exists():
        whole = samples.whole_bytes if samples else 0
        tails[SAMPLES] = (folder / SAMPLES).stat().st_size - whole
    return RunData(folder, _header(folder), samples, texts, tails, _marker(folder))


def convert(run: RunData, flags: Sequence[Flag] = ()) -> Path:
    """Write a run's recording beside its journals, whole or not at all; return its path.

    Raises
    ------
    DiskFullError
        If there is no room.
    DataError
        If there are no samples, or the recording is there already.
    """
    path = run.folder / RECORDING
    recording = as_recording(run, flags)
    need = 8 * (recording.samples.shape[0] + 1) * recording.sample_count
    if (free := free_bytes(run.folder)) < need:
        raise DiskFullError(
            f"{path}: needs {need / 1e6:.1f} MB, {free / 1e6:.1f} MB are free; what was recorded "
            f"is kept. Make room, then: pmm recover {run.folder}"
        )
    for part in run.folder.glob(f".{RECORDING}.*.part"):
        part.unlink()  # of a conversion that was killed
    write_recording(recording, path)
    sync_folder(run.folder)
    return path


def as_recording(run: RunData, flags: Sequence[Flag] = ()) -> Recording:
    """Return a run as a recording; its samples stay in the journal.

    Raises
    ------
    DataError
        If there are no samples.
    """
    header, samples = run.header, run.samples
    if samples is None:
        raise DataError(f"{run.folder}: holds no whole sample; there is nothing to make of it")
    edges, unordered = _edges(run)
    told = [Flag(**{**one, "severity": Severity(one["severity"])}) for one in _told(run)]
    return Recording(
        name=header.run_name,
        channels=header.channels,
        samples=samples,
        sample_rate_hz=header.sample_rate_hz,
        start_s=samples.first_sync / header.sample_rate_hz,
        photocell_edges_s=edges if header.photocell else None,
        set_point=header.set_point,
        provenance=_provenance(run),
        flags=(*told, *_gaps(run), *unordered, *flags),
    )


def marker_text(
    run: RunData, outcome: str, flags: Sequence[Flag], contents: Mapping[str, Any], frames: int
) -> str:
    """Return the completion marker: what the run's files have to hold."""
    found: dict[str, Any] = {"outcome": str(outcome), "frames": frames}
    found |= counts(run.samples) if run.samples else {"samples": 0}
    for name, key in ((PULSES, "pulses"), (EVENTS, "events"), (HARMONICS, "harmonics")):
        found[key] = len(run.texts[name])
    found["lines"] = len(run.texts[LINES])
    found["cycles"] = asdict(run.cycles) if run.cycles else None
    found["flags"] = [asdict(one) for one in flags]
    return json.dumps({**found, "files": contents}, indent=1)


def _header(folder: Path) -> RunHeader:
    """Return the header from its file, or the copy in the samples' journal."""
    path = folder / HEADER
    try:
        return RunHeader.from_json(path.read_text(encoding="utf-8"), str(path))
    except (OSError, UnicodeDecodeError, DataError) as error:
        header = read_header(folder / SAMPLES)
        if header is None:
            raise DataError(
                f"{folder}: neither {HEADER} nor the beginning of {SAMPLES} is whole ({error}); "
                f"nothing says what {BUS} belongs to"
            ) from error
        return header


def _marker(folder: Path) -> Mapping[str, Any] | None:
    try:
        found = json.loads((folder / MARKER).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and "files" in found else None


def _told(run: RunData) -> list[dict[str, Any]]:
    return list(run.marker["flags"]) if run.marker else []


def _edges(run: RunData) -> tuple[FloatArray, list[Flag]]:
    """Return the pulses' times, each later than the one before, and what was left out."""
    times = run.pulses_s
    latest = np.maximum.accumulate(np.concatenate([[-np.inf], times]))[:-1]
    kept = times > latest
    left_out = int(np.sum(~kept))
    message = f"{left_out} pulse(s) that came no later than one before are left out"
    flags = [Flag("pulse_order", Severity.WARNING, message)] if left_out else []
    return times[kept], flags


def _gaps(run: RunData) -> list[Flag]:
    gaps = run.samples.gaps if run.samples else ()
    if not gaps:
        return []
    missing = sum(count for _, count in gaps)
    at, longest = max(gaps, key=lambda one: one[1])
    message = (
        f"{missing} sample(s) are missing in {len(gaps)} gap(s), the longest {longest} from "
        f"{at / run.header.sample_rate_hz:.3f} s (SYNC {at}); they are NaN"
    )
    return [Flag("gap", Severity.WARNING, message)]


def _provenance(run: RunData) -> dict[str, str]:
    header = run.header
    found = dict(header.provenance) | {
        "recorder": "pmm",
        "started_utc": header.started_utc,
        "kind": header.kind,
        "plan": header.plan_json,
        "outcome": str(run.marker["outcome"]) if run.marker else "not closed",
        "configuration_sha256": json.dumps(dict(header.configuration_sha256)),
        "readings": json.dumps({name: asdict(one) for name, one in header.readings.items()}),
    }
    return found | _gate(run) | (run.cycles.as_text() if run.cycles else {})


def _gate(run: RunData) -> dict[str, str]:
    """Return when the pulses opened and closed the gate, as far as it came."""
    last = run.texts[HARMONICS][-1] if run.texts[HARMONICS] else {}
    if not {"opened_s", "periods"} <= set(last):
        return {}
    return {GATE_OPENED: repr(last["opened_s"]), GATE_PERIODS: str(last["periods"])}
