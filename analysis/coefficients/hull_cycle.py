"""Hydrodynamic loads on the hull over a cycle: gross loads less those of inertia and weight.

Inertia is taken off exactly, in body axes, and so are weight, buoyancy and the restoring that is
stated; of these three a zero run took off what the gauges read at rest.
"""

import math
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.body_axes import labels
from analysis.coefficients.phasors import Phasors, real_form
from analysis.coefficients.stated_uncertainties import STATED
from analysis.coefficients.tare import Tare
from analysis.kinematics.body_frame import HEEL, LOADS, UNIT_OF
from analysis.kinematics.complex_step import by_parts, pointwise
from analysis.kinematics.cycle import harmonics, per_part
from analysis.kinematics.geometry import Waves
from analysis.kinematics.motion import MotionWaves
from analysis.kinematics.rigid_body import heel_terms, inertia_terms, weight_terms
from hardware.description.arrays import FloatArray
from hardware.description.body import Body
from hardware.description.heel import Heel, righting_moment
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium

INPUTS = ((0, 0), (1, 0), (2, 0), (2, 1), (3, 0), (3, 1), (1, 1), (1, 2))
TURNS = (1, 1)  # the rate of the rotation
_OF_BODY = ("mass_kg", "cg_x_m", "cg_z_m", "inertia_kg_m2")
_TAKEN = (*_OF_BODY, "restoring_relative", "alignment_rad", "heel_rad")


@dataclass(frozen=True, eq=False)
class HullCycle:
    """Motion of the wanted point through the water, and the water's loads about it on the hull.

    Attributes
    ----------
    phasors
        Of :data:`analysis.kinematics.body_frame.CHANNELS`, order by order.
    sensitivity
        Slope of their real numbers by each stated quantity, shape ``(2 n, len(STATED))``.
    """

    phasors: Phasors
    sensitivity: FloatArray


def on_hull(
    gross: Phasors,
    sensitivity: FloatArray,
    channels: tuple[str, ...],
    *,
    plane: Plane,
    medium: Medium,
    frequency_hz: float,
    speed_m_s: float,
    drift_rad: float,
    tare: Tare,
    body: Body | None,
    restoring: FloatArray,
    point_ahead_m: float,
    heel: Heel | None = None,
    heel_rad: float = 0.0,
    turn_rate_rad_s: float = 0.0,
) -> HullCycle:
    """Return motion through the water and the water's loads.

    Parameters
    ----------
    gross, sensitivity, channels
        Of :class:`analysis.coefficients.body_cycle.BodyCycle`.
    """
    count, inputs = len(gross.names) // len(channels), inputs_of(channels)
    omega = 2.0 * math.pi * frequency_hz
    maps = per_part(count, len(channels), inputs, omega)
    parts = gross.real.values
    moved = parts @ maps
    turns, turned = inputs.index(TURNS), moved.copy()
    turned[turns] += turn_rate_rad_s
    stated = stated_at_instants(body, drift_rad, plane, medium, heel, heel_rad)
    rows = [LOADS.index(name) for name in channels if name in LOADS]
    values, slope = pointwise(
        lambda waves: loads_asked(waves, plane, tare, restoring, HEEL in channels)[..., rows, :],
        np.concatenate((turned, stated * np.ones(moved.shape[-1]))),
    )
    orders = count - 1
    net = HullParts(count, channels)
    parts_slope = net.with_loads(by_parts(slope[:, : len(inputs)], maps, orders))
    stated_slope = _by_stated(
        slope, moved, inputs, net, len(parts), body is not None, turn_rate_rad_s
    )
    sensitivity = stated_slope + parts_slope @ sensitivity
    changes = net.parts(parts, harmonics(values, orders))
    shift, by_pace, by_speed = to_point(count, channels, point_ahead_m, plane, omega, speed_m_s)
    sensitivity = shift @ sensitivity
    sensitivity[:, STATED.index("frequency_relative")] += by_pace @ changes
    sensitivity[:, STATED.index("speed_m_s")] += by_speed @ changes
    changes = shift @ changes
    across, of_turn = 2 * channels.index("across"), by_turn(plane, point_ahead_m, turn_rate_rad_s)
    changes[across] += of_turn
    sensitivity[across, STATED.index("turn_rate_relative")] += of_turn
    sensitivity[across, STATED.index("midpoint_x_m")] -= by_turn(plane, 1.0, turn_rate_rad_s)
    return HullCycle(
        Phasors(
            labels(channels, orders),
            tuple(UNIT_OF[name] for name in channels) * count,
            gross.real.carried(changes, shift @ parts_slope),
        ),
        sensitivity,
    )


