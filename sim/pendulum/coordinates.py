"""The signals of a pendulum test: for each coordinate displacement, rate and acceleration.

Body axes are those of the towing tank: x forward, y to starboard, z down. Angles are positive about
these axes; ``surge`` and ``sway`` are of the middle of the suspended beam.
"""

from dataclasses import dataclass

from sim.signals import Signal

RELEASE_HOLD = Signal("release_hold", "1")


@dataclass(frozen=True)
class Coordinate:
    """One degree of freedom of a swinging body."""

    name: str
    unit: str

    @property
    def displacement(self) -> Signal:
        """The coordinate itself."""
        return Signal(self.name, self.unit)

    @property
    def rate(self) -> Signal:
        """Its first derivative."""
        return Signal(f"{self.name}_rate", f"{self.unit}/s")

    @property
    def acceleration(self) -> Signal:
        """Its second derivative."""
        return Signal(f"{self.name}_acceleration", f"{self.unit}/s2")

    @property
    def held_position(self) -> Signal:
        """Where it is held before the release."""
        return Signal(f"held_{self.name}", self.unit)

    @property
    def kick(self) -> Signal:
        """The rate with which it is let go."""
        return Signal(f"released_{self.name}_rate", f"{self.unit}/s")


ANGLE = Coordinate("angle", "rad")  # of a swing or compound pendulum, zero where it hangs
SURGE = Coordinate("surge", "m")
SWAY = Coordinate("sway", "m")
YAW = Coordinate("yaw", "rad")
PITCH = Coordinate("pitch", "rad")
ROLL = Coordinate("roll", "rad")
HEAVE = Coordinate("heave", "m")
