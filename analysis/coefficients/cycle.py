"""The averaged cycle of a run: all harmonics of motion and loads together, mean included.

Non-linear terms are had from several harmonics at once, and these scatter together: one covariance
holds all of them. Phasors are named ``translation 0``, ``translation 1`` ...; order 0 is real.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from analysis.coefficients.corrections import Response, calibration, response_factors
from analysis.coefficients.measured import (
    DISPLACEMENTS,
    FORCES,
    MOTION_ASKED,
    joint_of,
    reading_phasors,
)
from analysis.coefficients.phasors import ComplexArray, FloatArray, Phasors, Source, joined
from analysis.coefficients.run import LOADS, MOTIONS, Run, strut_matrix
from analysis.motion import strut_displacements
from analysis.resolver.analyse import Analysis
from hardware.description.body import Body
from hardware.description.channels import FORCE_X
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import Medium, SetPoint

CHANNELS = (*MOTIONS, *LOADS)
SURGE_FORCE = "surge_force"


def at_order(name: str, order: int) -> str:
    """Return what a phasor of a cycle is called."""
    return f"{name} {order}"


def _nothing() -> FloatArray:
    return np.zeros((2, 2))


@dataclass(frozen=True, eq=False)
class Cycle:
    """Motion and loads of the model about the midpoint, at the harmonics 0 to ``orders``.

    Attributes
    ----------
    frequency_hz
        Of the fundamental; 0 for a static run, which has order 0 alone.
    speed_m_s
        Of the carriage.
    phasors
        By order: ``translation`` (m), ``rotation`` (rad), ``force`` (N), ``moment`` (N m) and,
        where there is a gauge for it, ``surge_force`` (N, of the strut on the model, ahead).
    mean_known
        Whether zero runs were taken off, so that the means are loads of the water.
    body, restoring, point_ahead_m, drift_rad
        As in :class:`analysis.coefficients.run.Run`.
    """

    name: str
    plane: Plane
    half_spacing_m: float
    frequency_hz: float
    speed_m_s: float
    phasors: Phasors
    orders: int
    medium: Medium = Medium.WATER
    body: Body | None = None
    restoring: FloatArray = field(default_factory=_nothing)
    point_ahead_m: float = 0.0
    drift_rad: float = 0.0
    mean_known: bool = False
    flags: tuple[Flag, ...] = ()

    @property
    def has_surge(self) -> bool:
        """Whether the surge force was measured."""
        return at_order(SURGE_FORCE, 0) in self.phasors.names

    @property
    def names(self) -> tuple[str, ...]:
        """The phasors' names in the order that fits work in: by order, then by channel."""
        channels = (*CHANNELS, SURGE_FORCE) if self.has_surge else CHANNELS
        return tuple(at_order(name, n) for n in range(self.orders + 1) for name in channels)

    def run(self, order: int = 1) -> Run:
        """Return one harmonic as a run of its own."""
        if not 0 <= order <= self.orders:
            raise DataError(
                f"{self.name} has harmonics 0 to {self.orders}, not {order}; resolve more of them"
            )
        chosen = self.phasors.select([at_order(name, order) for name in CHANNELS])
        return Run(
            self.name,
            self.plane,
            self.half_spacing_m,
            self.frequency_hz,
            self.speed_m_s,
            self.medium,
            replace(chosen, names=CHANNELS),
            order,
            self.body,
            self.restoring,
            self.point_ahead_m,
            self.flags,
            self.drift_rad,
        )

    def without(self, body: Body | None = None, restoring: FloatArray | None = None) -> "Cycle":
        """Return the cycle with what is to be taken off; see :meth:`Run.without`."""
        run = self.run(min(1, self.orders)).without(body, restoring)
        return replace(self, body=run.body, restoring=run.restoring)

    def without_dry(self, dry: "Cycle") -> "Cycle":
        """Return the cycle less the harmonics of a run in still air with the same motion.

        Each harmonic is turned by its own multiple of the angle between the two; the means stay,
        because zero runs are what they are taken from.

        Raises
        ------
        ConfigurationError
            As :meth:`Run.without_dry`.
        """
        first = self.run(1)
        flags = first.without_dry(dry.run(1)).flags
        lever = np.array([1.0, self.half_spacing_m])
        own, other = first.motion.values * lever, dry.run(1).motion.values * lever
        ratio = np.vdot(other, own) / np.vdot(other, other)
        scale = np.zeros((len(self.phasors.names), len(dry.phasors.names)), dtype=np.complex128)
        for n in range(1, min(self.orders, dry.orders) + 1):
            for name in LOADS:
                place = self.phasors.names.index(at_order(name, n))
                turn = abs(ratio) * np.exp(1j * n * np.angle(ratio))
                scale[place, dry.phasors.index(at_order(name, n))] = turn
        taken = dry.phasors.mapped(scale, self.phasors.names, self.phasors.units)
        return replace(self, phasors=self.phasors.minus(taken), flags=flags)

    def about(self, ahead_m: float) -> "Cycle":
        """Return the cycle with its coefficients wanted about a point ahead of the midpoint."""
        return replace(self, point_ahead_m=ahead_m)


