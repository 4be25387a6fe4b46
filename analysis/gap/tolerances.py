"""What the nominal simulation and the rig's settings may be wrong by without anybody's fault."""

from dataclasses import dataclass, fields
from typing import ClassVar

from hardware.description.errors import ConfigurationError


@dataclass(frozen=True)
class Tolerances:
    """Standard deviations, Gaussian about what the campaign states.

    Attributes
    ----------
    added_mass_relative, damping_relative, restoring_relative
        Of the water's matrices; a coupling has ``coupling_relative`` times the root of the product
        of the two diagonal terms.
    added_mass_per_octave, damping_per_octave
        By how much of itself each changes, smoothly, over an octave of frequency beyond what is
        stated: panel tables of ship models.
    added_mass_per_speed, damping_per_speed
        The same where the carriage's speed is doubled: tests at several Froude numbers.
    mass_relative, inertia_relative, cg_m
        Of the model's mass, inertia and centre of gravity.
    gain_relative, zero_n
        Of each dynamometer.
    eccentricity_m, strut_phase_rad
        Of each strut's eccentricity and of the phase between them, the same in all runs.
    photocell_angle_rad
        Of the photocell's mark.
    frequency_relative
        Of each run's frequency, which is measured besides.
    pulse_scatter_rad
        By which the photocell's pulses scatter on any rig; not a tolerance but a belief.
    reference_rad
        Of each run's phase reference: pulses that scatter, a shaft that does not turn quite evenly.
    carriage_speed_relative
        Of the carriage's mean speed.
    displacement_gain_relative
        Of each strut's displacement sensor.
    """

    added_mass_relative: float = 0.2
    damping_relative: float = 0.3
    restoring_relative: float = 0.02
    coupling_relative: float = 0.1
    added_mass_per_octave: float = 0.05
    damping_per_octave: float = 0.05
    added_mass_per_speed: float = 0.03
    damping_per_speed: float = 0.1
    mass_relative: float = 0.002
    inertia_relative: float = 0.01
    cg_m: float = 0.001
    gain_relative: float = 0.001
    zero_n: float = 0.05
    eccentricity_m: float = 2e-5
    strut_phase_rad: float = 1e-3
    photocell_angle_rad: float = 1e-3
    frequency_relative: float = 1e-4
    pulse_scatter_rad: float = 2e-4
    reference_rad: float = 1e-4
    carriage_speed_relative: float = 1e-3
    displacement_gain_relative: float = 5e-4

    __pydantic_config__: ClassVar = {"extra": "forbid"}

    def __post_init__(self) -> None:
        faults = [
            f"tolerances.{one.name} = {getattr(self, one.name):g} must not be negative"
            for one in fields(self)
            if not getattr(self, one.name) >= 0.0
        ]
        if faults:
            raise ConfigurationError("; ".join(faults))
