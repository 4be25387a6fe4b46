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
    columns: list[FoundColumn] = []
    for kind, channels in _PAIRS:
        columns += _of_struts([role for role in roles if role.kind is kind], channels)
    columns += [
        FoundColumn(role.kind.name, role.column, doubt=role.doubt)
        for role in roles
        if role.kind.places == 1
    ]
    columns = [_with_unit(column, running) for column in columns]
    columns.sort(key=lambda column: CHANNELS.index(column.name))
    return [
        *columns,
        *_keeping_names({column.column for column in columns if not column.doubt}, running),
    ]


def _of_struts(roles: Sequence[ColumnRole], channels: Sequence[str]) -> Iterator[FoundColumn]:
    doubts = {role.column: role.doubt for role in roles}
    names = words.struts_in_order(list(doubts))
    ends = [words.says(name, words.FORE) - words.says(name, words.AFT) for name in names]
    if ends == [0, 0]:  # what is sure is no worse for being called the first
        names.sort(key=lambda name: bool(doubts[name]))
    places = channels[1:] if ends == [1] else channels
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


def _with_unit(column: FoundColumn, running: Sequence[RecordingBehaviour]) -> FoundColumn:
    """Say the unit that the numbers have where the header has none."""
    behaviours = [
        watched.columns[column.column] for watched in running if column.column in watched.columns
    ]
    if behaviours[0].unit or column.name == PULSES.name:
        return column
    if column.name == ANGLE.name:
        turn = next(each.turn for each in behaviours if each.turn)
        return replace(column, unit=turn.unit, remark="no unit in the header: it turns so")
    if column.name in (*DISPLACEMENTS, *COMMANDS):
        amplitude = float(np.median([abs(each.part.first) for each in behaviours]))
        unit = "m" if amplitude < _LARGEST_M else "mm"
        said = f"no unit in the header: {unit} by its amplitude of {amplitude:.3g}"
        return replace(column, unit=unit, remark=said)
    if column.name in FORCES:
        said = f"no unit in the header: if it is kN, write {column.column + ':kN'!r}"
        return replace(column, remark=said)
    return replace(column, remark="no unit in the header")


def _keeping_names(taken: set[str], running: Sequence[RecordingBehaviour]) -> Iterator[FoundColumn]:
    """Yield what carries the line in most runs and is no channel of the rig for sure."""
    names = sorted(
        {name for recording in running for name in recording.columns} - taken, key=words.natural
    )
    for name in names:
        held = [recording.columns[name] for recording in running if name in recording.columns]
        if (
            len(held) == len(running)
            and sum(behaviour.part.carried for behaviour in held) > len(held) / 2
        ):
            yield FoundColumn(name, name)
