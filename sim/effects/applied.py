"""Switching effects on: one, or several at once, for one run of a campaign."""

from collections.abc import Sequence

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect
from sim.rig import SimulatedRig


def switch_on(
    effects: Sequence[Effect], rig: SimulatedRig, set_point: SetPoint, run_index: int = 0
) -> tuple[SimulatedRig, SetPoint]:
    """Return the rig with all effects, and the set-point that is really run.

    Parameters
    ----------
    effects
        Each adds to what those before it have done.
    run_index
        Number of the run in its campaign, from 0: for effects that build up over a campaign.
    """
    for effect in effects:
        set_point = effect.change_set_point(set_point, run_index)
    for effect in effects:
        rig = effect.change(rig, set_point)
    return rig, set_point
