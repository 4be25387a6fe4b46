"""Opening the recorder of a run: its folder, its header, the room on its disk."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from hardware.opening import opening_of
from hardware.rig import Rig
from hardware.roles import Reading
from pmm.calibrated import provenance_of
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.disk import DiskWatch, bytes_per_s
from pmm.recorder.header import LiveSettings, RunHeader
from pmm.recorder.run_recorder import RunRecorder
from pmm.run.journal import Taps, kept
from pmm.run.measurement import LiveOptions, Measurement
from pmm.run.sampler import header_channels, sampled_devices

_SAFE_OVER_FULL: Final = 1.5
_FRAMES_A_CYCLE: Final = 3.0  # of each node: process data both ways, and its share of the rest
_MEGA: Final = 1e6


@dataclass(frozen=True)
class Recording:
    """Opens recorders in a campaign's folder.

    Attributes
    ----------
    utc
        Says date and time in ISO 8601: for the header only.
    taps
        Where the rig's observers hand frames and lines on.
    provenance
        Kept with every run: version, operator, machine.
    """

    rig: Rig
    rig_file: RigFile
    plan: Plan
    folder: Path
    utc: Callable[[], str]
    taps: Taps
    provenance: Mapping[str, str] = field(default_factory=dict)

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, *_: object) -> None:
        """Let go of a recorder that was not closed: its journals stay, for ``pmm recover``."""
        recorder, self.taps.recorder = self.taps.recorder, None
        if recorder is not None:
            recorder.__exit__(None, None, None)

    def begin(self, run: RunPlan) -> Measurement:
        """Open the recorder of a run and begin to record.

        Raises
        ------
        DiskFullError
            If there is no room for the whole run.
        RecordingError
            If its folder cannot be made or holds a run.
        """
        with kept(run.name):
            watch = self._watch()
            watch.check_before(run.moving_s)
            recorder = RunRecorder(
                free_folder(self.folder, run.name),
                self._header(run),
                flush_s=self.rig_file.recorder.flush_s,
                disk=watch,
            )
        self.taps.recorder = recorder
        offset = self.rig_file.photocell_offset
        options = LiveOptions(3, offset.latency_s, offset.angle_offset_rad)
        return Measurement(self.rig, run, recorder, options, self._safe_loads())

    def free_bytes(self) -> int | None:
        """Return the room on the campaign's disk."""
        try:
            found = os.statvfs(self.folder)
        except OSError:
            return None
        return found.f_bavail * found.f_frsize

    def _watch(self) -> DiskWatch:
        rate = self.rig.configuration.sample_rate_hz
        nodes = len(self.rig.master.nodes) if self.rig.master is not None else 0
        per_s = bytes_per_s(len(header_channels(self.rig)), rate, _FRAMES_A_CYCLE * nodes * rate)
        return DiskWatch(self.folder, per_s, self.rig_file.recorder.reserve_mb * _MEGA)

    def _safe_loads(self) -> dict[str, float]:
        return {
            one.channel: one.safe_load_n
            if one.safe_load_n is not None
            else _SAFE_OVER_FULL * one.full_scale_n
            for one in self.rig_file.gauges
        }

    def _header(self, run: RunPlan) -> RunHeader:
        rig, offset = self.rig, self.rig_file.photocell_offset
        return RunHeader(
            run_name=run.name,
            channels=header_channels(rig),
            sample_rate_hz=rig.configuration.sample_rate_hz,
            started_utc=self.utc(),
            kind=str(run.kind),
            set_point=run.set_point,
            plan_json=run.to_json(),
            configuration_sha256=self._hashes(),
            provenance=dict(self.provenance) | provenance_of(self.rig_file.calibration),
            readings=self._readings(),
            sources={c.name: one.name for one in sampled_devices(rig) for c in one.channels},
            photocell=rig.photocell is not None,
            first_sync=rig.number + 1,
            rig_tables=self.rig_file.hardware_tables,
            opening=opening_of(rig),
            live=LiveSettings(
                periods=max(run.max_periods, run.periods, 1),
                latency_s=offset.latency_s,
                angle_offset_rad=offset.angle_offset_rad,
            ),
        )

    def _hashes(self) -> dict[str, str]:
        found = {"plan": self.plan.sha256, "rig": self.rig_file.sha256}
        one = self.rig_file.calibration
        return found if one is None else found | {"calibration": one.sha256}

    def _readings(self) -> dict[str, Reading]:
        axes = {"eccentricity": self.rig.eccentricity, "phase": self.rig.phase}
        found = {name: one.reading for name, one in axes.items() if one is not None}
        return {name: one for name, one in found.items() if one is not None}


def free_folder(campaign: Path, name: str) -> Path:
    """Return the folder for a run's next try; what an earlier try left is moved aside, not lost."""
    folder = campaign / name
    if not folder.exists():
        return folder
    number = 1
    while (aside := campaign / f"{name}.try{number}").exists():
        number += 1
    folder.rename(aside)
    return folder
