"""Which channel of the campaign each column is: from the roles to names, units and remarks."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from hardware.description.channels import COMMANDS, DISPLACEMENTS, FORCES, POSITIONS
from pmm.start import words
from pmm.start.behaviour import RecordingBehaviour
from pmm.start.found_campaign import CHANNELS, FoundColumn
from pmm.start.roles import ANGLE, COMMAND, DISPLACEMENT, FORCE, POSITION, PULSES, ColumnRole

_PAIRS: Final = (
    (DISPLACEMENT, DISPLACEMENTS), (FORCE, FORCES), (COMMAND, COMMANDS), (POSITION, POSITIONS),
)  # fmt: skip
_LARGEST_M: Final = 1.0  # of an eccentricity in metres; and the smallest of one in millimetres


def as_columns(
    roles: Sequence[ColumnRole], running: Sequence[RecordingBehaviour]
) -> list[FoundColumn]:
    """Return the channels, sure or not, and the columns with the line that keep their names."""
    found: list[FoundColumn] = []
    for kind, channels in _PAIRS:
        found += _of_struts([role for role in roles if role.kind is kind], channels)
    found += [
        FoundColumn(role.kind.name, role.column, doubt=role.doubt)
        for role in roles
        if role.kind.places == 1
    ]
    found = [_with_unit(one, running) for one in found]
    found.sort(key=lambda one: CHANNELS.index(one.name))
    return [*found, *_keeping_names({one.column for one in found if not one.doubt}, running)]


def _of_struts(roles: Sequence[ColumnRole], channels: Sequence[str]) -> Iterator[FoundColumn]:
    doubts = {role.column: role.doubt for role in roles}
    names = words.struts_in_order(list(doubts))
    told = [words.says(name, words.FORE) - words.says(name, words.AFT) for name in names]
    if told == [0, 0]:  # what is sure is no worse for being called the first
        names.sort(key=lambda name: bool(doubts[name]))
    places = channels[1:] if told == [1] else channels
    for channel, name in zip(places, names, strict=False):
        yield FoundColumn(channel, name, doubt=doubts[name])


def by_order_of_names(columns: Sequence[FoundColumn]) -> bool:
    """Tell whether nothing but the order of their names says which of two columns is aft."""
    return any(
        len(pair) == 2 and not any(words.says(name, (*words.FORE, *words.AFT)) for name in pair)
        for channels in (DISPLACEMENTS, FORCES)
        for pair in [
            [column.column for column in columns if column.name in channels and not column.doubt]
        ]
    )


def _with_unit(one: FoundColumn, running: Sequence[RecordingBehaviour]) -> FoundColumn:
    """Say the unit that the numbers have where the header has none."""
    seen = [watched.columns[one.column] for watched in running if one.column in watched.columns]
    if seen[0].unit or one.name == PULSES.name:
        return one
    if one.name == ANGLE.name:
        turn = next(each.turn for each in seen if each.turn)
        return replace(one, unit=turn.unit, remark="no unit in the header: it turns so")
    if one.name in (*DISPLACEMENTS, *COMMANDS):
        amplitude = float(np.median([abs(each.part.first) for each in seen]))
        unit = "m" if amplitude < _LARGEST_M else "mm"
        said = f"no unit in the header: {unit} by its amplitude of {amplitude:.3g}"
        return replace(one, unit=unit, remark=said)
    if one.name in FORCES:
        said = f"no unit in the header: if it is kN, write {one.column + ':kN'!r}"
        return replace(one, remark=said)
    return replace(one, remark="no unit in the header")


def _keeping_names(taken: set[str], running: Sequence[RecordingBehaviour]) -> Iterator[FoundColumn]:
    """Yield what carries the line in most runs and is no channel of the rig for sure."""
    names = sorted({name for one in running for name in one.columns} - taken, key=words.natural)
    for name in names:
        held = [one.columns[name] for one in running if name in one.columns]
        if len(held) == len(running) and sum(one.part.carried for one in held) > len(held) / 2:
            yield FoundColumn(name, name)
