"""From a rig and its run control to one frame."""

import math
from itertools import islice
from typing import Final

import numpy as np

from analysis.resolver.harmonics import Harmonics
from hardware.description.arrays import FloatArray
from hardware.rig import Rig
from pmm.console.messages import Bus, ChannelInfo, Hello, Needles
from pmm.console.traces import points_a_second
from pmm.plan.rig_file import RigFile, is_simulated
from pmm.plan.run_plan import RunPlan
from pmm.recorder.live_path import header_channels
from pmm.run.measurement import Measurement
from pmm.run.readings import rows_of
from pmm.run.run_control import RunControl
from pmm.run.states import Command, is_allowed
from pmm.run.status import ChannelReading, RunStatus

HARMONICS: Final = 3
_FOLLOWING: Final = 3


def channels_of(rig: Rig, rig_file: RigFile) -> tuple[ChannelInfo, ...]:
    """Return the recorded channels with the ranges of their needles."""
    gauges = {gauge.channel: gauge.full_scale_n for gauge in rig_file.gauges}
    return tuple(
        ChannelInfo(
            header_channel.name,
            header_channel.unit,
            gauges.get(header_channel.name, header_channel.full_scale or math.nan),
        )
        for header_channel in header_channels(rig)
    )


def hello_of(rig: Rig, rig_file: RigFile, channels: tuple[ChannelInfo, ...], speed: float) -> Hello:
    """Return what does not change; ``speed`` is that of the rig, in times the clock's."""
    rate_hz = rig.configuration.sample_rate_hz
    return Hello(
        rig=rig_file.name,
        rig_path=rig_file.path,
        simulated=is_simulated(rig_file.hardware),
        channels=channels,
        sample_rate_hz=rate_hz,
        trace_rate_hz=points_a_second(rate_hz)[1],
        harmonics=HARMONICS,
        speed=speed,
    )


def bus_of(rig: Rig) -> Bus:
    """Return whether the bus is healthy, its nodes and error frames, and the rig's faults."""
    master = rig.master
    faults = tuple(str(fault) for fault in rig.faults)
    if master is None:
        return Bus(not faults, 0, 0, faults)
    return Bus(master.healthy and not faults, len(master.nodes), master.error_frames.total, faults)


def axes_of(rig: Rig) -> tuple[tuple[str, str, float], ...]:
    """Return name, unit and reading of the axes."""
    return tuple(
        (name, axis.unit, math.nan if axis.reading is None else axis.reading.value)
        for name, axis in (
            ("eccentricity", rig.eccentricity),
            ("phase", rig.phase),
            *rig.angles.items(),
        )
        if axis is not None
    )


def allowed(control: RunControl) -> tuple[str, ...]:
    """Return the commands that the present state takes."""
    return tuple(str(command) for command in Command if is_allowed(command, control.state))


def present_run(control: RunControl, status: RunStatus) -> RunPlan | None:
    """Return the run that a status tells of."""
    return control.runs[status.run_number - 1] if status.run_number else None


def following(control: RunControl, status: RunStatus) -> tuple[str, ...]:
    """Return the names of the runs that come after that one."""
    planned = control.planned
    after = islice(planned.runs, status.run_number, None)
    return tuple(
        islice((run.name for run in after if run.name not in planned.held_runs), _FOLLOWING)
    )


class NeedleReader:
    """Reads the needles: all harmonics, with the interval of the last final reading."""

    def __init__(self) -> None:
        self._last: Harmonics | None = None
        self._widths: FloatArray | None = None

    def read(
        self, measurement: Measurement | None, rows: tuple[ChannelReading, ...]
    ) -> Needles | None:
        """Return the needles; ``None`` where nothing is known yet."""
        if measurement is None or not rows:
            return None
        final = measurement.reading
        shape = (len(rows), 2 * HARMONICS + 1)
        widths = self._half_widths(final)
        values = np.full(shape, math.nan) if final is None else final.coefficients.copy()
        first = [(row.mean, row.in_phase, row.quadrature) for row in rows]
        values[:, :3] = first
        if widths is None or widths.shape != values.shape:
            widths = np.full(values.shape, math.nan)
            widths[:, 0] = [row.half_width for row in rows]
        return Needles(values, widths, final=all(row.final for row in rows))

    def standing(self, measurement: Measurement) -> Needles | None:
        """Return the last reading over whole periods; where there is none, what the needles show.

        A motion that is being stopped spoils the provisional one.
        """
        rows = measurement.rows()
        reading = measurement.reading
        if reading is None:
            return self.read(measurement, rows)
        return self.read(measurement, rows_of(reading))

    def _half_widths(self, reading: Harmonics | None) -> FloatArray | None:
        """Compute the intervals once for each reading."""
        if reading is not self._last:
            self._last, self._widths = reading, None
            if reading is not None and np.isfinite(reading.covariance).any():
                self._widths = reading.half_width()
        return self._widths