@dataclass(frozen=True, eq=False)
class StrutCycle:
    """All harmonics of the struts of one run, as they were read; phasors as in :class:`Cycle`."""

    name: str
    oscillator: Oscillator
    set_point: SetPoint
    frequency_hz: float
    phasors: Phasors
    orders: int
    mean_known: bool = False
    flags: tuple[Flag, ...] = ()

    def calibrated(self, matrix: FloatArray) -> "StrutCycle":
        """Return it with ``force = matrix @ reading`` at every order, aft and fore.

        Raises
        ------
        ConfigurationError
            As :func:`analysis.coefficients.corrections.calibrated`.
        """
        return self._mapped(FORCES, lambda _: calibration(matrix))

    def without_response(self, responses: Mapping[str, Response]) -> "StrutCycle":
        """Return it with known responses taken out, each order's at its own frequency.

        Raises
        ------
        DataError
            As :func:`analysis.coefficients.corrections.without_response`.
        """
        names = tuple(responses)

        def factors(order: int) -> ComplexArray:
            found = response_factors(self.name, self.frequency_hz, order, responses)
            return np.diag([found[name] for name in names])

        return self._mapped(names, factors)

    def without_zero(self, offsets: Phasors) -> "StrutCycle":
        """Return it with the offsets of the zero runs taken off its means."""
        place = np.zeros((len(self.phasors.names), len(offsets.names)))
        for k, name in enumerate(offsets.names):
            place[self.phasors.index(at_order(name, 0)), k] = 1.0
        taken = offsets.mapped(place, self.phasors.names, self.phasors.units)
        return replace(self, phasors=self.phasors.minus(taken), mean_known=True)

    def _mapped(
        self, names: tuple[str, ...], matrix: Callable[[int], ComplexArray | FloatArray]
    ) -> "StrutCycle":
        whole = np.eye(len(self.phasors.names), dtype=np.complex128)
        for n in range(self.orders + 1):
            places = [self.phasors.index(at_order(name, n)) for name in names]
            whole[np.ix_(places, places)] = matrix(n)
        return replace(self, phasors=self.phasors.mapped(whole))

    def model(self, *, drift_rad: float = 0.0) -> Cycle:
        """Return motion and loads of the model about the midpoint between the struts."""
        surge = at_order(FORCE_X.name, 0) in self.phasors.names
        single = strut_matrix(self.oscillator)
        inputs = (*DISPLACEMENTS, *FORCES, *((FORCE_X.name,) if surge else ()))
        outputs = (*CHANNELS, *((SURGE_FORCE,) if surge else ()))
        if surge:
            single = np.block([[single, np.zeros((4, 1))], [np.zeros((1, 4)), np.ones((1, 1))]])
        orders = range(self.orders + 1)
        ordered = self.phasors.select([at_order(name, n) for n in orders for name in inputs])
        units = ("m", "rad", "N", "N m", "N")[: len(outputs)] * len(orders)
        names = [at_order(name, n) for n in orders for name in outputs]
        return Cycle(
            self.name,
            self.oscillator.plane,
            self.oscillator.half_spacing_m,
            self.frequency_hz,
            self.set_point.carriage_speed_m_s,
            ordered.mapped(np.asarray(np.kron(np.eye(len(orders)), single)), names, units),
            self.orders,
            self.set_point.medium,
            drift_rad=drift_rad,
            mean_known=self.mean_known,
            flags=self.flags,
        )


