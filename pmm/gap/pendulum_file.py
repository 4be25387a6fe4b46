"""``FILE.toml`` of a pendulum's gap: records, what the simulation believes, tolerances.

``docs/gap-pendulums.md`` has the keys.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from analysis.gap.pendulum.further import Reach
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
    suspensions: tuple[GateTable, ...] = ()
    gyradius_m: float = 1.0
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
        given = (case.measured is not None, bool(case.suspensions))
        if sum(given) != 1:
            faults.append(Fault(("measured",), "or [[suspensions]]: give exactly one of them"))
        told = (case.simulated, case.floating, case.pivot)
        if case.measured and sum(one is not None for one in told) != 1:
            said = "or [floating], or [pivot]: give exactly one of them"
            faults.append(Fault(("simulated",), said))
    if case is None or faults:
        raise as_error(path, faults, table)
    return case
