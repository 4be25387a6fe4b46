"""One rig for the tests against closed forms: heave and pitch in still water, no coupling."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tests.sealed.generator.effect import Effect
from tests.sealed.generator.features import harmonics, reference, resampled
from tests.sealed.generator.mechanism import SETTLING_PERIODS, happen, set_run
from tests.sealed.generator.parameters import FloatArray, P, neutral
from tests.sealed.generator.rig import CHANNELS, Noise, Rig, Run
from tests.sealed.generator.sensing import sense

MASS, ADDED, DAMPING, STIFFNESS = 70.0, 75.0, 190.0, 6900.0
RIG = Rig("vertical", 0.5, None, 400.0, (*CHANNELS, "photocell"), Noise(0.3, 0.1, 0.1, 0.01, 1e-5))
HEAVE = Run("heave", 0.8, 0.02, periods=6)
OMEGA, AMPLITUDE = 2.0 * np.pi * HEAVE.frequency_hz, HEAVE.eccentricity_m


def still() -> FloatArray:
    """Return the parameters of a rig without effects."""
    p = neutral()
    p[P.MASS], p[P.INERTIA] = MASS, 27.5
    p[P.ADDED_00], p[P.ADDED_11] = ADDED, 22.0
    p[P.DAMPING_00], p[P.DAMPING_11] = DAMPING, 55.0
    p[P.RESTORING_00], p[P.RESTORING_11] = STIFFNESS, 2400.0
    return p


def impedance(order: int, omega: float = OMEGA) -> complex:
    """Return Z_n of heave."""
    n = order * omega
    return complex(STIFFNESS - (MASS + ADDED) * n * n, DAMPING * n)


@dataclass(frozen=True)
class Phasors:
    """Mean and ``S_n + i C_n`` of every channel; ``force`` is the sum of both struts."""

    mean: Mapping[str, float]
    of: Mapping[str, FloatArray]

    def __sub__(self, other: "Phasors") -> "Phasors":
        return Phasors(
            {name: self.mean[name] - other.mean[name] for name in self.mean},
            {name: self.of[name] - other.of[name] for name in self.of},
        )


def phasors(
    p: FloatArray, run: Run = HEAVE, rig: Rig = RIG, settling: float = SETTLING_PERIODS
) -> Phasors:
    """Return the harmonics of a noise-free run, the photocell as the reference."""
    truth = happen(p, run, rig, settling=settling)
    record = sense(set_run(p, run), truth, run, rig, None)
    values = resampled(record, reference(record, run, rig.sensors), run.periods)
    values = np.vstack([values, values[3] + values[4]])
    mean, sine, cosine = harmonics(values, run.periods)
    names = (*CHANNELS, "force")
    return Phasors(
        {name: float(mean[i]) for i, name in enumerate(names)},
        {name: np.append(0.0, sine[i] + 1j * cosine[i]) for i, name in enumerate(names)},
    )


def change(effect: Effect, size: float, run: Run = HEAVE, **drawn: float) -> Phasors:
    """Return what an effect at a size changes; ``drawn`` names what a case would draw."""
    values = {P[name]: value for name, value in drawn.items()}
    for place, (low, high) in effect.draws.items():
        values.setdefault(place, 0.5 * (low + high))
    return phasors(effect.put(still(), size, values), run) - phasors(still(), run)


def scaled(run: Run, **changes: float) -> Run:
    """Return a run at another frequency or eccentricity."""
    return replace(run, **changes)  # type: ignore[arg-type]
