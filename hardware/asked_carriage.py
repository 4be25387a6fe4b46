"""The carriage behind a programmable controller (Modbus TCP or RTU) or a panel that says lines."""

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final

from hardware.asked_device import AskedDevice, raise_worst
from hardware.carriage_settings import AskedCarriageSettings
from hardware.description.channels import CARRIAGE_SPEED, TURN_RATE, Channel
from hardware.description.oscillator import Range
from hardware.driver import Services
from hardware.errors import (
    HardwareError,
    LimitError,
    NotReadyError,
    SensorInvalidError,
    TrackEndError,
)
from hardware.limits import (
    CARRIAGE_PLAUSIBLE,
    CARRIAGE_REST_SHARE,
    RAMP_MARGIN,
    REST_DEADLINE_S,
    TRACK_MARGIN,
)
from hardware.roles import Cycle, Sample, SampleBlock, blocks

_AT_START: Final = 0.02  # of the track, in metres: so near the start it stands there
_PLACE: Final = "m as its place; look at its sensor, then at type and words of position"


class AskedCarriage(AskedDevice):
    """A :class:`hardware.roles.Carriage` and a :class:`hardware.roles.SpeedFollower`.

    Its channels have a sample in every cycle: what was read last, NaN before and in silence.
    """

    def __init__(self, name: str, settings: AskedCarriageSettings, services: Services) -> None:
        registers = settings.signals
        super().__init__(
            name, settings, services, registers.read(), registers.status, registers.command
        )
        self.sample_rate_hz = services.sample_rate_hz
        self.tolerance_m_s = settings.tolerance_m_s
        self.speed_m_s = Range(0.0, settings.highest_speed_m_s)
        self._settings = settings
        self._track = Range(*(settings.track_m or (-math.inf, math.inf)))
        self._rest_m_s = CARRIAGE_REST_SHARE * settings.highest_speed_m_s
        self._goal_m_s = self._turn_rad_s = 0.0
        turns = registers.turn_rate is not None
        self.channels: tuple[Channel, ...] = (CARRIAGE_SPEED, *((TURN_RATE,) if turns else ()))
        self._steady_s: float | None = None  # since when it keeps the goal
        self._returning = False
        self._samples: list[Sample] = []
        self.tell(registers.set_speed, 0.0)

    @property
    def measured_speed_m_s(self) -> float:
        """Speed that it reads; NaN before, and in silence."""
        return self.values["speed"] if self._link.is_answering else math.nan

    @property
    def measured_turn_rate_rad_s(self) -> float:
        """Rate of turn that it reads; NaN before and in silence, 0 where it goes straight."""
        return self.values.get("turn_rate", 0.0) if self._link.is_answering else math.nan

    @property
    def position_m(self) -> float:
        """Place along the track; NaN where nothing reads it."""
        return self.values.get("position", math.nan) if self._link.is_answering else math.nan

    @property
    def returns(self) -> bool:
        """Whether its place is read, so that it can go back by itself."""
        return self._settings.track_m is not None

    @property
    def at_speed(self) -> bool:
        """Whether it has kept the speed asked for, within its tolerance, for its time."""
        kept_s = math.nan if self._steady_s is None else self._now_s - self._steady_s
        return self._goal_m_s > 0.0 and kept_s >= self._settings.settle_s

    @property
    def moving(self) -> bool:
        """Whether it moves, is told to, or is not heard."""
        return self._goal_m_s != 0.0 or not abs(self.measured_speed_m_s) <= self._rest_m_s

    def run_at(self, speed_m_s: float, turn_rate_rad_s: float = 0.0) -> None:
        """Run up to a speed, straight or round a circle.

        Raises
        ------
        LimitError
            If it is beyond the highest, or what is left of the track is shorter than its ramps, or
            it cannot turn so fast.
        NotReadyError
            If it is not enabled, or its place on the track is not known.
        """
        self._check_speed(speed_m_s)
        if abs(turn_rate_rad_s) > self._settings.highest_turn_rate_rad_s:
            raise LimitError(
                self.name,
                f"{turn_rate_rad_s:g} rad/s is beyond {self._settings.highest_turn_rate_rad_s:g} "
                "rad/s (highest_turn_rate_rad_s; 0 for a carriage that goes straight)",
            )
        ramp_s = speed_m_s / self._settings.acceleration_m_s2
        needs_m, left_m = speed_m_s * (ramp_s + self._settings.settle_s), self._left_m
        if self.returns and not math.isfinite(left_m):
            raise NotReadyError(self.name, f"reads {self.position_m:g} {_PLACE}")
        if left_m < needs_m:
            raise LimitError(
                self.name,
                f"{left_m:.3g} m of track are left and {speed_m_s:g} m/s takes {needs_m:.3g} m to "
                "reach, settle and stop; take it back, or run slower",
            )
        self._go(speed_m_s, turn_rate_rad_s)
        self.set_deadline(
            RAMP_MARGIN * ramp_s + 3.0 * self._settings.settle_s,
            f"{speed_m_s:g} m/s within {self.tolerance_m_s:g} m/s",
        )

    def lead(self, speed_m_s: float) -> None:
        """Go on at another speed, as the carriage's ramps allow.

        Raises
        ------
        LimitError
            If it is beyond the highest, or not above 0.
        NotReadyError
            If it does not run.
        """
        if not self._goal_m_s > 0.0:
            raise NotReadyError(self.name, "does not run; it is led from run_at on")
        self._check_speed(speed_m_s)
        self._goal_m_s = speed_m_s
        self.tell(self._settings.signals.set_speed, speed_m_s)

    def go_back(self) -> None:
        """Go back to the start, if its place is known; raises :class:`NotReadyError` as above."""
        way_m = self.position_m - self._track.low
        if not way_m > _AT_START:
            return
        speed = self._settings.return_speed_m_s
        self._go(-speed)
        self._returning = True
        takes_s = way_m / speed + 3.0 * speed / self._settings.acceleration_m_s2
        self.set_deadline(RAMP_MARGIN * takes_s + REST_DEADLINE_S, "the start of the track")

    def stop(self) -> None:
        """Come to rest on the ramp, under power."""
        was_told = self._goal_m_s != 0.0
        self._set(0.0)
        if was_told and self._wants_power:
            self._come_to_rest("rest")

    def quick_stop(self) -> None:
        """Come to rest as fast as the carriage's own controller does without its enable."""
        self._set(0.0)
        self.cancel_deadline()
        self._wants_power = False

    def disable(self) -> None:
        """Come to rest, and take the power off."""
        self.quick_stop()

    def reset_fault(self) -> None:
        """Begin anew, without power; raises as :meth:`AskedDevice.reset_fault`."""
        self._set(0.0)
        super().reset_fault()

    def tick(self, cycle: Cycle) -> None:
        """Take what came and pursue the goal.

        Raises
        ------
        TrackEndError
            If it has to stop now for the track's sake.
        SensorInvalidError
            If what it reads is no speed of this carriage, or no place.
        HardwareError
            As :meth:`AskedDevice.exchange` says.
        """
        fresh, faults = self.exchange(cycle)
        read = (self.measured_speed_m_s, self.measured_turn_rate_rad_s)
        self._samples.append((cycle.number, read[: len(self.channels)]))
        if fresh:
            self._pursue()
            wrong = [
                error for error in self._implausible_readings() if type(error) not in self._known
            ]
            self._known |= {type(error) for error in wrong}
            faults += wrong
        if faults and not self._wants_power:
            self._set(0.0)
        raise_worst(faults)

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call: the speed in m/s, the rate of turn in rad/s."""
        taken, self._samples = self._samples, []
        return blocks(taken)

    def carried(self) -> dict[str, Any]:
        """Return the numbers read last, ``None`` for none; see :mod:`hardware.carry_over`."""
        return {name: None if math.isnan(value) else value for name, value in self.values.items()}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Go on from there."""
        self.values = {
            name: math.nan if value is None else value for name, value in carried.items()
        }
        self._link.assume(heard=not math.isnan(self.values["speed"]))

    @property
    def _left_m(self) -> float:
        """Track that is left ahead; infinite where nobody reads the place, NaN where it is none."""
        return self._track.high - self.position_m if self.returns else math.inf

    def _check_speed(self, speed_m_s: float) -> None:
        if not (speed_m_s > 0.0 and speed_m_s in self.speed_m_s):
            raise LimitError(
                self.name,
                f"{speed_m_s:g} m/s is outside 0 to {self.speed_m_s.high:g} m/s (and above 0)",
            )

    def _go(self, speed_m_s: float, turn_rate_rad_s: float = 0.0) -> None:
        if not self.enabled:
            raise NotReadyError(
                self.name, "is not enabled; enable it, and look whether it is in remote and ready"
            )
        self._set(speed_m_s, turn_rate_rad_s)

    def _come_to_rest(self, event: str) -> None:
        """Wait for rest: for as long as the ramp takes from the highest speed."""
        ramp_s = self.speed_m_s.high / self._settings.acceleration_m_s2
        self.set_deadline(RAMP_MARGIN * ramp_s + REST_DEADLINE_S, event)

    def _set(self, speed_m_s: float, turn_rate_rad_s: float = 0.0) -> None:
        if (speed_m_s, turn_rate_rad_s) != (self._goal_m_s, self._turn_rad_s):
            self._steady_s = None
        self._goal_m_s, self._turn_rad_s, self._returning = speed_m_s, turn_rate_rad_s, False
        self.tell(self._settings.signals.set_speed, speed_m_s)
        if self._settings.signals.set_turn_rate is not None and speed_m_s:
            # At rest it keeps the last: on its ramp the carriage stays on the circle.
            self.tell(self._settings.signals.set_turn_rate, turn_rate_rad_s)

    def _pursue(self) -> None:
        """Look at what was read: whether the goal is kept, or the way back is at its end."""
        speed = self.measured_speed_m_s
        if self._returning:
            self._approach(self.position_m - self._track.low)
        # Nor is it kept by what is no number.
        if not max(abs(speed - self._goal_m_s), self._astray_m_s) <= self.tolerance_m_s:
            self._steady_s = None
        elif self._steady_s is None:
            self._steady_s = self._now_s
        if self.at_speed or not self.moving:
            self.cancel_deadline()

    @property
    def _astray_m_s(self) -> float:
        """How far the midpoint's speed is off by the rate of turn, the radius being right."""
        if not (self._turn_rad_s and self._goal_m_s):
            return 0.0
        radius_m = self._goal_m_s / abs(self._turn_rad_s)
        return radius_m * abs(self.measured_turn_rate_rad_s - self._turn_rad_s)

    def _approach(self, way_m: float) -> None:
        """Brake towards the start at half the ramp, so that it is not overrun."""
        if not way_m > 0.5 * _AT_START:
            self._set(0.0)
            self._come_to_rest("rest at the start of the track")
            return
        fastest = math.sqrt(self._settings.acceleration_m_s2 * way_m)
        self.tell(self._settings.signals.set_speed, -min(self._settings.return_speed_m_s, fastest))

    def _implausible_readings(self) -> Iterator[HardwareError]:
        speed, highest = self.measured_speed_m_s, self.speed_m_s.high
        if "speed" in self.read_now and not abs(speed) <= CARRIAGE_PLAUSIBLE * highest:
            yield SensorInvalidError(
                self.name,
                f"reads {speed:.6g} m/s where {highest:g} m/s is the highest; correct type, words, "
                "scale or unit of speed",
            )
        elif "position" in self.read_now and not math.isfinite(self.position_m):
            yield SensorInvalidError(self.name, f"reads {self.position_m:g} {_PLACE}")
        elif self._goal_m_s > 0.0:
            yield from self._end_of_track()

    def _end_of_track(self) -> Iterator[HardwareError]:
        speed, lost_s = self.measured_speed_m_s, 2.0 * self._settings.lost_s
        braking_m = speed**2 / (2.0 * self._settings.acceleration_m_s2)
        if self._says("at_end"):
            yield TrackEndError(self.name, "has run onto the switch at the end of its track")
        elif not self._left_m > TRACK_MARGIN * braking_m + lost_s * speed:
            yield TrackEndError(
                self.name,
                f"{self._left_m:.3g} m of track are left at {speed:.3g} m/s, which brakes in "
                f"{braking_m:.3g} m; ask for fewer periods, or start further back",
            )
