"""What the nominal simulation and the rig's settings may be wrong by without anybody's fault."""

import math
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar

from hardware.description.errors import ConfigurationError


def _tolerance(default: float, unit: str, meaning: str, source: str) -> Any:
    return field(default=default, metadata={"unit": unit, "meaning": meaning, "source": source})


@dataclass(frozen=True)
class Tolerances:
    """Standard deviations, Gaussian about what the campaign states.

    The defaults are a good rig's: what stays within them is no gap. Of each field the metadata have
    its unit, what it is of, and where the default comes from.

    Raises
    ------
    ConfigurationError
        If one is negative.
    """

    added_mass_relative: float = _tolerance(0.2, "1", "added mass", "strip theory against tests")
    damping_relative: float = _tolerance(0.3, "1", "damping", "strip theory against tests")
    restoring_relative: float = _tolerance(0.02, "1", "restoring", "hydrostatics of a built model")
    coupling_relative: float = _tolerance(
        0.1, "1", "couplings, of the root of the diagonal terms' product", "strip theory"
    )
    added_mass_per_octave: float = _tolerance(
        0.05,
        "1/octave",
        "smooth change of added mass with frequency",
        "panel tables of ship models",
    )
    damping_per_octave: float = _tolerance(
        0.05, "1/octave", "smooth change of damping with frequency", "panel tables of ships"
    )
    added_mass_per_speed: float = _tolerance(
        0.03,
        "1",
        "change of added mass as the speed is doubled, or is none",
        "tests at several Froude numbers",
    )
    damping_per_speed: float = _tolerance(
        0.1,
        "1",
        "change of damping as the speed is doubled, or is none",
        "tests at several Froude numbers",
    )
    mass_relative: float = _tolerance(0.002, "1", "mass of the model", "scales of a workshop")
    inertia_relative: float = _tolerance(
        0.01, "1", "inertia of the model", "swing and bifilar tests"
    )
    cg_m: float = _tolerance(0.001, "m", "centre of gravity, either way", "knife edge")
    gain_relative: float = _tolerance(
        0.001, "1", "gain of each dynamometer", "calibration, class 0.1"
    )
    zero_n: float = _tolerance(0.05, "N", "zero of each dynamometer", "0.01 % of 500 N")
    eccentricity_m: float = _tolerance(2e-5, "m", "eccentricity of each strut", "setting by gauge")
    strut_phase_rad: float = _tolerance(
        1e-3, "rad", "phase between the struts", "index of the crank"
    )
    photocell_angle_rad: float = _tolerance(1e-3, "rad", "mark of the photocell", "setting by eye")
    frequency_relative: float = _tolerance(1e-4, "1", "frequency of each run", "quartz and encoder")
    pulse_scatter_rad: float = _tolerance(
        2e-4, "rad", "scatter of the pulses of any rig: a belief", "slotted discs"
    )
    reference_rad: float = _tolerance(
        1e-4, "rad", "phase reference of each run", "pulses that scatter, a shaft that is not even"
    )
    carriage_speed_relative: float = _tolerance(
        1e-3, "1", "mean speed of the carriage, alike in all runs", "ITTC 7.5-02-06-02: 0.1 %"
    )
    displacement_gain_relative: float = _tolerance(
        5e-4, "1", "gain of each displacement sensor", "magnetostrictive sensors: 0.05 %"
    )
    ripple_1_relative: float = _tolerance(
        2.5e-4, "1", "speed ripple once a revolution, each phase", "servo drives: 5e-4 at most"
    )
    ripple_2_relative: float = _tolerance(
        2.5e-4, "1", "speed ripple twice a revolution, each phase", "servo drives: 5e-4 at most"
    )
    load_ripple_1_kg_m2: float = _tolerance(
        1e-3, "1/(kg m2)", "give of the shaft under load: one over what turns with it",
        "geared drives: 500 kg m2 and more at the crank",
    )  # fmt: skip
    warming_k_h: float = _tolerance(
        0.1, "K/h", "warming of gauges and water over the campaign", "tank halls: 1 K a day"
    )
    warming_n_s: float = _tolerance(
        1e-4, "N/s", "drift of each zero, alike in each record", "bridges that are warm: 0.4 N/h"
    )
    hum_n: float = _tolerance(0.02, "N", "hum of the mains in each force", "shielded cables")
    wander_n: float = _tolerance(
        0.005, "N", "wander of each zero, where zero runs do not tell it", "0.001 % of 500 N"
    )
    wander_s: float = _tolerance(100.0, "s", "time over which it wanders", "air conditioning")
    carriage_relative: float = _tolerance(
        1e-3, "1", "unevenness of the carriage's speed in a run", "ITTC 7.5-02-06-02: 0.1 %"
    )

    __pydantic_config__: ClassVar = {"extra": "forbid"}

    @property
    def wander(self) -> tuple[float, float]:
        """Wander of each zero: in N, and as a random walk in N per root s."""
        return self.wander_n, self.wander_n * math.sqrt(2.0 / max(self.wander_s, 1e-9))

    def __post_init__(self) -> None:
        faults = [
            f"tolerances.{tolerance.name} = {getattr(self, tolerance.name):g} must not be negative"
            for tolerance in fields(self)
            if not getattr(self, tolerance.name) >= 0.0
        ]
        if self.wander_n > 0.0 and self.wander_s == 0.0:
            faults.append("tolerances.wander_s = 0 must be above 0 where wander_n is")
        if faults:
            raise ConfigurationError("; ".join(faults))