def _by_stated(
    slope: FloatArray,
    moved: FloatArray,
    inputs: tuple[tuple[int, int], ...],
    net: "HullParts",
    count: int,
    has_body: bool,
    turn_rate_rad_s: float,
) -> FloatArray:
    """Return the loads' own slopes by the stated quantities, beside those that the motion has.

    Shape ``(count, len(STATED))``.

    Parameters
    ----------
    slope, moved
        Of the loads at each instant by each input, and the motion's inputs there.
    """
    orders = net.orders
    stated_slope = np.zeros((count, len(STATED)))
    taken_slopes = slope[
        :, len(inputs) : len(inputs) + len(_TAKEN)
    ]  # what comes after is not uncertain
    for name, column in zip(_TAKEN, np.moveaxis(taken_slopes, 1, 0), strict=True):
        if has_body or name not in _OF_BODY:
            stated_slope[net.loads, STATED.index(name)] += harmonics(column, orders)
    stated_slope[:, STATED.index("density_relative")] += stated_slope[
        :, STATED.index("restoring_relative")
    ]
    times = np.array([often for _, often in inputs])
    faster = (slope[:, : len(inputs)] * (times[:, None] * moved)).sum(axis=1)
    stated_slope[net.loads, STATED.index("frequency_relative")] += harmonics(faster, orders)
    steadily = turn_rate_rad_s * harmonics(slope[:, inputs.index(TURNS)], orders)
    stated_slope[net.loads, STATED.index("turn_rate_relative")] += steadily
    return stated_slope


def inputs_of(channels: tuple[str, ...]) -> tuple[tuple[int, int], ...]:
    """Return :data:`INPUTS`, and heel with two derivatives where there is one."""
    if HEEL not in channels:
        return INPUTS
    return (*INPUTS, *((channels.index(HEEL), times) for times in range(3)))


def stated_at_instants(
    body: Body | None,
    drift_rad: float,
    plane: Plane,
    medium: Medium,
    heel: Heel | None = None,
    heel_rad: float = 0.0,
) -> FloatArray:
    """Return the values of :data:`_TAKEN`, and then what the struts bear, shape ``(k, 1)``.

    Of mass and m x_G a part, of m z_G a part, less displaced mass and its moments; of a model that
    heels I_xx, product and spread, and its righting moments.
    """
    body_values = (
        (0.0,) * 4 if body is None else (body.mass_kg, body.cg_x_m, body.cg_z_m, body.inertia_kg_m2)
    )
    borne: tuple[float, ...] = (0.0,) * 5
    if body is not None and plane is Plane.VERTICAL:
        in_air, floats = medium is Medium.AIR, body.displaced_kg is None
        lift = 0.0 if in_air or body.displaced_kg is None else body.displaced_kg
        levers = (lift, lift * body.buoyancy_x_m, lift * body.buoyancy_z_m)
        borne = (float(in_air or not floats), 1.0, *levers)
    rolled: tuple[float, ...] = (0.0,) * 5
    if body is not None and heel is not None:
        rolled = (*heel.moments(body), *heel.righting(body))
    return np.array([[*body_values, 1.0, drift_rad, heel_rad, *borne, *rolled]]).T


class HullParts:
    """Where the loads stand among the parts."""

    def __init__(self, count: int, channels: tuple[str, ...]) -> None:
        self.orders = count - 1
        place = np.arange(2 * count * len(channels)).reshape(count, len(channels), 2)
        load_places = [k for k, name in enumerate(channels) if name in LOADS]
        self.loads = place[:, load_places].ravel()
        self.is_load = np.zeros(place.size, dtype=bool)
        self.is_load[self.loads] = True

    def with_loads(self, asked_slope: FloatArray) -> FloatArray:
        """Return the slope of the hull's parts by the gross ones."""
        signs = np.diag(np.where(self.is_load, -1.0, 1.0))
        signs[self.loads] += asked_slope
        return signs

    def parts(self, gross: FloatArray, asked_loads: FloatArray) -> FloatArray:
        """Return the hull's parts, ``(..., 2 n)``, of the gross ones and of what is asked."""
        parts = np.where(self.is_load, -gross, gross)
        parts[..., self.loads] += asked_loads
        return parts


