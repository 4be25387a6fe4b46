"""Whether runs belong together, and which coefficients they can tell; what is missing, by name."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np

from analysis.coefficients.names import Form, Place
from analysis.coefficients.phasors import ComplexArray
from analysis.coefficients.run import Run
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium

_SAME_FREQUENCY = 5e-3
_SAME_SPEED = 1e-2
ALONE = 1e-2  # of the other motion: less may be left out
_APART = 2e-2  # ratio of singular values above which two motions can be told apart


def check_together(runs: Sequence[Run]) -> None:
    """Refuse runs that cannot be solved together.

    Raises
    ------
    ConfigurationError
        Naming every run and what does not fit.
    """
    if not runs:
        raise ConfigurationError("no run was given; one or more are needed")
    twice = [name for name, count in Counter(run.name for run in runs).items() if count > 1]
    faults = [f"two runs are called {name!r}; rename one" for name in twice]
    for run in runs:
        faults += [*_unfit(run), *_differences(run, runs[0])]
    if faults:
        raise ConfigurationError("the runs do not belong together: " + "; ".join(faults))


def _unfit(run: Run) -> Iterator[str]:
    if run.order < 1:
        yield f"{run.name} holds the mean; take a harmonic"
    if run.medium is not Medium.WATER:
        yield f"{run.name} was run in air; take it off as a dry run"
    if not np.isfinite(run.phasors.values).all():
        yield f"{run.name} has values that are not finite; leave the run out"
    if not np.abs(run.motion.values).max() > 0.0:
        yield f"{run.name} does not move; leave the run out"


def _differences(run: Run, first: Run) -> Iterator[str]:
    if run.plane is not first.plane:
        yield f"{run.name} is {run.plane}, {first.name} {first.plane}"
    for name in ("half_spacing_m", "point_ahead_m"):
        own, other = getattr(run, name), getattr(first, name)
        if own != other:
            yield f"{run.name} has {name} = {own:g}, {first.name} {other:g}"
    own, other = run.frequency_hz * run.order, first.frequency_hz * first.order
    if abs(own - other) > _SAME_FREQUENCY * other:
        yield (
            f"{run.name} moves at {own:g} Hz, {first.name} at {other:g} Hz; solve each frequency "
            "alone"
        )
    if abs(run.speed_m_s - first.speed_m_s) > _SAME_SPEED * max(abs(first.speed_m_s), 0.01):
        yield f"{run.name} ran at {run.speed_m_s:g} m/s, {first.name} at {first.speed_m_s:g} m/s"


def told_apart(runs: Sequence[Run], moved: ComplexArray) -> tuple[int, ...]:
    """Return which motions' coefficients can be told; none where both always go together.

    Parameters
    ----------
    moved
        Velocities of the form, the rotation's at the struts, shape ``(runs, 2)``.
    """
    if len(runs) > 1:
        singular = np.linalg.svd(moved / np.abs(moved).max(), compute_uv=False)
        if singular[1] > _APART * singular[0]:
            return (0, 1)
    for column in (0, 1):
        own, other = np.abs(moved[:, column]).max(), np.abs(moved[:, 1 - column]).max()
        if other <= ALONE * own:
            return (column,)
    return ()


def motion_words(plane: Plane, form: Form) -> tuple[str, str]:
    """Return what the two motions are called."""
    if form is Form.MANOEUVRING:
        return ("w", "q") if plane is Plane.VERTICAL else ("v", "r")
    return ("heave", "pitch") if plane is Plane.VERTICAL else ("sway", "yaw")


def _phase_for(column: int, run: Run, form: Form) -> float:
    """Strut phase of the pure motion that a column needs."""
    if column == 0:
        return 0.0
    speed = abs(run.speed_m_s) if form is Form.MANOEUVRING else 0.0
    return 2.0 * math.atan2(run.omega * run.half_spacing_m, speed)


def lacking(name: str, place: Place, runs: Sequence[Run], form: Form, moved: ComplexArray) -> str:
    """Return why a coefficient is not determined, and which run would do it."""
    words = motion_words(runs[0].plane, form)
    own, other = np.abs(moved[:, place.column]).max(), np.abs(moved[:, 1 - place.column]).max()
    phase = math.degrees(_phase_for(place.column, runs[0], form))
    return (
        f"{name} cannot be determined from {', '.join(run.name for run in runs)}: "
        f"{words[place.column]} there is {100.0 * own / other:.2g} % of {words[1 - place.column]} "
        f"at the struts and not told apart from it; add a run in {words[place.column]} at "
        f"{runs[0].frequency_hz:g} Hz and {runs[0].speed_m_s:g} m/s, for example with a strut "
        f"phase of {phase:.4g} deg"
    )


def mixed(runs: Sequence[Run], form: Form, moved: ComplexArray) -> str:
    """Return why nothing is determined, and which run would do it."""
    words = motion_words(runs[0].plane, form)
    share = np.abs(moved).max(axis=0)
    phases = " or ".join(f"{math.degrees(_phase_for(c, runs[0], form)):.4g} deg" for c in (0, 1))
    return (
        f"no coefficient can be determined from {', '.join(run.name for run in runs)} alone: "
        f"{words[0]} and {words[1]} go together ({share[1] / share[0]:.2g} at the struts); add a "
        f"run at {runs[0].frequency_hz:g} Hz and {runs[0].speed_m_s:g} m/s with another strut "
        f"phase, for example {phases}"
    )
