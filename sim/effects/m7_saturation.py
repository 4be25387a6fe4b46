"""M7: a dynamometer, or its amplifier, that stops at a largest force."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import HIGHEST, with_gauges
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.gauges.dynamometer import Dynamometer
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class Saturation(Effect):
    """The reading stays within ``-lower_n`` to ``upper_n``: flat tops beyond a threshold.

    Alike to both sides it leaves odd orders; to one side, a mean and even orders as well. An
    amplifier bends towards its limit before (Rapp), which then lies a little further out:
    :func:`sim.gauges.characteristic.limited`.
    """

    code = "M7"
    name = "saturation"
    title = "Saturation of the dynamometers"
    stage = StageName.DYNAMOMETERS

    upper_n: float = parameter(
        100.0,
        0.1,
        10000.0,
        "N",
        "largest positive reading",
        one_sign="a limit to either side has its own",
    )
    lower_n: float = parameter(
        100.0,
        0.1,
        10000.0,
        "N",
        "largest negative reading, its size",
        one_sign="a limit to either side has its own",
    )
    knee: float = parameter(
        0.0,
        0.0,
        0.3,
        "1",
        "how softly it bends towards the limits; 0 for not at all",
        one_sign="no amplifier bends away from its limit",
        forms=(0.1, 0.2),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these limits, or the narrower ones that the gauges have."""
        # As much is lost of a force that is 1.2 times the limit, to 1 % of it for each form.
        further = 1.0 + 5.2 * self.knee**2

        def limited(dynamometer: Dynamometer, _: int) -> Dynamometer:
            lowest = -np.inf if dynamometer.lowest_n is None else dynamometer.lowest_n
            highest = np.inf if dynamometer.highest_n is None else dynamometer.highest_n
            return replace(
                dynamometer,
                lowest_n=float(max(lowest, -self.lower_n * further)),
                highest_n=float(min(highest, self.upper_n * further)),
                limit_knee=max(dynamometer.limit_knee, self.knee),
            )

        return with_gauges(rig, limited)

    def signature(self, situation: Situation) -> Signature:
        """Return what is cut off a force with one harmonic, and a mean."""
        mean, force = situation.force(0).real, situation.force()
        size, phase = np.abs(force), np.angle(force)
        predicted: dict[tuple[str, int], complex] = {}
        for order in range(HIGHEST + 1):
            above = _excess(size, self.upper_n - mean, order)
            below = _excess(size, self.lower_n + mean, order)
            # cos(n t) about the crest (t = 0 where the phase is a quarter turn), and the trough.
            crest, trough = (
                1j * np.exp(1j * order * (phase - side * np.pi / 2.0)) if order else 1.0
                for side in (1.0, -1.0)
            )
            values = below * trough - above * crest
            predicted |= at_struts(values, order, RECORDED_FORCES)
        return predicted


def _excess(size: FloatArray, limit: FloatArray, order: int) -> FloatArray:
    """Return the cosine coefficient of what rises above a limit, of ``size cos(t)``."""
    half = np.arccos(np.clip(limit / size, -1.0, 1.0))

    def wave(k: int) -> FloatArray:
        integral: FloatArray = half if k == 0 else np.sin(k * half) / k
        return integral

    waves = wave(order - 1) + wave(order + 1) - 2.0 * np.cos(half) * wave(order)
    return size / np.pi * waves * (0.5 if order == 0 else 1.0)
