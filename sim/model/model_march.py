"""The model on its mounting, made ready for the compiled march (:mod:`sim.model.march`)."""

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from sim.drive.shaft_system import MarchedShaft
from sim.model.law_point import Acting
from sim.model.law_table import LawTable, has_number, table_of
from sim.model.system import LOAD_DEGREE, HullSystem
from sim.solve.compilation import available
from sim.solve.linear_system import Hold

if TYPE_CHECKING:
    from sim.model.march import Course, ModelLoop

_NOTHING_KEPT = (
    Hold(np.zeros((0, 0)), np.zeros((2, 0, 6))),
    Hold(np.zeros((0, 0)), np.zeros((LOAD_DEGREE + 1, 0, 4))),
)
LOADS = 6  # f, g, and what the gauges give back in their clearance: two of each
OUTPUTS = 10  # as in sim.model.broyden


class Marching(NamedTuple):
    """What does not change from block to block."""

    model: "ModelLoop"
    table: LawTable


@lru_cache(maxsize=64)
def periodic_laws(all_laws: tuple[Acting, ...], system: HullSystem) -> LawTable | None:
    """Return the laws that repeat as a table; ``None`` where they cannot be in one.

    That is without numba, and where a law has no number.
    """
    laws = tuple(acting for acting in all_laws if acting.law.periodic)
    if not (available() and all(has_number(acting.law) for acting in laws)):
        return None
    return table_of(laws, system)


@lru_cache(maxsize=64)
def marching_of(
    all_laws: tuple[Acting, ...], system: HullSystem, step_s: float, needed: bool = False
) -> Marching | None:
    """Return model and laws for the march; ``None`` where sweeps do instead.

    Sweeps do without numba. A clearance needs the march, compiled or not. Laws that have no number
    are left out of the table; they are swept around the march.

    Parameters
    ----------
    needed
        True where something else than the model needs the march.
    """
    if not (available() or needed or system.joint):
        return None
    laws = tuple(acting for acting in all_laws if has_number(acting.law))
    table = table_of(laws, system)
    return Marching(_model(system, step_s), table)


def _model(system: HullSystem, step_s: float) -> "ModelLoop":
    from sim.model.march import ModelLoop

    by_motion, by_load = system.holds(step_s) if system.states else _NOTHING_KEPT
    by_struts, by_states, by_loads = system.model_maps
    opening, struts = np.zeros((system.states, 2)), np.zeros((6, 2))
    if system.elastic_count >= 2:
        opening[:2] = np.eye(2)
    weights = np.zeros((LOAD_DEGREE + 1, system.states, LOADS))
    weights[:, :, : by_load.weights.shape[2]] = by_load.weights
    from_loads = np.zeros((LOADS, OUTPUTS))
    from_loads[: len(by_loads), :8] = by_loads
    gap = np.zeros((2, 3))
    joint = system.joint
    if joint is not None:
        for strut, more in enumerate((1.0 + joint.unlike, 1.0 - joint.unlike)):
            stiffness = system.elastic.stiffness[strut, strut]
            gap[strut] = (stiffness, more * joint.half_play_m, joint.preload_n)
    arrays = (
        by_motion.step,
        by_motion.weights[0],
        by_motion.weights[1],
        weights,
        np.hstack([by_states, opening]),
        np.hstack([by_struts, struts]),
        from_loads,
        system.turn,
        gap,
    )
    return ModelLoop(*(np.array(array, dtype=np.float64, order="C") for array in arrays))


def course_of(
    struts: FloatArray,
    states: int,
    loads: int,
    time_s: FloatArray,
    step_s: float,
    scale: FloatArray,
) -> "Course":
    """Return room for a march over as many samples as there are times; all else zero.

    Parameters
    ----------
    struts
        The struts' motion at the sample before the first and at each one.
    states, loads
        Number of states, and of loads that are there.
    scale
        What a change of (f, g) counts relative to, shape ``(4,)``.
    """
    from sim.model.march import Course

    count = len(time_s)
    size = np.concatenate([scale, scale[:2]])[:loads]
    return Course(
        np.ascontiguousarray(struts),
        np.zeros((count + LOAD_DEGREE, states)),
        np.zeros((count + LOAD_DEGREE, loads)),
        np.zeros((count, loads)),
        np.column_stack([time_s, np.zeros((count, 2))]),
        step_s,
        np.maximum(size, np.finfo(np.float64).tiny),
        0,
    )


def march_model(marching: Marching, course: "Course") -> FloatArray | None:
    """Fill in states and loads; return the outputs, or ``None`` if a sample does not settle."""
    from sim.model.march import march

    columns = OUTPUTS if course.external_loads.shape[1] == LOADS else OUTPUTS - 2
    outputs = np.empty((len(course.external_loads), columns))
    shaft, links = _undriven()
    bad = march(marching.model, marching.table, course, shaft, links, outputs)
    return None if bad >= 0 else outputs


@lru_cache(maxsize=1)
def _undriven() -> tuple[MarchedShaft, FloatArray]:
    """Return a shaft that drives nothing, and its linkages."""
    flat, deep = np.zeros((0, 0)), np.zeros((0, 0, 0))
    shaft = MarchedShaft(
        False, flat, deep, flat, flat, flat, flat, flat, flat, flat, np.zeros(5), flat, np.zeros(3)
    )  # fmt: skip
    return shaft, np.zeros((2, 5))
