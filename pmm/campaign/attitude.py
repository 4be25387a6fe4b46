"""``[attitude]`` of a campaign beside its oscillator."""

from collections.abc import Iterator
from typing import Any

from hardware.description.attitude import AttitudeSensors, HeaveAndPitch
from hardware.description.oscillator import Oscillator, Plane
from pmm.configuration import Fault, validate


def forced_faults(oscillator: Oscillator | None, table: Any) -> Iterator[Fault]:
    """Refuse a model that is free in what a vertical oscillator forces.

    A table that is wrong by itself passes: whoever reads it tells.
    """
    sensors = validate(AttitudeSensors, table, [])
    if oscillator is None or sensors is None or oscillator.plane is not Plane.VERTICAL:
        return
    if sensors.heave_and_pitch is HeaveAndPitch.FREE:
        yield Fault(
            ("attitude", "heave_and_pitch"),
            '= "free": a vertical oscillator forces heave and pitch; say "fixed", or correct plane '
            "in [oscillator]",
        )


def attitude_faults(oscillator: Oscillator | None, table: Any) -> Iterator[Fault]:
    """Yield all that is wrong with the table."""
    own: list[Fault] = []
    validate(AttitudeSensors, table, own)
    yield from (Fault(("attitude", *one.place), one.message) for one in own)
    yield from forced_faults(oscillator, table)
