"""``[attitude]`` and ``[heel]`` of a campaign beside its oscillator."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from hardware.description.arrangement import Gauges
from hardware.description.attitude import AttitudeSensors, HeaveAndPitch
from hardware.description.heel import Heel
from hardware.description.oscillator import Oscillator, Plane
from pmm.configuration import Fault, validate


def attitude_faults(
    oscillator: Oscillator | None, tables: Mapping[str, Any], *, own: bool = False
) -> Iterator[Fault]:
    """Refuse a model that sinks, trims or heels where a rig cannot have it.

    Parameters
    ----------
    own
        Whether what is wrong with a table by itself is told too; else whoever reads it tells.
    """
    for key, (kind, beside) in _TABLES.items():
        if tables.get(key) is None:
            continue
        faults: list[Fault] = []
        table = validate(kind, tables[key], faults)
        if own:
            yield from (Fault((key, *fault.place), fault.message) for fault in faults)
        if table is not None and oscillator is not None:
            yield from beside(oscillator, table)


def _forced(oscillator: Oscillator, sensors: AttitudeSensors) -> Iterator[Fault]:
    if oscillator.plane is Plane.VERTICAL and sensors.heave_and_pitch is HeaveAndPitch.FREE:
        yield Fault(
            ("attitude", "heave_and_pitch"),
            '= "free": a vertical oscillator forces heave and pitch; say "fixed", or correct plane '
            "in [oscillator]",
        )


def _heeled(oscillator: Oscillator, _: Heel) -> Iterator[Fault]:
    if oscillator.plane is Plane.VERTICAL:
        yield Fault(("heel",), "is for the horizontal oscillator; take it out, or correct plane")
    if oscillator.gauges is Gauges.RIG:
        yield Fault(
            ("heel",),
            'needs gauges = "model" in [oscillator]: gauges that stay with the rig as the model '
            "yaws read a part of its pitch moment as roll moment",
        )


_TABLES: Final[Mapping[str, tuple[type[Any], Callable[[Oscillator, Any], Iterator[Fault]]]]] = {
    "attitude": (AttitudeSensors, _forced),
    "heel": (Heel, _heeled),
}
