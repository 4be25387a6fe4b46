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
from analysis.design.expectation import SCATTER, ExpectedCoefficient, expected, made_up
from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.coefficients.campaign_cycles import campaign_cycles
from pmm.coefficients.settings import settings_of
from pmm.coefficients.stated_inputs import largest
from pmm.design.design_file import DesignFile

_LINES = "a design goes on from single sines; runs of many lines are not among them"
_ENOUGH = 3  # runs, or repeats beyond the first of their kind: fewer say too little of the noise


@dataclass(frozen=True, eq=False)
class Measured:
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


def after(file: DesignFile, parts: Sequence[Measured]) -> DesignFile:
    """Return a design that goes on from runs that were made, with the noise that they showed.

    What ``[[runs]]`` has is taken to be among them.

    Raises
    ------
    DataError
        If no run can be used.
    """
    candidates = tuple(one for part in parts for one in part.candidates)
    cycles = [one for part in parts for one in part.cycles]
    if not cycles:
        why = "; ".join(f"{name}: {said}" for part in parts for name, said in part.failed.items())
        raise DataError(f"none of the runs that were made can be used{why and f' ({why})'}")
    spread = repeating(cycles, file.noise.repeat_relative)
    stated = largest([file.stated, *(part.stated for part in parts)])
    table = {key: one for key, one in file.plan_table.items() if key != "runs"}
    going_on = replace(
        file, plan_table=table, fixed=(), made=candidates, stated=stated,
        cycles=tuple(with_repeats(one, spread) for one in cycles),
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
    known = repeatability(cycles)
    if known.degrees_of_freedom >= _ENOUGH:
        return known
    freedom = known.degrees_of_freedom or math.inf
    return replace(known, relative=np.maximum(known.relative, stated), degrees_of_freedom=freedom)


def repeats_said(cycles: Sequence[BodyCycle], stated: float) -> str:
    """Say which scatter between repeats uncertainties count on; empty where there is none."""
    known = repeatability(cycles)
    shown = f"{100.0 * float(known.relative.max()):.2g} %"
    freedom = f"{known.degrees_of_freedom:g} degrees of freedom"
    if known.degrees_of_freedom >= _ENOUGH:
        return f"repeats differ by {shown} of their load, as they showed with {freedom}"
    if not stated > 0.0:
        return ""
    few = f"repeats with {freedom} showed {shown}" if known.kinds else "no repeat was made"
    return (
        f"repeats are taken to differ by {100.0 * stated:.2g} % of their load, as repeat_relative "
        f"states, or more: {few}, and what they show counts alone from {_ENOUGH} on"
    )


def measured(file: DesignFile, folder: Path, executor: Executor) -> Measured:
    """Read the runs of a campaign's folder, each on an executor.

    Raises
    ------
    ConfigurationError
        If the folder holds no campaign, or one of another oscillator.
    """
    path = folder / CAMPAIGN_FILE
    campaign = read_campaign(path)
    runs = {one.name: one for one in campaign.runs}
    settings, _ = settings_of(folder, None)
    found = campaign_cycles(folder, campaign, settings, executor, lambda *_: None)
    moving = [one for one in found.cycles if one.frequency_hz > 0.0]
    cycles = [one for one in moving if not one.lines]
    oscillator = file.rig.oscillator
    for one in cycles:
        if (one.plane, one.half_spacing_m) != (oscillator.plane, oscillator.half_spacing_m):
            raise ConfigurationError(
                f"{path}: {one.name} was made on another oscillator than that of "
                f"{file.rig_path.name}; name the campaigns of this design alone"
            )
    made = [runs[one.name] for one in cycles]
    candidates = tuple(CandidateRun(one.set_point, one.periods, math.inf) for one in made)
    failed = {one.name: one.message for one in found.failed}
    failed |= {one.name: _LINES for one in moving if one.lines}
    return Measured(candidates, tuple(cycles), found.stated, failed)


def _noise_shown(file: DesignFile) -> float:
    """Return how many times as much the runs scatter as is believed; 1 where they cannot tell."""
    if len(file.made) < _ENOUGH:
        return 1.0
    cycles = (made_up(file.made, file.belief, file.noise), file.cycles)
    believed, shown = (
        expected(file.made, own, file.targets, file.belief, file.stated) for own in cycles
    )
    pairs = zip(map(_scatter, shown), map(_scatter, believed), strict=True)
    ratios = [one / other for one, other in pairs if math.isfinite(one) and other > 0.0]
    return median(ratios) if ratios and min(ratios) > 0.0 else 1.0


def _scatter(one: ExpectedCoefficient) -> float:
    """Return what the periods' scatter leaves of a coefficient."""
    if not math.isfinite(one.standard_uncertainty):
        return math.inf
    return one.standard_uncertainty * math.sqrt(one.shares.get(SCATTER, 0.0))
