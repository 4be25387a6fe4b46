"""A conclusion in three plain sentences: what is wrong, how large it is, what to do next."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from analysis.gap.inference.answers import COEFFICIENTS, NONE, ODD_RUN, UNKNOWN
from pmm.gap.conclusion import EFFECT, Conclusion
from pmm.gap.sizes import HowLarge

_WITHIN: Final = "no coefficient is off by more than its uncertainty"
OUTSIDE: Final = "something that the catalogue does not have"


@dataclass(frozen=True)
class Remedies:
    """What can be done about a gap.

    Attributes
    ----------
    odd
        The run that alone is off; ``""`` where there is none.
    measures
        What would tell the effects apart that these runs cannot.
    run
        The run that is expected to tell most; ``""`` where none is proposed.
    """

    odd: str = ""
    measures: tuple[str, ...] = ()
    run: str = ""


def sentences(
    found: Conclusion, large: HowLarge, own: Sequence[str], todo: Remedies
) -> tuple[str, str, str]:
    """Return the three sentences.

    Parameters
    ----------
    own
        The sizes of the effects that are named, in their own units.
    """
    return what_is_wrong(found), how_large_it_is(found, large, own), what_to_do(found, todo)


def what_is_wrong(found: Conclusion) -> str:
    """Return what separates rig and simulation, and how probable that is."""
    said = {
        NONE: _none,
        COEFFICIENTS: _coefficients,
        ODD_RUN: _odd_run,
        UNKNOWN: _unknown,
        EFFECT: _effect,
    }
    return f"{said[found.verdict](found)}."


def _none(found: Conclusion) -> str:
    if found.unexplained:
        return (
            f"Nothing that was considered explains the difference in {_steps(found)}: that there "
            f"is no gap has probability {found.probability:.2f}"
        )
    fitted = " once the coefficients are fitted" if found.fitted else ""
    agree = f"rig and simulation agree{fitted} within what the recordings can tell"
    return f"No gap: {agree} (probability {found.probability:.2f})"


def _coefficients(found: Conclusion) -> str:
    left = f"; they do not explain the difference in {_steps(found)}" if found.unexplained else ""
    missing = "No effect is missing: the coefficients are not those that the campaign states"
    return f"{missing} (probability {found.probability:.2f}){left}"


def _odd_run(found: Conclusion) -> str:
    return (
        f"Run {found.weighing.odd_run} alone is off, by a gain or a zero of its own "
        f"(probability {found.probability:.2f})"
    )


def _unknown(found: Conclusion) -> str:
    given = found.weighing
    outside = OUTSIDE
    if given.restricted is not None:
        outside = f"something else than the {given.restricted} effects considered"
    where = f", most likely in the {given.stage}" if given.stage else ""
    near = f"; nearest, but not it: {joined(given.best)}" if given.best else ""
    return (
        f"{outside[0].upper()}{outside[1:]} separates rig and simulation "
        f"(probability {found.probability:.2f}){where}{near}"
    )


def _effect(found: Conclusion) -> str:
    given = found.weighing
    what = " and ".join(f"{given.titles.get(one, one)} ({one})" for one in found.names)
    verb = "is" if len(found.names) == 1 else "are"
    said = f"{what} {verb} missing in the simulation"
    alike = [
        f"{' or '.join(others)} would look the same as {own} in these runs"
        for own, others in given.alike.items()
        if others and own in found.names
    ]
    said = f"{said} (probability {found.probability:.2f}), or whatever acts alike"
    return "; ".join([said, *alike])


def _steps(found: Conclusion) -> str:
    return " and ".join(one.what for one in found.unexplained)


def how_large_it_is(found: Conclusion, large: HowLarge, own: Sequence[str]) -> str:
    """Return how large the difference is, and by how much it puts a coefficient off."""
    sizes, worst = " and ".join(one.said for one in large.sizes), large.coefficient
    if found.adds:
        put = f"it puts {worst.name} off by {worst.said}" if worst else _WITHIN
        return f"{'; '.join([f'It changes {sizes}', put, *own])}."
    fitted = f"{worst.name} is fitted {worst.said} off what is stated" if worst else _WITHIN
    if found.unexplained:
        why = ", whatever the reason" if worst else ""
        return f"Rig and simulation differ in {sizes}; {fitted}{why}."
    return f"They differ in {sizes}, no more than noise; {fitted}."


def what_to_do(found: Conclusion, todo: Remedies) -> str:
    """Return what to do next."""
    if todo.odd:
        return f"Withhold run {todo.odd}, which alone is off: --hold-out {todo.odd}."
    if found.adds:
        add = 'put it into the simulation with "pmm gap add", and look again'
        if not todo.measures:
            return f"{add[0].upper()}{add[1:]}."
        return f"Tell what looks the same apart by {'; '.join(todo.measures)}; or {add}."
    make = f"make the run that tells most, {todo.run}" if todo.run else "record more kinds of runs"
    if found.unexplained:
        return f"Look at what remains, below, and {make}."
    if found.verdict == COEFFICIENTS:
        return "Put the fitted coefficients into the campaign file: to find them is what it is for."
    return "Nothing has to be done: the coefficients of this campaign may be reported."


def joined(answer: str) -> str:
    """Return an answer as people read it: the effects of a pair with "and" between them."""
    return " and ".join(answer.split("+"))
