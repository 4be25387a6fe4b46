"""All harmonics of the struts, as they were read: corrections, then motion and loads of the model.

The corrections are those of :mod:`analysis.coefficients.corrections`, at every order at once, so
that the covariance between the orders is kept.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.body_axes import at_order, labels, of_struts
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.corrections import Response, calibration, response_factors
from analysis.coefficients.phasors import Phasors, interleaved, joined
from analysis.coefficients.strut_phasors import (
    CHANNELS_INDEPENDENT,
    MOTION_ASKED,
    STRUT_ASKED,
    asked_motion,
    reading_phasors,
)
from analysis.kinematics.body_frame import HEEL
from analysis.kinematics.body_frame import ROLL_MOMENT as ROLL
from analysis.kinematics.cycle import waves
from analysis.kinematics.geometry import Geometry
from analysis.recording import Recording
from analysis.resolver.analysis import Analysis
from analysis.resolver.harmonics import Harmonics, IntervalSource
from analysis.resolver.reference import ReferenceSource
from analysis.response.following import recorded_age
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import (
    CARRIAGE_SPEED,
    DISPLACEMENTS,
    FORCE_X,
    FORCES,
    HEEL_ANGLE,
    ROLL_MOMENT,
)
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from hardware.description.heel import Heel, HeelGauges, RollConstraint
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import SetPoint


@dataclass(frozen=True, eq=False)
class StrutCycle:
    """All harmonics of the struts of one run as read; phasors as in :class:`BodyCycle`.

    Attributes
    ----------
    carriage
        Harmonics of the carriage's speed by order, where it follows the struts' path.
    """

    name: str
    oscillator: Oscillator
    set_point: SetPoint
    frequency_hz: float
    phasors: Phasors
    orders: int
    mean_known: bool = False
    flags: tuple[Flag, ...] = ()
    heel: Heel | None = None
    carriage: ComplexArray | None = None

    def calibrated(self, matrix: FloatArray) -> "StrutCycle":
        """Return it with ``force = matrix @ reading`` at every order, aft and fore.

        It raises what :func:`analysis.coefficients.corrections.calibration` raises.
        """
        return self._mapped(FORCES, lambda _: calibration(matrix))

    def without_response(self, responses: Mapping[str, Response]) -> "StrutCycle":
        """Return it with known responses taken out, each order's at its own frequency.

        It raises what :func:`analysis.coefficients.corrections.response_factors` raises.
        """
        names = tuple(responses)

        def factors(order: int) -> ComplexArray:
            by_channel = response_factors(self.name, self.frequency_hz, order, responses)
            return np.diag([by_channel[name] for name in names])

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
        matrices = np.eye(len(self.phasors.names), dtype=np.complex128)
        for n in range(self.orders + 1):
            places = [self.phasors.index(at_order(name, n)) for name in names]
            matrices[np.ix_(places, places)] = matrix(n)
        return replace(self, phasors=self.phasors.mapped(matrices))

    @property
    def geometry(self) -> Geometry:
        """Pivot, joint, gauges, drift, heel and speed of the rig in this run."""
        heeled = self.heel is not None and self.heel.gauges is HeelGauges.HEELED
        geometry = replace(Geometry.of(self.oscillator, self.set_point), gauges_heel=heeled)
        if self.carriage is None:
            return geometry
        (speed,) = waves(interleaved(self.carriage), 1)
        return replace(geometry, varies_m_s=speed - geometry.speed_m_s)

    def heeled(self, heel: Heel) -> "StrutCycle":
        """Return it with the heel of its model: as it was set, else as it was measured.

        A zero run is made at the heel of rest, so what was measured counts from there.

        Raises
        ------
        DataError
            If a model that is free to roll was not measured in heel.
        """
        measured = at_order(HEEL_ANGLE.name, 0) in self.phasors.names
        if heel.held is RollConstraint.FREE and not measured:
            raise DataError(
                f"{self.name}: no channel {HEEL_ANGLE.name}, and the model is free to roll: record "
                "its heel, or fix it and say so in [heel]"
            )
        names = labels((HEEL_ANGLE.name,), self.orders)
        rest = np.zeros(len(names), dtype=np.complex128)
        rest[0] = self.set_point.heel_rad
        heel_phasors = Phasors.of(names, ("rad",) * len(names), rest)
        kept_names = [name for name in self.phasors.names if name not in names]
        phasors = self.phasors.select(kept_names)
        if heel.held is RollConstraint.FREE:
            record = self.phasors.select(names)
            shifted = record.real.values + heel_phasors.real.values
            heel_phasors = replace(record, real=replace(record.real, values=shifted))
        return replace(self, phasors=joined(phasors, heel_phasors), heel=heel)

    def model(self) -> BodyCycle:
        """Return motion and loads of the model about the midpoint between the struts.

        It raises what :func:`analysis.kinematics.body_frame.in_body_axes` raises.
        """
        point, oscillator = self.set_point, self.oscillator
        geometry = self.geometry
        recorded = [n for n in (FORCE_X.name, *_ROLLING) if at_order(n, 0) in self.phasors.names]
        channels = recorded if self.heel is not None else [n for n in recorded if n not in _ROLLING]
        inputs = (*DISPLACEMENTS, *FORCES, *channels)
        roll = tuple(_ROLLING[name] for name in channels if name in _ROLLING)
        ordered = self.phasors.select(labels(inputs, self.orders))
        asked = any(flag.code == MOTION_ASKED.code for flag in self.flags)
        model = of_struts(ordered, geometry, self.frequency_hz, self.orders, asked=asked, roll=roll)
        return BodyCycle(
            self.name,
            oscillator.plane,
            oscillator.half_spacing_m,
            self.frequency_hz,
            point.carriage_speed_m_s,
            model.phasors,
            self.orders,
            point.medium,
            drift_rad=point.drift_rad,
            mean_known=self.mean_known,
            flags=self.flags,
            sensitivity=model.sensitivity,
            tare=model.tare,
            arrangement=oscillator.arrangement,
            readings=ordered.values.reshape(self.orders + 1, -1),
            heel=self.heel,
            heel_rad=point.heel_rad,
            lines=point.own_orders,
            turn_rate_rad_s=point.turn_rate_rad_s,
            varies_m_s=np.asarray(geometry.varies_m_s),
        )


_ROLLING = {ROLL_MOMENT.name: ROLL, HEEL_ANGLE.name: HEEL}


def measured_cycle(
    analysis: Analysis,
    oscillator: Oscillator,
    *,
    set_point: SetPoint | None = None,
) -> StrutCycle:
    """Return all harmonics of the first reading.

    A set-point stands in for displacements that were not measured. Of one strut that was measured
    alone, the other is taken in step with it.

    Of a carriage that follows the struts' path the speed is read likewise.

    Raises
    ------
    DataError
        If a force channel is missing, there is no set-point, or nothing tells the motion's phase.
    """
    reading = analysis.readings[0]
    set_point = analysis.recording.set_point if set_point is None else set_point
    if set_point is None:
        raise DataError(
            f"{reading.run}: no set-point; give frequency, eccentricity, strut phase and speed"
        )
    moved = tuple(name for name in DISPLACEMENTS if name in reading.channel_names)
    if not moved and analysis.reference.source is ReferenceSource.SET_POINT:
        raise DataError(
            f"{reading.run}: no displacement, no photocell, no encoder: nothing tells where in the "
            "motion the forces are; name those columns in [columns], or in [reference] a channel "
            "that goes with the motion (with frequency_hz there, it is at 0 at the first sample)"
        )
    channels = (*moved, *FORCES)
    channels += tuple(n for n in (FORCE_X.name, *_ROLLING) if n in reading.channel_names)
    count = reading.order
    phasors = reading_phasors(reading, channels, count)
    tapered = reading.interval_source is IntervalSource.BINS
    flags = (*reading.flags, CHANNELS_INDEPENDENT) if tapered else reading.flags
    if len(moved) < len(DISPLACEMENTS):
        phasors = joined(asked_motion(oscillator, set_point, phasors, count), phasors)
        flags = (*flags, STRUT_ASKED if moved else MOTION_ASKED)
    return StrutCycle(
        reading.run,
        oscillator,
        set_point,
        reading.frequency_hz,
        phasors,
        count,
        flags=flags,
        carriage=_carriage(analysis.recording, reading, oscillator, set_point),
    )


def _carriage(
    recording: Recording, reading: Harmonics, oscillator: Oscillator, set_point: SetPoint
) -> ComplexArray | None:
    """Return harmonics of a carriage's speed that follows a path: measured, else as it was told.

    What was measured is brought forward by its age.
    """
    led = CarriagePath.of(oscillator, set_point)
    if led is None or CARRIAGE_SPEED.name not in reading.channel_names:
        return None if led is None else led.harmonics(reading.order)
    measured = reading_phasors(reading, (CARRIAGE_SPEED.name,), reading.order).values
    age_s, _ = recorded_age(recording.between(reading.opened_s, reading.closed_s))
    order = np.arange(len(measured))
    turned: ComplexArray = measured * np.exp(2j * np.pi * reading.frequency_hz * age_s * order)
    return turned


def static_cycle(
    name: str,
    reading: Phasors,
    oscillator: Oscillator,
    set_point: SetPoint,
) -> StrutCycle:
    """Return a run that does not oscillate: its means, displacements at rest taken as none.

    Parameters
    ----------
    reading
        Of the forces at speed (:func:`analysis.coefficients.corrections.zero_reading` reads any
        record that stands still); until a zero run is taken off, they are not known to be loads.
    """
    still = Phasors.of(
        tuple(at_order(channel, 0) for channel in DISPLACEMENTS), ("m", "m"), np.zeros(2, complex)
    )
    names = tuple(at_order(name, 0) for name in reading.names)
    forces = replace(reading, names=names)
    return StrutCycle(name, oscillator, set_point, 0.0, joined(still, forces), 0)
