"""How a driver presents itself, and how drivers are found: entry points of ``pmm.drivers``."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from importlib.metadata import EntryPoint
from typing import TYPE_CHECKING, Any, Final, TypeVar, cast

from hardware.description.errors import ConfigurationError
from hardware.description.toml import adapter, dotted, not_finite
from hardware.dictionary import Entry, PdoLayout, layout, load
from hardware.installed import installed
from hardware.roles import Device, Role
from hardware.serial_port import Ports, SerialPort

if TYPE_CHECKING:
    from hardware.master import Master
    from hardware.node import Node
    from hardware.roles import Shaft

GROUP: Final = "pmm.drivers"
T = TypeVar("T")
Prompt = Callable[[str], str | None]


@dataclass(frozen=True)
class NodePlan:
    """What a driver wants of the bus: a node id, an EDS, and the objects of each PDO."""

    name: str
    node_id: int
    eds: str
    tpdos: tuple[tuple[Entry, ...], ...] = ()
    rpdos: tuple[tuple[Entry, ...], ...] = ()

    def layouts(self) -> tuple[tuple[PdoLayout, ...], tuple[PdoLayout, ...]]:
        """Return the layouts of TPDOs and RPDOs with their identifiers.

        Raises
        ------
        ConfigurationError
            If the EDS is unknown, an object cannot be mapped, or there are more than four PDOs.
        """
        dictionary = load(self.eds, self.node_id, self.name)
        layouts = []
        for kind, base, pdos in (("tpdo", 0x180, self.tpdos), ("rpdo", 0x200, self.rpdos)):
            if len(pdos) > 4:
                raise ConfigurationError(f"{self.name}: {len(pdos)} {kind}s; the limit is 4")
            layouts.append(
                tuple(
                    layout(dictionary, pdo, base + 0x100 * n + self.node_id, f"{self.name} {kind}")
                    for n, pdo in enumerate(pdos)
                )
            )
        return layouts[0], layouts[1]


@dataclass(frozen=True)
class Services:
    """What a driver may use.

    Attributes
    ----------
    clock
        Monotonic seconds, for time-outs.
    prompt
        Shows a question and returns the operator's answer, or ``None`` as long as there is none.
        It is asked again in every cycle, because the loop must not wait.
    sample_rate_hz
        Cycles per second.
    master
        The bus; ``None`` in a rig without one.
    shaft
        The rig's shaft, for a photocell that is wired to its drive.
    port
        Opens a serial port by its device's name and settings, so that what it says is logged.
    """

    clock: Callable[[], float]
    prompt: Prompt
    sample_rate_hz: float
    master: "Master | None" = None
    shaft: "Shaft | None" = None
    port: Ports = SerialPort


def join(plan: NodePlan, services: Services) -> "Node":
    """Add a driver's node to the bus.

    Raises
    ------
    ConfigurationError
        If the rig has no bus, or the plan is wrong (see :meth:`NodePlan.layouts`).
    """
    if services.master is None:
        raise ConfigurationError(f"{plan.name}: needs a CAN bus, and the rig has no [bus] table")
    dictionary = load(plan.eds, plan.node_id, plan.name)
    return services.master.add(plan.name, plan.node_id, dictionary, *plan.layouts())


def gap_cycles(services: Services) -> int:
    """Return after how many cycles without process data a value is stale."""
    return services.master.configuration.allowed_gap_cycles if services.master else 0


def _no_nodes(name: str, settings: Any) -> tuple[NodePlan, ...]:  # noqa: ARG001
    return ()


@dataclass(frozen=True)
class Driver:
    """A driver, as its entry point presents it.

    Attributes
    ----------
    settings
        A frozen dataclass: the keys of the driver's table in ``rig.toml``.
    open
        Makes the device from its name, its settings and the services.
    nodes
        What the device wants of the CAN bus, without opening anything.
    """

    role: Role
    settings: type
    open: Callable[[str, Any, Services], Device]
    nodes: Callable[[str, Any], tuple[NodePlan, ...]] = _no_nodes


def find_driver(name: str, where: str, among: Iterable[EntryPoint] | None = None) -> Driver:
    """Return the driver with a name.

    Parameters
    ----------
    where
        The place in the configuration, for messages.
    among
        Entry points to look through; all installed ones by default.

    Raises
    ------
    ConfigurationError
        If there is none, or its package cannot be loaded.
    """
    drivers = {
        entry_point.name: entry_point
        for entry_point in (installed(GROUP) if among is None else among)
    }
    if name not in drivers:
        near = get_close_matches(name, drivers, n=1, cutoff=0.5)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(sorted(drivers))}"
        raise ConfigurationError(f"{where}.driver = {name!r} is not installed; {hint}")
    try:
        driver = drivers[name].load()
    except Exception as error:  # a foreign package may raise anything while it is imported
        raise ConfigurationError(
            f"{where}.driver = {name!r}: {drivers[name].value} cannot be loaded: {error}"
        ) from error
    if not isinstance(driver, Driver):
        raise ConfigurationError(
            f"{where}.driver = {name!r}: {drivers[name].value} is no hardware.driver.Driver"
        )
    return driver


def read_settings(kind: type[T], table: Mapping[str, object], where: str) -> T:
    """Make a driver's settings from its table.

    Numbers have to be numbers: text and booleans are not taken for any.

    Raises
    ------
    ConfigurationError
        With a line for every wrong, missing or unknown key.
    """
    import json

    from pydantic import ValidationError

    keys = _keys(kind)
    faults = [
        f"{where}.{key} is not a known key; {_hint(key, keys)}" for key in table if key not in keys
    ]
    values = {key: value for key, value in table.items() if key in keys}
    faults += [f"{where}.{dotted(place)} has to be a finite number" for place in not_finite(values)]
    settings: T | None = None
    try:
        settings = adapter(cast("Any", kind)).validate_json(json.dumps(values), strict=True)
    except ValidationError as error:
        for fault in error.errors(include_url=False):
            place = ".".join(map(str, (where, *fault["loc"])))
            shown = "" if fault["type"] == "missing" else f" = {fault['input']!r}"
            faults.append(f"{place}{shown}: {fault['msg']}")
    except ConfigurationError as error:
        faults.append(f"{where}: {error}")
    if faults or settings is None:
        raise ConfigurationError("\n".join(faults))
    return settings


def _keys(kind: type) -> dict[str, None]:
    from dataclasses import fields

    return {field.name: None for field in fields(kind)}


def _hint(key: str, keys: Iterable[str]) -> str:
    names = list(keys)
    near = get_close_matches(key, names, n=1, cutoff=0.5)
    return f"did you mean {near[0]}?" if near else f"known: {', '.join(names)}"
