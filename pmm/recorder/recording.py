"""A run's folder as a recording: what is whole of its journals, and the NetCDF of it."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final
from zlib import crc32

import numpy as np

from analysis.readers.netcdf import write_recording
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.dataset import GATE_OPENED, GATE_PERIODS
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.description.kinds import RunKind
from pmm.recorder.disk import DiskFullError, free_bytes
from pmm.recorder.files import (
    BUS,
    CYCLES,
    EVENTS,
    HARMONICS,
    HEADER,
    LINES,
    PULSES,
    RECORDING,
    SAMPLES,
    TEXTS,
)
from pmm.recorder.header import RunHeader
from pmm.recorder.lateness import CycleStatistics
from pmm.recorder.line_shapes import read_lines, read_marker
from pmm.recorder.samples import JournalSamples, counts, read_header, read_samples
from pmm.whole_file import sync_folder

_OPEN, _CLOSED = "gate open", "hold"  # states of run control, as its events have them
_SUM: Final = "crc32"  # in the marker: of all else in it
NOISE: Final = "noise_rms"  # in the marker of a zero run: of each channel, in its unit


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
        return np.array([text[1] for text in self.texts[PULSES]], dtype=np.float64)

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
    for name in TEXTS:
        texts[name], tails[name] = read_lines(folder / name)
    if (folder / SAMPLES).exists():
        whole_bytes = samples.whole_bytes if samples else 0
        tails[SAMPLES] = (folder / SAMPLES).stat().st_size - whole_bytes
    return RunData(folder, _header(folder, samples), samples, texts, tails, read_marker(folder))


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
    stored_flags = map(Flag.read, _stored_flags(run))
    return Recording(
        name=header.run_name,
        channels=header.channels,
        samples=samples,
        sample_rate_hz=header.sample_rate_hz,
        start_s=samples.first_sync / header.sample_rate_hz,
        photocell_edges_s=edges if header.photocell else None,
        set_point=header.set_point,
        provenance=_provenance(run),
        flags=(*stored_flags, *_gaps(run), *unordered, *flags),
    )


def marker_text(
    run: RunData, outcome: str, flags: Sequence[Flag], contents: Mapping[str, Any], frames: int
) -> str:
    """Return the completion marker: what the run's files have to hold."""
    marker: dict[str, Any] = {"outcome": str(outcome), "frames": frames}
    marker |= counts(run.samples) if run.samples else {"samples": 0}
    for name, key in ((PULSES, "pulses"), (EVENTS, "events"), (HARMONICS, "harmonics")):
        marker[key] = len(run.texts[name])
    marker["lines"] = len(run.texts[LINES])
    marker["cycles"] = asdict(run.cycles) if run.cycles else None
    marker["flags"] = [asdict(flag) for flag in flags]
    marker |= _noise_at_rest(run)
    marker |= {"files": contents}
    return json.dumps({**marker, _SUM: _sum(marker)}, indent=1)


def marker_is_whole(marker: Mapping[str, Any] | None) -> bool:
    """Tell whether a completion marker is what was written; one without a checksum is taken."""
    if marker is None:
        return False
    rest = {key: value for key, value in marker.items() if key != _SUM}
    return bool(marker.get(_SUM, _sum(rest)) == _sum(rest))


def _sum(marker: Mapping[str, Any]) -> int:
    return crc32(json.dumps(marker).encode())


def _noise_at_rest(run: RunData) -> dict[str, Any]:
    """Return what a zero run tells of the channels' noise; another record shows more than noise."""
    if run.header.kind != RunKind.ZERO or run.samples is None:
        return {}
    noise_rms = white_noise_rms(run.samples[:, :])
    names = (channel.name for channel in run.header.channels)
    pairs = zip(names, noise_rms, strict=True)
    return {NOISE: {name: float(rms) for name, rms in pairs if np.isfinite(rms)}}


