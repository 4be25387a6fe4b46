"""A run as it would be read if the hull were as it is believed to be: the inverse of the analysis.

The struts' motion gives the model's, the terms the water's loads, inertia and weight what the
struts exert besides, and the geometry what the gauges read of it; a zero run is taken off.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle, zero_matrix
from analysis.coefficients.hull_cycle import loads_asked, stated_at_instants
from analysis.coefficients.identifiability import identifiable_motions
from analysis.coefficients.linear_fit import term_at
from analysis.coefficients.names import Form, place_of
from analysis.coefficients.phasors import Phasors, from_interleaved, interleaved
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.coefficients.tare import Tare
from analysis.coefficients.term_waves import waves_of
from analysis.coefficients.terms import Term, letter_of, term_of
from analysis.ideal_rig import strut_displacements
from analysis.kinematics.cycle import driven, harmonics
from analysis.kinematics.geometry import Geometry, Waves
from analysis.kinematics.motion import MotionWaves, motion
from analysis.kinematics.projection import readings
from analysis.uncertainty.values import Contribution
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import SetPoint

ORDERS = 3  # of a cycle: those that terms are fitted to
_LOADS = 3
CHANNELS = (*DISPLACEMENTS, *FORCES)


@dataclass(frozen=True, eq=False)
class Belief:
    """What is believed before the test.

    Attributes
    ----------
    values
        Coefficients by name, SI units; all of one form.
    body
        The model with all that moves below the dynamometers, about the midpoint.
    restoring
        Hydrostatic, about the midpoint, shape ``(2, 2)``.
    """

    oscillator: Oscillator
    body: Body
    values: Mapping[str, float]
    form: Form = Form.MANOEUVRING
    restoring: FloatArray = field(default_factory=zero_matrix)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Of the values, in their order.

        Raises
        ------
        ConfigurationError
            If a name means none in this plane and form.
        """
        plane = self.oscillator.plane
        if self.form is Form.SEAKEEPING:
            return tuple(term_at(place_of(name, plane, self.form)) for name in self.values)
        return tuple(term_of(name, plane) for name in self.values)

    @cached_property
    def vector(self) -> FloatArray:
        """The values, shape ``(terms,)``."""
        return np.array(list(self.values.values()), dtype=np.float64)


def told_terms(belief: Belief, points: Iterable[SetPoint]) -> tuple[bool, ...]:
    """Tell of each term whether runs move in all that it goes with.

    Runs in sway alone tell what goes with v; it counts as theirs what their analysis takes for it
    (:func:`analysis.coefficients.identifiability.identifiable_motions`).
    """
    rates = [_velocities(belief, point) for point in dict.fromkeys(points)]
    moved = np.concatenate([np.zeros((1, 2), dtype=np.complex128), *rates])
    columns = (identifiable_motions(moved) if moved.any() else ()) or (0, 1)
    still = {"vr"[column] for column in (0, 1) if column not in columns}
    return tuple(not still & set(map(letter_of, term.factors)) for term in belief.terms)


def _velocities(belief: Belief, point: SetPoint) -> ComplexArray:
    """Return velocity across and, at the struts, of turning: steady, then at each line."""
    orders = np.array([line.order for line in point.every_line])
    struts = strut_displacements(belief.oscillator, point, int(orders.max()))[orders]
    rate = 2j * np.pi * point.frequency_hz * orders
    half_m = belief.oscillator.half_spacing_m
    turned = 0.5 * (struts[:, 1] - struts[:, 0]) / half_m
    ahead = point.carriage_speed_m_s if belief.form is Form.MANOEUVRING else 0.0
    across = 0.5 * rate * struts.sum(axis=1) - ahead * turned
    steady = [-ahead * math.sin(point.drift_rad), half_m * point.turn_rate_rad_s]
    return np.array([steady, *np.stack([across, half_m * rate * turned], axis=1)])


