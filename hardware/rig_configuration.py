"""What a rig is made of, read from the tables of ``rig.toml`` and checked as a whole."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint
from typing import Final

from hardware.bus import FASTEST_HZ, BusConfiguration, bus_load, check_load
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import ANGLE_KEYS
from hardware.driver import Driver, NodePlan, find_driver, read_settings
from hardware.roles import Role

ROLES: Final = {
    "shaft": Role.SHAFT,
    "eccentricity": Role.POSITION_AXIS,
    "phase": Role.POSITION_AXIS,
    "photocell": Role.PHOTOCELL,
    "inclinometer": Role.INCLINOMETER,
    "carriage": Role.CARRIAGE,
    **dict.fromkeys(ANGLE_KEYS, Role.POSITION_AXIS),
    "forces": Role.FORCES,
}
TABLES: Final = (*ROLES, "bus", "cycle_rate_hz")  # of rig.toml; others are not the devices'
_SYNC_BYTES, _BEAT_BYTES = 1, 1


@dataclass(frozen=True)
class RigPart:
    """One device of a rig: where it belongs, its driver and the driver's settings."""

    name: str
    driver: Driver
    settings: object

    def nodes(self) -> tuple[NodePlan, ...]:
        """Return what it wants of the bus."""
        return self.driver.nodes(self.name, self.settings)


@dataclass(frozen=True)
class RigConfiguration:
    """A whole rig; each part may be absent.

    Attributes
    ----------
    cycle_rate_hz
        Cycles per second of a rig without a bus; with one, the bus's SYNC rate holds.
    """

    bus: BusConfiguration | None = None
    shaft: RigPart | None = None
    eccentricity: RigPart | None = None
    phase: RigPart | None = None
    photocell: RigPart | None = None
    inclinometer: RigPart | None = None
    carriage: RigPart | None = None
    drift: RigPart | None = None
    heel: RigPart | None = None
    rudder: RigPart | None = None
    forces: tuple[RigPart, ...] = ()
    cycle_rate_hz: float = 100.0

    @property
    def sample_rate_hz(self) -> float:
        """Cycles per second."""
        return self.bus.sync_rate_hz if self.bus else self.cycle_rate_hz

    @property
    def angles(self) -> dict[str, RigPart]:
        """The axes of static angles that the rig has, by name."""
        return {key: part for key in ANGLE_KEYS if (part := getattr(self, key)) is not None}

    def parts(self) -> Iterator[RigPart]:
        """Yield the parts, the shaft first."""
        for part in (self.shaft, self.eccentricity, self.phase, *self.forces):
            if part is not None:
                yield part
        for part in (self.photocell, self.inclinometer, self.carriage, *self.angles.values()):
            if part is not None:
                yield part


def read_rig(
    tables: Mapping[str, object], among: Iterable[EntryPoint] | None = None
) -> RigConfiguration:
    """Read the tables of a rig: ``bus``, one per part, ``forces`` as an array of tables.

    Raises
    ------
    ConfigurationError
        With a line for every error of the whole configuration.
    """
    faults: list[str] = []
    faults += [
        f"{key} is not a known table; known: {', '.join(TABLES)}"
        for key in tables
        if key not in TABLES
    ]
    parts_by_role = {
        role: _parts(role, tables[role], faults, None if among is None else tuple(among))
        for role in ROLES
        if role in tables
    }
    bus = _read(BusConfiguration, tables.get("bus"), "bus", faults)
    if faults:
        raise ConfigurationError("\n".join(faults))
    single = {role: parts[0] for role, parts in parts_by_role.items() if role != "forces" and parts}
    rate = tables.get("cycle_rate_hz", 100.0)
    if not isinstance(rate, int | float) or rate is True or not 0.0 < rate <= FASTEST_HZ:
        raise ConfigurationError(
            f"cycle_rate_hz = {rate!r} has to be a number above 0, at most {FASTEST_HZ:g}"
        )
    rig = RigConfiguration(bus=bus, forces=tuple(parts_by_role.get("forces", ())),
                           cycle_rate_hz=rate, **single)  # fmt: skip
    check(rig)
    return rig


