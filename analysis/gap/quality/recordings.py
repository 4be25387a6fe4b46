"""Recordings that cannot be what they say: another unit, another sign, a run that went wrong.

What is found is said and left out; nothing is repaired silently.
"""

from collections.abc import Sequence

from analysis.gap.forward.free_numbers import free_numbers
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun, Stack
from analysis.gap.quality.finding import Doubt
from analysis.gap.quality.harmonics import of_first_harmonics
from analysis.gap.quality.recentring import Recentred, recentred
from analysis.gap.quality.records import of_records, of_scatter
from hardware.description.channels import DISPLACEMENTS, FORCES
from sim.effects.effect import Effect
from sim.rig import SimulatedRig

_FEW = 3


def doubts(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    on: Sequence[Effect] = (),
    reference_channel: str | None = None,
) -> tuple[Doubt, ...]:
    """Return what is wrong with a campaign's recordings; with fewer than three runs nothing.

    Raises
    ------
    ConfigurationError
        If the rig cannot run what was recorded.
    """
    if len(runs) < _FEW:
        return ()
    stack = Stack.of(runs)
    nominal = Simulator(rig, stack, tuple(on), reference_channel).steady(())
    all_doubts = list(of_records(runs))
    for channel in (*DISPLACEMENTS, *FORCES):
        all_doubts += of_first_harmonics(rig, stack, nominal, channel)
    all_doubts += of_scatter(runs)
    first = {(doubt.run, doubt.channel): doubt for doubt in reversed(all_doubts)}
    return tuple(reversed(first.values()))


def judge_recordings(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    tolerances: Tolerances,
    on: Sequence[Effect] = (),
    reference_channel: str | None = None,
) -> tuple[Recentred, tuple[Doubt, ...]]:
    """Return the rig about which to go on, and what is wrong with the recordings.

    A doubt stands only if it stays when the coefficients are fitted: to the other runs, or to all,
    whichever leaves fewer doubts.

    Raises
    ------
    ConfigurationError
        If the rig cannot run what was recorded.
    """
    stated = Recentred(rig, free_numbers(rig, tolerances))
    stated_doubts = doubts(rig, runs, on, reference_channel)
    if any(doubt.run == "" for doubt in stated_doubts):
        return stated, stated_doubts
    bad = {doubt.run for doubt in stated_doubts}
    good = [run for run in runs if run.name not in bad]
    fitted = [group for group in (good, runs) if len(group) >= _FEW]
    tried = []
    for group in fitted if bad else fitted[:1]:
        recentred_rig = recentred(rig, group, tolerances, on, reference_channel)
        tried.append((recentred_rig, doubts(recentred_rig.rig, runs, on, reference_channel)))
    return min(tried, key=lambda pair: len(pair[1])) if tried else (stated, stated_doubts)
