"""What every driver has to do, whatever it drives. Inherit the class of your role and give a bench.

::

    class TestMyAmplifier(ForceContract):
        @pytest.fixture
        def bench(self):
            ...
            yield Bench(rig, apply=lambda newtons: ...)

The bench's rig has been prepared; :attr:`Bench.apply` does to the device what the world does: a
force in the unit of the first channel, an angle in radians, the shaft's frequency.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from hardware.errors import LimitError, NotReadyError, PhotocellMissedError
from hardware.rig import Rig
from hardware.roles import (
    PROTOCOLS,
    Carriage,
    PositionAxis,
    Pulse,
    Role,
    SampleBlock,
    Sampled,
    Shaft,
    SpeedFollower,
)

_TRIES = 4  # of what a busy machine has spoilt


def _nothing(_value: float) -> None:
    return


@dataclass
class Bench:
    """A rig with the device under test, and what the world does to it.

    ``within`` is how many cycles a command may take.
    """

    rig: Rig
    apply: Callable[[float], None] = _nothing
    within: int = 400

    def cycles(self, count: int) -> float:
        """Run cycles; return by how much the latest of them came late, in seconds."""
        return max((self.rig.cycle().lateness_s for _ in range(count)), default=0.0)

    def until(self, condition: Callable[[], bool], what: str) -> None:
        self.rig.run_until(condition, self.within, what)


def _numbers(blocks: tuple[SampleBlock, ...]) -> list[int]:
    return [one.first + i for one in blocks for i in range(one.values.shape[1])]


class _Contract:
    role: Role

    def device(self, bench: Bench) -> object:
        raise AssertionError("a contract says which device it is about")

    def test_it_answers_its_role(self, bench: Bench) -> None:
        device = self.device(bench)
        assert device.name
        inner = getattr(device, "_inner", device)
        assert isinstance(inner, PROTOCOLS[self.role])

    def test_it_closes_twice(self, bench: Bench) -> None:
        bench.cycles(2)
        device = self.device(bench)
        device.close()
        device.close()

    def test_a_reset_without_fault_leaves_it_in_order(self, bench: Bench) -> None:
        bench.rig.stop()  # where a person has to say so: the axis stands
        bench.until(lambda: not any(one.moving for one in bench.rig.powered()), "rest")
        bench.rig.reset()
        bench.cycles(60)
        assert not bench.rig.faults


class _SampledContract(_Contract):
    def sampled(self, bench: Bench) -> Sampled:
        device = self.device(bench)
        assert isinstance(device.channels, tuple)
        return device

    def test_channels_are_named_once_and_have_units(self, bench: Bench) -> None:
        channels = self.sampled(bench).channels
        assert len({one.name for one in channels}) == len(channels)
        assert all(one.name and one.unit for one in channels)
        assert self.sampled(bench).sample_rate_hz > 0

    def test_blocks_have_a_row_for_each_channel_and_no_gap(self, bench: Bench) -> None:
        device = self.sampled(bench)
        bench.cycles(3)
        device.take()
        bench.cycles(50)
        blocks = device.take()
        if not device.channels:
            assert blocks == ()
            return
        assert all(one.values.shape[0] == len(device.channels) for one in blocks)
        assert all(one.values.dtype == np.float64 for one in blocks)
        numbers = _numbers(blocks)
        assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))

    def test_taking_empties(self, bench: Bench) -> None:
        bench.cycles(10)
        self.sampled(bench).take()
        assert self.sampled(bench).take() == ()


class _PoweredContract(_Contract):
    def test_it_begins_without_power(self, bench: Bench) -> None:
        bench.cycles(2)
        assert not self.device(bench).enabled

    def test_power_comes_and_goes(self, bench: Bench) -> None:
        device = self.device(bench)
        device.enable()
        bench.until(lambda: device.enabled, "enable")
        device.disable()
        bench.until(lambda: not device.enabled, "disable")

    def test_a_quick_stop_takes_an_enable_to_go_on(self, bench: Bench) -> None:
        device = self.device(bench)
        device.enable()
        bench.until(lambda: device.enabled, "enable")
        device.quick_stop()
        bench.cycles(20)
        assert not device.enabled
        device.enable()
        bench.until(lambda: device.enabled, "enable again")


class ShaftContract(_SampledContract, _PoweredContract):
    """For drivers of the drive shaft."""

    role = Role.SHAFT

    def device(self, bench: Bench) -> Shaft:
        assert bench.rig.shaft is not None
        return bench.rig.shaft

    def test_it_refuses_to_turn_without_power(self, bench: Bench) -> None:
        shaft = self.device(bench)
        with pytest.raises(NotReadyError):
            shaft.turn(shaft.frequency_hz.high)

    @pytest.mark.parametrize("share", [-1.0, 0.0, 1.001, math.nan, math.inf])
    def test_it_refuses_speeds_beyond_its_limits(self, bench: Bench, share: float) -> None:
        shaft = self.device(bench)
        shaft.enable()
        bench.until(lambda: shaft.enabled, "enable")
        with pytest.raises(LimitError):
            shaft.turn(share * shaft.frequency_hz.high)
        bench.cycles(5)
        assert not shaft.moving

    def test_it_reaches_a_speed_and_stops(self, bench: Bench) -> None:
        shaft = self.device(bench)
        shaft.enable()
        bench.until(lambda: shaft.enabled, "enable")
        wanted = 0.5 * (shaft.frequency_hz.low + shaft.frequency_hz.high)
        shaft.turn(wanted)
        assert shaft.moving
        bench.until(lambda: shaft.at_speed, "speed")
        assert shaft.measured_frequency_hz == pytest.approx(wanted, rel=0.1)
        shaft.stop()
        bench.until(lambda: not shaft.moving, "stop")
        assert shaft.enabled

    def test_the_angle_grows_with_the_speed(self, bench: Bench) -> None:
        shaft = self.device(bench)
        if not shaft.channels:
            pytest.skip("no encoder")
        shaft.enable()
        bench.until(lambda: shaft.enabled, "enable")
        shaft.turn(shaft.frequency_hz.high)
        bench.until(lambda: shaft.at_speed, "speed")
        bench.cycles(3)
        shaft.take()
        bench.cycles(100)
        angle = np.concatenate([one.values[0] for one in shaft.take()])
        step = 2.0 * math.pi * shaft.frequency_hz.high / shaft.sample_rate_hz
        assert np.diff(angle) == pytest.approx(step, rel=0.05)


class CarriageContract(_SampledContract, _PoweredContract):
    """For drivers of the carriage; ``apply`` does nothing: the device is the world here."""

    role = Role.CARRIAGE

    def device(self, bench: Bench) -> Carriage:
        assert bench.rig.carriage is not None
        return bench.rig.carriage

    def ready(self, bench: Bench) -> Carriage:
        carriage = self.device(bench)
        carriage.enable()
        bench.until(lambda: carriage.enabled and not carriage.moving, "enable")
        return carriage

    def test_it_refuses_to_run_without_power(self, bench: Bench) -> None:
        carriage = self.device(bench)
        bench.cycles(20)
        with pytest.raises(NotReadyError):
            carriage.run_at(0.5 * carriage.speed_m_s.high)

    @pytest.mark.parametrize("share", [-1.0, 0.0, 1.001, math.nan, math.inf])
    def test_it_refuses_speeds_beyond_its_limits(self, bench: Bench, share: float) -> None:
        carriage = self.ready(bench)
        with pytest.raises(LimitError):
            carriage.run_at(share * carriage.speed_m_s.high)
        bench.cycles(20)
        assert not carriage.moving

    def test_it_keeps_a_speed_and_stops(self, bench: Bench) -> None:
        carriage = self.ready(bench)
        wanted = 0.5 * carriage.speed_m_s.high
        carriage.run_at(wanted)
        assert carriage.moving
        assert not carriage.at_speed
        bench.until(lambda: carriage.at_speed, "speed")
        assert carriage.measured_speed_m_s == pytest.approx(wanted, rel=0.02)
        carriage.take()
        bench.cycles(50)
        recorded = np.concatenate([one.values[0] for one in carriage.take()])
        assert recorded == pytest.approx(wanted, rel=0.02)
        carriage.stop()
        assert not carriage.at_speed
        bench.until(lambda: not carriage.moving, "stop")
        assert carriage.enabled

    def test_it_follows_a_speed_that_is_led(self, bench: Bench) -> None:
        carriage = self.ready(bench)
        if not isinstance(bench.rig.follower, SpeedFollower):
            pytest.skip("its speed is not led")
        lead, half = bench.rig.follower.lead, 0.5 * carriage.speed_m_s.high
        with pytest.raises(NotReadyError):
            lead(half)
        carriage.run_at(half)
        bench.until(lambda: carriage.at_speed, "speed")
        for step in range(20):
            lead(half * (1.0 - 0.002 * step))
            bench.cycles(2)
        bench.cycles(30)
        assert carriage.measured_speed_m_s == pytest.approx(0.962 * half, rel=0.01)
        for share in (0.0, -0.1, 2.001, math.nan):
            with pytest.raises(LimitError):
                lead(share * half)
        carriage.stop()
        with pytest.raises(NotReadyError):
            lead(half)
        bench.until(lambda: not carriage.moving, "stop")

    def test_it_goes_back_to_its_start(self, bench: Bench) -> None:
        carriage = self.ready(bench)
        if not carriage.returns:
            pytest.skip("nothing reads its place")
        carriage.run_at(0.5 * carriage.speed_m_s.high)
        bench.until(lambda: carriage.at_speed, "speed")
        carriage.stop()
        bench.until(lambda: not carriage.moving, "stop")
        carriage.go_back()
        assert carriage.moving
        bench.until(lambda: not carriage.moving, "return")
        carriage.go_back()
        assert not carriage.moving


class PositionAxisContract(_PoweredContract):
    """For drivers of eccentricity and phase; the bench has it as the eccentricity."""

    role = Role.POSITION_AXIS

    def device(self, bench: Bench) -> PositionAxis:
        assert bench.rig.eccentricity is not None
        return bench.rig.eccentricity

    def ready(self, bench: Bench) -> PositionAxis:
        axis = self.device(bench)
        axis.enable()
        bench.until(lambda: axis.enabled, "enable")
        axis.home()
        bench.until(lambda: axis.homed and not axis.moving, "home")
        return axis

    def test_it_knows_no_position_before_homing(self, bench: Bench) -> None:
        axis = self.device(bench)
        axis.enable()
        bench.until(lambda: axis.enabled, "enable")
        assert axis.reading is None
        with pytest.raises(NotReadyError):
            axis.move_to(axis.limits.low)

    def test_it_refuses_to_home_without_power(self, bench: Bench) -> None:
        with pytest.raises(NotReadyError):
            self.device(bench).home()

    def test_it_arrives_with_an_uncertainty(self, bench: Bench) -> None:
        axis = self.ready(bench)
        for share in (0.25, 0.75):
            wanted = axis.limits.low + share * (axis.limits.high - axis.limits.low)
            axis.move_to(wanted)
            assert axis.moving
            assert not axis.settled
            bench.until(lambda: axis.settled, "move")
            assert axis.reading is not None
            assert axis.reading.standard_uncertainty > 0
            assert axis.reading.source
            assert axis.reading.value == pytest.approx(wanted, rel=0.05)

    @pytest.mark.parametrize("beyond", [-1.0, 2.0, math.nan, math.inf])
    def test_it_refuses_positions_beyond_its_limits(self, bench: Bench, beyond: float) -> None:
        axis = self.ready(bench)
        with pytest.raises(LimitError):
            axis.move_to(axis.limits.low + beyond * (axis.limits.high - axis.limits.low))
        assert not axis.moving

    def test_a_stop_where_it_has_arrived_leaves_it_settled(self, bench: Bench) -> None:
        axis = self.ready(bench)
        axis.move_to(axis.limits.low + 0.25 * (axis.limits.high - axis.limits.low))
        bench.until(lambda: axis.settled, "move")
        axis.stop()
        bench.cycles(60)
        assert axis.settled
        assert not axis.moving

    def test_it_stops_on_the_way(self, bench: Bench) -> None:
        axis = self.ready(bench)
        axis.move_to(axis.limits.high)
        axis.stop()
        bench.until(lambda: not axis.moving, "stop")
        assert not axis.settled


class ForceContract(_SampledContract):
    """For amplifiers; ``apply`` sets the first channel's force, in its unit."""

    role = Role.FORCES

    def device(self, bench: Bench) -> Sampled:
        assert len(bench.rig.forces) == 1
        return bench.rig.forces[0]

    def mean(self, bench: Bench) -> float:
        device = self.device(bench)
        bench.cycles(5)
        device.take()
        bench.cycles(20)
        return float(np.mean(np.concatenate([one.values[0] for one in device.take()])))

    def test_full_scale_is_stated(self, bench: Bench) -> None:
        assert all(one.full_scale and one.full_scale > 0 for one in self.device(bench).channels)

    def test_it_measures_with_the_right_sign(self, bench: Bench) -> None:
        full_scale = self.device(bench).channels[0].full_scale
        for share in (0.5, -0.25):
            bench.apply(share * full_scale)
            assert self.mean(bench) == pytest.approx(share * full_scale, rel=0.01)

    def test_a_tare_takes_the_present_force_for_zero(self, bench: Bench) -> None:
        device = self.device(bench)
        full_scale = device.channels[0].full_scale
        bench.apply(0.2 * full_scale)
        bench.cycles(2 * round(device.sample_rate_hz))
        device.tare()
        assert self.mean(bench) == pytest.approx(0.0, abs=0.002 * full_scale)
        bench.apply(0.5 * full_scale)
        assert self.mean(bench) == pytest.approx(0.3 * full_scale, rel=0.02)

    def test_a_tare_without_samples_is_refused(self, bench: Bench) -> None:
        with pytest.raises(NotReadyError):
            self.device(bench).tare()


