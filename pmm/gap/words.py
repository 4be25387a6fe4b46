"""A conclusion in three plain sentences: what is wrong, how large it is, what to do next."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from analysis.gap.inference.answers import COEFFICIENTS, NONE, ODD_RUN, UNKNOWN
from pmm.gap.conclusion import EFFECT, Conclusion
from pmm.gap.sizes import HowLarge

_WITHIN: Final = "no coefficient is off by more than its uncertainty"
_PROBABLY: Final = 0.5
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
    conclusion: Conclusion, large: HowLarge, effect_sizes: Sequence[str], todo: Remedies
) -> tuple[str, str, str]:
    """Return the three sentences.

    Parameters
    ----------
    effect_sizes
        The sizes of the effects that are named, in their own units.
    """
    return (
        what_is_wrong(conclusion),
        how_large_it_is(conclusion, large, effect_sizes),
        what_to_do(conclusion, todo),
    )


def what_is_wrong(conclusion: Conclusion) -> str:
    """Return what separates rig and simulation, and how probable that is."""
    said = {
        NONE: _no_gap_text,
        COEFFICIENTS: _coefficients,
        ODD_RUN: _odd_run,
        UNKNOWN: _unknown_text,
        EFFECT: _effect,
    }
    return f"{said[conclusion.verdict](conclusion)}."


def _no_gap_text(conclusion: Conclusion) -> str:
    if conclusion.unexplained:
        return (
            f"Nothing that was considered explains the difference in {_steps(conclusion)}: that "
            f"there is no gap has probability {conclusion.probability:.2f}"
        )
    fitted = " once the coefficients are fitted" if conclusion.fitted else ""
    agree = f"rig and simulation agree{fitted} within what the recordings can tell"
    return f"No gap: {agree} (probability {conclusion.probability:.2f})"


def _coefficients(conclusion: Conclusion) -> str:
    remark = (
        f"; they do not explain the difference in {_steps(conclusion)}"
        if conclusion.unexplained
        else ""
    )
    missing = "No effect is missing: the coefficients are not those that the campaign states"
    return f"{missing} (probability {conclusion.probability:.2f}){remark}"


def _odd_run(conclusion: Conclusion) -> str:
    return (
        f"Run {conclusion.weighing.odd_run} alone is off, by a gain or a zero of its own "
        f"(probability {conclusion.probability:.2f})"
    )


def _unknown_text(conclusion: Conclusion) -> str:
    weighing = conclusion.weighing
    outside = OUTSIDE
    if weighing.restricted is not None:
        outside = f"something else than the {weighing.restricted} effects considered"
    where = f", most likely in the {weighing.stage}" if weighing.stage else ""
    near = f"; nearest, but not it: {joined(weighing.best)}" if weighing.best else ""
    return (
        f"{outside[0].upper()}{outside[1:]} separates rig and simulation "
        f"(probability {conclusion.probability:.2f}){where}{near}"
    )


def _effect(conclusion: Conclusion) -> str:
    weighing = conclusion.weighing
    titles = " and ".join(
        f"{weighing.titles.get(name, name)} ({name})" for name in conclusion.names
    )
    verb = "is" if len(conclusion.names) == 1 else "are"
    said = f"{titles} {verb} missing in the simulation"
    alike = [
        f"{' or '.join(twins)} would look the same as {effect} in these runs"
        for effect, twins in weighing.alike.items()
        if twins and effect in conclusion.names
    ]
    said = f"{said} (probability {conclusion.probability:.2f}), or whatever acts alike"
    return "; ".join([said, *alike])


def _steps(conclusion: Conclusion) -> str:
    return " and ".join(step.what for step in conclusion.unexplained)


def how_large_it_is(conclusion: Conclusion, large: HowLarge, effect_sizes: Sequence[str]) -> str:
    """Return how large the difference is, and by how much it puts a coefficient off."""
    sizes, worst = listed([size.sentence for size in large.sizes]), large.coefficient
    if conclusion.adds:
        put = f"it puts {worst.name} off by {worst.percentage}" if worst else _WITHIN
        return f"{'; '.join([f'It changes {sizes}', put, *effect_sizes])}."
    fitted = f"{worst.name} is fitted {worst.percentage} off what is stated" if worst else _WITHIN
    if conclusion.unexplained:
        why = ", whatever the reason" if worst else ""
        return f"Rig and simulation differ in {sizes}; {fitted}{why}."
    if conclusion.verdict == UNKNOWN:
        return f"They differ in {sizes}, little more than noise; {fitted}."
    return f"They differ in {sizes}, no more than noise; {fitted}."


def what_to_do(conclusion: Conclusion, todo: Remedies) -> str:
    """Return what to do next."""
    if todo.odd:
        return f"Withhold run {todo.odd}, which alone is off: --hold-out {todo.odd}."
    if conclusion.adds:
        add = 'put it into the simulation with "pmm gap add", and look again'
        if not todo.measures:
            return f"{add[0].upper()}{add[1:]}."
        return f"Tell what looks the same apart by {'; '.join(todo.measures)}; or {add}."
    make = f"make the run that tells most, {todo.run}" if todo.run else "record more kinds of runs"
    if conclusion.unexplained:
        return f"Look at what remains, below, and {make}."
    if conclusion.verdict == COEFFICIENTS:
        return "Put the fitted coefficients into the campaign file: to find them is what it is for."
    if conclusion.verdict == UNKNOWN:
        return f"{make[0].upper()}{make[1:]}, before any coefficient of this campaign is reported."
    return "Nothing has to be done: the coefficients of this campaign may be reported."


def joined(answer: str) -> str:
    """Return an answer as people read it: the effects of a pair with "and" between them."""
    return " and ".join(answer.split("+"))


def listed(parts: Sequence[str]) -> str:
    """Return parts of a sentence with commas between them, and "and" before the last."""
    *others, last = parts
    return f"{', '.join(others)} and {last}" if others else last


def something_besides(answer: str, share: float) -> Iterator[str]:
    """Yield a sentence where something unknown is probably there beside what is named."""
    if share > _PROBABLY:
        yield (
            f"beside {joined(answer)} there is something that the catalogue does not have "
            f"(probability {share:.2f}): another form of it, or something smaller"
        )
