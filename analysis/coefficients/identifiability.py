"""Which linear coefficients the runs determine, and which runs the others need."""

import math
from collections.abc import Sequence

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle, at_order
from analysis.coefficients.names import Form, MatrixElement
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.oscillator import Plane
from hardware.description.words import joined

ALONE = 1e-2  # of the other motion: less may be left out
_APART = 2e-2  # ratio of singular values above which two motions can be told apart


def fundamental_velocities(cycles: Sequence[BodyCycle], form: Form) -> ComplexArray:
    """Return the fundamental's velocities of a form, the rotation's at the struts; (cycles, 2)."""
    moved = []
    for cycle in cycles:
        phasors, rate = cycle.hull.phasors, 2j * math.pi * cycle.frequency_hz
        across = (
            phasors[at_order("across", 1)]
            if form is Form.MANOEUVRING
            else rate * phasors[at_order("translation", 1)]
        )
        moved.append((across, rate * cycle.half_spacing_m * phasors[at_order("rotation", 1)]))
    return np.array(moved)


def velocity_sizes(cycle: BodyCycle) -> FloatArray:
    """Return the sizes of a run's manoeuvring velocities; of lines the root of their squares."""
    phasors, rate = cycle.hull.phasors, 2.0 * math.pi * cycle.frequency_hz
    across = [phasors[at_order("across", n)] for n in cycle.lines or (1,)]
    turned = [n * rate * phasors[at_order("rotation", n)] for n in cycle.lines or (1,)]
    arm = cycle.half_spacing_m
    return np.array([np.linalg.norm(across), arm * float(np.linalg.norm(turned))])


def identifiable_motions(moved: ComplexArray) -> tuple[int, ...]:
    """Return the motions whose coefficients are determined; none if both always vary together.

    Parameters
    ----------
    moved
        Of :func:`fundamental_velocities`.
    """
    if len(moved) > 1:
        singular = np.linalg.svd(moved / np.abs(moved).max(), compute_uv=False)
        if singular[1] > _APART * singular[0]:
            return (0, 1)
    for column in (0, 1):
        size, other_size = np.abs(moved[:, column]).max(), np.abs(moved[:, 1 - column]).max()
        if other_size <= ALONE * size:
            return (column,)
    return ()


def motion_words(plane: Plane, form: Form) -> tuple[str, str]:
    """Return what the two motions are called."""
    if form is Form.MANOEUVRING:
        return ("w", "q") if plane is Plane.VERTICAL else ("v", "r")
    return ("heave", "pitch") if plane is Plane.VERTICAL else ("sway", "yaw")


def _phase_for(column: int, run: BodyCycle, form: Form) -> float:
    """Strut phase of the pure motion that a column needs."""
    if column == 0:
        return 0.0
    speed = abs(run.speed_m_s) if form is Form.MANOEUVRING else 0.0
    return 2.0 * math.atan2(2.0 * math.pi * run.frequency_hz * run.half_spacing_m, speed)


def missing_run(
    name: str, place: MatrixElement, runs: Sequence[BodyCycle], form: Form, moved: ComplexArray
) -> str:
    """Return why a coefficient is not determined, and which run would do it."""
    words = motion_words(runs[0].plane, form)
    size, other_size = (
        np.abs(moved[:, place.column]).max(),
        np.abs(moved[:, 1 - place.column]).max(),
    )
    phase = math.degrees(_phase_for(place.column, runs[0], form))
    return (
        f"{name} cannot be determined from {joined([run.name for run in runs])}: "
        f"{words[place.column]} there is {100.0 * size / other_size:.2g} % of "
        f"{words[1 - place.column]} at the struts and not told apart from it; add a run in "
        f"{words[place.column]} at {runs[0].frequency_hz:g} Hz and {runs[0].speed_m_s:g} m/s, for "
        f"example with a strut phase of {phase:.4g} deg"
    )


def mixture_run(runs: Sequence[BodyCycle], form: Form, moved: ComplexArray) -> str:
    """Return why nothing is determined, and which run would do it."""
    words = motion_words(runs[0].plane, form)
    share = np.abs(moved).max(axis=0)
    phases = " or ".join(f"{math.degrees(_phase_for(c, runs[0], form)):.4g} deg" for c in (0, 1))
    return (
        f"no coefficient can be determined from {joined([run.name for run in runs])} alone: "
        f"{words[0]} and {words[1]} go together ({share[1] / share[0]:.2g} at the struts); add a "
        f"run at {runs[0].frequency_hz:g} Hz and {runs[0].speed_m_s:g} m/s with another strut "
        f"phase, for example {phases}"
    )
