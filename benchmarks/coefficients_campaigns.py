"""Campaigns with known truth: exact cycles from terms, their scatter, and what was stated wrong.

Two struts at ``-l`` and ``l`` drive the model, whose line ``a`` from aft to fore turns ahead into
across; the fore attachment slides along it. With ``c`` from the midpoint to a point of the model,
as a complex number ahead + i across in body axes, d the drift and ' the time derivative:

    u + i v = (U exp(-i d) + i y_aft') exp(-i a) + i l a'
    acceleration of the point = (u + i v)' + i a' (u + i v) + (i a'' - a'^2) c
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.coefficients.terms import term_of
from analysis.uncertainty.values import UncertainValues
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.channels import DISPLACEMENTS, FORCE_X, FORCES
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Plane
from hardware.description.setpoint import SetPoint
from hardware.description.units import STANDARD_GRAVITY_M_S2
from tests.analysis.coefficients.sources import of_draws

HALF_M = 0.5
BODY = Body(mass_kg=70.0, inertia_kg_m2=27.5, cg_x_m=-0.02, cg_z_m=0.02)
RESTORING = np.array([[6900.0, 345.0], [345.0, 2400.0]])
VERTICAL = {
    "Z_wdot": -75.0, "Z_w": -190.0, "Z_qdot": -3.0, "Z_q": -12.0,
    "M_wdot": -3.0, "M_w": -12.0, "M_qdot": -22.0, "M_q": -55.0,
}  # fmt: skip
HORIZONTAL = {
    "Y_vdot": -62.0, "Y_v": -120.0, "Y_rdot": -2.0, "Y_r": 15.0,
    "N_vdot": -2.0, "N_v": -40.0, "N_rdot": -18.0, "N_r": -35.0,
}  # fmt: skip
CUBIC = {
    "Y_vvv": -900.0, "Y_vvr": 250.0, "Y_vrr": -180.0, "Y_rrr": 20.0,
    "N_vvv": 90.0, "N_vvr": -260.0, "N_vrr": 70.0, "N_rrr": -40.0,
}  # fmt: skip
SURGE_TRUTH = {"X_0": -12.0, "X_vv": -60.0, "X_vr": 45.0, "X_rr": -8.0}

_SAMPLES = 512
_ANGLES = 2.0 * math.pi * np.arange(_SAMPLES) / _SAMPLES


@dataclass(frozen=True)
class Made:
    """How a cycle is made.

    Attributes
    ----------
    truth, surge
        Coefficients by name, of force and moment and of X; no X gauge where ``None``.
    orders
        Harmonics that are resolved. What is above them is missed in the motion: of the cubic terms
        at 14 degrees 2e-3 with three of them, 2e-7 with five.
    body, restoring
        What the model has in truth, and what is named to be taken off.
    """

    truth: Mapping[str, float]
    plane: Plane = Plane.HORIZONTAL
    drift_rad: float = 0.0
    orders: int = 5
    surge: Mapping[str, float] | None = None
    body: Body = BODY
    restoring: FloatArray | None = None

    @property
    def known(self) -> FloatArray:
        """The restoring, nothing where there is none."""
        return np.zeros((2, 2)) if self.restoring is None else self.restoring

    @property
    def side(self) -> float:
        """+1 where the rotation turns ahead into across (yaw), -1 for pitch, bow up."""
        return -1.0 if self.plane is Plane.VERTICAL else 1.0

    @property
    def below_m(self) -> float:
        """Centre of gravity across, towards positive: to the side it is in the middle."""
        return self.body.cg_z_m if self.plane is Plane.VERTICAL else 0.0


@dataclass(frozen=True)
class Scatter:
    """Of one period's harmonics, part by part: of each displacement and of each gauge."""

    periods: int = 8
    motion_m: float = 2e-5
    force_n: float = 0.2
    correlation: float = 0.5


SCATTER = Scatter()


def made_up(
    point: SetPoint,
    made: Made,
    name: str,
    generator: Generator | None = None,
    scatter: Scatter = SCATTER,
) -> BodyCycle:
    """Return a run with exact loads, worked out sample by sample from the terms.

    Parameters
    ----------
    generator
        Of the scatter; without one there is none.
    """
    struts = made_struts(point, made, name)
    return taken(struts if generator is None else scattered(struts, generator, scatter), made)


