"""What spring and damper, side by side and in a row with a clearance, give back: compiled.

With x the opening of all three together, b where the clearance lies, and d = x - b, the sides push
with ``k d + s d'``; they never pull, and the damper acts in contact only:

    b is at a side, and what it pushes with is directed from there; or
    k d + s d' = 0, and b lies between.

So the teeth's give dies out where they touch nothing (Nordin, Galic and Gutman, "New models for
backlash and gear play", Int. J. Adaptive Control and Signal Processing 11, 1997). A linear system
that has spring and damper always gets back ``k b + s b'``. This is a function of b, which does not
jump where sides meet, as the damper's force does: b, times k, is what is solved for.
"""

import math

from hardware.description.arrays import FloatArray
from sim.solve.compilation import compile_loop


@compile_loop
def joint_return(gap: FloatArray, opening: float, share: float) -> float:
    """Return the stiffness times how far a joint lies off the side at which it is at rest.

    Spring and damper, side by side, are in a row with the clearance. Where they touch neither side
    they carry nothing, and the joint lies where that leaves it; else at the side, which pushes.

    Parameters
    ----------
    gap
        Stiffness, half clearance, preload.
    opening
        Of spring and clearance together, beyond what the spring keeps if it carries nothing; here
        without what this joint returns.
    share
        Stiffness times what the return adds to the opening.
    """
    side = math.copysign(gap[1], gap[2])
    free = (gap[0] * opening + gap[2]) / (1.0 - share)
    return float(min(max(free, -gap[0] * (gap[1] + side)), gap[0] * (gap[1] - side)))


@compile_loop
def begin_outputs(
    past: FloatArray, loads: FloatArray, k: int, count: int, work: FloatArray, row: int
) -> None:
    """Fill in, in a row, what the last ``count`` loads of the samples before add to the outputs."""
    first = loads.shape[1] - count
    for j in range(min(past.shape[2], work.shape[1])):
        work[row, j] = 0.0
        for i in range(count):
            for back in range(3):
                work[row, j] += past[back, i, j] * loads[k + back, first + i]


@compile_loop
def relax_joints(
    gap: FloatArray,
    states: FloatArray,
    loads: FloatArray,
    k: int,
    start: int,
    work: FloatArray,
    room: FloatArray,
) -> None:
    """Fill in what the gauges' springs keep if they carry nothing; at a known start, all of it."""
    for i in range(loads.shape[1] - 4):
        opening = work[0, 8 + i] if k < start else states[k + 2, i]
        left = 1.0 if k < start else gap[i, 3]
        room[7, i] = left * (opening + (gap[i, 2] - loads[k + 2, 4 + i]) / gap[i, 0])


@compile_loop
def relax_teeth(
    gap: FloatArray,
    to_outputs: FloatArray,
    unloaded: FloatArray,
    states: FloatArray,
    torques: FloatArray,
    k: int,
    room: FloatArray,
) -> None:
    """Fill in what the teeth keep of their give if they carry nothing."""
    if gap[1] > 0.0:
        opening = unloaded[k, 3] - torques[k + 2, 1] / gap[0]
        for i in range(states.shape[1]):
            opening += states[k + 2, i] * to_outputs[i, 3]
        room[7, 2] = gap[3] * opening
