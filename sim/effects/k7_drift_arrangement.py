"""K7: a drift (trim) angle is set in another way than is stated."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.arrangement import DriftBy, Gauges, Joint, Pivot
from hardware.description.arrays import ComplexArray
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import STRUT_FORCES, Situation
from sim.mechanism.geometry import AT_REST
from sim.model.numbers import turns_with
from sim.rig import SimulatedRig

_SLIDE, _HELD, _ALONG = range(3)
_CHOICE: Final = "the first or the second of them"


@dataclass(frozen=True)
class DriftArrangement(Effect):
    """The oscillator, the struts' mean positions or the model is turned, against what is said.

    With the drift b a model that sways by h at right angles to the struts' line, and not to its own
    heading, moves ahead by b h too: its inertia and its resistance to that show in ``force_x``.
    Gauges that do not turn with the model read b of its other force besides their own. Grows with
    the drift and the amplitude, and with their product in the mean; nothing without a drift.
    """

    code = "K7"
    name = "drift-arrangement"
    title = "The drift angle is set in another way than is stated"
    stage = StageName.MECHANISM

    way: float = parameter(
        1.0,
        1.0,
        2.0,
        "1",
        "which of the two other ways, rounded: rig turned, struts offset, model turned, in this "
        "order without the one that is stated",
        starts=(1.0, 2.0),
        held=True,
        one_sign=_CHOICE,
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with its drift set in the other way."""
        return replace(rig, oscillator=replace(rig.oscillator, drift_by=self._real(rig)))

    def _real(self, rig: SimulatedRig) -> DriftBy:
        ways = [way for way in DriftBy if way is not rig.oscillator.drift_by]
        return ways[round(self.way) - 1]

    def signature(self, situation: Situation) -> Signature:
        """Return what is of first order in the drift and in the motion."""
        rig = situation.rig
        angle = turns_with(rig.oscillator.plane) * situation.set_point.drift_rad
        loads = _Loads(situation)
        change = angle * (loads.read(self._real(rig)) - loads.read(rig.oscillator.drift_by))
        fixed = loads.fixed
        names = (STRUT_FORCES[1 - fixed], STRUT_FORCES[fixed], signals.FORCE_X.name)
        parts = {
            (name, order): complex(change[order, k])
            for k, name in enumerate(names)
            for order in range(2)
        }
        return {key: value for key, value in parts.items() if value}


class _Loads:
    """What the struts exert without a drift: mean and phasor, of zeroth and first order in motion.

    The strut that slides carries S; both carry N across their line, and L along it, which stands at
    the angle s in the rig.
    """

    def __init__(self, situation: Situation) -> None:
        oscillator = situation.rig.oscillator
        self._situation, self._given = situation, oscillator
        self.fixed = 0 if oscillator.pivot is Pivot.AFT else 1
        aft, fore = situation.displacement()
        self._line = complex(fore - aft) / (2.0 * oscillator.half_spacing_m)
        self._moved = (complex(situation.displacement()[self.fixed]), complex(aft + fore) / 2.0)
        # As at rest, which gauges are tared of: the weight of a model that hangs.
        rest = situation.system.numbers[AT_REST, :2]
        self._rest = float(rest[1 - self.fixed]), float(rest.sum())
        self._resistance, self._slope = _resistance(situation)
        body = situation.rig.body
        vertical = oscillator.plane is Plane.VERTICAL
        self._inertia = -(situation.omega**2) * body.mass_kg
        self._lever = body.cg_z_m / oscillator.half_spacing_m if vertical else 0.0
        self._below = self._inertia * self._lever * oscillator.half_spacing_m
        self._first = self._phasors()

    def _phasors(self) -> tuple[complex, complex, complex]:
        """Return the phasors of S, N and L."""
        forces = self._situation.force()
        slide, held = complex(forces[1 - self.fixed]), complex(forces[self.fixed])
        if self._given.gauges is Gauges.RIG:
            held -= self._resistance * self._line
        return slide, slide + held, (self._rest[1] - self._below) * self._line

    def read(self, way: DriftBy) -> ComplexArray:
        """Return what the gauges read more per drift than with the whole oscillator turned.

        Mean and phasor by the sliding strut, the other, and along: shape ``(2, 3)``.
        """
        if way is DriftBy.RIG_TURNED:
            return np.zeros((2, 3), dtype=np.complex128)
        offset = way is DriftBy.STRUTS_OFFSET
        loads = self._offset() if offset else self._turned()
        loads[1] += self._ahead(self._moved[0 if offset else 1])
        return loads

    def _ahead(self, moved: complex) -> ComplexArray:
        """Return the phasors of a motion that goes ahead by its part along the heading.

        The inertia of a centre of gravity below the struts' attachments turns the model, too.
        """
        inertia = self._inertia * moved
        pair = (0.5 if self.fixed else -0.5) * self._lever * inertia
        along = inertia - 1j * self._situation.omega * self._slope * moved
        return np.array([pair, -pair, along])

    def _offset(self) -> ComplexArray:
        """Return the derivative by the angle of the struts' line, the loads on the model kept."""
        slide, over = self._rest
        line, along = self._line, self._resistance
        first_slide, first_over, first_along = self._first
        loads = np.zeros((2, 3), dtype=np.complex128)
        on_rig = self._given.joint is Joint.SLIDES_ON_RIG
        if self._given.gauges is Gauges.MODEL:
            if on_rig:
                loads[1, _ALONG] = -first_slide
            else:
                loads[1, :2] = -slide * line, slide * line
        elif on_rig:
            loads[0, _HELD] = along
            loads[1] = slide * line, first_along - (over + slide) * line, -first_over - along * line
        else:
            held = first_over - first_slide
            loads[0, _HELD] = along
            across = first_along + (2.0 * slide - over) * line
            loads[1] = -2.0 * slide * line, across, -held - along * line
        return loads

    def _turned(self) -> ComplexArray:
        """Return the derivative by the angle of the model on its struts: L less by N, N more by L.

        Both struts carry half of what N is more.
        """
        over, line, along = self._rest[1], self._line, self._resistance
        _, first_over, first_along = self._first
        loads = np.zeros((2, 3), dtype=np.complex128)
        loads[0, :2] = along / 2.0
        loads[1] = first_along / 2.0, first_along / 2.0, -first_over
        on_rig = self._given.joint is Joint.SLIDES_ON_RIG
        stays = self._given.gauges is Gauges.RIG
        if stays:
            loads[1, _HELD] -= over * line
        loads[1, _ALONG] -= (int(on_rig) + int(stays)) * along * line / 2.0
        return loads


def _resistance(situation: Situation) -> tuple[float, float]:
    """Return what the struts pull a straight model along with, and minus its slope by the speed."""
    surge, speed = situation.rig.surge, situation.flow_m_s
    if surge is None or not situation.in_water:
        return 0.0, 0.0
    x_u, x_uu = surge.x_u, surge.x_uu
    return -(x_u + x_uu * abs(speed)) * speed, x_u + 2.0 * x_uu * abs(speed)
