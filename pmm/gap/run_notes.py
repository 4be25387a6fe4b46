"""What is said of single runs that are used: one that alone is off, and those cut short."""

from collections.abc import Iterator

from analysis.gap.odd_run import odd_run
from analysis.gap.withheld import gap_of
from pmm.gap.cells import remains
from pmm.gap.examine import Examined


def run_notes(examined: Examined) -> Iterator[str]:
    """Yield notes about single runs."""
    yield from _odd(examined)
    yield from _not_foretold(examined)
    for name, said in examined.ready.cut_short.items():
        yield f"run {name}: {said}"


def _odd(examined: Examined) -> Iterator[str]:
    """Yield the run that alone is off, unless the cause that is named explains it too.

    An effect may show beyond noise in the one run that drives it hardest.
    """
    if not any(one.beyond for one in remains(examined)):
        return
    looked = examined.diagnosis.weighed.looked
    fits = [one.fit for one in looked if one.fit is not None]
    found = odd_run(examined.diagnosis.problem, fits)
    if found is not None:
        named = " and ".join(found.beside)
        rest = f"{named} explains the others" if named else "the others show no gap beyond u"
        yield (
            f"run {found.name} alone is off: without it {rest} (it leaves "
            f"{found.rms:.3g} u); a bad run? withhold it with --hold-out {found.name}"
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
