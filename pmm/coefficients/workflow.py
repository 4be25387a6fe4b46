"""From folders of recordings to a campaign's coefficients, on any executor."""

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.dry_checks import dry_checks
from analysis.coefficients.righting_checks import righting_checks
from analysis.coefficients.roll_decay import NAMES as OF_DECAYS
from analysis.coefficients.roll_decay import with_decays
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.steady_turns import SteadyTurn
from analysis.memory.measured_matrices import MeasuredMatrix, measured_matrices
from hardware.description.body import Body
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.water import TankWater, common_water
from pmm.coefficients.campaign_cycles import CampaignCycles, campaign_cycles
from pmm.coefficients.decays import Decay, with_recorded
from pmm.coefficients.run_names import check_left_out, check_names
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.solving import Progress, solve_campaign
from pmm.coefficients.stated_inputs import largest, with_turns
from pmm.coefficients.tasks import FailedRecording, ReadRecording
from pmm.coefficients.turn_file import read_turns, turn_cycles
from pmm.coefficients.wave_runs import WaveRun

if TYPE_CHECKING:
    from analysis.memory.result import MeasuredMemory

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class CampaignOutcome:
    """A campaign's coefficients and all that they rest on.

    Attributes
    ----------
    parts
        What was read, of each of the campaigns that are taken as one.
    result
        In SI units; :mod:`pmm.coefficients.systems` takes the dimensions off.
    cycles
        Of the runs that were used, with what was taken off.
    left_out
        About the campaign: what was not used, and what is missing or looks wrong.
    settings
        As they were given, with the density of the campaigns' water where they state none.
    water
        That of the campaigns.
    at_rest
        Added mass and damping without carriage speed, where four frequencies or more tell them.
    """

    parts: tuple[CampaignCycles, ...]
    result: CampaignCoefficients
    cycles: tuple[BodyCycle, ...]
    left_out: tuple[Flag, ...]
    stated: StatedUncertainties
    settings: CoefficientSettings
    water: TankWater | None = None
    turns: tuple[SteadyTurn, ...] = ()
    at_rest: tuple[MeasuredMatrix, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The campaigns' names."""
        return tuple(part.campaign.name for part in self.parts)

    @property
    def body(self) -> Body | None:
        """The model, one for all campaigns; ``None`` where dry runs are taken off."""
        return self.parts[0].body if self.parts else None

    @property
    def runs(self) -> tuple[ReadRecording, ...]:
        """What was read, zeros and dry runs included."""
        return _joined(part.runs for part in self.parts)

    @property
    def failed(self) -> tuple[FailedRecording, ...]:
        """What could not be used."""
        return _joined(part.failed for part in self.parts)

    @property
    def not_recorded(self) -> tuple[str, ...]:
        """Names of runs whose recordings are not there yet."""
        return _joined(part.work.not_recorded for part in self.parts)

    @property
    def decays(self) -> tuple[Decay, ...]:
        """The free decays, by campaign and speed."""
        return _joined(part.decays for part in self.parts)

    @property
    def waves(self) -> tuple[WaveRun, ...]:
        """The runs in waves."""
        return _joined(part.waves for part in self.parts)

    @property
    def with_memory(self) -> tuple[Campaign, ...]:
        """The campaigns whose simulation has a memory of the water, fitted to a table."""
        return tuple(part.campaign for part in self.parts if part.campaign.radiation is not None)

    @property
    def flags(self) -> Mapping[str, tuple[Flag, ...]]:
        """About runs, by the run's name."""
        return {run.name: run.flags for run in self.runs if run.flags}

    @cached_property
    def memories(self) -> "tuple[MeasuredMemory, ...]":
        """The water's memory of each of the matrices at rest, in SI units."""
        from analysis.memory.fit import fit_measured

        return tuple(fit_measured(matrices) for matrices in self.at_rest)

    @property
    def noticed(self) -> tuple[Flag, ...]:
        """All that was flagged of the runs that were used, each flag with its runs."""
        of_runs = [flag for flags in self.flags.values() for flag in flags]
        flags = (*self.implausible, *self.left_out, *self.result.flags, *of_runs)
        return tuple(dict.fromkeys(flags))

    @property
    def implausible(self) -> tuple[Flag, ...]:
        """What makes all numbers doubtful: channels that look wrong in all runs."""
        return _joined(part.implausible for part in self.parts)

    @property
    def all_flags(self) -> tuple[Flag, ...]:
        """The same with the runs that could not be used."""
        failure_flags = [
            Flag("run_failed", Severity.VOID, failure.message, None, (failure.name,))
            for failure in self.failed
        ]
        return (*failure_flags, *self.noticed)


_NOTHING_STATED = Flag(
    "nothing_stated",
    Severity.WARNING,
    "no standard uncertainty is stated: the intervals hold the scatter of the periods and nothing "
    "of mass, inertia, calibration, amplitude or speed; write [uncertainty] in coefficients.toml "
    "and [model_uncertainty] in the campaign file",
)


def coefficients_of(
    folders: Sequence[Path],
    settings: CoefficientSettings,
    executor: Executor,
    progress: Progress,
    *,
    hashed: bool = False,
) -> CampaignOutcome:
    """Analyse all runs of some campaigns and return their coefficients.

    Parameters
    ----------
    folders
        Each with a campaign file; several are taken as one campaign of one rig and model.
    hashed
        Whether the recordings' hashes are wanted.

    Raises
    ------
    ConfigurationError
        If a file is wrong, inertia is missing, geometry differs, or two runs have one name.
    DataError
        If no run can be used, or a wanted coefficient is not determined.
    """
    campaigns = [(folder, read_campaign(folder / CAMPAIGN_FILE)) for folder in folders]
    check_names(campaigns)
    check_left_out(settings.leave_out, [campaign for _, campaign in campaigns])
    water = common_water([campaign.water for _, campaign in campaigns])
    settings = replace(settings, ship=settings.ship.within(water))
    parts = tuple(
        campaign_cycles(folder, campaign, settings, executor, progress, hashed=hashed)
        for folder, campaign in campaigns
    )
    first, body = parts[0].campaign, parts[0].body
    decays = _joined(part.decays for part in parts)
    settings, alone = with_recorded(settings, decays, first.heel)
    turns = () if settings.steady_turns is None else read_turns(Path(settings.steady_turns))
    circles = turn_cycles(turns, first.oscillator, body)
    cycles = (
        *_joined(part.cycles for part in parts),
        *(cycle.about(settings.point_ahead_m) for cycle in circles),
    )
    if not cycles:
        raise DataError(_no_runs_message(folders, parts))
    cycles, unweighed = _with_scatter(cycles)
    turns = (*_joined(part.turns for part in parts), *turns)
    stated = largest([part.stated for part in parts])
    doubts = (
        *_joined((*part.work.left_out, *part.without_roll_gauge) for part in parts),
        *unweighed,
        *(() if stated.vector.any() else (_NOTHING_STATED,)),
        *alone,
        *_joined(decay.flags for decay in decays),
    )
    stated = with_turns(stated, turns)
    result = solve_campaign(cycles, request_of(settings, stated), executor, progress)
    result = with_decays(result, settings.roll_decays, first.heel, body)
    in_air = _joined(part.in_air for part in parts)
    if in_air and body is not None:
        extra = dry_checks(in_air, body, stated, settings.level)
        result = replace(result, checks=(*result.checks, *extra))
    zeros = [run.zero for part in parts for run in part.runs if run.zero is not None]
    at_heels = [(zero.name, zero.heel_rad, zero.reading) for zero in zeros]
    righting = righting_checks(at_heels, first.heel, body, settings.level)
    result = replace(result, checks=(*result.checks, *righting))
    rest = measured_matrices(result)
    return CampaignOutcome(parts, result, cycles, doubts, stated, settings, water, turns, rest)


def _with_scatter(
    cycles: tuple[BodyCycle, ...],
) -> tuple[tuple[BodyCycle, ...], tuple[Flag, ...]]:
    """Leave out runs that tell no scatter, where others do: nothing says how much they weigh."""
    silent = [
        cycle.name
        for cycle in cycles
        if not np.isfinite(cycle.phasors.real.standard_uncertainty).all()
    ]
    if len(silent) in (0, len(cycles)):
        return cycles, ()
    message = (
        "left out: a single whole period tells no scatter, so nothing says what it weighs beside "
        "the other runs; record more periods, or gate more"
    )
    flag = Flag("run_left_out", Severity.WARNING, message, None, tuple(dict.fromkeys(silent)))
    return tuple(cycle for cycle in cycles if cycle.name not in silent), (flag,)


def _joined(parts: Iterable[tuple[T, ...]]) -> tuple[T, ...]:
    return tuple(chain.from_iterable(parts))


def request_of(settings: CoefficientSettings, stated: StatedUncertainties) -> Request:
    """Return what is wanted of the campaign."""
    return Request(
        settings.form,
        stated,
        tuple(name for name in settings.wanted if not (settings.roll_decays and name in OF_DECAYS)),
        settings.level,
        settings.trials,
        settings.seed,
        settings.nonlinear,
        settings.zero_frequency,
    )


def _no_runs_message(folders: Sequence[Path], parts: Sequence[CampaignCycles]) -> str:
    folder_text = ", ".join(map(str, folders))
    missing = _joined(part.work.not_recorded for part in parts)
    if failures := _joined(part.failed for part in parts):
        return f"{folder_text}: none of the runs can be used; the first: {failures[0].message}"
    if missing:
        return (
            f"{folder_text}: none of the runs is recorded yet ({', '.join(missing[:5])}); a "
            'recording is NAME.nc in that folder, or what the run names with file = "..."'
        )
    return f"{folder_text}: no runs in water; add a table [[runs]] for each"
