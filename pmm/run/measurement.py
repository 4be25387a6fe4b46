"""One run's data: from the live path to the recorder, the live resolver and the gate."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live_resolver import LiveResolver
from hardware.description.channels import CARRIAGE_SPEED
from hardware.description.errors import DataError, PmmError
from hardware.description.flags import Flag, Severity
from hardware.description.known_loads import LoadStep
from hardware.errors import HardwareError
from hardware.rig import Rig
from hardware.roles import Pulse
from pmm.plan.force_estimate import ExpectedAmplitude
from pmm.plan.run_plan import RunPlan
from pmm.recorder.header import LiveSettings
from pmm.recorder.live_path import CycleSamples, GateResolver, as_record, header_channels
from pmm.run.errors import GateVoidError, RecordingError
from pmm.run.gate import Gate, GateState
from pmm.run.journal import RunJournal
from pmm.run.push_record import PushRecord
from pmm.run.readings import Means, far_text, needles, rows_of, with_expected, worst_relative
from pmm.run.status import ChannelReading

if TYPE_CHECKING:
    from hardware.description.arrays import FloatArray

_TRIES = 3  # gates of a run; the third void one ends it


@contextmanager
def recorder_faults(run: str) -> Iterator[None]:
    """Turn what a recorder raises into a fault of the run, which stops it along the profile."""
    try:
        yield
    except HardwareError:
        raise  # the recorder's own, with its reaction
    except (PmmError, OSError) as error:
        raise RecordingError(f"recorder of {run}", str(error)) from error


class Measurement:
    """A run that is being recorded.

    Parameters
    ----------
    live
        How the live resolver is set.
    expected
        What the plan estimates of gauges' first harmonics.

    Attributes
    ----------
    channels
        What is recorded, in the order of the samples' rows.
    gate, flags
        Where the gate stands, and what was noticed.
    reading
        Harmonics over the periods that are final by now.
    voided
        How often the gate was void.
    """

    def __init__(
        self,
        rig: Rig,
        run: RunPlan,
        journal: RunJournal,
        live: LiveSettings,
        expected: Mapping[str, ExpectedAmplitude] = MappingProxyType({}),
    ) -> None:
        self.run, self.journal = run, journal
        self.channels = header_channels(rig)
        self.gate = Gate(live.periods)
        self.flags: list[Flag] = []
        self.reading: Harmonics | None = None
        self.voided = 0
        self._rig, self._live, self._expected = rig, live, expected
        self._rate_hz = rig.configuration.sample_rate_hz
        self._next = rig.number + 1
        self._forces = [i for i, c in enumerate(self.channels) if c.unit in ("N", "N m")]
        self._resolving: GateResolver | None = None
        self._judged = 0
        names = [channel.name for channel in self.channels]
        self._towed = names.index(CARRIAGE_SPEED.name) if CARRIAGE_SPEED.name in names else None
        self._speeds: list[FloatArray] = []
        self._means = Means(self.channels)
        self._push = PushRecord(self.channels)

    def opened(self, *, wait: bool) -> bool:
        """Tell whether the recorder is open; with ``wait`` when it is.

        Raises
        ------
        RecordingError
            If its folder cannot be made, holds a run, or its disk has no room for this one.
        """
        with recorder_faults(self.run.name):
            return self.journal.opened(wait=wait)

    def arm(self) -> None:
        """Begin to wait for the pulse that opens the gate; forget what was measured before."""
        self._resolving = GateResolver(self.channels, self._rate_hz, self._live, self._next)
        self.reading, self._judged = None, 0
        self._speeds.clear()
        self.gate.arm()
        self.event("armed", str(self._next))

    def open_by_time(self) -> None:
        """Open the gate now: of a run at rest, or of a rig without a photocell."""
        self._means = Means(self.channels)
        self._speeds.clear()
        self.gate.arm()
        self.gate.pulse(self._rig.number / self._rate_hz)

    def close_by_time(self) -> None:
        """Close the gate at the present cycle, without a pulse."""
        self.gate.hold()
        self.gate.pulse(self._rig.number / self._rate_hz)

    def cycle(self, taken: CycleSamples, lateness_s: float, now_s: float) -> None:
        """Take what came in a cycle.

        Raises
        ------
        RecordingError
            If the recorder cannot keep it.
        """
        self._next = taken.first + taken.values.shape[1]
        with recorder_faults(self.run.name):
            self.journal.cycle_statistics(lateness_s)
            self.journal.samples(taken.first, taken.values)
            for pulse in taken.pulses:
                self.journal.pulse(pulse)
        if self._resolving is not None:
            self._take_readings(self._resolving.push(taken))
            self._judge(self._resolving.resolver)
        if self._towed is not None and self.gate.state is GateState.OPEN:
            self._speeds.append(taken.values[self._towed])
        if not self.run.oscillates and self.gate.state is GateState.OPEN:
            self._means.take(taken.values)
            self._push.take(taken.values)
        for pulse in taken.pulses:
            self._pulse(pulse)
        with recorder_faults(self.run.name):
            self.journal.tick(now_s)

    def pushing(self) -> None:
        """From here on somebody pushes."""
        self._push.begin()

    def let_go(self) -> None:
        """From here on nobody pushes any more."""
        self._push.end()

    def judge_push(self, asked: LoadStep) -> None:
        """Compare what the gauges showed with what was asked for.

        Raises
        ------
        PushRefusedError
            If cables are swapped, a sign is wrong, or no push is seen.
        """
        self.event("push", self._push.verdict(asked))

    def void(self, why: str) -> None:
        """Throw the gate away and wait for another one.

        Raises
        ------
        GateVoidError
            If it was void too often.
        """
        self.voided += 1
        self.note("gate_void", Severity.VOID, f"gate {self.voided} is void: {why}")
        if self.voided >= _TRIES:
            raise GateVoidError("gate", f"void {self.voided} times (limit {_TRIES}); last: {why}")
        self.arm()

    def finish(self) -> None:
        """Make the last reading, and flag a gate that lacks samples."""
        self._tell_speed()
        if self._resolving is None:
            return
        self._take_readings(self._resolving.resolver.finish())
        self.reading = self._resolving.resolver.so_far()
        periods = 0 if self.reading is None else self.reading.periods
        if periods != self.gate.periods:
            text = f"{periods} of the gate's {self.gate.periods} periods have all their samples"
            self.note("gate_short", Severity.WARNING, text)
        for row in self.rows():
            if row.far:
                self.note("force_far", Severity.WARNING, far_text(row), row.channel)

    def note(self, code: str, severity: Severity, text: str, channel: str | None = None) -> None:
        """Keep a flag and write it down."""
        self.flags.append(Flag(code, severity, text, channel))
        self.event(code, text)

    def event(self, kind: str, text: str) -> None:
        """Write down what happened."""
        number = self._rig.number
        with recorder_faults(self.run.name):
            self.journal.event(number, number / self._rate_hz, kind, text)

    def rows(self) -> tuple[ChannelReading, ...]:
        """Return what is known of the channels by now: final, else the needles, else nothing."""
        if self.gate.state is GateState.HELD and self.reading is not None:
            return with_expected(rows_of(self.reading), self._expected)
        if self._resolving is not None:
            resolver = self._resolving.resolver
            if resolver.finished_periods > max(self.reading.periods if self.reading else 0, 1):
                self.reading = resolver.so_far()
            rows = needles(self.channels, resolver.provisional(), self.reading)
            return with_expected(rows, self._expected)
        return self._means.rows()

    def _pulse(self, pulse: Pulse) -> None:
        listening = self.gate.state in (GateState.ARMED, GateState.OPEN)
        if self._resolving is None or not listening or not self._resolving.takes(pulse):
            return
        try:
            readings = self._resolving.resolver.pulse(pulse.time_s)
        except DataError as error:
            self.void(str(error))
            return
        before = self.gate.state
        self.gate.pulse(pulse.time_s)
        if self.gate.state is not before:
            self.event("gate", f"{self.gate.state} at {pulse.time_s:.6f} s")
        self._take_readings(readings)

    def _take_readings(self, readings: Sequence[Harmonics]) -> None:
        if self._resolving is not None:
            self._tell_spikes(self._resolving)
        for reading in readings:
            self.reading = reading
            self._keep(reading)

    def _tell_speed(self) -> None:
        """Write down how the carriage ran while the gate was open."""
        speed = np.concatenate([*self._speeds, np.empty(0)])
        speed = speed[np.isfinite(speed)]
        if speed.size:
            point = self.run.set_point
            asked = "along the model asked" if point.steady_ahead else "asked"
            self.event(
                "carriage",
                f"{speed.mean():.6g} m/s mean, {speed.std():.3g} m/s standard deviation over the "
                f"gate; {point.carriage_speed_m_s:g} m/s {asked}",
            )

    def _tell_spikes(self, resolving: GateResolver) -> None:
        for spike in resolving.resolver.spikes():
            channel = self.channels[spike.row]
            at_s, size = resolving.start_s + spike.number / self._rate_hz, spike.spike.size
            text = (
                f"{channel.name}: a spike of {size:+.4g} {channel.unit} at {at_s:.6g} s "
                "was taken out of the live readings; the recording has it"
            )
            self.note("spike", Severity.WARNING, text)

    def _keep(self, reading: Harmonics) -> None:
        with recorder_faults(self.run.name):
            self.journal.harmonic(as_record(reading))

    def _judge(self, resolver: LiveResolver) -> None:
        """Close a gate whose uncertainty is small enough, at the end of its last period."""
        target = self.run.target_relative
        if target is None or self.gate.state is not GateState.OPEN:
            return
        periods = resolver.finished_periods
        if (
            periods <= self._judged
            or periods < max(self.run.periods, 2)
            or periods != self.gate.periods
        ):
            return
        self._judged = periods
        self.reading = resolver.so_far()
        if self.reading is not None and worst_relative(self.reading, self._forces) <= target:
            self.gate.hold_at_last()
            self._keep(self.reading)
            self.event("gate", f"held: target {target:g} met after {periods} periods")
