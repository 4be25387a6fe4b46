"""Small campaigns in memory: a rig that believes one thing, recordings of another."""

import math
from collections.abc import Sequence
from dataclasses import replace

from analysis.gap.forward.free_numbers import free_numbers, tolerated
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun, Stack
from analysis.gap.observe.observation import observe
from analysis.readers.dataset import from_dataset
from analysis.resolver.reference_choice import ReferenceChoice
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.a5_trigger_jitter import TriggerJitter
from sim.effects.campaign import CampaignRun
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.run import simulate

USUAL = Tolerances()
POINTS = (
    SetPoint(0.5, 0.02, 0.0, 1.0),
    SetPoint(1.0, 0.02, 0.0, 1.0),
    SetPoint(1.0, 0.01, 0.0, 1.0),
    SetPoint(0.5, 0.02, math.pi, 1.0),
    SetPoint(1.0, 0.02, math.pi, 1.0),
    SetPoint(1.0, 0.02, 0.0, 0.0, Medium.AIR),
)


def record(
    rig: SimulatedRig,
    effects: Sequence[Effect],
    seed: int,
    points: Sequence[SetPoint] = POINTS,
    phase: str | None = None,
) -> tuple[GapRun, ...]:
    """Simulate and observe a campaign of eight periods a run, its pulses scattered as usual."""
    every = (TriggerJitter(Tolerances().pulse_scatter_rad), *effects)
    told = ReferenceChoice(channel=phase)
    return tuple(
        one_run(rig, every, seed, number, point, told) for number, point in enumerate(points)
    )


def one_run(
    rig: SimulatedRig,
    effects: Sequence[Effect],
    seed: int,
    number: int,
    point: SetPoint,
    told: ReferenceChoice = ReferenceChoice(),
) -> GapRun:
    place = CampaignRun(number, 400.0 * number, 300.0 if number else 0.0, None)
    changed, really = switch_on(effects, rig, point, place)
    dataset = simulate(
        changed,
        really,
        periods=8,
        sample_rate_hz=64.0,
        seed=1000 * seed + number,
        name=f"r{number}",
    )
    seen = observe(replace(from_dataset(dataset), set_point=point), told)
    periods = seen.analysis.stretch.period_count
    return GapRun(f"r{number}", point, place, seen.observation, periods, 64.0, seen.lead_s)


def problem_of(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    reference_channel: str | None = None,
    tolerances: Tolerances = USUAL,
) -> Problem:
    """Return the problem that a diagnosis holds its hypotheses against."""
    free = free_numbers(rig, tolerances)
    stack = Stack.of(pooled(runs, rig, tolerances))
    simulator = Simulator(rig, stack, reference_channel=reference_channel)
    nuisances = tolerated(simulator, free, tolerances)
    return Problem(simulator, nuisances)
