"""What is looked at in ``rig.toml`` beyond the types of its keys."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from hardware.description.arrangement import DriftBy
from hardware.rig_configuration import TABLES, RigConfiguration
from pmm.campaign.model_uncertainty import take_uncertainty
from pmm.configuration import Fault, unknown, validate
from pmm.plan.rig_tables import HANDED_ON, Gauge, RigTables

SIMULATED: Final = "pmm-simulated"  # the simulated rig's name among the buses
_OWN: Final = tuple(RigTables.__dataclass_fields__)


def table_faults(table: dict[str, Any]) -> Iterator[Fault]:
    """Yield what is wrong with the tables beside the devices; unknown ones are taken out."""
    yield from _unknown_tables(table)
    yield from _handed_on_faults(table)


def _unknown_tables(table: dict[str, Any]) -> Iterator[Fault]:
    """Yield the top's unknown keys and take them out: the devices' names are known ones too."""
    for key in [key for key in table if key not in _OWN]:
        del table[key]
        yield Fault((key,), unknown((key,), (*_OWN, *TABLES)))


def _handed_on_faults(table: dict[str, Any]) -> Iterator[Fault]:
    campaign = table.get("campaign")
    if not isinstance(campaign, dict):
        return
    for key in campaign:
        if key not in HANDED_ON:
            place = ("campaign", key)
            yield Fault(place, unknown(place, HANDED_ON))
    inner: list[Fault] = []
    take_uncertainty(campaign, inner)  # of the copy; the campaign's file gets it as it is
    analysis = campaign.get("analysis", {})
    if isinstance(analysis, dict):
        inner += _analysis_faults(analysis)
    yield from (Fault(("campaign", *fault.place), fault.message) for fault in inner)


def _analysis_faults(table: dict[str, Any]) -> Iterator[Fault]:
    """Yield what the analysis would refuse, while there is time to change it."""
    from analysis.resolver.settings import ResolverSettings

    keys = tuple(ResolverSettings.__dataclass_fields__)
    yield from (Fault(("analysis", key), unknown((key,), keys)) for key in table if key not in keys)
    inner: list[Fault] = []
    validate(ResolverSettings, table, inner)
    yield from (Fault(("analysis", *fault.place), fault.message) for fault in inner)


def point_at_simulation(devices: dict[str, Any], path: Path) -> None:
    """Let the file of a simulated rig be seen from the rig's file, wherever the command is given.

    Buses and ports of the simulated rig share its name, so both are resolved alike.
    """
    bus = devices.get("bus")
    if not isinstance(bus, dict) or bus.get("interface") != SIMULATED:
        return
    channel = bus.get("channel")
    if not isinstance(channel, str) or not channel.endswith(".toml"):
        return
    full_path = (path.parent / channel).resolve().as_posix()
    bus["channel"] = full_path
    for part in devices.values():
        port = part.get("port") if isinstance(part, dict) else None
        url = port.get("url") if isinstance(port, dict) else None
        if isinstance(port, dict) and isinstance(url, str):
            port["url"] = url.replace(f"sim://{channel}/", f"sim://{full_path}/")


def channels_of(hardware: RigConfiguration) -> tuple[str, ...]:
    """Return the names of the channels that measure forces."""
    return tuple(
        getattr(channel, "name", str(channel))
        for part in hardware.forces
        for channel in getattr(part.settings, "channels", ())
        if getattr(channel, "unit", "N") == "N"
    )


def gauges_of(hardware: RigConfiguration) -> tuple[Gauge, ...]:
    """Return the amplifiers' own ranges of their force channels."""
    return tuple(
        Gauge(channel.name, channel.full_scale)
        for part in hardware.forces
        for channel in getattr(part.settings, "channels", ())
        if getattr(channel, "unit", None) == "N" and hasattr(channel, "full_scale")
    )


def carriage_faults(tables: RigTables, hardware: RigConfiguration) -> Iterator[Fault]:
    """Yield what is asked of carriage and angles that their drivers or the rig do not do."""
    settings = None if hardware.carriage is None else hardware.carriage.settings
    for key, limit in (
        ("carriage_acceleration_m_s2", "acceleration_m_s2"),
        ("highest_speed_m_s", "highest_speed_m_s"),
    ):
        asked, most = getattr(tables.tank, key, None), getattr(settings, limit, None)
        if asked is not None and most is not None and asked > most:
            yield Fault(
                ("tank", key),
                f"= {asked:g} is above carriage.{limit} = {most:g}, which its drive does; lower it",
            )
    for name, part in hardware.angles.items():
        if (unit := getattr(part.settings, "unit", "rad")) != "rad":
            yield Fault((name, "unit"), f'= {unit!r}: {name} is an angle; say "rad"')
    if "drift" in hardware.angles and tables.oscillator.drift_by is DriftBy.STRUTS_OFFSET:
        yield Fault(
            ("drift",),
            "sets an angle, and oscillator.drift_by = 'struts_offset' sets the struts apart; leave "
            "the table out, or say 'rig_turned' or 'model_turned'",
        )


def gauge_faults(tables: RigTables, hardware: RigConfiguration) -> Iterator[Fault]:
    """Yield gauges that the rig does not have, and safe loads below the range."""
    names = channels_of(hardware)
    for number, gauge in enumerate(tables.gauges):
        if gauge.channel not in names:
            place = ("gauges", number, "channel")
            said = unknown((gauge.channel,), names).replace("a known key", "a force channel")
            yield Fault(place, f"= {gauge.channel!r} {said}")
        if gauge.safe_n < gauge.full_scale_n:
            place = ("gauges", number, "safe_load_n")
            yield Fault(place, f"= {gauge.safe_n:g} should not be below full_scale_n = "
                               f"{gauge.full_scale_n:g}")  # fmt: skip
