"""The lines of a run of many frequencies, each as a run of its own at its frequency.

Motion and loads in body axes, and what inertia and weight take off, are reckoned of the whole
motion: the products of different lines are in them. What the hull then bears at a line is what a
single sine of that frequency and amplitude would show, as far as the water answers linearly.
"""

from dataclasses import replace

import numpy as np

from analysis.coefficients.body_axes import at_order, labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors, interleaved, parts_of
from analysis.coefficients.tare import Tare
from analysis.kinematics.body_frame import LOADS
from hardware.description.errors import DataError


def by_lines(cycle: BodyCycle) -> tuple[BodyCycle, ...]:
    """Return a cycle for each line of a run; the run's own where it is a single sine.

    Their scatter has the run's label, so that what the lines share is never lost.

    Raises
    ------
    DataError
        If the run was not resolved as far as its highest line.
    """
    if not cycle.lines:
        return (cycle,)
    if max(cycle.lines) > cycle.orders:
        raise DataError(
            f"{cycle.name}: resolved up to harmonic {cycle.orders}, and its highest line is "
            f"{max(cycle.lines)}; resolve as many harmonics"
        )
    lines = zip(names_of_lines(cycle), cycle.lines, strict=True)
    return tuple(_line(cycle, name, order) for name, order in lines)


def names_of_lines(cycle: BodyCycle) -> tuple[str, ...]:
    """Return what the runs are called that a run's lines become; its own name of a single sine."""
    return tuple(f"{cycle.name} line {order}" for order in cycle.lines) or (cycle.name,)


def _line(cycle: BodyCycle, name: str, order: int) -> BodyCycle:
    places = [cycle.phasors.index(at_order(name, n)) for n in (0, order) for name in cycle.channels]
    names = labels(cycle.channels, 1)
    line_phasors = cycle.phasors.select([cycle.phasors.names[place] for place in places])
    sensitivity = cycle.sensitivity
    line_cycle = replace(
        cycle,
        name=name,
        frequency_hz=order * cycle.frequency_hz,
        phasors=replace(line_phasors, names=names),
        orders=1,
        lines=(),
        tare=Tare(cycle.tare.place_m, cycle.tare.of_load.mean(axis=-1, keepdims=True)),
        readings=np.zeros((0, 0), dtype=np.complex128),
        sensitivity=sensitivity[parts_of(places)] if len(sensitivity) else sensitivity,
        point_ahead_m=0.0,
    )
    run_phasors = replace(cycle, point_ahead_m=0.0).hull.phasors
    products = _loads(line_cycle.hull.phasors, line_cycle, 1) - _loads(run_phasors, cycle, order)
    values = line_cycle.phasors.values.copy()
    loads = [name for name in cycle.channels if name in LOADS]
    values[[names.index(at_order(name, 1)) for name in loads]] += products
    shifted = replace(line_cycle.phasors.real, values=interleaved(values))
    phasors = replace(line_cycle.phasors, real=shifted)
    return replace(line_cycle, phasors=phasors, point_ahead_m=cycle.point_ahead_m)


def _loads(phasors: Phasors, cycle: BodyCycle, order: int) -> np.ndarray:
    names = [at_order(name, order) for name in cycle.channels if name in LOADS]
    return phasors.values[[phasors.index(name) for name in names]]
