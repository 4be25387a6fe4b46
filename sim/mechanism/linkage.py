"""The mechanism: from the shaft's rotation to the motion of the two struts."""

import math
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.lines import Line
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim import signals
from sim.mechanism.play import JointMotion, PlayState, follow_with_play
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block

# Of each strut; None before the first sample, and for a strut without play.
PlayStates: TypeAlias = tuple[PlayState | None, PlayState | None]

_LEVERS = (signals.LEVER_AFT, signals.LEVER_FORE)
_WRITES = tuple(
    (*motion, lever) for motion, lever in zip(signals.STRUT_MOTIONS, _LEVERS, strict=True)
)


@dataclass(frozen=True)
class Setting:
    """How the linkage of one strut differs from what was set.

    Attributes
    ----------
    gain
        Factor of the eccentricity: an axis that does not go as far as it is commanded.
    eccentricity_error_m
        Added to the eccentricity.
    phase_error_rad
        Added to the strut's crank angle.
    slot_tilt_rad
        Tilt of a yoke's slot: turns the motion by as much, and makes it 1/cos as large.
    rod_offset_m
        By how much a rod's guide misses the crank's centre: first-harmonic phase, third harmonic.
    half_play_m
        Clearance of the strut's last joint to either side of its middle; friction holds what is
        behind it, the displacement's sensor too, until the clearance is taken up.
    """

    eccentricity_error_m: float = 0.0
    phase_error_rad: float = 0.0
    slot_tilt_rad: float = 0.0
    rod_offset_m: float = 0.0
    half_play_m: float = 0.0
    gain: float = 1.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def eccentricity_m(self, set_m: float) -> float:
        """Return the eccentricity where this much was set."""
        return self.gain * set_m + self.eccentricity_error_m


