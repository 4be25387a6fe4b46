"""Whether a simulated rig has what a run asks of it."""

import math
from collections.abc import Collection, Iterator, Mapping
from functools import lru_cache
from typing import Final, Protocol

import numpy as np

from hardware.description.arrangement import DriftBy, Joint
from hardware.description.attitude import AttitudeSensors, HeaveAndPitch
from hardware.description.channels import HEELING, POSITIONS, STEERING, WAVE_PROBE
from hardware.description.errors import ConfigurationError
from hardware.description.lines import Line, struts_over_turn
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Acquisition
from sim.drive.prescribed_drive import DriveSettings
from sim.model.heel import Heeling
from sim.model.steering import Steering

_INSTANTS: Final = 720  # of a turn


class _Rig(Protocol):
    """What of a :class:`sim.rig.SimulatedRig` is looked at."""

    @property
    def oscillator(self) -> Oscillator: ...
    @property
    def drive(self) -> DriveSettings: ...
    @property
    def acquisition(self) -> Acquisition: ...
    @property
    def flow_factor(self) -> float: ...
    @property
    def waves(self) -> object | None: ...
    @property
    def steering(self) -> Steering | None: ...
    @property
    def attitude(self) -> AttitudeSensors | None: ...
    @property
    def squat(self) -> object | None: ...
    @property
    def heel(self) -> object | None: ...
    @property
    def heel_loads(self) -> Mapping[str, float]: ...

    def heeling(self, set_point: SetPoint) -> Heeling | None: ...


def check_run(rig: _Rig, set_point: SetPoint) -> None:
    """Refuse a run that the rig has not the parts for.

    Raises
    ------
    ConfigurationError
        Naming all that is missing, or that does not go together.
    """
    checks = (_of_joint, _of_circle, _of_waves, _of_steering, _of_lines, _of_attitude, _of_heel)
    faults = [fault for check in checks for fault in check(rig, set_point)]
    if faults:
        raise ConfigurationError(f"the simulated rig lacks what a run needs: {'; '.join(faults)}")


def recorded(acquisition: Acquisition, channels: Collection[str]) -> list[str]:
    """Return the names of the recorded channels that are among some."""
    return [name for name in acquisition.names if name in channels]


def _of_joint(rig: _Rig, set_point: SetPoint) -> Iterator[str]:
    if rig.oscillator.joint is Joint.YAW_TABLE:
        yield (
            'joint = "yaw_table": a turntable is analysed but not simulated; simulate '
            '"slides_on_model" or "slides_on_rig", which have two struts'
        )
    if rig.oscillator.joint is not Joint.SLIDES_ON_RIG:
        return
    apart_m = set_point.eccentricity_m * _furthest_apart(set_point.every_line)
    sine = apart_m / (2.0 * rig.oscillator.half_spacing_m)
    if rig.oscillator.drift_by is DriftBy.STRUTS_OFFSET:
        sine += abs(math.sin(set_point.drift_rad))
    if sine >= 1.0:
        yield (
            f'joint = "slides_on_rig": the displacements would differ by {sine:.3g} of their '
            "spacing (limit 1, where the model stands across); lower eccentricity_m"
        )


@lru_cache(maxsize=64)
def _furthest_apart(lines: tuple[Line, ...]) -> float:
    """Return the largest difference of both struts over a turn, per eccentricity."""
    aft, fore = struts_over_turn(lines, least=_INSTANTS)
    return float(np.abs(fore - aft).max())


def _of_circle(rig: _Rig, set_point: SetPoint) -> Iterator[str]:
    if not set_point.turn_rate_rad_s:
        return
    if rig.oscillator.plane is Plane.VERTICAL:
        yield "a circle (turn_rate_rad_s) is for the horizontal oscillator"
    if rig.flow_factor != 1.0:
        yield "a circle is simulated in open water: leave the blockage of the tank out"


def _of_waves(rig: _Rig, set_point: SetPoint) -> Iterator[str]:
    if rig.waves is None:
        if set_point.wave_frequency_hz:
            yield "waves, but [waves] is missing"
        for name in recorded(rig.acquisition, (WAVE_PROBE.name,)):
            yield f"acquisition.{name}, but [waves] is missing"
    elif _is_driven(rig):
        yield "[waves] needs a drive without motor and gear"


def _of_steering(rig: _Rig, set_point: SetPoint) -> Iterator[str]:
    steering = rig.steering
    if set_point.rudder_angle_rad and (steering is None or steering.rudder is None):
        yield "a rudder angle, but [steering.rudder] is missing"
    if set_point.revolutions_hz and (steering is None or steering.propeller is None):
        yield "revolutions, but [steering.propeller] is missing"
    if steering is not None:
        yield from _of_shaft_and_plane(rig, "steering")
    written = {signal.name for signal in (steering.writes if steering is not None else ())}
    for name in recorded(rig.acquisition, {signal.name for signal in STEERING} - written):
        yield f"acquisition.{name}, but nothing in [steering] has it"


def _of_shaft_and_plane(rig: _Rig, table: str) -> Iterator[str]:
    if rig.oscillator.plane is Plane.VERTICAL:
        yield f"[{table}] is for the horizontal oscillator"
    if _is_driven(rig):
        yield f"[{table}] needs a drive without motor and gear"


def _is_driven(rig: _Rig) -> bool:
    return rig.drive.motor is not None or rig.drive.gear is not None


def _of_lines(rig: _Rig, set_point: SetPoint) -> Iterator[str]:
    if set_point.steady_ahead:
        yield (
            "steady_ahead: a carriage that is led is simulated behind its driver only; make the "
            "run with pmm run, on a rig of simulated devices"
        )
    if set_point.lines and _is_driven(rig):
        yield (
            "lines are followed by struts with drives of their own: leave motor and gear of "
            "the shaft out of [drive]"
        )


def _of_attitude(rig: _Rig, _: SetPoint) -> Iterator[str]:
    positions = recorded(rig.acquisition, POSITIONS)
    if rig.attitude is None and positions:
        names = " and ".join(f"acquisition.{name}" for name in positions)
        yield f"{names}, but no [attitude] says where the sensors stand"
    free = rig.attitude is not None and rig.attitude.heave_and_pitch is HeaveAndPitch.FREE
    if rig.squat is not None and not free:
        yield '[squat], but no [attitude] with heave_and_pitch = "free"'


def _of_heel(rig: _Rig, set_point: SetPoint) -> Iterator[str]:
    if rig.heel is None:
        for name in recorded(rig.acquisition, {signal.name for signal in HEELING}):
            yield f"acquisition.{name}, but [heel] is missing"
        if set_point.heel_rad or set_point.release_rad:
            yield "a heel angle, but [heel] is missing"
        if rig.heel_loads:
            yield "[heel_loads], but [heel] is missing"
        return
    yield from _of_shaft_and_plane(rig, "heel")
    heeling = rig.heeling(set_point)
    if heeling is not None and heeling.free and not heeling.righting[0] > 0.0:
        below = "gm_m above 0" if heeling.in_water else "a centre of gravity below its axis"
        yield f"a model that is free to roll, and nothing rights it: it takes {below}"
