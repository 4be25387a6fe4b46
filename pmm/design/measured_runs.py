"""Runs of a design that were made: their cycles as the analysis reads them, and what they showed.

A campaign's folder is all the state there is: whoever was interrupted designs anew from it.
"""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.repeats import Repeatability, repeatability, with_repeats
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.candidate import CandidateRun
from analysis.design.expectation import SCATTER, ExpectedCoefficient, expected_coefficients, made_up
from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.coefficients.campaign_cycles import campaign_cycles
from pmm.coefficients.settings import settings_of
from pmm.coefficients.stated_inputs import largest
from pmm.design.counted_runs import MANY_LINES
from pmm.design.design_file import DesignFile

_ENOUGH = 3  # runs, or repeats beyond the first of their kind: fewer say too little of the noise


@dataclass(frozen=True, eq=False)
class MeasuredRuns:
    """Oscillations that were made and can be used, each with its cycle.

    Attributes
    ----------
    failed
        Why others cannot be used, by run.
    """

    candidates: tuple[CandidateRun, ...]
    cycles: tuple[BodyCycle, ...]
    stated: StatedUncertainties
    failed: Mapping[str, str]


def continued_design(file: DesignFile, parts: Sequence[MeasuredRuns]) -> DesignFile:
    """Return a design that goes on from runs that were made, with the noise that they showed.

    What ``[[runs]]`` has is taken to be among them.

    Raises
    ------
    DataError
        If no run can be used.
    """
    candidates = tuple(candidate for part in parts for candidate in part.candidates)
    cycles = [cycle for part in parts for cycle in part.cycles]
    if not cycles:
        reasons = "; ".join(
            f"{name}: {message}" for part in parts for name, message in part.failed.items()
        )
        raise DataError(f"none of the runs that were made can be used{reasons and f' ({reasons})'}")
    spread = repeating(cycles, file.noise.repeat_relative)
    stated = largest([file.stated, *(part.stated for part in parts)])
    table = {key: value for key, value in file.plan_table.items() if key != "runs"}
    going_on = replace(
        file, plan_table=table, tables=replace(file.tables, runs=()), fixed=(),
        uncounted={},
        made_runs=candidates, stated=stated,
        cycles=tuple(with_repeats(cycle, spread) for cycle in cycles),
    )  # fmt: skip
    times = _noise_shown(going_on)
    noise = file.noise
    return replace(
        going_on,
        noise=replace(
            noise,
            force_n=times * noise.force_n,
            displacement_m=times * noise.displacement_m,
            repeat_relative=float(spread.relative.max()),
        ),
    )


def repeating(cycles: Sequence[BodyCycle], stated: float) -> Repeatability:
    """Return what repeats differ by: what they showed, or what is stated while they are few.

    While they have fewer than three degrees of freedom the larger counts; then what they showed
    alone, so that nobody makes runs against a scatter that is not there.

    Parameters
    ----------
    stated
        Standard deviation between repeats beyond their scatter, over the load.
    """
    repeats = repeatability(cycles)
    if repeats.degrees_of_freedom >= _ENOUGH:
        return repeats
    freedom = repeats.degrees_of_freedom or math.inf
    return replace(
        repeats, relative=np.maximum(repeats.relative, stated), degrees_of_freedom=freedom
    )


def repeats_said(cycles: Sequence[BodyCycle], stated: float) -> str:
    """Say which scatter between repeats uncertainties count on; empty where there is none."""
    repeats = repeatability(cycles)
    shown_text = f"{100.0 * float(repeats.relative.max()):.2g} %"
    freedom = f"{repeats.degrees_of_freedom:g} degrees of freedom"
    if repeats.degrees_of_freedom >= _ENOUGH:
        return f"repeats differ by {shown_text} of their load, as they showed with {freedom}"
    if not stated > 0.0:
        return ""
    basis = f"repeats with {freedom} showed {shown_text}" if repeats.kinds else "no repeat was made"
    return (
        f"repeats are taken to differ by {100.0 * stated:.2g} % of their load, as repeat_relative "
        f"states, or more: {basis}, and what they show counts alone from {_ENOUGH} on"
    )


def read_measured_runs(file: DesignFile, folder: Path, executor: Executor) -> MeasuredRuns:
    """Read the runs of a campaign's folder, each on an executor.

    Raises
    ------
    ConfigurationError
        If the folder holds no campaign, or one of another oscillator.
    """
    path = folder / CAMPAIGN_FILE
    campaign = read_campaign(path)
    runs = {run.name: run for run in campaign.runs}
    settings, _ = settings_of(folder, None)
    recorded = campaign_cycles(folder, campaign, settings, executor, lambda *_: None)
    moving = [cycle for cycle in recorded.cycles if cycle.frequency_hz > 0.0]
    cycles = [cycle for cycle in moving if not cycle.lines]
    oscillator = file.rig.oscillator
    for cycle in cycles:
        if (cycle.plane, cycle.half_spacing_m) != (oscillator.plane, oscillator.half_spacing_m):
            raise ConfigurationError(
                f"{path}: {cycle.name} was made on another oscillator than that of "
                f"{file.rig_path.name}; name the campaigns of this design alone"
            )
    made_runs = [runs[cycle.name] for cycle in cycles]
    candidates = tuple(CandidateRun(run.set_point, run.periods, math.inf) for run in made_runs)
    failures = {failure.name: failure.message for failure in recorded.failed}
    failures |= {cycle.name: MANY_LINES for cycle in moving if cycle.lines}
    return MeasuredRuns(candidates, tuple(cycles), recorded.stated, failures)


def _noise_shown(file: DesignFile) -> float:
    """Return how many times as much the runs scatter as is believed; 1 where they cannot tell."""
    if len(file.made_runs) < _ENOUGH:
        return 1.0
    cycles = (made_up(file.made_runs, file.belief, file.noise), file.cycles)
    believed, shown = (
        expected_coefficients(file.made_runs, group, file.targets, file.belief, file.stated)
        for group in cycles
    )
    pairs = zip(map(_scatter, shown), map(_scatter, believed), strict=True)
    ratios = [
        shown_u / believed_u
        for shown_u, believed_u in pairs
        if math.isfinite(shown_u) and believed_u > 0.0
    ]
    return median(ratios) if ratios and min(ratios) > 0.0 else 1.0


def _scatter(coefficient: ExpectedCoefficient) -> float:
    """Return what the periods' scatter leaves of a coefficient."""
    if not math.isfinite(coefficient.standard_uncertainty):
        return math.inf
    return coefficient.standard_uncertainty * math.sqrt(coefficient.shares.get(SCATTER, 0.0))