def _header(folder: Path, samples: JournalSamples | None) -> RunHeader:
    """Return the header that a checksum vouches for; else that of its file, or any copy."""
    if samples is not None and samples.is_headed:
        return samples.header
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


def _stored_flags(run: RunData) -> list[dict[str, Any]]:
    return list(run.marker["flags"]) if run.marker else []


def _edges(run: RunData) -> tuple[FloatArray, list[Flag]]:
    """Return the pulses' times, each later than the one before, and what was left out."""
    times = run.pulses_s
    latest = np.maximum.accumulate(np.concatenate([[-np.inf], times]))[:-1]
    is_later = times > latest
    left_out = int(np.sum(~is_later))
    message = f"{left_out} pulse(s) that came no later than one before are left out"
    flags = [Flag("pulse_order", Severity.WARNING, message)] if left_out else []
    return times[is_later], flags


def _gaps(run: RunData) -> list[Flag]:
    gaps = run.samples.gaps if run.samples else ()
    if not gaps:
        return []
    missing = sum(count for _, count in gaps)
    at, longest = max(gaps, key=lambda gap: gap[1])
    message = (
        f"{missing} sample(s) are missing in {len(gaps)} gap(s), the longest {longest} from "
        f"{at / run.header.sample_rate_hz:.3f} s (SYNC {at}); they are NaN"
    )
    return [Flag("gap", Severity.WARNING, message)]


def _provenance(run: RunData) -> dict[str, str]:
    header = run.header
    provenance = dict(header.provenance) | {
        "recorder": "pmm",
        "started_utc": header.started_utc,
        "kind": header.kind,
        "plan": header.plan_json,
        "outcome": str(run.marker["outcome"]) if run.marker else "not closed",
        "configuration_sha256": json.dumps(dict(header.configuration_sha256)),
        "readings": json.dumps(
            {name: asdict(reading) for name, reading in header.readings.items()}
        ),
    }
    return provenance | _gate(run) | (run.cycles.as_text() if run.cycles else {})


def _gate(run: RunData) -> dict[str, str]:
    """Return when the pulses opened and closed the gate, as far as it came; else by time."""
    last = run.texts[HARMONICS][-1] if run.texts[HARMONICS] else _gate_by_time(run)
    if not {"opened_s", "periods"} <= set(last):
        return {}
    return {GATE_OPENED: repr(last["opened_s"]), GATE_PERIODS: str(last["periods"])}


def _gate_by_time(run: RunData) -> dict[str, Any]:
    """Return the gate of an oscillation without pulses: whole periods, wherever one begins."""
    point = run.header.set_point
    events = (text for text in run.texts[EVENTS] if text["kind"] == "state")
    times = {event["text"]: float(event["time_s"]) for event in events}
    if run.header.photocell or point is None or not {_OPEN, _CLOSED} <= set(times):
        return {}
    # The cycle in which it closed is open to its end.
    open_s = times[_CLOSED] - times[_OPEN] + 1.0 / run.header.sample_rate_hz
    periods = math.floor(open_s * point.frequency_hz) - 1
    return {"opened_s": times[_OPEN], "periods": periods} if periods > 0 else {}


def white_noise_rms(samples: FloatArray) -> FloatArray:
    """Return the standard deviation of each channel's white noise.

    From the differences of neighbouring samples, which are blind to a zero that wanders and to
    waves that are long against a sample; missing samples are passed over.

    The result has the shape ``(channels,)``; NaN where a channel has no two samples in a row.

    Parameters
    ----------
    samples
        Shape ``(channels, n)``.
    """
    steps = np.diff(samples, axis=1) ** 2
    is_finite = np.isfinite(steps)
    count = is_finite.sum(axis=1)
    total = np.where(is_finite, steps, 0.0).sum(axis=1)
    variance = np.full(len(samples), np.nan)
    np.divide(total, 2.0 * count, out=variance, where=count > 0)
    return np.asarray(np.sqrt(variance))
