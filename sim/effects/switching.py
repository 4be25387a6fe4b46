"""Switching effects on: one, or several at once, for one run of a campaign."""

from collections.abc import Sequence

from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import Effect
from sim.rig import SimulatedRig


def switch_on(
    effects: Sequence[Effect],
    rig: SimulatedRig,
    set_point: SetPoint,
    run: CampaignRun | None = None,
) -> tuple[SimulatedRig, SetPoint]:
    """Return the rig with all effects, and the set-point that is really run.

    Parameters
    ----------
    effects
        Each adds to what those before it have done; those that change others come last.
    run
        The run's place in its campaign, for effects that build up or die out over a campaign;
        ``None`` for a run by itself, in which they are as their parameters say.
    """
    if run is not None:
        effects = [effect.at_run(run) for effect in effects]
    run_index = 0 if run is None else run.index
    for effect in effects:
        set_point = effect.change_set_point(set_point, run_index)
    for effect in sorted(effects, key=lambda item: item.changes_others):
        rig = effect.change(rig, set_point)
    return rig, set_point
