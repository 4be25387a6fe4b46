"""Model and water: from the motion of the struts to the forces that the struts have to exert."""

from dataclasses import dataclass
from typing import ClassVar, TypeAlias

from hardware.description.body import Body
from hardware.description.oscillator import Plane
from hardware.description.struts import to_motion
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim import signals
from sim.signals import FloatArray, Signal, Signals
from sim.stage import UNKNOWN_KEYS_REFUSED, Block

# Rows are force and moment, columns translation and rotation about the midpoint of the struts.
Matrix: TypeAlias = tuple[tuple[float, float], tuple[float, float]]
Pair: TypeAlias = tuple[FloatArray, FloatArray]

_NONE: Matrix = ((0.0, 0.0), (0.0, 0.0))


@dataclass(frozen=True)
class HullCoefficients:
    """Linear reaction of the water, constant over frequency.

    Each matrix has the rows force (N) and moment (N m) and the columns translation and rotation, in
    SI units, about the midpoint: heave and pitch (bow up), or sway and yaw (bow to starboard).
    Positive values are those of a force that the struts have to exert.

    Attributes
    ----------
    added_mass
        Per acceleration of the model through the water: kg and kg m; kg m and kg m^2.
    damping
        Per velocity of the model through the water, the translation being that of the angle of
        attack (see :class:`Hull`): N s/m and N s; N s and N m s.
    restoring
        Per displacement: the change of buoyancy, without the model's weight: N/m and N; N and N m.
    """

    added_mass: Matrix = _NONE
    damping: Matrix = _NONE
    restoring: Matrix = _NONE

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Hull:
    """A rigid model in water, or in air where the water has no coefficients.

    With the motion q = (translation, rotation) of the midpoint and carriage speed U, the velocity
    of the model through the water is v = q' + U (s rotation, 0), where s = +1 in the vertical plane
    (w = z' + U pitch) and s = -1 in the horizontal plane (v = y' - U yaw). The struts exert

        (force, moment) = M q'' + A v' + B v + (C + G) q

    with the model's mass matrix M and its weight G (pitch only: m g z_G). Loads at rest, weight
    less buoyancy at zero displacement, are left out: dynamometers are tared with the model in
    place. U is taken as steady within v'.
    """

    plane: Plane
    half_spacing_m: float
    body: Body
    water: HullCoefficients = HullCoefficients()

    name: ClassVar[str] = "hull"
    reads: ClassVar[tuple[Signal, ...]] = (
        signals.DISPLACEMENT_AFT,
        signals.DISPLACEMENT_FORE,
        signals.VELOCITY_AFT,
        signals.VELOCITY_FORE,
        signals.ACCELERATION_AFT,
        signals.ACCELERATION_FORE,
        signals.CARRIAGE_SPEED,
    )
    writes: ClassVar[tuple[Signal, ...]] = (signals.FORCE_AFT, signals.FORCE_FORE)

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: constant coefficients leave no memory in the water."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:  # noqa: ARG002
        """Return the force of each strut on the model over the block."""
        aft_fore = [inputs[signal.name] for signal in self.reads[:6]]
        position, velocity, acceleration = (
            to_motion(aft_fore[i], aft_fore[i + 1], self.half_spacing_m, self.plane)
            for i in (0, 2, 4)
        )
        drift = inputs[signals.CARRIAGE_SPEED.name] * (1 if self.plane is Plane.VERTICAL else -1)
        through_water = (velocity[0] + drift * position[1], velocity[1])
        water_acceleration = (acceleration[0] + drift * velocity[1], acceleration[1])
        force, moment = _sum(
            _times(mass_matrix(self.body, self.plane), acceleration),
            _times(weight_matrix(self.body, self.plane), position),
            _times(self.water.added_mass, water_acceleration),
            _times(self.water.damping, through_water),
            _times(self.water.restoring, position),
        )
        aft, fore = strut_forces(force, moment, self.half_spacing_m, self.plane)
        return state, {signals.FORCE_AFT.name: aft, signals.FORCE_FORE.name: fore}


def mass_matrix(body: Body, plane: Plane) -> Matrix:
    """Return the model's mass matrix about the midpoint, in kg, kg m and kg m^2.

    A centre of gravity ahead of the midpoint moves up with the bow and to starboard with it, so the
    coupling is -m x_G for heave and pitch and +m x_G for sway and yaw.
    """
    coupling = body.mass_kg * body.cg_x_m * (-1.0 if plane is Plane.VERTICAL else 1.0)
    return ((body.mass_kg, coupling), (coupling, body.inertia_kg_m2))


def weight_matrix(body: Body, plane: Plane) -> Matrix:
    """Return the stiffness that the model's weight gives: m g z_G against pitch, else nothing."""
    if plane is Plane.HORIZONTAL:
        return _NONE
    return ((0.0, 0.0), (0.0, body.mass_kg * STANDARD_GRAVITY_M_S2 * body.cg_z_m))


def strut_forces(
    force: FloatArray, moment: FloatArray, half_spacing_m: float, plane: Plane
) -> tuple[FloatArray, FloatArray]:
    """Turn force and moment on the model into the force of each strut, ``(aft, fore)``.

    The force is the sum of both; the moment about the midpoint is (aft - fore) l for pitch, bow up,
    and (fore - aft) l for yaw, bow to starboard.
    """
    couple = moment / half_spacing_m
    if plane is Plane.HORIZONTAL:
        couple = -couple
    return (force + couple) / 2.0, (force - couple) / 2.0


def _times(matrix: Matrix, vector: Pair) -> Pair:
    first, second = matrix
    return (
        first[0] * vector[0] + first[1] * vector[1],
        second[0] * vector[0] + second[1] * vector[1],
    )


def _sum(*terms: Pair) -> Pair:
    force, moment = terms[0]
    for more in terms[1:]:
        force, moment = force + more[0], moment + more[1]
    return force, moment