def check(rig: RigConfiguration) -> None:
    """Check a rig as a whole: EDS files, mappings, node ids, channel names, bus load.

    Raises
    ------
    ConfigurationError
        With a line for every error, each with the object, the value and the limit.
    """
    faults: list[str] = []
    plans: list[NodePlan] = []
    frames: Counter[int] = Counter()
    for part in rig.parts():
        try:
            mine = part.nodes()
            plans += mine
            for plan in mine:
                for layouts in plan.layouts():
                    frames.update(layout.size for layout in layouts)
        except ConfigurationError as error:
            faults.append(str(error))
    faults += _node_faults(plans, rig.bus)
    faults += _channel_faults(rig)
    if rig.bus is not None:
        try:
            check_load(load_of(rig.bus, frames, len(plans)), rig.bus)
        except ConfigurationError as error:
            faults.append(str(error))
    if faults:
        raise ConfigurationError("\n".join(faults))


def load_of(bus: BusConfiguration, pdo_sizes: Mapping[int, int], node_count: int) -> float:
    """Return the bus load: SYNC and every PDO in each cycle, and everyone's heartbeat."""
    per_s: Counter[int] = Counter()
    for size, count in pdo_sizes.items():
        per_s[size] += round(count * bus.sync_rate_hz)
    per_s[_SYNC_BYTES] += round(bus.sync_rate_hz)
    per_s[_BEAT_BYTES] += round((node_count + 1) * 1000.0 / bus.heartbeat_ms)
    return bus_load(per_s, bus.bit_rate)


def _parts(
    role: str, table: object, faults: list[str], among: tuple[EntryPoint, ...] | None
) -> list[RigPart]:
    many = role == "forces"
    tables = table if many and isinstance(table, list) else [table]
    parts = []
    for i, part in enumerate(tables):
        where = f"{role}[{i}]" if many else role
        if not isinstance(part, Mapping):
            faults.append(f"{where} = {part!r} has to be a table")
            continue
        try:
            parts.append(_part(where, ROLES[role], part, among))
        except ConfigurationError as error:
            faults.append(str(error))
    return parts


def _part(
    where: str, role: Role, table: Mapping[str, object], among: tuple[EntryPoint, ...] | None
) -> RigPart:
    rest = dict(table)
    name = rest.pop("driver", None)
    if not isinstance(name, str):
        raise ConfigurationError(f"{where}.driver is missing: it names the driver")
    driver = find_driver(name, where, among)
    if driver.role is not role:
        raise ConfigurationError(f"{where}.driver = {name!r} is for {driver.role}, not {role}")
    return RigPart(where, driver, read_settings(driver.settings, rest, where))


def _read(
    kind: type[BusConfiguration], table: object, where: str, faults: list[str]
) -> BusConfiguration | None:
    if table is None:
        return None
    if not isinstance(table, Mapping):
        faults.append(f"{where} = {table!r} has to be a table")
        return None
    try:
        return read_settings(kind, table, where)
    except ConfigurationError as error:
        faults.append(str(error))
        return None


def _node_faults(plans: list[NodePlan], bus: BusConfiguration | None) -> Iterator[str]:
    taken = {} if bus is None else {bus.master_node: "the controller (bus.master_node)"}
    for plan in plans:
        if bus is None:
            yield f"{plan.name}: needs a CAN bus, and the rig has no [bus] table"
        if not 1 <= plan.node_id <= 127:
            yield f"{plan.name}.node = {plan.node_id}; a node id is 1 to 127"
        if plan.node_id in taken:
            yield f"{plan.name}.node = {plan.node_id} is taken by {taken[plan.node_id]}"
        taken.setdefault(plan.node_id, plan.name)


def _channel_faults(rig: RigConfiguration) -> Iterator[str]:
    names: Counter[str] = Counter()
    for part in rig.forces:
        for channel in getattr(part.settings, "channels", ()):
            names[getattr(channel, "name", str(channel))] += 1
    for name, count in names.items():
        if count > 1:
            yield f"forces: channel {name!r} is there {count} times; a name has to be unique"
