"""A body on two lines: yaw and sway of the bifilar, surge and pitch of the double pendulum."""

import math
from dataclasses import dataclass, field

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.pendulum.body import LINEAR, SUSPENSION
from sim.pendulum.coordinates import PITCH, SURGE, SWAY, YAW
from sim.pendulum.resistance import Air, Resistance


@dataclass(frozen=True)
class Suspension:
    """A body under a beam on two equal parallel lines: bifilar and double pendulum in one.

    The lines hang from (0, +-d); the body turns freely about the beam. Coordinates: surge and sway
    of the beam's middle, yaw, pitch about the beam. Beyond the linear the motion is that of the
    rigid body on lines of fixed length, exactly: heave and roll follow from the lines.

    Attributes
    ----------
    line_length_m, half_spacing_m
        l and d, as the experimenter measured them, without load.
    depth_m
        l_2, of the centre of gravity below the beam.
    roll_gyradius_m, pitch_gyradius_m, yaw_gyradius_m
        About the body's own axes through the centre of gravity.
    off_level_rad
        The hull's pitch, bow up, as it hangs.
    stretch_ratio, creep_per_decade
        Relative extension of the lines under the load at once, and per decade of minutes:
        l (1 + stretch)(1 + creep log10(1 + t/60 s)).
    linear
        True for small displacements: the four coordinates then obey equations 5, 7 and 16.
    """

    mass_kg: float
    line_length_m: float
    half_spacing_m: float
    depth_m: float
    yaw_gyradius_m: float
    pitch_gyradius_m: float
    roll_gyradius_m: float
    off_level_rad: float = 0.0
    stretch_ratio: float = 0.0
    creep_per_decade: float = 0.0
    surge: Resistance = field(default_factory=Resistance)
    sway: Resistance = field(default_factory=Resistance)
    yaw: Resistance = field(default_factory=Resistance)
    pitch: Resistance = field(default_factory=Resistance)
    air: Air = field(default_factory=Air)
    linear: bool = False
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
    coordinates = (SURGE, SWAY, YAW, PITCH)

    def __post_init__(self) -> None:
        names = ("mass_kg", "line_length_m", "half_spacing_m", "depth_m")
        gyradii = ("yaw_gyradius_m", "pitch_gyradius_m", "roll_gyradius_m")
        faults = [
            f"{n} = {getattr(self, n):g}" for n in names + gyradii if not getattr(self, n) > 0.0
        ]
        if faults:
            raise ConfigurationError(f"suspension: {', '.join(faults)} must be above 0")
        if self.linear and self.creep_per_decade:
            raise ConfigurationError(
                f"suspension: creep_per_decade = {self.creep_per_decade:g} with linear = True; the "
                "linear motion has lines of one length: leave one of them out"
            )

    @property
    def resistances(self) -> tuple[Resistance, ...]:
        """Those of the four coordinates."""
        return (self.surge, self.sway, self.yaw, self.pitch)

    @property
    def kind(self) -> int:
        """Exact beyond small displacements, or linear."""
        return LINEAR if self.linear else SUSPENSION

    @property
    def length_m(self) -> float:
        """Length of the loaded lines at time 0."""
        return self.line_length_m * (1.0 + self.stretch_ratio)

    @property
    def weight_n(self) -> float:
        """Weight less the air's buoyancy."""
        return self.mass_kg * self.gravity_m_s2 * (1.0 - self.air.buoyancy_ratio)

    @property
    def _moving_kg(self) -> float:
        return self.mass_kg * (1.0 + self.air.added_mass_ratio)

    @property
    def hanging_inertia_kg_m2(self) -> tuple[float, float, float, float]:
        """I_xx, I_yy, I_zz and I_xz about level and vertical axes, the air's included."""
        scale = self.mass_kg * (1.0 + self.air.added_inertia_ratio)
        xx, zz = scale * self.roll_gyradius_m**2, scale * self.yaw_gyradius_m**2
        s, c = math.sin(self.off_level_rad), math.cos(self.off_level_rad)
        yy = scale * self.pitch_gyradius_m**2
        return xx * c * c + zz * s * s, yy, xx * s * s + zz * c * c, (zz - xx) * s * c

    @property
    def mass(self) -> FloatArray:
        """M of (surge, sway, yaw, pitch)."""
        m, depth = self._moving_kg, self.depth_m
        _, yy, zz, _ = self.hanging_inertia_kg_m2
        matrix = np.diag([m, m, zz, yy + m * depth**2])
        matrix[0, 3] = matrix[3, 0] = m * depth
        return matrix

    @property
    def stiffness(self) -> FloatArray:
        """K of (surge, sway, yaw, pitch)."""
        line = self.weight_n / self.length_m
        return np.diag([line, line, line * self.half_spacing_m**2, self.weight_n * self.depth_m])

    @property
    def parameters(self) -> FloatArray:
        """Geometry, weight and inertia in the order that the compiled loop reads."""
        if self.linear:
            return np.zeros(10)
        lines = (self.length_m, self.creep_per_decade, self.half_spacing_m, self.depth_m)
        return np.array([*lines, self._moving_kg, self.weight_n, *self.hanging_inertia_kg_m2])

    @property
    def truth(self) -> dict[str, float]:
        """Mass, depth of the centre of gravity, gyradii and inertias, and the suspension's own."""
        return {
            "mass_kg": self.mass_kg,
            "depth_m": self.depth_m,
            "yaw_gyradius_m": self.yaw_gyradius_m,
            "pitch_gyradius_m": self.pitch_gyradius_m,
            "roll_gyradius_m": self.roll_gyradius_m,
            "yaw_inertia_kg_m2": self.mass_kg * self.yaw_gyradius_m**2,
            "pitch_inertia_kg_m2": self.mass_kg * self.pitch_gyradius_m**2,
            "line_length_m": self.line_length_m,
            "half_spacing_m": self.half_spacing_m,
        }
