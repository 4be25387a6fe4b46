"""A chain's periodic steady state stage by stage, each stage solved once for the same input.

A diagnosis asks for the same run some hundred times, and most effects change one stage only: those
before it need not be solved again.
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

from sim.periodic import SteadyState, steady_of
from sim.solve.period import Period, Spectra
from sim.stage import Stage

if TYPE_CHECKING:
    from hardware.description.arrays import ComplexArray

_MOST: Final = 4096  # results that are kept: some 10 kB each


class Solved:
    """Stages that were solved, with what they were fed and what came out.

    A copy in another process begins empty.
    """

    def __init__(self) -> None:
        self._known: dict[Any, tuple[Spectra, Period, Spectra]] = {}

    def __reduce__(self) -> tuple[type["Solved"], tuple[()]]:
        """Leave what was solved behind."""
        return Solved, ()

    def steady_state(self, stages: Iterable[Stage[Any]], period: Period) -> SteadyState:
        """Return the steady state of a chain without inputs; see :mod:`sim.periodic`."""
        spectra: dict[str, ComplexArray] = {}
        for stage in stages:
            fed = {signal.name: spectra[signal.name] for signal in stage.reads}
            period, written = self._stage(stage, period, fed)
            spectra |= written
        return SteadyState(period, spectra)

    def _stage(self, stage: Any, period: Period, fed: Spectra) -> tuple[Period, Spectra]:
        # The arrays of one result are fed on as they are, so their identity tells them.
        key = (stage, period, *(id(array) for array in fed.values()))
        try:
            solution = self._known.get(key)
        except TypeError:  # a stage that holds an array has no hash
            return steady_of(stage, period, fed)
        if solution is None:
            if len(self._known) >= _MOST:
                self._known.clear()
            solution = (fed, *steady_of(stage, period, fed))
            self._known[key] = solution
        return solution[1], solution[2]