def taken(struts: StrutCycle, made: Made) -> BodyCycle:
    """Return the run in body axes, with :data:`BODY` and the restoring to be taken off."""
    return struts.model().without(BODY, made.known)


def made_struts(point: SetPoint, made: Made, name: str) -> StrutCycle:
    """Return what displacements and gauges read of a run, tared, with nothing uncertain."""
    turned = point.strut_phase_rad
    aft, fore = (point.eccentricity_m * np.sin(_ANGLES + phase) for phase in (0.0, turned))
    line = np.arctan2(fore - aft, 2.0 * HALF_M)
    read = _gauges(*_exerted(point, made, aft, line), line)
    rest = np.zeros(1)
    read -= _gauges(rest.astype(np.complex128), _hanging(made, rest), rest)
    channels = (*DISPLACEMENTS, *FORCES, FORCE_X.name)
    units = ("m", "m", "N", "N", "N")
    count = 4 if made.surge is None else 5
    phasors = Phasors.of(
        labels(channels[:count], made.orders),
        units[:count] * (made.orders + 1),
        _harmonics(np.stack((aft, fore, *read))[:count], made.orders),
    )
    return StrutCycle(
        name,
        VERTICAL_1963 if made.plane is Plane.VERTICAL else HORIZONTAL_1963,
        replace(point, drift_rad=made.drift_rad),
        point.frequency_hz,
        phasors,
        made.orders,
        mean_known=True,
    )


def _exerted(
    point: SetPoint, made: Made, aft: FloatArray, line: FloatArray
) -> tuple[ComplexArray, FloatArray]:
    """What the struts exert on the model: force, ahead + i across, and moment, ahead to across."""
    omega, drift = 2.0 * math.pi * point.frequency_hz, made.side * made.drift_rad
    turning = _rate(line, omega).real
    carried = point.carriage_speed_m_s * np.exp(-1j * drift) + 1j * _rate(aft, omega).real
    through = carried * np.exp(-1j * line) + 1j * HALF_M * turning
    change, bending = _rate(through, omega), _rate(turning, omega).real
    body, centre = made.body, made.body.cg_x_m + 1j * made.below_m
    force = change + 1j * turning * through + (1j * bending - turning**2) * centre
    force = body.mass_kg * force
    own = body.inertia_kg_m2 - body.mass_kg * abs(centre) ** 2
    moment = own * bending + (centre.conjugate() * force).imag + _hanging(made, line)
    place = np.exp(1j * drift) * (HALF_M * (np.exp(1j * line) - 1.0) + 1j * aft)
    held = made.known @ np.stack((place.imag, made.side * line))
    moves = {
        "u": through.real,
        "v": through.imag,
        "r": made.side * turning,
        "vdot": change.imag,
        "rdot": made.side * bending,
    }
    water = -np.stack((held[0], held[1], 0.0 * line))
    for key, value in {**made.truth, **(made.surge or {})}.items():
        term = term_of(key, made.plane)
        water[term.row] += value * _product(term.factors, moves)
    return force - water[2] - 1j * water[0], moment - made.side * water[1]


def _hanging(made: Made, line: FloatArray) -> FloatArray:
    """Moment, ahead to across, of a model that the water bears: of its weight ``m g z_G``."""
    drift = made.side * made.drift_rad
    return made.body.mass_kg * STANDARD_GRAVITY_M_S2 * made.below_m * np.sin(line + drift)


def _gauges(force: ComplexArray, moment: FloatArray, line: FloatArray) -> FloatArray:
    """Readings of gauges that turn with the model: aft, fore and X, ``(3, samples)``."""
    fore = (moment + force.imag * HALF_M) * np.cos(line) / (2.0 * HALF_M)
    return np.stack((force.imag - fore, fore, force.real))


def _product(factors: Sequence[str], moves: Mapping[str, FloatArray]) -> FloatArray:
    found = np.ones(_SAMPLES)
    for factor in factors:
        wave = moves[factor.strip("|")]
        found = found * (np.abs(wave) if "|" in factor else wave)
    return found


