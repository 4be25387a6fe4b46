"""A joint with play: what is behind it stays where it is until the clearance is taken up."""

from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray


class PlayState(NamedTuple):
    """Position and velocity behind the joint, half a sample after the last one.

    ``owed`` is what the next sample still has to show of a jump of the velocity.
    """

    position: float
    velocity: float
    owed: float = 0.0


class JointMotion(NamedTuple):
    """Position, velocity and acceleration in front of the joint, one value a sample."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


class Follower(NamedTuple):
    """Motion behind the joint, one value a sample, and where it is in contact (1) or not (0)."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    contact: FloatArray


def follow_with_play(
    state: PlayState | None, motion: JointMotion, half_play_m: float, step_s: float
) -> tuple[PlayState, Follower]:
    """Return the motion behind a joint with friction, which stays put within the clearance.

    Where contact begins the velocity jumps: there velocity and acceleration are means over the
    sample, from the positions and velocities half a sample before and after it, and the jump itself
    is shared by the two samples beside it, so that its impulse comes when it should. The motion in
    front goes on to second order within a sample, and where it turns is found between samples.

    Parameters
    ----------
    state
        ``None`` before the first sample: in the middle of the clearance.
    half_play_m
        Clearance to either side.
    """
    d, v, a = motion
    half = step_s / 2.0
    if state is None:
        state = PlayState(float(d[0]), 0.0)
    ends = d + v * half + a * (half**2 / 2.0)
    speeds = v + a * half
    turning = (np.abs(v) < np.abs(a) * half) & (a != 0.0)
    extremes = np.where(turning, d - v**2 / (2.0 * np.where(turning, a, 1.0)), ends)
    after = _positions_behind(state.position, extremes, ends, half_play_m)
    before = np.concatenate([[state.position], after[:-1]])
    slack = half_play_m * (1.0 - 1e-12)
    pushed = ((ends - after >= slack) & (speeds > 0.0)) | ((after - ends >= slack) & (speeds < 0.0))
    carried = np.where(pushed, speeds, 0.0)
    earlier = np.concatenate([[state.velocity], carried[:-1]])
    carried_through = pushed & (earlier != 0.0) & ~turning
    still = ~pushed & (earlier == 0.0)
    begun = pushed & (earlier == 0.0)
    jump, fraction = _contact(motion, np.where(begun, before, after), half_play_m, step_s)
    begins = np.where(begun, jump, 0.0)
    late = begins * np.clip(fraction, 0.0, 0.5)
    early = np.where(still & (fraction >= 0.5) & (fraction < 1.0), jump * (1.0 - fraction), 0.0)
    due = np.concatenate([[state.owed], late[:-1]])
    shown = early + due + begins * (1.0 - np.abs(np.clip(fraction, -0.5, 0.5)))
    smooth = np.where(carried_through, a, (carried - earlier - begins) / step_s)
    last = PlayState(float(after[-1]), float(carried[-1]), float(late[-1]))
    return last, Follower(
        np.clip(before, d - half_play_m, d + half_play_m),
        np.where(carried_through, v, (after - before) / step_s),
        smooth + shown / step_s,
        np.where(carried_through, 1.0, np.where(still, 0.0, 0.5)),
    )


def _contact(
    motion: JointMotion, held: FloatArray, half_play_m: float, step_s: float
) -> tuple[FloatArray, FloatArray]:
    """Return velocity and time of the next contact, seen from each sample: m/s, and in samples."""
    d, v, a = motion
    sign = np.sign(v)
    gap = half_play_m + sign * (held - d)
    speed = np.sqrt(np.maximum(v**2 + 2.0 * sign * a * gap, 0.0))
    mean = np.maximum((np.abs(v) + speed) / 2.0, np.finfo(np.float64).tiny)
    with np.errstate(over="ignore"):
        return sign * speed, gap / (mean * step_s)


def _positions_behind(
    start: float, extremes: FloatArray, ends: FloatArray, half_play_m: float
) -> FloatArray:
    """Return where what is behind the joint is, after each extreme and the end that follows it."""
    position, positions = start, []
    for extreme, end in zip(extremes.tolist(), ends.tolist(), strict=True):
        position = min(max(position, extreme - half_play_m), extreme + half_play_m)
        position = min(max(position, end - half_play_m), end + half_play_m)
        positions.append(position)
    return np.array(positions)
