"""The signals between stages: one name and one unit each, said here and nowhere else.

A quantity that a rig can also record keeps its channel's name; what the acquisition makes of it is
called ``recorded_`` and that name. Axes and signs are those of :mod:`hardware.description`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from hardware.description import channels
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.dataset import EDGE_TIME

# Values by signal name: one array of shape ``(samples,)`` each, events of shape ``(events,)``.
Signals: TypeAlias = Mapping[str, FloatArray]


@dataclass(frozen=True)
class Signal:
    """One quantity that stages hand to each other.

    Attributes
    ----------
    sampled
        True for one value per sample of the block; False for events, of which a block may hold any
        number (the photocell's edges).
    """

    name: str
    unit: str
    sampled: bool = True


def of_channel(channel: Channel) -> Signal:
    """Return the true quantity that a channel measures, under the channel's own name and unit."""
    return Signal(channel.name, channel.unit)


def recorded(channel: Channel) -> Signal:
    """Return what the acquisition delivers for a channel."""
    return Signal(f"recorded_{channel.name}", channel.unit)


# Drive and carriage.
SHAFT_ANGLE = of_channel(channels.SHAFT_ANGLE)  # unwrapped
SHAFT_SPEED = Signal("shaft_speed", "rad/s")
SHAFT_ACCELERATION = Signal("shaft_acceleration", "rad/s2")
CARRIAGE_SPEED = of_channel(channels.CARRIAGE_SPEED)
CARRIAGE_ACCELERATION = Signal("carriage_acceleration", "m/s2")  # beside what ripples on its speed
TURN_RATE = of_channel(channels.TURN_RATE)

# Mechanism: motion of each strut.
DISPLACEMENT_AFT = of_channel(channels.DISPLACEMENT_AFT)
VELOCITY_AFT = Signal("velocity_aft", "m/s")
ACCELERATION_AFT = Signal("acceleration_aft", "m/s2")
DISPLACEMENT_FORE = of_channel(channels.DISPLACEMENT_FORE)
VELOCITY_FORE = Signal("velocity_fore", "m/s")
ACCELERATION_FORE = Signal("acceleration_fore", "m/s2")

# Where the struts would be if drive and linkage did as they are told.
COMMAND_AFT = of_channel(channels.COMMAND_AFT)
COMMAND_FORE = of_channel(channels.COMMAND_FORE)

# Of each strut, aft and fore: displacement, velocity, acceleration.
STRUT_MOTIONS = (
    (DISPLACEMENT_AFT, VELOCITY_AFT, ACCELERATION_AFT),
    (DISPLACEMENT_FORE, VELOCITY_FORE, ACCELERATION_FORE),
)

# How struts and carriage move the model: its own and the water's forces follow from nothing else.
MODEL_MOTION = (
    DISPLACEMENT_AFT,
    DISPLACEMENT_FORE,
    VELOCITY_AFT,
    VELOCITY_FORE,
    ACCELERATION_AFT,
    ACCELERATION_FORE,
    CARRIAGE_SPEED,
)

# Displacement of each strut per shaft angle: the lever at which its force loads the shaft.
LEVER_AFT = Signal("lever_aft", "m/rad")
LEVER_FORE = Signal("lever_fore", "m/rad")
LOAD_TORQUE = Signal("load_torque", "N m")  # of both struts and their guides, against the motion

# Model and water: force of each strut on the model, positive along the strut's displacement.
FORCE_AFT = of_channel(channels.FORCE_AFT)
FORCE_FORE = of_channel(channels.FORCE_FORE)

# Force of the strut on the model along it, positive ahead.
FORCE_X = of_channel(channels.FORCE_X)

# A probe on the carriage.
WAVE_PROBE = of_channel(channels.WAVE_PROBE)

# Behind the model: what propeller and rudder do to their own gauges.
RUDDER_ANGLE = of_channel(channels.RUDDER_ANGLE)
REVOLUTIONS = of_channel(channels.REVOLUTIONS)
PROPELLER_THRUST = of_channel(channels.PROPELLER_THRUST)
PROPELLER_TORQUE = of_channel(channels.PROPELLER_TORQUE)
RUDDER_NORMAL_FORCE = of_channel(channels.RUDDER_NORMAL_FORCE)

# The model's own sensors of position.
POSITION_AFT = of_channel(channels.POSITION_AFT)
POSITION_FORE = of_channel(channels.POSITION_FORE)

# A model that heels.
ROLL_MOMENT = of_channel(channels.ROLL_MOMENT)
HEEL_ANGLE = of_channel(channels.HEEL_ANGLE)

# Dynamometers: what the gauges make of those forces.
DYNAMOMETER_FORCE_AFT = Signal("dynamometer_force_aft", "N")
DYNAMOMETER_FORCE_FORE = Signal("dynamometer_force_fore", "N")

# Photocell.
PHOTOCELL_EDGE_TIME = Signal(EDGE_TIME, "s", sampled=False)