def _rate(wave: FloatArray | ComplexArray, omega: float) -> ComplexArray:
    """Return the time derivative of a wave that repeats."""
    order = np.fft.fftfreq(_SAMPLES, 1.0 / _SAMPLES)
    return np.asarray(np.fft.ifft(1j * omega * order * np.fft.fft(wave)))


def _harmonics(rows: FloatArray, orders: int) -> ComplexArray:
    """Return H of ``y = H[0] + sum of Im(H[n] exp(i n angle))``, order by order."""
    spectrum = np.fft.fft(rows).T[: orders + 1] / _SAMPLES
    return np.concatenate((spectrum[0].real, 2j * spectrum[1:].ravel()))


def scattered(struts: StrutCycle, generator: Generator, scatter: Scatter = SCATTER) -> StrutCycle:
    """Return the mean of noisy periods, all harmonics tied, with the scatter that they show."""
    phasors, tied = struts.phasors, scatter.correlation
    count = len(phasors.names)
    size = [scatter.motion_m if unit == "m" else scatter.force_n for unit in phasors.units]
    spread = np.repeat(size, 2)
    spread[1 : 2 * count // (struts.orders + 1) : 2] = 0.0  # a mean has no quadrature
    common = generator.standard_normal((scatter.periods, 1))
    own = generator.standard_normal((scatter.periods, 2 * count))
    draws = spread * (math.sqrt(tied) * common + math.sqrt(1.0 - tied) * own)
    source = of_draws(f"scatter of {struts.name}", draws)
    real = UncertainValues(phasors.real.values + draws.mean(axis=0), (source,))
    return replace(struts, phasors=replace(phasors, real=real))


def wrong(
    struts: StrutCycle, stated: StatedUncertainties, errors: Mapping[str, float]
) -> StrutCycle:
    """Return the run as a chain reads it that errs by so many stated standard uncertainties.

    Knows amplitude, lag and force gain; errors of the body belong to :class:`Made`.
    """
    lag = errors.get("lag_s", 0.0) * stated.lag_s
    gain = 1.0 + errors.get("force_gain_relative", 0.0) * stated.force_gain_relative
    longer = 1.0 + errors.get("amplitude_relative", 0.0) * stated.amplitude_relative
    late = -2j * math.pi * struts.frequency_hz * lag
    factors = [
        longer if name.startswith("displacement") else gain * np.exp(late * int(name.split()[1]))
        for name in struts.phasors.names
    ]
    return replace(struts, phasors=struts.phasors.mapped(np.diag(factors)))


def wrong_body(stated: StatedUncertainties, errors: Mapping[str, float]) -> Body:
    """Return the body as it is, where :data:`BODY` is what is taken off."""
    names = ("mass_kg", "cg_x_m", "cg_z_m", "inertia_kg_m2")
    return replace(
        BODY,
        **{n: getattr(BODY, n) + errors.get(n, 0.0) * getattr(stated, n) for n in names},
    )


def without_incidence(frequency_hz: float, speed_m_s: float) -> float:
    """Return the strut phase of pure yaw or pitch: ``tan(phi/2) = omega l / U``."""
    return 2.0 * math.atan2(2.0 * math.pi * frequency_hz * HALF_M, speed_m_s)


def pure_pair(frequency_hz: float, eccentricity_m: float, speed_m_s: float) -> list[SetPoint]:
    """Return translation alone, and rotation without incidence."""
    phases = (0.0, without_incidence(frequency_hz, speed_m_s))
    return [SetPoint(frequency_hz, eccentricity_m, phase, speed_m_s) for phase in phases]


def amplitudes(speed_m_s: float = 1.2, frequency_hz: float = 0.3) -> list[tuple[str, SetPoint]]:
    """Return sway and pure yaw at three amplitudes, and a run between both."""
    turn = without_incidence(frequency_hz, speed_m_s)
    sizes = (0.06, 0.12, 0.2)
    points = [(f"sway {e:g}", SetPoint(frequency_hz, e, 0.0, speed_m_s)) for e in sizes]
    points += [(f"yaw {e:g}", SetPoint(frequency_hz, e, turn, speed_m_s)) for e in sizes]
    return [*points, ("mixed", SetPoint(frequency_hz, 0.15, 1.8, speed_m_s))]