@dataclass(frozen=True)
class Mechanism:
    """A scotch yoke, or a crank with a connecting rod, on each strut.

    The aft strut follows the shaft angle, the fore strut is ``strut_phase_rad`` ahead of it. A
    strut's displacement at its crank angle th is

        d = e sin(th)                                         scotch yoke
        d = e sin(th) + sqrt(L^2 - e^2 cos^2(th)) - L         crank with a rod of length L
        d = e sum a_k sin(n_k th + phase_k)                   struts that follow lines

    Velocity and acceleration follow by the chain rule from the shaft's speed and acceleration; no
    samples are differenced.

    Attributes
    ----------
    rod_length_m
        ``L``; ``None`` for a scotch yoke. Negative, with ``-sqrt`` for ``+sqrt``, for a rod that
        lies to the other side of the crank.
    aft, fore
        How each strut's linkage differs from what was set.
    lines
        Of position-controlled struts, whose master angle the shaft's is, each with its own strut
        phase; empty for yoke and crank.

    Raises
    ------
    ConfigurationError
        If the rod is not longer than the eccentricity and its guide's offset: the crank could not
        turn.
    """

    eccentricity_m: float
    strut_phase_rad: float = 0.0
    rod_length_m: float | None = None
    aft: Setting = Setting()
    fore: Setting = Setting()
    lines: tuple[Line, ...] = ()

    name = "mechanism"
    reads = (
        signals.SHAFT_ANGLE,
        signals.SHAFT_SPEED,
        signals.SHAFT_ACCELERATION,
    )
    writes = _WRITES[0] + _WRITES[1]

    def __post_init__(self) -> None:
        offset_m = max(abs(self.aft.rod_offset_m), abs(self.fore.rod_offset_m))
        rod_m = math.inf if self.rod_length_m is None else abs(self.rod_length_m)
        if rod_m <= self.eccentricity_m + offset_m:
            aside = f" and rod_offset_m = {offset_m:g}" if offset_m else ""
            raise ConfigurationError(
                f"rod_length_m = {self.rod_length_m:g} must exceed "
                f"eccentricity_m = {self.eccentricity_m:g}{aside}: the crank could not turn"
            )

    def start(self, sample_rate_hz: float, seed: int) -> PlayStates | None:
        """Return no state: the struts follow the shaft at once, or after the play of a joint."""
        return None

    def run(
        self, state: PlayStates | None, block: Block, inputs: Signals
    ) -> tuple[PlayStates | None, Signals]:
        """Return displacement, velocity and acceleration of both struts over the block."""
        angle = inputs[signals.SHAFT_ANGLE.name]
        speed = inputs[signals.SHAFT_SPEED.name]
        acceleration = inputs[signals.SHAFT_ACCELERATION.name]
        written: dict[str, FloatArray] = {}
        after = list(state or (None, None))
        for i, (strut, names) in enumerate(zip(self.struts, _WRITES, strict=True)):
            d, slope, curvature = self._strut(i, angle)
            motion = JointMotion(d, slope * speed, curvature * speed**2 + slope * acceleration)
            values: tuple[FloatArray, ...] = (*motion, slope)
            if strut[0].half_play_m and block.count:
                after[i], behind = follow_with_play(
                    after[i], motion, strut[0].half_play_m, 1.0 / block.sample_rate_hz
                )
                values = (*behind[:3], slope * behind.contact)
            written |= {name.name: v for name, v in zip(names, values, strict=True)}
        return None if after == [None, None] else (after[0], after[1]), written

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the harmonics of motion and levers over a period."""
        beyond = period.values(inputs[signals.SHAFT_ANGLE.name])
        angle = period.omega_rad_s * period.time_s + beyond
        written: dict[str, np.ndarray] = {}
        for i, (strut, names) in enumerate(zip(self.struts, _WRITES, strict=True)):
            d, slope, curvature = self._strut(i, angle)
            if strut[0].half_play_m:
                speed = period.values(inputs[signals.SHAFT_SPEED.name])
                gained = period.values(inputs[signals.SHAFT_ACCELERATION.name])
                in_front = (d, slope * speed, curvature * speed**2 + slope * gained)
                twice = JointMotion(*(np.tile(signal, 2) for signal in in_front))
                _, behind = follow_with_play(None, twice, strut[0].half_play_m, period.step_s)
                d, slope = behind.position[period.points :], slope * behind.contact[period.points :]
            motion, lever = period.harmonics(np.column_stack([d, slope])).T
            values = (motion, period.s * motion, period.s**2 * motion, lever)
            written |= {name.name: v for name, v in zip(names, values, strict=True)}
        return period, written

    @property
    def struts(self) -> tuple[tuple[Setting, float], tuple[Setting, float]]:
        """Each strut's setting, and the crank angle (rad) by which it is ahead: aft, fore."""
        return (self.aft, 0.0), (self.fore, self.strut_phase_rad)

    def _strut(self, number: int, angle: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what :meth:`displacement` does of the aft strut (0) or the fore one (1)."""
        setting, phase_rad = self.struts[number]
        if not self.lines:
            return self._linkage(setting, angle + phase_rad)
        motion = (np.zeros_like(angle), np.zeros_like(angle), np.zeros_like(angle))
        for line in self.lines:
            ahead = line.phase_rad + number * line.strut_phase_rad
            single = replace(self, eccentricity_m=self.eccentricity_m * line.share, lines=())
            line_setting = replace(
                setting, eccentricity_error_m=setting.eccentricity_error_m * line.share
            )
            for times, part in enumerate(single._linkage(line_setting, line.order * angle + ahead)):
                motion[times][...] += line.order**times * part
        return motion

    def _linkage(
        self, setting: Setting, angle: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what :meth:`displacement` does of a linkage that differs from what was set."""
        if setting == _AS_SET:
            return self.displacement(angle)
        eccentricity = setting.eccentricity_m(self.eccentricity_m)
        real = replace(
            self, eccentricity_m=eccentricity / math.cos(setting.slot_tilt_rad), aft=_AS_SET
        )
        turned = angle + (setting.phase_error_rad + setting.slot_tilt_rad)
        return real.displacement(turned, setting.rod_offset_m)

    def displacement(
        self, angle: FloatArray, rod_offset_m: float = 0.0
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return a strut's displacement and its first two derivatives by the crank angle.

        The results are displacement, slope, curvature: in m, m/rad and m/rad^2.

        Parameters
        ----------
        angle
            Crank angle of this strut in radians, any shape.
        rod_offset_m
            By how much a rod's guide misses the crank's centre.
        """
        e = self.eccentricity_m
        sine, cosine = np.sin(angle), np.cos(angle)
        yoke = (e * sine, e * cosine, -e * sine)
        if self.rod_length_m is None:
            return yoke
        beside = e * cosine + rod_offset_m
        rod = math.copysign(1.0, self.rod_length_m) * np.sqrt(self.rod_length_m**2 - beside**2)
        rod_slope = e * sine * beside / rod
        rod_curvature = (e * (cosine * beside - e * sine**2) - rod_slope**2) / rod
        middle = self.rod_length_m
        if rod_offset_m:
            middle = math.copysign(math.sqrt(middle**2 - rod_offset_m**2), middle)
        return (
            yoke[0] + (rod - middle),
            yoke[1] + rod_slope,
            yoke[2] + rod_curvature,
        )


_AS_SET = Setting()
