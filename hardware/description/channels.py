"""What a run's channels are called and what they measure."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from hardware.description.arrangement import Joint


class Quantity(StrEnum):
    """What a channel measures; decides which plots and checks apply to it."""

    FORCE = "force"
    MOMENT = "moment"
    DISPLACEMENT = "displacement"
    ANGLE = "angle"
    SPEED = "speed"
    VOLTAGE = "voltage"
    OTHER = "other"


_BY_SI_UNIT = {
    "N": Quantity.FORCE,
    "N m": Quantity.MOMENT,
    "m": Quantity.DISPLACEMENT,
    "rad": Quantity.ANGLE,
    "m/s": Quantity.SPEED,
    "V": Quantity.VOLTAGE,
}


@dataclass(frozen=True)
class Channel:
    """One sampled signal of a run.

    Attributes
    ----------
    name
        Unique within the run. The standard names below are used where the channel is one of them.
    unit
        SI unit of the stored values; ``"1"`` for none, ``""`` where nobody stated one.
    full_scale
        Largest magnitude that the instrument can deliver, in ``unit``; ``None`` if unknown. Samples
        at or above it are saturated.
    """

    name: str
    unit: str = ""
    full_scale: float | None = None

    @property
    def quantity(self) -> Quantity:
        """What the channel measures, told from its unit."""
        return _BY_SI_UNIT.get(self.unit, Quantity.OTHER)


# The standard names. Strut displacements are positive down (vertical oscillator) or to starboard
# (horizontal); strut forces are those of the strut on the model, positive along the displacement.
SHAFT_ANGLE = Channel("shaft_angle", "rad")
DISPLACEMENT_AFT = Channel("displacement_aft", "m")
DISPLACEMENT_FORE = Channel("displacement_fore", "m")
# Where the drives were told to have the struts, as they gave it to be recorded.
COMMAND_AFT = Channel("command_aft", "m")
COMMAND_FORE = Channel("command_fore", "m")
FORCE_AFT = Channel("force_aft", "N")
FORCE_FORE = Channel("force_fore", "N")
FORCE_X = Channel("force_x", "N")
CARRIAGE_SPEED = Channel("carriage_speed", "m/s")
# Of a carriage or arm that drives a circle: how fast it turns, positive to starboard.
TURN_RATE = Channel("turn_rate", "rad/s")
# Elevation of the water at a probe on the carriage, positive up.
WAVE_PROBE = Channel("wave_probe", "m")
# Behind the model. A positive rudder angle turns the ship to starboard, and its normal force is
# then positive (to port); thrust is positive ahead, both are those of the propeller and the rudder
# on their gauges in the model.
RUDDER_ANGLE = Channel("rudder_angle", "rad")
REVOLUTIONS = Channel("revolutions", "Hz")
PROPELLER_THRUST = Channel("propeller_thrust", "N")
PROPELLER_TORQUE = Channel("propeller_torque", "N m")
RUDDER_NORMAL_FORCE = Channel("rudder_normal_force", "N")
# A model that heels, positive to starboard: the moment of the struts on it about its roll axis, and
# its angle.
ROLL_MOMENT = Channel("roll_moment", "N m")
HEEL_ANGLE = Channel("heel_angle", "rad")
# How far two points of the model stand below where they stood at rest, positive down.
POSITION_AFT = Channel("position_aft", "m")
POSITION_FORE = Channel("position_fore", "m")

# A turntable's sway, angle, force and moment stand in the places of the struts', aft first.
_STRUTS: Final = {
    channel.name: channel.unit
    for channel in (DISPLACEMENT_AFT, DISPLACEMENT_FORE, FORCE_AFT, FORCE_FORE, FORCE_X)
}
_TURNTABLE: Final = _STRUTS | {DISPLACEMENT_FORE.name: "rad", FORCE_FORE.name: "N m"}


def units_on(joint: Joint) -> Mapping[str, str]:
    """Return the SI unit of each displacement and gauge of a rig, by the channel's name."""
    return _TURNTABLE if joint is Joint.YAW_TABLE else _STRUTS


# Names of the struts' channels, aft first; and all that a rig records, in the order of a recording.
DISPLACEMENTS: Final = (DISPLACEMENT_AFT.name, DISPLACEMENT_FORE.name)
COMMANDS: Final = (COMMAND_AFT.name, COMMAND_FORE.name)
FORCES: Final = (FORCE_AFT.name, FORCE_FORE.name)
STEERING: Final = (
    RUDDER_ANGLE, REVOLUTIONS, PROPELLER_THRUST, PROPELLER_TORQUE, RUDDER_NORMAL_FORCE,
)  # fmt: skip
HEELING: Final = (ROLL_MOMENT, HEEL_ANGLE)
POSITIONS_OF_MODEL: Final = (POSITION_AFT, POSITION_FORE)
POSITIONS: Final = (POSITION_AFT.name, POSITION_FORE.name)
STANDARD: Final = (
    SHAFT_ANGLE, DISPLACEMENT_AFT, DISPLACEMENT_FORE, FORCE_AFT, FORCE_FORE, FORCE_X,
    CARRIAGE_SPEED, TURN_RATE, WAVE_PROBE, *STEERING, *POSITIONS_OF_MODEL, *HEELING, COMMAND_AFT,
    COMMAND_FORE,
)  # fmt: skip
