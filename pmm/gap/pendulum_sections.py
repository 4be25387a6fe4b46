"""The sections of a pendulum's diagnosis, the same ones for the terminal and for the page."""

from collections.abc import Iterator
from typing import Final

from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.hypothesis import Hypothesis
from analysis.gap.pendulum.verdict import told_apart
from analysis.gap.pendulum.withheld import Foretold
from pmm.gap.pendulum_document import classes, parameters, ranking
from pmm.report.table import Section, Table

_SHOWN = 6  # proposals


WHERE: Final = "Where"
WHICH: Final = "Which"
HOW_FAR: Final = "How far"
RECORDS: Final = "Records"

_E: Final = (
    "E is measured minus simulated, u its standard uncertainty, in windows of whole swings: "
    "amplitude (decay), phase (period), mean, third harmonic. E/u is their ratio, root mean "
    "square: 1 is noise alone. As stated, the releases alone are fitted; what is known within "
    "tolerances is fitted too after that."
)
_LAWS: Final = (
    "Each law beside what else the answer holds. One is told from the best only if the whole "
    "record prefers the best by a factor of 20, and the other foretells no withheld swings better "
    "by more than 0.2 u. ln evidence ratio: the natural logarithm of by how much the record "
    "prefers the best; 3 is a factor of 20."
)


def sections(found: Diagnosis) -> Iterator[Section]:
    """Yield what there is to show, in the order in which it is read."""
    yield Section(WHERE, (_E,), (where_rows(found),))
    shown = (answer_rows(found), class_rows(found), alternative_rows(found))
    yield Section(WHICH, ("Answers by their probability.",), shown)
    if found.laws:
        yield Section("Laws of damping", (_LAWS,), (law_rows(found),))
    if found.regimes:
        line = "Swings that were not fitted to: the gap in u, and by how much an answer shrinks it."
        yield Section(HOW_FAR, (line,), tuple(regime_rows(found)))
    yield Section(RECORDS)
    yield _remains(found)
    if found.proposals and found.rivals is not None:
        one, other = (" + ".join(rival.names) for rival in found.rivals)
        line = (
            "Records that a further test can make, by the ln evidence that the right one of two "
            f"answers is expected to gain at least, whichever is right: {one}, or {other}."
        )
        yield Section("Next", (line,), (next_rows(found),))


def _remains(found: Diagnosis) -> Section:
    rows = tuple(
        (one.kind, "gap" if one.beyond else "no gap", f"{one.after:.2f}") for one in found.where
    )
    wide = found.verdict.inflation
    line = (
        f"All evidence is weakened by {wide:.2f}, the chi-square per degree of freedom that the "
        "search's best fit leaves."
    )
    table = Table("Remainder", ("where", "verdict", "E/u"), rows, 2)
    return Section("What remains", (line,) if wide > 1.0 else (), (table,))


def where_rows(found: Diagnosis) -> Table:
    """Return the gap by kind of observable."""
    rows = tuple(
        (one.kind, f"{one.stated:.2f}", f"{one.before:.2f}", f"{one.after:.2f}")
        for one in found.where
    )
    headings = ("where", "as stated [u]", "tolerances fitted [u]", "with the answer [u]")
    return Table("Where", headings, rows)


def answer_rows(found: Diagnosis) -> Table:
    """Return the answers with their parameters and probabilities."""
    sets = {" and ".join(names): one for names, one in found.searched.sets.items() if names}
    sets[" and ".join(found.best.names)] = found.settled.best
    rows = tuple(
        (name, fitted(sets[name]) if sets.get(name) else "", percent(share))
        for name, share in ranking(found.verdict)
    )
    return Table("Answers", ("answer", "parameters (u)", "probability"), rows, 2)


def fitted(one: Hypothesis) -> str:
    """Return a set's parameters with their standard uncertainties."""
    return "; ".join(
        f"{name}: {key} = {value['value']:.4g} ± {value['uncertainty']:.2g}"
        for name, rows in parameters(one).items()
        for key, value in rows.items()
    )


def class_rows(found: Diagnosis) -> Table:
    """Return classes and single causes with their probabilities."""
    rows = tuple((name, percent(share)) for name, share in classes(found.verdict))
    return Table("Classes and causes", ("class, or cause in any set", "probability"), rows)


def law_rows(found: Diagnosis) -> Table:
    """Return the laws of damping beside what else the best set holds."""
    headings = ("law of damping", "ln evidence ratio", "withheld gap [u]", "told apart")
    return Table("Laws of damping", headings, tuple(_laws(found)))


def _laws(found: Diagnosis) -> Iterator[tuple[str, ...]]:
    for at, law in enumerate(found.laws):
        apart = "yes" if told_apart(found.laws[0], law) else "no"
        left = ", ".join(f"{gap:.1f}" for gap in law.withheld)
        yield law.name, f"{law.log_ratio:.1f}", left, apart if at else ""


def alternative_rows(found: Diagnosis) -> Table:
    """Return what could stand in the place of each cause."""
    rows = tuple((one.instead_of, one.name, f"{one.log_ratio:.1f}") for one in found.alternatives)
    return Table("Alternatives", ("in place of", "could be", "ln evidence ratio"), rows, 2)


def regime_rows(found: Diagnosis) -> Iterator[Table]:
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
        yield Table(title, (title, "gap [u]", "shrinks by", "95 %"), rows)


def _asked(one: Foretold, found: Diagnosis) -> str:
    control = "wrong cause: " if one.causes == found.control and one.causes else ""
    return control + (", ".join(one.causes) or "no cause")


def next_rows(found: Diagnosis) -> Table:
    """Return the proposed runs, best first."""
    rows = tuple((one.what, f"{one.gain:.1f}") for one in found.proposals[:_SHOWN])
    return Table("Next", ("next run", "expected ln evidence"), rows)


def percent(share: float) -> str:
    """Return a share as people read it."""
    return f"{100.0 * share:z.1f} %"