def loads_asked(
    waves: Waves, plane: Plane, tare: Tare, restoring: FloatArray, heels: bool = False
) -> Waves:
    """What inertia, weight and restoring ask of the struts: force, moment, surge force, in roll.

    Less what the latter two ask at rest, as the gauges read it there.
    """
    translation, rotation, u, u_rate, v, v_rate, r, r_rate = np.moveaxis(waves[..., :8, :], -2, 0)
    rolling, taken = waves[..., 8:11, :], np.moveaxis(waves[..., 8 + 3 * heels :, :], -2, 0)
    mass, ahead, below, turned, factor, drift, resting, weight, under, *rest = taken
    lift, rolled = rest[:3], rest[3:]
    state = MotionWaves(
        rotation,
        rotation,
        translation,
        np.stack((u, v, r), axis=-2),
        np.stack((u_rate, v_rate, r_rate), axis=-2),
    )
    moments = np.stack((mass, mass * ahead, mass * below, turned), axis=-2)
    loads = np.einsum("...kt,...krt->...rt", moments, inertia_terms(state, plane))
    parts = np.stack((weight, weight, under), axis=-2)
    hanging = parts * moments[..., :3, :] - np.stack(lift, axis=-2)

    def static(place: Waves, angle: Waves) -> Waves:
        held = np.einsum("...kt,...krt->...rt", hanging, weight_terms(angle))
        where = np.stack((place, angle), axis=-2)
        held[..., :2, :] += factor[..., None, :] * np.einsum("...rc,...ct->...rt", restoring, where)
        return np.asarray(held)

    still = np.broadcast_to(tare.place_m[..., None], translation.shape)
    tared = tare.missing_loads(static(still, drift))
    loads += static(translation, rotation + drift)
    loads[..., : tared.shape[-2], :] -= tared
    in_roll = np.zeros_like(loads[..., :1, :])
    loads = np.concatenate((loads, in_roll), axis=-2)
    if heels:
        by_heel = np.stack((mass * below, *rolled[:3]), axis=-2)
        loads += np.einsum("...kt,...krt->...rt", by_heel, heel_terms(state, rolling))
        of_gm, of_bm = rolled[3], rolled[4]
        loads[..., 3, :] += righting_moment(of_gm, of_bm, rolling[..., 0, :])
        loads[..., 3, :] -= righting_moment(of_gm, of_bm, resting)
    return np.asarray(loads)


def by_turn(plane: Plane, ahead_m: float, turn_rate_rad_s: float) -> float:
    """Return what a steady turn, no harmonic of the rotation, adds to a point's velocity across."""
    return (-1.0 if plane is Plane.VERTICAL else 1.0) * ahead_m * turn_rate_rad_s


def to_point(
    count: int,
    channels: tuple[str, ...],
    ahead_m: float,
    plane: Plane,
    omega: float,
    speed_m_s: float,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return what takes the parts to a point ahead, and its slopes by ln(omega) and the speed.

    The translation becomes that whose rate is the velocity through the water less the incidence,
    ``q' = v - U E q``: what the seakeeping form writes its loads with, at any angle.
    """
    side = -1.0 if plane is Plane.VERTICAL else 1.0
    arm, names = side * ahead_m, channels
    transfer = np.eye(count * len(names), dtype=np.complex128)
    by_pace, by_speed = np.zeros_like(transfer), np.zeros_like(transfer)
    for n in range(count):
        place = {name: n * len(names) + k for k, name in enumerate(names)}
        rate = 1j * n * omega
        way, across, turn = place["translation"], place["across"], place["rotation"]
        transfer[across, turn] = by_pace[across, turn] = rate * arm
        transfer[place["moment"], place["force"]] = -arm
        transfer[way, turn] = arm
        if n:
            transfer[way, way], transfer[way, across] = 0.0, 1.0 / rate
            by_speed[way, turn] = side / rate
            transfer[way, turn] += speed_m_s * by_speed[way, turn]
            by_pace[way, across] = -1.0 / rate
            by_pace[way, turn] = -speed_m_s * by_speed[way, turn]
    return real_form(transfer), real_form(by_pace), real_form(by_speed)
