"""One run's data: from the devices to the recorder, the live resolver and the gate."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live import LiveResolver
from analysis.resolver.weights import REACH
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.description.known_loads import LoadStep
from hardware.rig import Rig
from hardware.roles import Pulse
from pmm.plan.force_estimate import Expected
from pmm.plan.run_plan import RunPlan
from pmm.recorder.live_path import as_record
from pmm.run.errors import GateVoidError
from pmm.run.gate import Gate, GateState
from pmm.run.journal import Journal, kept
from pmm.run.push import PushRecord
from pmm.run.readings import beside, far_text, needles, rows_at_rest, rows_of, worst_relative
from pmm.run.sampler import Sampler, sampled_devices
from pmm.run.status import HarmonicRow

_COLLECT_S = 0.05  # samples are taken in blocks of so much
_TRIES = 3  # gates of a run; the third void one ends it


@dataclass(frozen=True)
class LiveOptions:
    """How the live resolver is set; see :class:`analysis.resolver.live.LiveResolver`."""

    harmonics: int = 3
    latency_s: float = 0.0
    angle_offset_rad: float = 0.0


class Measurement:
    """A run that is being recorded.

    Parameters
    ----------
    expected
        What the plan estimates of gauges' first harmonics.

    Attributes
    ----------
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
        journal: Journal,
        options: LiveOptions,
        expected: Mapping[str, Expected] = MappingProxyType({}),
    ) -> None:
        self.run, self.journal = run, journal
        self.gate = Gate(max(run.max_periods, run.periods, 1))
        self.flags: list[Flag] = []
        self.reading: Harmonics | None = None
        self.voided = 0
        self._rig, self._options, self._expected = rig, options, expected
        self._rate_hz = rig.configuration.sample_rate_hz
        self._every = max(1, round(_COLLECT_S * self._rate_hz))
        self._sampler = Sampler(sampled_devices(rig), rig.number + 1)
        self._sampler.skip(rig.number + 1)
        self._forces = [i for i, c in enumerate(self.channels) if c.unit in ("N", "N m")]
        self._resolver: LiveResolver | None = None
        self._resolver_from_s, self._usable_from_s = 0.0, math.inf
        self._judged = 0
        self._sum = np.zeros(len(self.channels))
        self._square, self._count = np.zeros(len(self.channels)), 0
        self._push = PushRecord(self.channels)
        if rig.photocell is not None:
            rig.photocell.take()

    @property
    def channels(self) -> tuple[Channel, ...]:
        """What is recorded, in the order of the samples' rows."""
        return self._sampler.channels

    @property
    def lost(self) -> int:
        """Samples that never came."""
        return self._sampler.lost

    def opened(self, *, wait: bool) -> bool:
        """Tell whether the recorder is open; with ``wait`` when it is.

        Raises
        ------
        RecordingError
            If its folder cannot be made, holds a run, or its disk has no room for this one.
        """
        with kept(self.run.name):
            return self.journal.opened(wait=wait)

    def arm(self) -> None:
        """Begin to wait for the pulse that opens the gate; forget what was measured before."""
        self.collect()
        one = self._options
        start_s = self._sampler.next / self._rate_hz
        self._resolver = LiveResolver(
            self.channels,
            self._rate_hz,
            harmonics=one.harmonics,
            periods=self.gate.wanted,
            start_s=start_s,
            latency_s=one.latency_s,
            angle_offset_rad=one.angle_offset_rad,
        )
        self._resolver_from_s = start_s
        self._usable_from_s = start_s + REACH / self._rate_hz + one.latency_s
        self.reading, self._judged = None, 0
        self.gate.arm()
        self.event("armed", str(self._sampler.next))

    def open_by_time(self) -> None:
        """Open the gate now: of a run at rest, or of a rig without a photocell."""
        self.collect()
        self._sum[:], self._square[:], self._count = 0.0, 0.0, 0
        self.gate.arm()
        self.gate.pulse(self._rig.number / self._rate_hz)

    def close_by_time(self) -> None:
        """Close the gate now."""
        self.gate.hold()
        self.gate.pulse(self._rig.number / self._rate_hz)

    def cycle(self, lateness_s: float, now_s: float) -> None:
        """Take what came in a cycle.

        Raises
        ------
        RecordingError
            If the recorder cannot keep it.
        """
        self.journal.cycle_statistics(lateness_s)
        if self._rig.number % self._every == 0:
            self.collect()
        self._take_pulses()
        with kept(self.run.name):
            self.journal.tick(now_s)

    def collect(self, *, final: bool = False) -> None:
        """Take the samples that have come; raises as :meth:`cycle` does."""
        first = self._sampler.next
        values = self._sampler.collect(self._rig.number, final=final)
        if not values.shape[1]:
            return
        with kept(self.run.name):
            self.journal.samples(first, values)
        if self._resolver is not None:
            self._heard(self._resolver.push(values))
            self._judge()
        if not self.run.oscillates and self.gate.state is GateState.OPEN:
            self._add(values)
            self._push.take(values)

    def pushing(self) -> None:
        """From here on somebody pushes."""
        self.collect()
        self._push.begin()

    def let_go(self) -> None:
        """From here on nobody pushes any more."""
        self.collect()
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
        """Take what is still on its way and make the last reading."""
        self.collect(final=True)
        if self._resolver is None:
            return
        self._heard(self._resolver.finish())
        self.reading = self._resolver.so_far()
        found = 0 if self.reading is None else self.reading.periods
        if found != self.gate.periods:
            text = f"{found} of the gate's {self.gate.periods} periods have all their samples"
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
        with kept(self.run.name):
            self.journal.event(number, number / self._rate_hz, kind, text)

    def rows(self) -> tuple[HarmonicRow, ...]:
        """Return what is known of the channels by now: final, else the needles, else nothing."""
        if self.gate.state is GateState.HELD and self.reading is not None:
            return beside(rows_of(self.reading), self._expected)
        if self._resolver is not None:
            known = 0 if self.reading is None else self.reading.periods
            if self._resolver.finished > max(known, 1):
                self.reading = self._resolver.so_far()
            found = needles(self.channels, self._resolver.provisional(), self.reading)
            return beside(found, self._expected)
        return rows_at_rest(self.channels, self._sum, self._square, self._count)

    def _take_pulses(self) -> None:
        if self._rig.photocell is None:
            return
        for pulse in self._rig.photocell.take():
            with kept(self.run.name):
                self.journal.pulse(pulse)
            self._pulse(pulse)

    def _pulse(self, pulse: Pulse) -> None:
        listening = self.gate.state in (GateState.ARMED, GateState.OPEN)
        if self._resolver is None or not listening or pulse.time_s < self._usable_from_s:
            return
        try:
            found = self._resolver.pulse(pulse.time_s)
        except DataError as error:
            self.void(str(error))
            return
        before = self.gate.state
        self.gate.pulse(pulse.time_s)
        if self.gate.state is not before:
            self.event("gate", f"{self.gate.state} at {pulse.time_s:.6f} s")
        self._heard(found)

    def _heard(self, readings: Sequence[Harmonics]) -> None:
        self._tell_spikes()
        for one in readings:
            self.reading = one
            self._keep(one)

    def _tell_spikes(self) -> None:
        spikes = self._resolver.spikes() if self._resolver is not None else []
        for one in spikes:
            channel = self.channels[one.row]
            at_s = self._resolver_from_s + one.number / self._rate_hz
            text = (
                f"{channel.name}: a spike of {one.spike.size:+.4g} {channel.unit} at {at_s:.6g} s "
                "was taken out of the live readings; the recording has it"
            )
            self.note("spike", Severity.WARNING, text)

    def _keep(self, reading: Harmonics) -> None:
        with kept(self.run.name):
            self.journal.harmonic(as_record(reading))

    def _judge(self) -> None:
        """Close a gate whose uncertainty is small enough, at the end of its last period."""
        resolver, target = self._resolver, self.run.target_relative
        if resolver is None or target is None or self.gate.state is not GateState.OPEN:
            return
        done = resolver.finished
        if done <= self._judged or done < max(self.run.periods, 2) or done != self.gate.periods:
            return
        self._judged = done
        self.reading = resolver.so_far()
        if self.reading is not None and worst_relative(self.reading, self._forces) <= target:
            self.gate.hold_at_last()
            self._keep(self.reading)
            self.event("gate", f"held: target {target:g} met after {done} periods")

    def _add(self, values: FloatArray) -> None:
        good = values[:, np.isfinite(values).all(axis=0)]
        self._sum += good.sum(axis=1)
        self._square += (good**2).sum(axis=1)
        self._count += good.shape[1]