class PhotocellContract(_Contract):
    """For photocells; ``apply`` makes the shaft turn so many times a second (0: no pulses).

    That is well below what the rig may do: where frames come late, a speed found from two of them
    is too high for a moment.
    """

    role = Role.PHOTOCELL
    frequency_hz = 1.5

    def device(self, bench: Bench) -> object:
        assert bench.rig.photocell is not None
        return bench.rig.photocell

    def test_pulses_come_once_a_turn(self, bench: Bench) -> None:
        cell, rate = self.device(bench), bench.rig.configuration.sample_rate_hz
        bench.apply(self.frequency_hz)
        bench.cycles(round(rate / self.frequency_hz))
        cell.take()
        cell.expect(self.frequency_hz)
        pulses = self._six_turns(bench)
        assert len(pulses) in (6, 7)
        assert np.diff([one.number for one in pulses]) == pytest.approx(1)
        periods = np.diff([one.time_s for one in pulses])
        assert periods == pytest.approx(1.0 / self.frequency_hz, abs=1.1 / rate)
        angles = [one.shaft_angle_rad for one in pulses if math.isfinite(one.shaft_angle_rad)]
        assert np.diff(angles) == pytest.approx(2.0 * math.pi, abs=0.01)
        assert cell.take() == ()

    def _six_turns(self, bench: Bench) -> tuple[Pulse, ...]:
        """Return the pulses of six turns.

        In real time a pulse comes by the wall's clock and is stamped by the loop's. Where the
        machine kept the loop waiting for half a cycle, the two say nothing of the photocell: such
        turns are looked at again, a few times.
        """
        cell, rate = self.device(bench), bench.rig.configuration.sample_rate_hz
        for _ in range(_TRIES):
            late_s = bench.cycles(round(6.2 * rate / self.frequency_hz))
            pulses: tuple[Pulse, ...] = cell.take()
            if late_s < 0.5 / rate:
                break
        return pulses

    def test_a_pulse_that_stays_away_is_missed_in_time(self, bench: Bench) -> None:
        cell, rate = self.device(bench), bench.rig.configuration.sample_rate_hz
        bench.apply(self.frequency_hz)
        cell.expect(self.frequency_hz)
        bench.cycles(round(3.1 * rate / self.frequency_hz))
        bench.apply(0.0)
        with pytest.raises(PhotocellMissedError, match="limit"):
            bench.cycles(round(1.6 * rate / self.frequency_hz))


class InclinometerContract(_SampledContract):
    """For inclinometers; ``apply`` tilts it, in radians."""

    role = Role.INCLINOMETER

    def device(self, bench: Bench) -> Sampled:
        assert bench.rig.inclinometer is not None
        return bench.rig.inclinometer

    def test_it_measures_radians_with_the_right_sign(self, bench: Bench) -> None:
        device = self.device(bench)
        assert [one.unit for one in device.channels] == ["rad"]
        for angle in (0.02, -0.01):
            bench.apply(angle)
            bench.cycles(5)
            device.take()
            bench.cycles(20)
            values = np.concatenate([one.values[0] for one in device.take()])
            assert values == pytest.approx(angle, abs=1e-4)
