"""``[heel]`` of a campaign beside its oscillator."""

from collections.abc import Iterator
from typing import Any

from hardware.description.arrangement import Gauges
from hardware.description.heel import Heel
from hardware.description.oscillator import Oscillator, Plane
from pmm.configuration import Fault, validate


def heel_faults(oscillator: Oscillator | None, table: Any) -> Iterator[Fault]:
    """Refuse heel where a rig cannot have it; what is wrong with the table itself passes."""
    if table is None or oscillator is None or validate(Heel, table, []) is None:
        return
    if oscillator.plane is Plane.VERTICAL:
        yield Fault(("heel",), "is for the horizontal oscillator; take it out, or correct plane")
    if oscillator.gauges is Gauges.RIG:
        yield Fault(
            ("heel",),
            'needs gauges = "model" in [oscillator]: gauges that stay with the rig as the model '
            "yaws read a part of its pitch moment as roll moment",
        )


def own_heel_faults(oscillator: Oscillator | None, table: Any) -> Iterator[Fault]:
    """Yield all that is wrong with the table."""
    own: list[Fault] = []
    validate(Heel, table, own)
    yield from (Fault(("heel", *one.place), one.message) for one in own)
    yield from heel_faults(oscillator, table)
