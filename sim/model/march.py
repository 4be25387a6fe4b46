"""Model, mounting and drive solved sample by sample, with all feedback in one unknown.

What a sample leaves open are the loads of model and mounting and the torques at the shaft. All
else follows from them by matrices that are the same for every sample, so that one evaluation is a
few dozen multiplications and the laws. They are solved by :mod:`sim.model.broyden`.

Loaded when the first such loop runs, because numba is. Without numba the functions are Python: the
same numbers, slowly. Arrays are handed on whole, with the row that is meant: numba counts every
view.
"""

from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from sim.drive.shaft_system import MarchedShaft
from sim.model.broyden import add_struts, settle
from sim.model.law_table import LawTable
from sim.solve.compilation import compile_loop


class ModelLoop(NamedTuple):
    """The model on its mounting, ready to march.

    Attributes
    ----------
    step
        What a sample leaves of the n states, shape ``(n, n)``.
    before, after
        What the struts' motion (six columns) at both ends of the sample adds, ``(n, 6)``.
    by_loads
        What the loads add, oldest sample first, shape ``(4, n, 6)``: f, g, and what the gauges give
        back in their clearance, two columns each.
    from_states, from_struts, from_loads
        To the outputs: ``(n, 10)``, ``(6, 10)`` and ``(6, 10)``.
    by_speed
        Velocities through the water per speed beyond the mean and per displacement: ``(2, 2)``.
    gap
        Stiffness, half clearance and preload of the gauges' joints, a row each; clearances of zero
        for none.
    """

    step: FloatArray
    before: FloatArray
    after: FloatArray
    by_loads: FloatArray
    from_states: FloatArray
    from_struts: FloatArray
    from_loads: FloatArray
    by_speed: FloatArray
    gap: FloatArray


class Course(NamedTuple):
    """What is given over the samples.

    Attributes
    ----------
    struts
        Their motion at the sample before the first and at each one, ``(samples + 1, 6)``; filled in
        where a shaft drives them.
    states, loads
        At the three samples before the first and, once solved, at each: ``(samples + 3, n)`` and
        ``(samples + 3, m)``, with the first m of the six loads, those that are there.
    external_loads
        Loads that come from elsewhere, ``(samples, m)``.
    instants
        Time, speed beyond the mean, and speed, ``(samples, 3)``.
    scale
        What a change of the loads, then of the torques, counts relative to.
    is_start_known
        1 where the state at the first sample is known, else 0.
    """

    struts: FloatArray
    states: FloatArray
    loads: FloatArray
    external_loads: FloatArray
    instants: FloatArray
    step_s: float
    scale: FloatArray
    is_start_known: int


@compile_loop
def _free_outputs(
    step: FloatArray,
    before: FloatArray,
    by_loads: FloatArray,
    from_states: FloatArray,
    struts: FloatArray,
    states: FloatArray,
    loads: FloatArray,
    k: int,
    start: int,
    work: FloatArray,
) -> None:
    """Fill in the state of sample k and its outputs, but for its own struts and loads."""
    size, columns, past = step.shape[0], work.shape[1], loads.shape[1]
    for j in range(columns):
        work[0, j] = 0.0
    for i in range(size):
        total = states[k + 3, i] if k < start else 0.0
        if k >= start:
            for j in range(size):
                total += step[i, j] * states[k + 2, j]
            for j in range(6):
                total += before[i, j] * struts[k, j]
            for j in range(past):
                total += by_loads[0, i, j] * loads[k, j] + by_loads[1, i, j] * loads[k + 1, j]
                total += by_loads[2, i, j] * loads[k + 2, j]
        states[k + 3, i] = total
        for j in range(columns):
            work[0, j] += total * from_states[i, j]


@compile_loop
def _maps(model: ModelLoop, stepped: bool, work: FloatArray) -> None:
    """Fill in what struts and loads of a sample add to its outputs, by way of the state too."""
    after, by_loads, from_states = model.after, model.by_loads, model.from_states
    for j in range(6):
        for column in range(work.shape[1]):
            by_strut, by_load = model.from_struts[j, column], model.from_loads[j, column]
            for i in range(after.shape[0] if stepped else 0):
                by_strut += after[i, j] * from_states[i, column]
                by_load += by_loads[3, i, j] * from_states[i, column]
            work[3 + j, column], work[9 + j, column] = by_strut, by_load


