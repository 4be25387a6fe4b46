"""Recordings: our own files, text, and the binary formats of others."""

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Final

import numpy as np

from analysis.readers import read_recording, write_recording
from analysis.recording import Recording
from benchmarks.fuzz.promises import check_recording
from benchmarks.machine import ROOT
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import SetPoint
from hardware.raw_log import Frame
from hardware.raw_log_reading import read_frames
from hardware.roles import Pulse
from pmm.plan.plan import read_plan_and_rig
from pmm.plan.run_plan import RunPlan
from pmm.recorder.files import BUS, HEADER, MARKER, RECORDING, STREAMS
from pmm.recorder.header import RunHeader
from pmm.recorder.recording import as_recording, read_run
from pmm.recorder.recovery import recover
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from pmm.run.campaign_folder import finished_runs

_PLAN: Final = RunPlan("good", RunKind.ZERO, Motion.NONE, SetPoint(0.0, 0.0), duration_s=3.0)
Read = Callable[[bytes], object]
JOURNALS: Final = (HEADER, MARKER, *STREAMS)
_RATE_HZ: Final = 100.0
_COUNT: Final = 300
_READING: Final = {
    "opened_s": 0.2,
    "closed_s": 2.2,
    "periods": 2,
    "channels": ["force_aft", "force_fore"],
    "coefficients": [[0.01, 20.0, -0.02], [0.03, 0.04, 15.0]],
}


def _samples() -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(_COUNT) / _RATE_HZ
    noise = np.random.default_rng(23).normal(0.0, 0.05, (2, _COUNT))
    return np.vstack([20.0 * np.sin(angle), 15.0 * np.cos(angle)]) + noise


def csv(_folder: Path) -> list[bytes]:
    """Return texts as systems write them."""
    rows = list(zip(np.arange(60) / _RATE_HZ, *_samples()[:, :60], strict=True))
    plain = "time_s,force_aft_N,force_fore_N\n" + "".join(
        f"{t:.3f},{a:.5g},{b:.5g}\n" for t, a, b in rows
    )
    comma = "Zeit [s];Kraft A [kN];Kraft B [kN]\n" + "".join(
        f"{t:.3f};{a / 1e3:.6f};{b / 1e3:.6f}\n".replace(".", ",") for t, a, b in rows
    )
    tabs = "# made by hand\nt\tF1\tF2\ns\tN\tN\n" + "".join(
        f"{t:.3f}\t{a:.4e}\t{b:.4e}\n" for t, a, b in rows
    )
    return [one.encode() for one in (plain, comma, tabs)]


def reading(name: str) -> Callable[[Path, ExitStack], Read]:
    """Return what reads a recording under a name."""

    def opened(folder: Path, _stack: ExitStack) -> Read:
        def take(data: bytes) -> object:
            (folder / name).write_bytes(data)
            found = read_recording(folder / name)
            check_recording(found)
            return sorted({flag.code for flag in found.flags})

        return take

    return opened


def netcdf(folder: Path) -> list[bytes]:
    """Return a recording of ours."""
    edges = np.arange(0.2, 2.9, 1.0)
    channels = (FORCE_AFT, FORCE_FORE)
    one = Recording(
        "fuzzed", channels, _samples(), _RATE_HZ, 0.0, edges, SetPoint(1.0, 0.02), {"a": "b"}
    )
    path = write_recording(one, folder / "good.nc", overwrite=True)
    return [path.read_bytes()]


def _record(folder: Path) -> None:
    header = RunHeader(
        run_name=folder.name, channels=(FORCE_AFT, FORCE_FORE), sample_rate_hz=_RATE_HZ,
        started_utc="2026-01-01T00:00:00+00:00", kind="zero", plan_json=_PLAN.to_json(),
        number=1, configuration_sha256={"plan": "12ab", "rig": "34cd"},
    )  # fmt: skip
    with RunRecorder(folder, header) as recorder:
        for first in range(0, _COUNT, 10):
            recorder.samples(first + 1, _samples()[:, first : first + 10])
            recorder.cycle_statistics(1e-4)
            recorder.frame(Frame(timestamp=first / _RATE_HZ, arbitration_id=0x181, data=[1] * 8))
            recorder.line(first, "photocell", b"P,1,2,3*44")
            recorder.tick(float(first))
        for turn in range(3):
            recorder.pulse(Pulse(turn, 0.2 + turn))
        recorder.event(1, 0.01, "state", "gate open")
        recorder.event(250, 2.5, "state", "hold")
        recorder.harmonic(_READING)
        recorder.close(RunEnd.COMPLETE)


def _recorded(folder: Path) -> Path:
    """Return the folder of a good run, made once."""
    run = folder / "good"
    if not run.exists():
        _record(run)
    return run


def journal(name: str, folder: Path) -> list[bytes]:
    """Return a good file of a run's folder."""
    return [(_recorded(folder) / name).read_bytes()]


def run(name: str, folder: Path, _stack: ExitStack) -> Read:
    """Return what reads a run of which one file is mutated."""
    place = _recorded(folder)
    whole = name in (HEADER, MARKER)
    planned = read_plan_and_rig(ROOT / "examples" / "vertical" / "plan.toml")

    def take(data: bytes) -> object:
        (place / name).write_bytes(data)
        if name == BUS:
            return sum(1 for _ in read_frames(place / BUS))
        if name == HEADER:
            finished_runs(folder, *planned)
        if whole:
            (place / RECORDING).unlink(missing_ok=True)
            return sorted({flag.code for flag in recover(place).flags})
        found = as_recording(read_run(place))
        check_recording(found)
        return sorted({flag.code for flag in found.flags})

    return take


def mat_5(folder: Path) -> list[bytes]:
    """Return MAT files of version 5, plain and packed."""
    from scipy.io import savemat

    found = []
    for packed in (False, True):
        savemat(folder / "good.mat", _columns(), do_compression=packed)
        found.append((folder / "good.mat").read_bytes())
    return found


def mat_73(folder: Path) -> list[bytes]:
    """Return a MAT file of version 7.3, which is HDF5 behind a head of text."""
    import h5py

    path = folder / "good.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for key, value in _columns().items():
            stored = file.create_dataset(key, data=np.atleast_2d(value))
            stored.attrs["MATLAB_class"] = np.bytes_("double")
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
    with path.open("r+b") as raw:
        raw.write(head)
    return [path.read_bytes()]


def tdms(folder: Path) -> list[bytes]:
    """Return a TDMS file."""
    from nptdms import ChannelObject, TdmsWriter

    path = folder / "good.tdms"
    with TdmsWriter(path) as writer:
        for key, value in _columns().items():
            properties = {"wf_increment": 1.0 / _RATE_HZ, "wf_start_offset": 0.0}
            writer.write_segment([ChannelObject("record", key, value, properties=properties)])
    return [path.read_bytes()]


def _columns() -> dict[str, np.ndarray]:
    aft, fore = _samples()
    return {"t": np.arange(_COUNT) / _RATE_HZ, "F1": aft, "F2": fore}
