"""``FILE.toml`` of a pendulum's gap: records, what the simulation believes, tolerances.

``docs/gap-pendulums.md`` has the keys.
"""

import cmath
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from analysis.gap.pendulum.further import Reach
from hardware.description.errors import ConfigurationError
from pmm.configuration import STRICT_TABLE, Fault, as_error, read_toml, validate
from sim.pendulum.floating import Floating
from sim.pendulum.pivot import Pendulum


@dataclass(frozen=True)
class Record:
    """A sampled record and its channel."""

    record: str
    channel: str

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class GateTable:
    """One suspension: edges of light gates, half spacing and line length as measured."""

    name: str
    gates: str
    half_spacing_m: float
    line_m: float

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class ForcedTable:
    """A run under a known force.

    Attributes
    ----------
    force
        The recorded force or moment; the wave's elevation where ``[over_frequency]`` has a force.
    measured
        What was seen of the motion, by one sensor or several.
    from_s, to_s
        The gate on the records' clock, in which the motion has settled; the whole record if left
        out.
    """

    name: str
    force: Record
    measured: tuple[Record, ...]
    from_s: float | None = None
    to_s: float | None = None

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class OverFrequency:
    """What the simulation believes over frequency, straight from one to the next.

    Attributes
    ----------
    frequency_hz
        Rising.
    added_inertia, damping
        In place of those of ``[floating]``.
    force, force_phase_rad
        Force of a wave over its elevation, and by how much it leads that.
    """

    frequency_hz: tuple[float, ...]
    added_inertia: tuple[float, ...] = ()
    damping: tuple[float, ...] = ()
    force: tuple[float, ...] = ()
    force_phase_rad: tuple[float, ...] = ()

    __pydantic_config__ = STRICT_TABLE

    def __post_init__(self) -> None:
        counts = {len(getattr(self, key.name)) for key in fields(self)} - {0}
        rising = all(a < b for a, b in pairwise(self.frequency_hz))
        if len(counts) != 1 or not self.frequency_hz or not rising:
            raise ConfigurationError(
                "[over_frequency]: frequency_hz has to rise, and each other list to have as many "
                "values, or none"
            )
        if bool(self.force) != bool(self.force_phase_rad):
            raise ConfigurationError("[over_frequency]: force and force_phase_rad go together")

    def at(self, body: Floating, frequency_hz: float) -> tuple[Floating, complex | None]:
        """Return the body at a frequency, and the force over a wave's elevation if it is stated.

        Raises
        ------
        ConfigurationError
            If the frequency lies outside.
        """
        low, high = self.frequency_hz[0], self.frequency_hz[-1]
        if not low <= frequency_hz <= high:
            raise ConfigurationError(
                f"[over_frequency] ends at {low:g} and {high:g} Hz, and a run is at "
                f"{frequency_hz:.4g} Hz; state more, or leave the run out"
            )
        added, damping, force, phase = (
            float(np.interp(frequency_hz, self.frequency_hz, values)) if values else None
            for values in (self.added_inertia, self.damping, self.force, self.force_phase_rad)
        )
        if added is not None:
            body = replace(body, added_inertia=added)
        if damping is not None:
            body = replace(body, resistance=replace(body.resistance, viscous=damping))
        return body, None if force is None or phase is None else cmath.rect(force, phase)


@dataclass(frozen=True)
class ReachTable(Reach):
    """What a further suspension may be."""

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class EffectTable:
    """An effect that the simulation has on; parameters left out are typical."""

    name: str
    parameters: Mapping[str, float | str] = field(default_factory=dict)

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class PendulumCase:
    """The file.

    Attributes
    ----------
    measured, simulated
        A decay pair; without ``simulated`` the simulation is of ``floating``, a body afloat, or of
        ``pivot``, parts on a knife edge: a swing, or a compound pendulum.
    forced, over_frequency
        Runs of ``floating`` under a known force, and what changes with their frequency.
    suspensions
        One body on several pairs of lines; ``gyradius_m`` is what it is thought to have.
    swings
        How many swings of a light gates' record count.
    tolerances
        Standard deviations of what is stated, by effect.
    reach
        Within which a further suspension is proposed.
    effects
        What the simulation has on already, in this order.
    """

    name: str
    measured: Record | None = None
    simulated: Record | None = None
    floating: Floating | None = None
    pivot: Pendulum | None = None
    forced: tuple[ForcedTable, ...] = ()
    over_frequency: OverFrequency | None = None
    suspensions: tuple[GateTable, ...] = ()
    gyradius_m: float = 0.0  # not stated
    gravity_m_s2: float = 9.80665
    swings: int = 60
    tolerances: Mapping[str, float] = field(default_factory=dict)
    reach: ReachTable | None = None
    effects: tuple[EffectTable, ...] = ()

    __pydantic_config__ = STRICT_TABLE


def read_case(path: Path) -> PendulumCase:
    """Read the file.

    Raises
    ------
    ConfigurationError
        With every error of it.
    """
    table = read_toml(path)
    faults: list[Fault] = []
    case = validate(PendulumCase, table, faults)
    if case is not None:
        kinds = (case.measured is not None, bool(case.suspensions), bool(case.forced))
        if sum(kinds) != 1:
            said = "or [[suspensions]], or [[forced]]: give exactly one of them"
            faults.append(Fault(("measured",), said))
        if case.suspensions and not case.gyradius_m > 0.0:
            said = "is needed by [[suspensions]], above 0: what the body is believed to have, in m"
            faults.append(Fault(("gyradius_m",), said))
        models = (case.simulated, case.floating, case.pivot)
        if case.measured and sum(model is not None for model in models) != 1:
            said = "or [floating], or [pivot]: give exactly one of them"
            faults.append(Fault(("simulated",), said))
    if case is None or faults:
        raise as_error(path, faults, table)
    return case