@compile_loop
def _free_shaft(
    step: FloatArray,
    by_inputs: FloatArray,
    to_outputs: FloatArray,
    states: FloatArray,
    torques: FloatArray,
    k: int,
    start: int,
    work: FloatArray,
) -> None:
    """Fill in the shaft's state and outputs at sample k, but for this sample's torques."""
    size = step.shape[0]
    for j in range(4):
        work[15, j] = 0.0
    for i in range(size):
        total = states[k + 3, i] if k < start else 0.0
        if k >= start:
            for j in range(size):
                total += step[i, j] * states[k + 2, j]
            for j in range(torques.shape[1]):
                total += by_inputs[0, i, j] * torques[k, j] + by_inputs[1, i, j] * torques[k + 1, j]
                total += by_inputs[2, i, j] * torques[k + 2, j]
        states[k + 3, i] = total
        for j in range(4):
            work[15, j] += total * to_outputs[i, j]


@compile_loop
def _guess(loads: FloatArray, k: int, unknown: FloatArray, first: int) -> None:
    """Go on by the parabola through the last three samples."""
    for j in range(loads.shape[1]):
        change = loads[k + 2, j] - loads[k + 1, j]
        unknown[first + j] = loads[k, j] + 3.0 * change


@compile_loop
def _keep_model(
    after: FloatArray,
    by_loads: FloatArray,
    struts: FloatArray,
    states: FloatArray,
    loads: FloatArray,
    k: int,
    start: int,
    unknown: FloatArray,
) -> None:
    """Write down the loads of sample k, and its state."""
    count = loads.shape[1]
    for j in range(count):
        loads[k + 3, j] = unknown[j]
    if k >= start:
        for i in range(after.shape[0]):
            total = states[k + 3, i]
            for j in range(6):
                total += after[i, j] * struts[k + 1, j]
            for j in range(count):
                total += by_loads[3, i, j] * unknown[j]
            states[k + 3, i] = total


@compile_loop
def _keep_shaft(
    by_inputs: FloatArray,
    states: FloatArray,
    torques: FloatArray,
    motion: FloatArray,
    k: int,
    start: int,
    unknown: FloatArray,
    first: int,
    work: FloatArray,
) -> None:
    """Write down the torques of sample k, the shaft's motion with the levers, and its state."""
    for j in range(5):
        motion[k, j] = work[2, j]
    for j in range(torques.shape[1]):
        torques[k + 3, j] = unknown[first + j]
        for i in range(states.shape[1] if k >= start else 0):
            states[k + 3, i] += by_inputs[3, i, j] * unknown[first + j]


@compile_loop
def march(
    model: ModelLoop,
    table: LawTable,
    course: Course,
    shaft: MarchedShaft,
    links: FloatArray,
    outputs: FloatArray,
) -> int:
    """Solve all samples; return the number of one that does not settle, or -1.

    Fills in ``states`` and ``loads`` of the course, ``outputs`` (h, h', h'' and linear force at
    both struts; opening of both gauges), shape ``(samples, 8)``, or 10 where
    the gauges have a clearance, and all that the shaft does, if it is driven.
    """
    struts, states, loads, start = course.struts, course.states, course.loads, course.is_start_known
    step, before, after, by_loads = model.step, model.before, model.after, model.by_loads
    base_loads, driven, motion, torques = (
        course.external_loads,
        shaft.driven,
        shaft.unloaded,
        shaft.torques,
    )
    laws, hull, by_speed, gap = table.laws, table.hull, model.by_speed, model.gap
    instants, step_s, scale = course.instants, course.step_s, course.scale
    by_torque, numbers, cogging, shaft_gap = (
        shaft.at_once, shaft.numbers, shaft.cogging, shaft.gap
    )  # fmt: skip
    first = loads.shape[1]
    unknown, room = np.zeros(first + torques.shape[1]), np.zeros((8, 8))
    slope, work = np.eye(unknown.size), np.zeros((16, outputs.shape[1]))
    for k in range(len(outputs)):
        if k == 0 or k == start:
            _maps(model, k >= start, work)
            if k >= start:
                by_torque = shaft.by_torque
        _free_outputs(
            step, before, by_loads, model.from_states, struts, states, loads, k, start, work
        )
        _guess(loads, k, unknown, 0)
        if driven:
            _free_shaft(
                shaft.step, shaft.by_inputs, shaft.to_outputs, shaft.states, torques, k, start, work
            )  # fmt: skip
            _guess(torques, k, unknown, first)
        else:
            add_struts(struts, k, work, 0)
        settled = settle(
            laws, hull, by_speed, gap, instants, step_s, base_loads, struts, scale, driven, motion,
            by_torque, numbers, cogging, shaft_gap, links, k, unknown, slope, work, room,
        )  # fmt: skip
        if not settled:
            return k
        for j in range(work.shape[1]):
            outputs[k, j] = work[1, j]
        _keep_model(after, by_loads, struts, states, loads, k, start, unknown)
        if driven:
            _keep_shaft(
                shaft.by_inputs, shaft.states, torques, shaft.motion, k, start, unknown, first, work
            )  # fmt: skip
    return -1
