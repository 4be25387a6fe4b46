"""The kinds of runs that a campaign is made of, and the motions by their names."""

from enum import StrEnum


class RunKind(StrEnum):
    """What a run is for."""

    OSCILLATION = "oscillation"
    ZERO = "zero"  # a record at rest, whose means are the readings without load
    DRY = "dry"  # an oscillation in air: inertia of everything that moves
    KNOWN_MASS = "known-mass"  # the same with a known mass added: gain, lag and sign in place
    CHECK_WEIGHT = "check-weight"  # one load step of a calibration, at rest
    PUSH = "push"  # a push by hand names channel and sign of a gauge
    PLUCK = "pluck"  # a ring-down: natural frequencies of the structure
    RESTORING = "restoring"  # a turn so slow that the force is that of the displacement
    STATIC_DRIFT = "static-drift"  # towed at an angle, the shaft at rest
    STRAIGHT_TOW = "straight-tow"  # towed straight, the shaft at rest
    CIRCLE = "circle"  # towed round a circle, the shaft at rest
    FREE_DECAY = "free-decay"  # let go from a heel, to roll by itself until it rests
    CONTROL = "control"  # a condition that is repeated through the campaign

    @property
    def oscillates(self) -> bool:
        """Whether the shaft turns."""
        return self in _TURNING

    @property
    def in_air(self) -> bool:
        """Whether the model hangs in air."""
        return self in (RunKind.DRY, RunKind.KNOWN_MASS)

    @property
    def towed(self) -> bool:
        """Whether the run needs forward speed."""
        return self in (RunKind.STATIC_DRIFT, RunKind.STRAIGHT_TOW, RunKind.CIRCLE)

    @property
    def wants_zeros(self) -> bool:
        """Whether its mean force is used, so that the gauges' zero has to be known."""
        return self in _TURNING or self.towed


_TURNING = frozenset(
    {
        RunKind.OSCILLATION,
        RunKind.DRY,
        RunKind.KNOWN_MASS,
        RunKind.RESTORING,
        RunKind.CONTROL,
    }
)


class Motion(StrEnum):
    """A motion by its name; the strut phase follows from it.

    Heave and sway: both struts together. Pitch and yaw: opposite at zero speed; with forward speed
    ``U`` the strut phase is that of ``tan(phase / 2) = omega l / U``, for which the angle of attack
    stays zero. Yaw with drift: the same at a steady drift angle, set as the oscillator's
    arrangement has it. Phase: the strut phase is given. None: the shaft is at rest.
    """

    HEAVE = "heave"
    PITCH = "pitch"
    SWAY = "sway"
    YAW = "yaw"
    YAW_DRIFT = "yaw-drift"
    PHASE = "phase"
    NONE = "none"
