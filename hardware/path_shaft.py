"""A shaft that is a program: two struts with drives of their own follow a path over its angle.

The master angle turns as a shaft would. In every cycle each strut is sent the set-point of two
SYNCs later, ``e`` times its lines at the master angle of then, so that run-up, running and stop are
one path. Time is the count of SYNCs; the set-point's place in it is its time stamp.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from hardware.axis import nodes as axis_nodes
from hardware.command_limits import check_enabled, check_speed
from hardware.description.channels import (
    COMMAND_AFT,
    COMMAND_FORE,
    DISPLACEMENT_AFT,
    DISPLACEMENT_FORE,
    SHAFT_ANGLE,
)
from hardware.description.lines import Line
from hardware.description.oscillator import Range
from hardware.driver import Driver, NodePlan, Services
from hardware.errors import HardwareError, NotReadyError, as_fault, worst
from hardware.path_approach import PathApproach
from hardware.path_record import PathRecord
from hardware.path_shaft_settings import STRUTS, PathShaftSettings
from hardware.path_strut import PathStrut
from hardware.roles import Cycle, Role, SampleBlock
from hardware.serial_port import PortSettings
from hardware.strut_path import StrutPath, check_clock, check_path

_TURN = 2.0 * math.pi
_LOOPED: Final = "loop://"  # of pyserial: what is written is read back
LEAD_CYCLES = 2  # from sending a set-point to its SYNC (hardware/path_strut.py)


class PathShaft:
    """A :class:`hardware.roles.Shaft` and a :class:`hardware.roles.PathFollower`.

    Attributes
    ----------
    struts
        Aft and fore.
    eccentricity_m, strut_phase_rad
        Of the path that is to be followed.
    """

    def __init__(self, name: str, settings: PathShaftSettings, services: Services) -> None:
        self.name = name
        self.settings = settings
        self.sample_rate_hz = services.sample_rate_hz
        self.frequency_hz = Range(settings.lowest_frequency_hz, settings.highest_frequency_hz)
        encoder_channels = (DISPLACEMENT_AFT, DISPLACEMENT_FORE) if settings.encoders else ()
        self.channels = (SHAFT_ANGLE, *encoder_channels, COMMAND_AFT, COMMAND_FORE)
        self.struts = tuple(
            PathStrut(f"{name}.{strut}", getattr(settings, strut), services) for strut in STRUTS
        )
        self.eccentricity_m = self.strut_phase_rad = 0.0
        self._lines: tuple[Line, ...] = ()
        self._path = StrutPath()
        self._angle = self._speed_hz = self._target_hz = 0.0
        self._points = np.zeros(2)
        self._approach = PathApproach(self.struts, settings.approach_speed, self.sample_rate_hz)
        port = services.port(name, PortSettings(_LOOPED))
        self._record = PathRecord(self.struts, port, encoders=settings.encoders)

    @property
    def enabled(self) -> bool:
        """Whether both struts hold or move under power."""
        return all(strut.enabled for strut in self.struts)

    @property
    def homed(self) -> bool:
        """Whether both struts know where they are."""
        return all(strut.homed for strut in self.struts)

    @property
    def setting(self) -> bool:
        """Whether the struts are being homed, or go to another path at rest."""
        homing = any(strut.homing for strut in self.struts)
        return homing or (self._approach.under_way and self._target_hz == 0.0)

    @property
    def placed(self) -> bool:
        """Whether the struts stand where the path is now, by their encoders, or follow it."""
        if self._approach.under_way or not self.homed:
            return False
        return bool((np.abs(self._points - self._wanted()) <= 1e-9).all())

    @property
    def measured_frequency_hz(self) -> float:
        """Turns of the master angle per second."""
        return self._speed_hz

    @property
    def moving(self) -> bool:
        """Whether the master angle turns, or a strut moves by its encoder without being set."""
        rest = self.setting or all(strut.drive.motion.at_rest for strut in self.struts)
        return not rest or self._speed_hz != 0.0 or self._target_hz != 0.0

    @property
    def at_speed(self) -> bool:
        """Whether the master angle turns at the commanded speed, and the drives are led by it."""
        led = all(strut.drive.in_mode for strut in self.struts)
        return self.enabled and led and 0.0 < self._speed_hz == self._target_hz

    def enable(self) -> None:
        """Put both struts under power where they stand."""
        self._halt()
        for strut in self.struts:
            strut.enable()

    def disable(self) -> None:
        """Take the power off as soon as the struts are at rest: by quick stop if they move."""
        self._halt()
        for strut in self.struts:
            strut.disable()

    def home(self) -> None:
        """Find both struts' reference positions; raises as an axis's ``home`` does."""
        self._halt()
        for strut in self.struts:
            strut.home()

    def follow(self, lines: Sequence[Line]) -> None:
        """Let the struts follow these lines from now on; a single sine without any.

        Raises
        ------
        NotReadyError
            While the master angle turns.
        """
        self.aim(lines=tuple(lines))

    def aim(
        self,
        *,
        eccentricity_m: float | None = None,
        strut_phase_rad: float | None = None,
        lines: tuple[Line, ...] | None = None,
    ) -> None:
        """Change the path at rest; the struts go to where it is now, once they may.

        Raises
        ------
        NotReadyError
            While the master angle turns.
        """
        if self._speed_hz or self._target_hz:
            raise NotReadyError(self.name, "turns; stop it before its path is changed")
        if eccentricity_m is not None:
            self.eccentricity_m = eccentricity_m
        if strut_phase_rad is not None:
            self.strut_phase_rad = strut_phase_rad
        if lines is not None:
            self._lines = lines
        self._path = StrutPath(self._lines, self.strut_phase_rad)
        if self.enabled and self.homed:
            self._approach.begin()

    def turn(self, frequency_hz: float) -> None:
        """Go to the path if the struts are not on it, then run up or down to a speed.

        Raises
        ------
        LimitError
            If the speed, or the path at it, lies outside the limits.
        NotReadyError
            If the struts are not enabled or not homed.
        """
        check_speed(self, frequency_hz)
        check_enabled(self)
        if not self.homed:
            raise NotReadyError(self.name, "is not homed; home its struts before it turns")
        check_path(self.name, self.settings, self._path, self.eccentricity_m, frequency_hz)
        if not self.placed:
            self._approach.begin()
        self._target_hz = frequency_hz

    def stop(self) -> None:
        """Decelerate along the path, then stand under power."""
        self._target_hz = 0.0
        self._approach.stop()
        for strut in self.struts:
            if strut.homing:
                strut.stop()

    def quick_stop(self) -> None:
        """Decelerate on the drives' quick-stop ramps, off the path."""
        self._halt()
        for strut in self.struts:
            strut.quick_stop()

    def reset_fault(self) -> None:
        """Reset the drives' faults; they stay disabled."""
        self._halt()
        for strut in self.struts:
            strut.reset_fault()

    def prepare(self) -> None:
        """Write limits, ramps and the set-points' period to the drives."""
        for strut in self.struts:
            strut.prepare()

    @property
    def notes(self) -> tuple[str, ...]:
        """What the drives lack, a sentence each."""
        return tuple(note for strut in self.struts for note in strut.notes)

    def tick(self, cycle: Cycle) -> None:
        """Take the struts' positions, and send the set-points of two SYNCs later.

        Raises
        ------
        CycleJumpError
            If the cycle came so late while the struts move that set-points were left out.
        HardwareError
            What the drives raise, the most severe first.
        """
        faults: list[HardwareError] = []
        for strut in self.struts:
            try:
                strut.tick(cycle)
            except HardwareError as error:
                faults.append(error)
        self._record.tick(cycle.number, self._angle)
        try:
            if self._speed_hz or self._approach.moves:
                check_clock(self.name, cycle, self.sample_rate_hz)
            self._lead(cycle.number + LEAD_CYCLES)
        except Exception as error:  # beside what the drives have raised
            faults.append(as_fault(self.name, error))
        if faults:
            raise worst(faults)

    def angle_at(self, number: int) -> float:
        """Return the master angle at a SYNC of the latest; NaN at one that it knows nothing of."""
        return self._record.angle_at(number)

    def take(self) -> tuple[SampleBlock, ...]:
        """Return angle, displacements and commands since the last call."""
        return self._record.take()

    def carried(self) -> dict[str, Any]:
        """Return what the struts are led to; see :mod:`hardware.carry_over`."""
        return self._record.carried()

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Go on recording from there; a replay leads nothing."""
        self._record.carry_on(carried)

    def close(self) -> None:
        """Close the record; the bus is the master's."""
        self._record.close()

    def _halt(self) -> None:
        """End what is under way, off the path: the drives decelerate."""
        self._target_hz = self._speed_hz = 0.0
        self._approach.drop()
        for strut in self.struts:
            strut.drive.cancel_deadline()

    def _wanted(self) -> np.ndarray:
        """Return where the path has the struts now."""
        return np.asarray(self.eccentricity_m * self._path.at(self._angle))

    def _lead(self, number: int) -> None:
        """Go on by a cycle to SYNC ``number``, and send the struts there."""
        period_s = 1.0 / self.sample_rate_hz
        free = [not strut.enabled or strut.homing for strut in self.struts]
        if any(free):
            self._points = np.array([strut.position for strut in self.struts])
        elif self._approach.under_way:
            self._points = self._approach.step(self._points, self._wanted())
        elif self._target_hz or self._speed_hz:
            before = self._speed_hz
            most = self.settings.acceleration_hz_per_s * period_s
            self._speed_hz += min(max(self._target_hz - before, -most), most)
            self._angle += _TURN * (before + self._speed_hz) / 2.0 * period_s
            self._points = self._wanted()
        for strut, point, is_free in zip(self.struts, self._points, free, strict=True):
            if not strut.homing:
                strut.lead(strut.position if is_free else float(point))
        self._record.led(number, self._angle, self._points)


def nodes(name: str, settings: PathShaftSettings) -> tuple[NodePlan, ...]:
    """Return what both struts' drives want of the bus."""
    return tuple(
        plan for strut in STRUTS for plan in axis_nodes(f"{name}.{strut}", getattr(settings, strut))
    )


DRIVER = Driver(Role.SHAFT, PathShaftSettings, PathShaft, nodes)
