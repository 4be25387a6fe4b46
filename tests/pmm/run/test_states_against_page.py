"""The page on run control shows the tables of states and faults that are in force."""

from collections.abc import Iterable
from pathlib import Path

import pytest

from pmm.run.states import FAULTS, STATES, Command, State

PAGE = (Path(__file__).parents[3] / "docs" / "run-control.md").read_text(encoding="utf-8")
REACTION_NAMES = ("refuse", "void gate", "profile stop", "quick stop", "end run")


def line(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def words(names: Iterable[str]) -> str:
    return ", ".join(names)


def rows_below(header: str) -> list[str]:
    """Return the rows of the table with a header."""
    below = PAGE.split(header + "\n", 1)[1].split("\n")
    assert set(below[0]) <= set("|-")
    return below[1 : below.index("")]


def state_line(state: State) -> str:
    row = STATES[state]
    commands = words(f"*{one}*" for one in Command if one in row.commands)
    return line(state, row.happens, row.ends, words(row.follows), commands)


def test_the_page_has_a_row_for_each_state() -> None:
    shown = rows_below("| state | what happens | ends when | followed by | commands |")
    assert shown == [state_line(state) for state in State]


def test_the_page_has_a_row_for_each_reaction() -> None:
    shown = rows_below("| a fault asks for | the rig | run control | leads to |")
    expected = []
    for name, (reaction, row) in zip(REACTION_NAMES, FAULTS.items(), strict=True):
        assert reaction.name.lower().replace("_", " ") == name
        within = words(one for one in State if one in row.within)
        where = "" if row.within == frozenset(State) else f", from {within}"
        own = ", own command only" if row.own_only else ""
        expected.append(line(name, row.rig, row.control, f"{row.leads_to}{where}{own}"))
    assert shown == expected


@pytest.mark.parametrize("state", State)
def test_no_state_lists_what_every_state_has(state: State) -> None:
    assert State.FAULT not in STATES[state].follows
    assert Command.QUICK_STOP not in STATES[state].commands
