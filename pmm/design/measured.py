"""Runs of a design that were made: their cycles as the analysis reads them, and what they showed.

A campaign's folder is all the state there is: whoever was interrupted designs anew from it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.repeats import repeatability, with_repeats
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.candidate import CandidateRun
from analysis.design.expectation import SCATTER, ExpectedCoefficient, expected, made_up
from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.coefficients.settings import settings_of
from pmm.coefficients.stated_inputs import largest
from pmm.coefficients.workflow import coefficients_of
from pmm.design.design_file import DesignFile
from pmm.parallel import open_executor

_ENOUGH = 3  # runs: fewer say too little of the noise


@dataclass(frozen=True, eq=False)
class Measured:
    """Oscillations that were made and can be used; each with its cycle."""

    candidates: tuple[CandidateRun, ...]
    cycles: tuple[BodyCycle, ...]
    stated: StatedUncertainties


def after(file: DesignFile, folders: Sequence[Path]) -> DesignFile:
    """Return a design that goes on from runs that were made, with the noise that they showed.

    What ``[[runs]]`` has is taken to be among them.

    Raises
    ------
    ConfigurationError
        If a folder holds no campaign, or one of another oscillator.
    DataError
        If no run can be used.
    """
    found = [_measured(file, folder) for folder in folders]
    candidates = tuple(one for part in found for one in part.candidates)
    cycles = [one for part in found for one in part.cycles]
    known = repeatability(cycles)
    both = np.maximum(known.relative, file.noise.repeat_relative)
    spread = replace(known, relative=both, degrees_of_freedom=known.degrees_of_freedom or math.inf)
    stated = largest([file.stated, *(part.stated for part in found)])
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
            noise, force_n=times * noise.force_n, displacement_m=times * noise.displacement_m
        ),
    )


def _measured(file: DesignFile, folder: Path) -> Measured:
    path = folder / CAMPAIGN_FILE
    runs = {one.name: one for one in read_campaign(path).runs}
    settings, _ = settings_of(folder, None)
    with open_executor(1) as executor:
        outcome = coefficients_of([folder], settings, executor, lambda *_: None)
    cycles = [one for one in outcome.cycles if one.frequency_hz > 0.0]
    oscillator = file.rig.oscillator
    for one in cycles:
        if (one.plane, one.half_spacing_m) != (oscillator.plane, oscillator.half_spacing_m):
            raise ConfigurationError(
                f"{path}: {one.name} was made on another oscillator than that of "
                f"{file.rig_path.name}; name the campaigns of this design alone"
            )
    made = [runs[one.name] for one in cycles]
    candidates = tuple(CandidateRun(one.set_point, one.periods, math.inf) for one in made)
    return Measured(candidates, tuple(cycles), outcome.stated)


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