def believed_cycles(
    names: Sequence[str],
    points: Sequence[SetPoint],
    belief: Belief,
    scatter: Sequence[Contribution] | None = None,
) -> list[BodyCycle]:
    """Return the averaged cycles of runs, inertia and restoring named to be taken off.

    Parameters
    ----------
    scatter
        Of each run's struts' phasors, as :func:`analysis.coefficients.body_axes.labels` orders
        those of :data:`CHANNELS`; known exactly where there is none.

    Raises
    ------
    DataError
        If the struts cannot reach, or the loads across cannot be told without an X gauge.
    """
    read = _read(points, belief)
    return [
        _cycle(name, point, belief, values, () if scatter is None else (scatter[k],))
        for k, (name, point, values) in enumerate(zip(names, points, read, strict=True))
    ]


def _cycle(
    name: str,
    point: SetPoint,
    belief: Belief,
    read: ComplexArray,
    scatter: tuple[Contribution, ...],
) -> BodyCycle:
    units = ("m", "m", "N", "N") * (ORDERS + 1)
    phasors = Phasors.of(labels(CHANNELS, ORDERS), units, read.ravel(), scatter)
    struts = StrutCycle(
        name, belief.oscillator, point, point.frequency_hz, phasors, ORDERS, mean_known=True
    )
    return struts.model().without(belief.body, belief.restoring)


def _read(points: Sequence[SetPoint], belief: Belief) -> ComplexArray:
    """Displacements and gauge readings, aft and fore, shape ``(points, ORDERS + 1, 4)``."""
    oscillator = belief.oscillator
    speed, drift, frequency = np.array(
        [[point.carriage_speed_m_s, point.drift_rad, point.frequency_hz] for point in points]
    ).T[..., None]
    geometry = Geometry(
        oscillator.plane, oscillator.half_spacing_m, oscillator.arrangement, speed, drift
    )
    moved = np.stack([strut_displacements(oscillator, point, ORDERS) for point in points])
    moved[:, 0] = moved[:, 0].imag
    parts = interleaved(moved.reshape(len(points), -1))
    struts = driven(parts, 2.0 * math.pi * frequency[:, 0])
    moving = motion(geometry, struts)
    tare = Tare.of(geometry, struts, _LOADS)
    exerted = _required_loads(moving, points, belief, tare) - _of_water(moving, geometry, belief)
    gauges = readings(geometry, moving.line_rad, exerted)[:, : len(FORCES)]
    forces = from_interleaved(harmonics(gauges, ORDERS))
    return np.concatenate((moved, forces.reshape(*moved.shape[:2], len(FORCES))), axis=2)


def _required_loads(
    moving: MotionWaves, points: Sequence[SetPoint], belief: Belief, tare: Tare
) -> Waves:
    """What inertia, weight and restoring ask of the struts, ``(points, 3, instants)``."""
    plane = belief.oscillator.plane
    drift = np.array([[point.drift_rad] for point in points])
    rates = np.stack((moving.velocity, moving.rate), axis=-2)
    inputs = np.concatenate(
        (
            np.stack((moving.across_m, moving.rotation_rad - drift), axis=1),
            rates.reshape(len(points), -1, rates.shape[-1]),
            np.ones(rates.shape[-1])
            * [
                stated_at_instants(belief.body, point.drift_rad, plane, point.medium)
                for point in points
            ],
        ),
        axis=1,
    )
    loads = loads_asked(inputs, plane, tare, np.asarray(belief.restoring)[None])
    return np.asarray(loads[..., :_LOADS, :])


def _of_water(moving: MotionWaves, geometry: Geometry, belief: Belief) -> Waves:
    """The water's loads on the hull, ``(points, 3, instants)``."""
    u, v, r = np.moveaxis(moving.velocity, -2, 0)
    u_rate, v_rate, r_rate = np.moveaxis(moving.rate, -2, 0)
    if belief.form is Form.SEAKEEPING:
        # What the incidence adds to the velocity across, which this form leaves in a and b.
        carried = geometry.side * geometry.speed_m_s
        v = v + carried * moving.rotation_rad
        v, v_rate = v - v.mean(axis=-1, keepdims=True), v_rate + carried * r
    waves = waves_of(belief.terms, np.stack((u, v, r, u_rate, v_rate, r_rate), axis=-2))
    by_load = np.zeros((_LOADS, len(belief.terms)))
    by_load[[term.row for term in belief.terms], np.arange(len(belief.terms))] = belief.vector
    return np.asarray(-belief.form.sign * by_load @ waves)