def measured_cycle(
    analysis: Analysis,
    oscillator: Oscillator,
    *,
    reading_index: int = 0,
    set_point: SetPoint | None = None,
) -> StrutCycle:
    """Return all harmonics of one reading; a set-point stands in for displacements not measured.

    Raises
    ------
    DataError
        If a force channel is missing, or there is no set-point.
    """
    reading = analysis.readings[reading_index]
    set_point = analysis.recording.set_point if set_point is None else set_point
    if set_point is None:
        raise DataError(
            f"{reading.run}: no set-point; give frequency, eccentricity, strut phase and speed"
        )
    joint, flags = joint_of(analysis, reading_index)
    has_sensors = all(name in reading.channel_names for name in DISPLACEMENTS)
    channels = (*(DISPLACEMENTS if has_sensors else ()), *FORCES)
    channels += (FORCE_X.name,) if FORCE_X.name in reading.channel_names else ()
    count = reading.order
    single = [reading_phasors(reading, channels, n, joint) for n in range(count + 1)]
    if joint is None:
        phasors = _side_by_side(single, channels)
    else:
        rows = [reading.channel_names.index(name) for name in channels]
        phasors = _together(single, channels, reading.run, joint[0][rows][:, :, rows], joint[1])
    flags = (*reading.flags, *flags)
    if not has_sensors:
        phasors = joined(_asked_motion(oscillator, set_point, count), phasors)
        flags = (*flags, MOTION_ASKED)
    return StrutCycle(
        reading.run, oscillator, set_point, reading.frequency_hz, phasors, count, flags=flags
    )


def _labels(single: list[Phasors], channels: tuple[str, ...]) -> tuple[list[str], list[str]]:
    names = [at_order(name, n) for n in range(len(single)) for name in channels]
    return names, [unit for one in single for unit in one.units]


def _side_by_side(single: list[Phasors], channels: tuple[str, ...]) -> Phasors:
    """Orders that scatter independently of each other: a reading without its periods."""
    names, units = _labels(single, channels)
    size = 2 * len(channels)
    whole = np.zeros((len(single) * size, len(single) * size))
    for n, one in enumerate(single):
        whole[n * size : (n + 1) * size, n * size : (n + 1) * size] = one.covariance
    source = single[-1].sources[0]
    values = np.concatenate([one.values for one in single])
    return Phasors(tuple(names), tuple(units), values, (replace(source, covariance=whole),))


def _together(
    single: list[Phasors],
    channels: tuple[str, ...],
    run: str,
    covariance: FloatArray,
    freedom: FloatArray,
) -> Phasors:
    """All orders with their joint covariance, (channel, A0 S1 C1 S2 ...) twice."""
    names, units = _labels(single, channels)
    count, size = len(channels), covariance.shape[1]
    place = np.zeros((len(single), 2, size))
    place[0, 0, 0] = 1.0
    for n in range(1, len(single)):
        place[n, 0, 2 * n - 1] = place[n, 1, 2 * n] = 1.0
    spread = np.einsum("nai,cidj,mbj->ncamdb", place, covariance, place)
    spread = spread.reshape(2 * count * len(single), -1)
    source = Source(f"scatter of {run}", spread, float(freedom[1]))
    values = np.concatenate([one.values for one in single])
    return Phasors(tuple(names), tuple(units), values, (source,))


def _asked_motion(oscillator: Oscillator, set_point: SetPoint, orders: int) -> Phasors:
    values = strut_displacements(oscillator, set_point, max(orders, 1))[: orders + 1]
    values[0] = values[0].imag  # H[0] = i A0
    names = tuple(at_order(name, n) for n in range(orders + 1) for name in DISPLACEMENTS)
    return Phasors(names, ("m",) * len(names), values.ravel())
