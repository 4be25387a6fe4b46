"""Groups of runs solved, and their trials drawn, side by side on any executor.

The numbers are those of :func:`analysis.coefficients.campaign.campaign_coefficients`: only the work
is cut finer, a block of trials a task, so that one large group keeps all workers busy.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import assemble, planned
from analysis.coefficients.campaign_plan import Group, GroupKind, Request
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.campaign_solve import GroupCoefficients, solve_group
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.cycle_trials import block_sizes, columns, draw_cycles
from analysis.coefficients.linear_fit import linear_fit
from hardware.description.arrays import FloatArray

Progress = Callable[[int, int, str], None]
"""Takes how many are done, of how many, and what of."""


@dataclass(frozen=True)
class GroupSolver:
    """Solve a group for a request; an object, so that it can be sent to another process."""

    request: Request

    def __call__(self, group: Group) -> GroupCoefficients:
        """Return the group's block; the trials of a linear group are drawn in blocks."""
        linear = group.kind is GroupKind.LINEAR
        return solve_group(group, replace(self.request, trials=0) if linear else self.request)


@dataclass(frozen=True, eq=False)
class TrialBlock:
    """One block of trials of one linear group.

    Attributes
    ----------
    block
        Its number, from which its random numbers follow.
    """

    fit: CycleFit
    count: int
    seed: int
    block: int


def draw_block(block: TrialBlock) -> FloatArray:
    """Return the coefficients of each trial, shape ``(count, n)``."""
    return draw_cycles(block.fit, block.count, (block.seed, block.block))


def solve_campaign(
    cycles: Sequence[BodyCycle], request: Request, executor: Executor, progress: Progress
) -> CampaignCoefficients:
    """Return all coefficients of a campaign.

    It raises what :func:`analysis.coefficients.campaign.campaign_coefficients` raises.
    """
    groups, single, repeatability = planned(cycles, request)
    solver = GroupSolver(request)
    blocks = list(_counted(executor.map(solver, groups), len(groups), "solving", progress))
    if request.trials:
        blocks = _with_trials(blocks, groups, request, executor, progress)
    return assemble(blocks, single, repeatability, request)


def _counted(
    results: Iterator[GroupCoefficients], total: int, step: str, progress: Progress
) -> Iterator[GroupCoefficients]:
    for k, result in enumerate(results, 1):
        progress(k, total, step)
        yield result


def _with_trials(
    blocks: Sequence[GroupCoefficients],
    groups: Sequence[Group],
    request: Request,
    executor: Executor,
    progress: Progress,
) -> list[GroupCoefficients]:
    """Draw the trials of all linear groups; results come in order, one group after the other."""
    linear = [
        k for k, group in enumerate(groups) if group.kind is GroupKind.LINEAR and blocks[k].entries
    ]
    work = {k: _trial_blocks(groups[k], request) for k in linear}
    total = sum(map(len, work.values()))
    draws = executor.map(draw_block, [block for k in linear for block in work[k]])
    results, count = list(blocks), 0
    for k in linear:
        trials = []
        for _ in work[k]:
            trials.append(next(draws))
            count += 1
            progress(count, total, "drawing trials")
        results[k] = replace(results[k], trials=columns(np.concatenate(trials), request.level))
    return results


def _trial_blocks(group: Group, request: Request) -> list[TrialBlock]:
    fit = linear_fit(group.cycles, request.form, request.stated).fit
    return [
        TrialBlock(fit, count, request.seed, k)
        for k, count in enumerate(block_sizes(request.trials))
    ]
