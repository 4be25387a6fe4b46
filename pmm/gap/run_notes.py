"""What is said of single runs that are used: one that alone is off, and those cut short."""

from collections.abc import Iterator

from analysis.gap.odd_run import odd_run
from analysis.gap.withheld import gap_of
from pmm.gap.cells import remains
from pmm.gap.examine import Examined


def run_notes(examined: Examined) -> Iterator[str]:
    """Yield notes about single runs, but the odd one."""
    yield from _not_foretold(examined)
    for name, said in examined.ready.cut_short.items():
        yield f"run {name}: {said}"


def odd_note(examined: Examined) -> str | None:
    """Return what is said of the run that alone is off, unless the cause explains it too.

    An effect may show beyond noise in the one run that drives it hardest.
    """
    if not any(one.beyond for one in remains(examined)):
        return None
    looked = examined.diagnosis.weighed.looked
    fits = [one.fit for one in looked if one.fit is not None]
    found = odd_run(examined.diagnosis.problem, fits)
    if found is None:
        return None
    named = " and ".join(found.beside)
    rest = f"{named} explains the others" if named else "the others show no gap beyond u"
    return (
        f"run {found.name} alone is off: without it {rest} (it leaves {found.rms:.3g} u); a bad "
        f"run? withhold it with --hold-out {found.name}"
    )


def _not_foretold(examined: Examined) -> Iterator[str]:
    """Yield the only run that was withheld, where the cause that is named leaves much of it."""
    judged, cause = examined.judged, examined.diagnosis.cause
    if cause is None or len(judged.cured) != 1 or not judged.chosen:
        return
    before, left = (gap_of(one.left) for one in (judged.plain[0], judged.cured[0]))
    if left > max(1.0, 0.5 * before):
        yield (
            f"{judged.cured[0].regime} is not foretold: {' and '.join(cause.names)} leaves "
            f"{left:.3g} u of it; it may itself be off, or the cause be another one: withhold more "
            "runs to tell"
        )
