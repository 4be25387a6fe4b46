"""The acquisition: filter, sampling, noise and conversion of each channel that the rig records."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hardware.description import channels
from hardware.description.channels import Channel
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim import signals
from sim.acquisition.digitiser import Digitiser as Digitiser
from sim.acquisition.digitiser import LineState, digitise
from sim.acquisition.noise import start_stream
from sim.signals import Signal, Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block

if TYPE_CHECKING:
    from hardware.description.arrays import ComplexArray, FloatArray


class RecordedChannel(NamedTuple):
    """One recorded channel: what it is called, what it measures, and how."""

    channel: Channel
    source: Signal
    digitiser: Digitiser


# Field of Acquisition (and name of the channel) -> the signal behind it.
_SOURCES = {
    channels.SHAFT_ANGLE: signals.SHAFT_ANGLE,
    channels.DISPLACEMENT_AFT: signals.DISPLACEMENT_AFT,
    channels.DISPLACEMENT_FORE: signals.DISPLACEMENT_FORE,
    channels.FORCE_AFT: signals.DYNAMOMETER_FORCE_AFT,
    channels.FORCE_FORE: signals.DYNAMOMETER_FORCE_FORE,
    channels.FORCE_X: signals.FORCE_X,
    channels.CARRIAGE_SPEED: signals.CARRIAGE_SPEED,
    channels.TURN_RATE: signals.TURN_RATE,
    channels.WAVE_PROBE: signals.WAVE_PROBE,
    channels.RUDDER_ANGLE: signals.RUDDER_ANGLE,
    channels.REVOLUTIONS: signals.REVOLUTIONS,
    channels.PROPELLER_THRUST: signals.PROPELLER_THRUST,
    channels.PROPELLER_TORQUE: signals.PROPELLER_TORQUE,
    channels.RUDDER_NORMAL_FORCE: signals.RUDDER_NORMAL_FORCE,
    channels.POSITION_AFT: signals.POSITION_AFT,
    channels.POSITION_FORE: signals.POSITION_FORE,
    channels.ROLL_MOMENT: signals.ROLL_MOMENT,
    channels.HEEL_ANGLE: signals.HEEL_ANGLE,
    channels.COMMAND_AFT: signals.COMMAND_AFT,
    channels.COMMAND_FORE: signals.COMMAND_FORE,
}


_PERFECT = Digitiser()


@dataclass(frozen=True)
class Acquisition:
    """The recorded channels, under their standard names; ``None`` where the rig has no such sensor.

    The samples are those of the chain: all channels at the same instants, but for their delays.
    """

    shaft_angle: Digitiser | None = None
    displacement_aft: Digitiser | None = None
    displacement_fore: Digitiser | None = None
    force_aft: Digitiser | None = _PERFECT
    force_fore: Digitiser | None = _PERFECT
    carriage_speed: Digitiser | None = None
    turn_rate: Digitiser | None = None
    wave_probe: Digitiser | None = None
    force_x: Digitiser | None = None
    rudder_angle: Digitiser | None = None
    revolutions: Digitiser | None = None
    propeller_thrust: Digitiser | None = None
    propeller_torque: Digitiser | None = None
    rudder_normal_force: Digitiser | None = None
    position_aft: Digitiser | None = None
    position_fore: Digitiser | None = None
    roll_moment: Digitiser | None = None
    heel_angle: Digitiser | None = None
    command_aft: Digitiser | None = None
    command_fore: Digitiser | None = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
    name = "acquisition"

    @cached_property
    def lines(self) -> tuple[RecordedChannel, ...]:
        """The channels that are recorded, in their order."""
        lines = ((channel, getattr(self, channel.name)) for channel in _SOURCES)
        return tuple(
            RecordedChannel(channel, _SOURCES[channel], how) for channel, how in lines if how
        )

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the channels that are recorded."""
        return tuple(line.channel.name for line in self.lines)

    @cached_property
    def reads(self) -> tuple[Signal, ...]:
        """The quantities behind the recorded channels."""
        return tuple(line.source for line in self.lines)

    @cached_property
    def writes(self) -> tuple[Signal, ...]:
        """The recorded channels."""
        return tuple(signals.recorded(line.channel) for line in self.lines)

    def drifting_from(self, time_s: float) -> "Acquisition":
        """Return the acquisition with drifts that are zero at this time."""
        ways = {line.channel.name: line.digitiser for line in self.lines}
        drifting = {name: how for name, how in ways.items() if how.drift_per_s}
        return replace(
            self,
            **{
                name: replace(how, drifted=how.drifted - how.drift_per_s * time_s)
                for name, how in drifting.items()
            },
        )

    def start(self, sample_rate_hz: float, seed: int) -> tuple[LineState, ...]:
        """Return the beginning of each channel's own noise."""
        return tuple(
            LineState(
                start_stream(seed, self.name, line.channel.name),
                start_stream(seed, self.name, line.channel.name, "walk"),
            )
            for line in self.lines
        )

    def run(
        self, state: tuple[LineState, ...], block: Block, inputs: Signals
    ) -> tuple[tuple[LineState, ...], Signals]:
        """Return the recorded samples of each channel over the block."""
        after: list[LineState] = []
        written: dict[str, FloatArray] = {}
        for line, before, out in zip(self.lines, state, self.writes, strict=True):
            line_state, samples = digitise(line.digitiser, before, block, inputs[line.source.name])
            after.append(line_state)
            written[out.name] = samples
        return tuple(after), written

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the harmonics that the channels record.

        Noise, drift, rounding and hum, which are not periodic, are left out.
        """
        factors, added = _responses(self, period)
        recorded = np.empty_like(factors)
        for row, source in zip(recorded, self.reads, strict=True):
            row[:] = inputs[source.name]
        recorded *= factors
        recorded += added
        for at, limit in self._limits:
            row = recorded[at]
            if np.abs(row).sum() > limit:
                row[:] = period.harmonics(np.clip(period.values(row), -limit, limit))
        return period, {out.name: row for out, row in zip(self.writes, recorded, strict=True)}

    @cached_property
    def _limits(self) -> tuple[tuple[int, float], ...]:
        """Row and converter's range of each channel that has one; an encoder's turns have none."""
        return tuple(
            (at, line.digitiser.full_scale)
            for at, line in enumerate(self.lines)
            if line.digitiser.full_scale is not None and line.source is not signals.SHAFT_ANGLE
        )


@lru_cache(maxsize=512)
def _responses(acquisition: Acquisition, period: Period) -> "tuple[ComplexArray, ComplexArray]":
    """Return by what the channels multiply harmonics, and what they add, a row each."""
    responses = [line.digitiser.response(period.s) for line in acquisition.lines]
    factors = np.reshape(np.array(responses, np.complex128), (-1, period.orders + 1))
    added = np.zeros_like(factors)
    for row, line in enumerate(acquisition.lines):
        how = line.digitiser
        added[row, 0] = how.offset * factors[row, 0].real
        if line.source is signals.SHAFT_ANGLE:
            added[row, 0] -= period.omega_rad_s * how.delay_s
    return factors, added
