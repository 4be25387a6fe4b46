"""Opening the recorder of a run: its folder, its header, the room on its disk."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Final

from hardware.carry_over import opening_of
from hardware.rig import Rig
from hardware.roles import Reading
from pmm.campaign.calibrated_recording import provenance_of
from pmm.plan.force_estimate import expected_readings
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.plan.simulated_rig import Departure, departure_flag, departures, provenance_of_departures
from pmm.recorder.campaign_owner import own_campaign
from pmm.recorder.disk import DiskWatch, bytes_per_s, free_bytes
from pmm.recorder.files import set_aside
from pmm.recorder.header import LiveSettings, RunHeader
from pmm.recorder.live_path import header_channels, sampled_devices
from pmm.recorder.run_recorder import RunRecorder
from pmm.run.journal import Taps
from pmm.run.measurement import Measurement, recorder_faults

_FRAMES_A_CYCLE: Final = 3.0  # of each node: process data both ways, and its share of the rest
_MEGA: Final = 1e6


@dataclass
class RecorderFactory:
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
    _free_bytes: int | None = field(default=None, init=False)

    def __enter__(self) -> "RecorderFactory":
        return self

    def __exit__(self, *_: object) -> None:
        """Let go of a recorder that was not closed: its journals stay, for ``pmm recover``."""
        recorder, self.taps.recorder = self.taps.recorder, None
        if recorder is not None:
            recorder.__exit__(None, None, None)

    def begin(self, run: RunPlan) -> Measurement:
        """Begin to record a run, and to open its recorder: :meth:`Measurement.opened` tells when.

        In the recorder's thread a run is refused for which there is no room, and what an earlier
        try left is moved aside.
        """
        watch = self._watch()
        with recorder_faults(run.name):
            recorder = RunRecorder(
                self.folder / run.name,
                self._header(run),
                flush_s=self.rig_file.recorder.flush_s,
                disk=watch,
                admit=partial(self._admit, run, watch),
            )
        self.taps.recorder = recorder
        expected = expected_readings(run, self.rig_file)
        measurement = Measurement(self.rig, run, recorder, recorder.header.live, expected)
        measurement.flags += departure_flag(self._departures)
        return measurement

    def _admit(self, run: RunPlan, watch: DiskWatch, header: RunHeader) -> RunHeader:
        """Number a run for which there is room, and make way for its folder."""
        watch.check_before(run.moving_s)
        with own_campaign(self.folder, patience_s=0.0) as owned:
            number = owned.next_number()
        set_aside(self.folder / run.name, "try")
        return replace(header, number=number)

    @cached_property
    def _departures(self) -> tuple[Departure, ...]:
        """Where the rig that is simulated is not that of the rig's file."""
        return departures(self.rig_file)

    def free_bytes(self) -> int | None:
        """Return the room on the campaign's disk, as a recorder found it last."""
        return self._free_bytes

    def _look(self, path: Path) -> int:
        """Return the room on the disk, and keep it for who must not wait for the disk."""
        self._free_bytes = free_bytes(path)
        return self._free_bytes

    def _watch(self) -> DiskWatch:
        rate = self.rig.configuration.sample_rate_hz
        nodes = len(self.rig.master.nodes) if self.rig.master is not None else 0
        per_s = bytes_per_s(len(header_channels(self.rig)), rate, _FRAMES_A_CYCLE * nodes * rate)
        reserve = self.rig_file.recorder.reserve_mb * _MEGA
        return DiskWatch(self.folder, per_s, reserve, self._look)

    def _header(self, run: RunPlan) -> RunHeader:
        rig, offset = self.rig, self.rig_file.reference
        return RunHeader(
            run_name=run.name,
            channels=header_channels(rig),
            sample_rate_hz=rig.configuration.sample_rate_hz,
            started_utc=self.utc(),
            kind=str(run.kind),
            set_point=run.set_point,
            plan_json=run.to_json(),
            configuration_sha256={"plan": self.plan.sha256} | self.rig_file.hashes,
            provenance=dict(self.provenance)
            | provenance_of(self.rig_file.calibration)
            | provenance_of_departures(self._departures),
            readings=self._readings(),
            sources={
                c.name: sampled_device.name
                for sampled_device in sampled_devices(rig)
                for c in sampled_device.channels
            },
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

    def _readings(self) -> dict[str, Reading]:
        axes = {"eccentricity": self.rig.eccentricity, "phase": self.rig.phase}
        readings = {name: axis.reading for name, axis in axes.items() if axis is not None}
        return {name: reading for name, reading in readings.items() if reading is not None}


def plan_provenance(plan: Plan) -> dict[str, str]:
    """Return what is kept of a plan with every run: its name, and its operator where it has one."""
    return {"plan": plan.name, **({"operator": plan.operator} if plan.operator else {})}
