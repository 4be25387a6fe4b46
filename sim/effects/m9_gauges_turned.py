"""M9: the dynamometers turn with the rig, and not with the model as is stated; or the other way."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.arrangement import Gauges, Joint, Pivot
from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.effects.effect import Effect, Signature, StageName
from sim.effects.situation import STRUT_DISPLACEMENTS, STRUT_FORCES, Situation
from sim.rig import SimulatedRig

_OTHER = {Gauges.MODEL: Gauges.RIG, Gauges.RIG: Gauges.MODEL}
_READINGS = (*STRUT_FORCES, signals.FORCE_X.name)
_ORDERS = 4


@dataclass(frozen=True)
class GaugesTurned(Effect):
    """Dynamometers and ``force_x`` turn with the model, or stay with the rig, against what is said.

    At the strut that does not slide, the force along the model and the force across it mix by the
    angle s of the struts' line; the other strut reads 1 - s^2/2 of its force where an attachment
    slides along the model, 1 + s^2/2 where a strut slides along the rig. With a mean force along
    the model it grows with the amplitude, without one with the amplitude cubed; nothing where both
    struts move alike.
    """

    code = "M9"
    name = "gauges-turned"
    title = "The gauges turn with the rig for the model, or the model for the rig"
    stage = StageName.DYNAMOMETERS

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the gauges on the other one."""
        gauges = _OTHER[rig.oscillator.gauges]
        return replace(rig, oscillator=replace(rig.oscillator, gauges=gauges))

    def signature(self, situation: Situation) -> Signature:
        """Return the readings turned at each instant of a period, less as they were."""
        period, oscillator = situation.nominal.period, situation.rig.oscillator
        harmonics = [situation.nominal.spectra[name] for name in (*STRUT_DISPLACEMENTS, *_READINGS)]
        aft, fore, *read = period.values(np.stack(harmonics, axis=1)).T
        part = (fore - aft) / (2.0 * oscillator.half_spacing_m)
        on_rig = oscillator.joint is Joint.SLIDES_ON_RIG
        line = np.arcsin(part) if on_rig else np.arctan(part)
        readings = np.stack(read)
        changed = period.harmonics((_turned_readings(
            readings, line, oscillator.pivot, oscillator.gauges, on_rig) - readings).T)  # fmt: skip
        changes: dict[tuple[str, int], complex] = {}
        for k, name in enumerate(_READINGS):
            changes[name, 0] = complex(changed[0, k])
            for order in range(1, _ORDERS + 1):
                changes[name, order] = complex(-changed[order, k].imag, changed[order, k].real)
        return changes


def _turned_readings(
    readings: FloatArray, line: FloatArray, pivot: Pivot, gauges: Gauges, on_rig: bool
) -> FloatArray:
    """Return what gauges on the other body read, from aft, fore and along, ``(3, instants)``."""
    fixed = 0 if pivot is Pivot.AFT else 1
    turn = line if gauges is Gauges.MODEL else -line
    cosine, sine = np.cos(turn), np.sin(turn)
    turned = readings.copy()
    turned[fixed] = readings[fixed] * cosine + readings[2] * sine
    turned[2] = readings[2] * cosine - readings[fixed] * sine
    grows = on_rig is (gauges is Gauges.MODEL)
    turned[1 - fixed] = readings[1 - fixed] / cosine if grows else readings[1 - fixed] * cosine
    return turned
