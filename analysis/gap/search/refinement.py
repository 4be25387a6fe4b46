"""Improve a fit through the simulator, by damped Gauss-Newton steps."""

from analysis.gap.forward.problem import Compared
from analysis.gap.search.fit import Fit, at, linear_cost, most_probable, moved
from hardware.description.errors import PmmError

_STEPS = 6
_STEPS_IN_TIME = 5  # for what has to be simulated in time, a hundred times as costly
_FULFILLED = 0.5  # share of a step's promise below which slopes are found anew
_SETTLED = 0.05  # change of the log posterior at which a fit ends


def refine(problem: Compared, fit: Fit) -> Fit:
    """Improve a fit by damped Gauss-Newton steps through the simulator.

    The slopes are kept as long as a step brings most of what they promise, and for what does not
    repeat with the shaft to the end.
    """
    best, stale = fit, False
    for _ in range(_STEPS if fit.repeats else _STEPS_IN_TIME):
        better, fulfilled = _step(problem, best)
        if better is None:
            if not stale:
                break
            best, stale = _anew(problem, best), False
            continue
        gain, best, stale = best.cost - better.cost, better, True
        if gain < _SETTLED:
            break
        if fulfilled < _FULFILLED:
            best, stale = _anew(problem, best), False
    return _anew(problem, best) if stale and fit.repeats else best


def _anew(problem: Compared, fit: Fit) -> Fit:
    """Return a fit with slopes found where it is; as it is where nothing can be simulated aside."""
    try:
        return at(problem, fit.candidates, fit.units)
    except PmmError:
        return fit


def stepped(problem: Compared, fit: Fit, steps: int) -> Fit:
    """Return a fit after some steps with the slopes that it has; itself if none betters it."""
    best = fit
    for _ in range(steps):
        better, _ = _step(problem, best)
        if better is None or best.cost - better.cost < _SETTLED:
            return best if better is None else better
        best = better
    return best


def _step(problem: Compared, fit: Fit) -> tuple[Fit | None, float]:
    """Return a better fit along the Gauss-Newton step, and how much of its promise it keeps."""
    towards = most_probable(fit) - fit.units
    promise = fit.cost - linear_cost(problem, fit, fit.units + towards)
    for share in (1.0, 0.4, 0.1, 0.02):
        units = fit.units + share * towards
        try:
            better = moved(problem, fit, units)
        except PmmError:
            continue
        if better.cost < fit.cost:
            return better, (fit.cost - better.cost) / max(promise, 1e-9)
    return None, 0.0
