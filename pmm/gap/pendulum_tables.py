"""A pendulum's diagnosis as tables, the same ones for the terminal and for the page."""

from collections.abc import Iterator
from dataclasses import dataclass

from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.hypothesis import Hypothesis
from analysis.gap.pendulum.verdict import told_apart
from analysis.gap.pendulum.withheld import Foretold
from pmm.gap.pendulum_document import classes, parameters, ranking

_SHOWN = 6  # proposals


@dataclass(frozen=True)
class Rows:
    """One table: its first column and ``words - 1`` more are texts, the others numbers."""

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: int = 1


def tables(found: Diagnosis) -> Iterator[Rows]:
    """Yield all of them but the answers' own, in the order in which they are read."""
    yield class_rows(found)
    yield where_rows(found)
    yield law_rows(found)
    yield alternative_rows(found)
    yield from regime_rows(found)
    yield next_rows(found)


def where_rows(found: Diagnosis) -> Rows:
    """Return the gap by kind of observable."""
    rows = tuple(
        (one.kind, f"{one.stated:.2f}", f"{one.before:.2f}", f"{one.after:.2f}")
        for one in found.where
    )
    headings = ("where", "as stated [u]", "tolerances fitted [u]", "with the answer [u]")
    return Rows("Where", headings, rows)


def answer_rows(found: Diagnosis) -> Rows:
    """Return the answers with their parameters and probabilities."""
    sets = {" and ".join(names): one for names, one in found.searched.sets.items() if names}
    sets[" and ".join(found.best.names)] = found.settled.best
    rows = tuple(
        (name, fitted(sets[name]) if sets.get(name) else "", percent(share))
        for name, share in ranking(found.verdict)
    )
    return Rows("Answers", ("answer", "parameters (u)", "probability"), rows, 2)


def fitted(one: Hypothesis) -> str:
    """Return a set's parameters with their standard uncertainties."""
    return "; ".join(
        f"{name}: {key} = {value['value']:.4g} ± {value['uncertainty']:.2g}"
        for name, rows in parameters(one).items()
        for key, value in rows.items()
    )


def class_rows(found: Diagnosis) -> Rows:
    """Return classes and single causes with their probabilities."""
    rows = tuple((name, percent(share)) for name, share in classes(found.verdict))
    return Rows("Classes and causes", ("class, or cause in any set", "probability"), rows)


def law_rows(found: Diagnosis) -> Rows:
    """Return the laws of damping beside what else the best set holds."""
    headings = ("law of damping", "ln evidence ratio", "withheld gap [u]", "told apart")
    return Rows("Laws of damping", headings, tuple(_laws(found)))


def _laws(found: Diagnosis) -> Iterator[tuple[str, ...]]:
    for at, law in enumerate(found.laws):
        apart = "yes" if told_apart(found.laws[0], law) else "no"
        left = ", ".join(f"{gap:.1f}" for gap in law.withheld)
        yield law.name, f"{law.log_ratio:.1f}", left, apart if at else ""


def alternative_rows(found: Diagnosis) -> Rows:
    """Return what could stand in the place of each cause."""
    rows = tuple((one.instead_of, one.name, f"{one.log_ratio:.1f}") for one in found.alternatives)
    return Rows("Alternatives", ("in place of", "could be", "ln evidence ratio"), rows, 2)


def regime_rows(found: Diagnosis) -> Iterator[Rows]:
    """Yield, for each withheld regime, what each set of causes leaves of its gap."""
    for regime in found.regimes:
        rows = tuple(
            (
                _asked(one, found),
                f"{one.gap:.1f}",
                percent(one.shrinkage),
                f"{percent(one.low)} to {percent(one.high)}",
            )
            for one in (regime.before, *regime.foretold)
        )
        title = f"withheld: {regime.name}"
        yield Rows(title, (title, "gap [u]", "shrinks by", "95 %"), rows)


def _asked(one: Foretold, found: Diagnosis) -> str:
    control = "wrong cause: " if one.causes == found.control and one.causes else ""
    return control + (", ".join(one.causes) or "no cause")


def next_rows(found: Diagnosis) -> Rows:
    """Return the proposed runs, best first."""
    rows = tuple((one.what, f"{one.gain:.1f}") for one in found.proposals[:_SHOWN])
    return Rows("Next", ("next run", "expected ln evidence"), rows)


def percent(share: float) -> str:
    """Return a share as people read it."""
    return f"{100.0 * share:z.1f} %"
