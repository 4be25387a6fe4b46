"""What is said of single runs that are used: one that alone is off, and those cut short."""

from collections.abc import Iterator

from analysis.gap.odd_run import odd_run
from pmm.gap.cells import remains
from pmm.gap.examine import Examined


def run_notes(examined: Examined) -> Iterator[str]:
    """Yield notes about single runs."""
    yield from _odd(examined)
    for name, said in examined.ready.cut_short.items():
        yield f"run {name}: {said}"


def _odd(examined: Examined) -> Iterator[str]:
    """Yield the run that alone is off, unless the cause that is named explains it too.

    An effect may show beyond noise in the one run that drives it hardest.
    """
    if not any(one.beyond for one in remains(examined)):
        return
    found = odd_run(examined.diagnosis.problem)
    if found is not None:
        yield (
            f"run {found.name} alone is off: without it the others show no gap beyond u (it leaves "
            f"{found.rms:.3g} u); a bad run? withhold it with --hold-out {found.name}"
        )
