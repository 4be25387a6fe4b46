"""Which column is which channel: all roles together, by what the columns do, with their odds.

Each column gets the odds of each role from its unit, from what it does and from its name, as powers
of ten that add up. The roles are then given out together so that the sum is largest. How sure one
is, is by how much the sum falls when that column must not have it.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.channels import (
    CARRIAGE_SPEED,
    COMMAND_AFT,
    DISPLACEMENT_AFT,
    FORCE_AFT,
    FORCE_X,
    HEEL_ANGLE,
    POSITION_AFT,
    PROPELLER_THRUST,
    PROPELLER_TORQUE,
    REVOLUTIONS,
    ROLL_MOMENT,
    RUDDER_ANGLE,
    RUDDER_NORMAL_FORCE,
    SHAFT_ANGLE,
)
from pmm.start import words
from pmm.start.behaviour import Behaviour, RecordingBehaviour
from pmm.start.found_campaign import CHANNELS

# Powers of ten of odds, judged and tried on made-up laboratories
# (tests/pmm/start/test_roles_against_made_up_laboratories.py counts what they get wrong).
SURE: Final = 2.0  # 100 to 1
_UNIT: Final = 2.0  # the header's unit is that of the role
_NAME: Final = 1.0  # the name has a word of the role; or, taken off, of another one only
_DOES: Final = 1.0  # it does what such a sensor does, but for what others do as well
_AGAINST: Final = -3.0  # it does, or is called, what no such sensor is
_OTHER_STRUT: Final = 0.25  # relative, between the struts' amplitudes: both have one eccentricity
_CLEAN: Final = 1.5  # powers of ten below all: what is beside a driven motion, at most
_EVEN: Final = 0.2  # of its mean: a carriage's speed keeps within
_SWINGS: Final = 0.5  # share of the variance in the line: what oscillates is no carriage's speed


class RoleEvidence(NamedTuple):
    """One reason for or against a role, with its power of ten."""

    odds: float
    reason: str


@dataclass(frozen=True)
class ChannelKind:
    """A kind of channel: what it is called, its SI units and the words of it; ``places`` of it."""

    name: str
    units: tuple[str, ...]
    words: Sequence[str]
    places: int = 1


DISPLACEMENT: Final = ChannelKind("displacement", (DISPLACEMENT_AFT.unit,), words.DISPLACEMENT, 2)
FORCE: Final = ChannelKind("force", (FORCE_AFT.unit,), words.FORCE, 2)
ANGLE: Final = ChannelKind(SHAFT_ANGLE.name, (SHAFT_ANGLE.unit,), words.ANGLE)
SPEED: Final = ChannelKind(CARRIAGE_SPEED.name, (CARRIAGE_SPEED.unit,), words.SPEED)
ALONG: Final = ChannelKind(FORCE_X.name, (FORCE_X.unit,), words.ALONG)
PULSES: Final = ChannelKind("photocell", ("V", "1"), words.PULSES)
POSITION: Final = ChannelKind("position", (POSITION_AFT.unit,), words.SINKAGE, 2)
COMMAND: Final = ChannelKind("command", (COMMAND_AFT.unit,), words.COMMAND, 2)
# What the model has of its own does nothing that tells it, and a command does what the strut does:
# they are known by name and unit alone.
BY_NAME: Final = (
    COMMAND,
    ChannelKind(RUDDER_ANGLE.name, (RUDDER_ANGLE.unit,), words.RUDDER),
    ChannelKind(RUDDER_NORMAL_FORCE.name, (RUDDER_NORMAL_FORCE.unit,), words.RUDDER),
    ChannelKind(PROPELLER_THRUST.name, (PROPELLER_THRUST.unit,), words.THRUST),
    ChannelKind(PROPELLER_TORQUE.name, (PROPELLER_TORQUE.unit,), words.TORQUE),
    ChannelKind(REVOLUTIONS.name, (REVOLUTIONS.unit, "rad/s"), words.REVOLUTIONS),
    ChannelKind(ROLL_MOMENT.name, (ROLL_MOMENT.unit,), words.ROLL_MOMENT),
    ChannelKind(HEEL_ANGLE.name, (HEEL_ANGLE.unit,), words.HEEL),
    POSITION,
)
KINDS: Final = (DISPLACEMENT, FORCE, ANGLE, SPEED, ALONG, PULSES, *BY_NAME)
_NAMED: Final = tuple(word for kind in BY_NAME for word in kind.words)


@dataclass(frozen=True)
class ColumnRole:
    """A column that seems to be of a kind; ``doubt`` says why it may not be, empty where sure."""

    column: str
    kind: ChannelKind
    odds: float
    doubt: str = ""


def find_roles(watched: Sequence[RecordingBehaviour]) -> list[ColumnRole]:
    """Return the columns that seem to be channels of a rig, by kind and then by name.

    Parameters
    ----------
    watched
        One for each recording; those in which nothing keeps time say nothing.
    """
    telling = [recording for recording in watched if recording.line is not None]
    if not telling:
        return []
    columns = sorted(
        {name for recording in telling for name in recording.columns}, key=words.natural
    )
    reasons = {
        (column, kind): list(_reasons(column, kind, telling))
        for column in columns
        for kind in KINDS
    }
    odds = np.array(
        [[sum(r.odds for r in reasons[column, kind]) for kind in KINDS] for column in columns]
    )
    best = _given_out(odds)
    roles = []
    for row, at in sorted(best.items(), key=lambda pair: (pair[1], pair[0])):
        without = odds.copy()
        without[row, at] = -np.inf
        second = _given_out(without)
        margin = _total(odds, best) - _total(odds, second)
        column, kind = columns[row], KINDS[at]
        doubt = ""
        if margin < SURE:
            instead = [columns[r] for r, k in second.items() if k == at and best.get(r) != at]
            doubt = _doubt(reasons[column, kind], instead)
        roles.append(ColumnRole(column, kind, margin, doubt))
    return roles


def _given_out(odds: FloatArray) -> dict[int, int]:
    """Return the kind of each row that gets one, so that the sum of what they have is largest."""
    from scipy.optimize import linear_sum_assignment

    places = np.repeat(np.arange(len(KINDS)), [kind.places for kind in KINDS])
    worth = np.maximum(odds[:, places], 0.0)
    rows, chosen = linear_sum_assignment(worth, maximize=True)
    return {
        int(row): int(places[place])
        for row, place in zip(rows, chosen, strict=True)
        if worth[row, place] > 0.0
    }


def _total(odds: FloatArray, choice: Mapping[int, int]) -> float:
    return float(sum(odds[row, kind] for row, kind in choice.items()))


def _doubt(reasons: Sequence[RoleEvidence], instead: Sequence[str]) -> str:
    if instead:
        return f"{' and '.join(instead)} may be it as well"
    against = [reason.reason for reason in reasons if reason.odds < 0.0]
    return "; ".join(against) or "nothing but " + " and ".join(
        reason.reason for reason in reasons if reason.odds > 0.0
    )


def _reasons(
    column: str, kind: ChannelKind, telling: Sequence[RecordingBehaviour]
) -> Iterator[RoleEvidence]:
    """Yield what speaks for a role and against it; what a column does, in most recordings."""
    pairs = [
        (recording, recording.columns[column])
        for recording in telling
        if column in recording.columns
    ]
    if len(pairs) < len(telling):
        yield RoleEvidence(_AGAINST, "it is not in every recording")
    unit = pairs[0][1].unit
    if unit not in ("", *kind.units):
        yield RoleEvidence(-np.inf, f"it is in {unit}")
    elif unit and kind is not PULSES:
        yield RoleEvidence(_UNIT, f"its unit is {unit}")
    yield from _of_name(column, kind, telling)
    if kind in BY_NAME:
        return
    evidence = [list(_DOING[kind.name](behaviour, watch)) for watch, behaviour in pairs]
    yield from sorted(evidence, key=lambda reasons: sum(e.odds for e in reasons))[
        (len(evidence) - 1) // 2
    ]


def _of_name(
    column: str, kind: ChannelKind, telling: Sequence[RecordingBehaviour]
) -> Iterator[RoleEvidence]:
    if column in CHANNELS:  # our own name says it, and no other
        is_own = column.startswith(kind.name) and (column == FORCE_X.name) == (kind is ALONG)
        yield RoleEvidence(SURE if is_own else -np.inf, "its name is that of the channel")
        return
    if kind in BY_NAME:
        says = words.says(column, kind.words)
        yield RoleEvidence(_NAME if says else -np.inf, "its name")
        return
    if words.says(column, _NAMED):
        yield RoleEvidence(_AGAINST, "it is called as a command, or as the model's own")
    if words.says(column, words.OTHERS):
        yield RoleEvidence(_AGAINST, "it is called as what is no part of the oscillator")
    if words.says(column, kind.words):
        yield RoleEvidence(_NAME, "its name")
    elif any(words.says(column, other_kind.words) for other_kind in KINDS):
        yield RoleEvidence(-_NAME, "its name is that of something else")
    axes = {words.axis_of(name) for recording in telling for name in recording.columns} - {""}
    if kind in (FORCE, ALONG) and words.axis_of(column) and len(axes) > 1:
        named = ", ".join(sorted(axes))
        yield RoleEvidence(
            _AGAINST, f"it is one of a balance's axes ({named}), not of a strut's gauge"
        )


def _displacement(behaviour: Behaviour, watch: RecordingBehaviour) -> Iterator[RoleEvidence]:
    if not behaviour.part.carried or behaviour.turn:
        yield RoleEvidence(-np.inf, "it does not move at the line")
        return
    clean = float(np.clip(-np.log10(max(behaviour.part.residual, 1e-12)) - _CLEAN, -1.0, 1.0))
    yield RoleEvidence(
        _DOES * clean, f"{100.0 * behaviour.part.residual:.2g} % of it is beside the line"
    )
    like = [
        motion
        for motion in watch.columns.values()
        if motion.unit == behaviour.unit and motion.part.carried
    ]
    driver = min(like, key=lambda motion: motion.part.residual)
    apart = abs(behaviour.part.first) / max(abs(driver.part.first), 1e-300)
    if not 1.0 - _OTHER_STRUT < apart < 1.0 / (1.0 - _OTHER_STRUT):
        yield RoleEvidence(
            _AGAINST, f"its amplitude is {apart:.2g} times that of the cleanest motion"
        )


def _force(behaviour: Behaviour, _: RecordingBehaviour) -> Iterator[RoleEvidence]:
    if behaviour.part.carried:
        yield RoleEvidence(_DOES, "it answers at the line")
    else:
        yield RoleEvidence(_AGAINST, "it does not answer at the line")


def _angle(behaviour: Behaviour, _: RecordingBehaviour) -> Iterator[RoleEvidence]:
    if behaviour.turn is None:
        yield RoleEvidence(-np.inf, "it does not turn once in each period")
        return
    yield RoleEvidence(1.5 * _DOES, "it rises by one turn in each period")
    if behaviour.turn.wraps:
        yield RoleEvidence(_DOES, "it begins anew after each turn")


def _speed(behaviour: Behaviour, _: RecordingBehaviour) -> Iterator[RoleEvidence]:
    if behaviour.part.carried and behaviour.part.residual < _SWINGS:
        yield RoleEvidence(_AGAINST, "it swings with the line")
    elif behaviour.spread <= _EVEN * abs(behaviour.mean):
        yield RoleEvidence(_DOES, "it is even")


def _surge_force(_one: Behaviour, _watch: RecordingBehaviour) -> Iterator[RoleEvidence]:
    yield RoleEvidence(-_NAME, "few rigs have a gauge along the model")


def _pulses(behaviour: Behaviour, _: RecordingBehaviour) -> Iterator[RoleEvidence]:
    odds = 3.0 * _DOES if behaviour.pulses else -np.inf
    yield RoleEvidence(odds, "it has one pulse in each period")


_DOING: Final[Mapping[str, Callable[[Behaviour, RecordingBehaviour], Iterator[RoleEvidence]]]] = {
    DISPLACEMENT.name: _displacement,
    FORCE.name: _force,
    ANGLE.name: _angle,
    SPEED.name: _speed,
    ALONG.name: _surge_force,
    PULSES.name: _pulses,
}
