"""One campaign's recordings, read into the cycles that are fitted."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.line_cycles import by_lines
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.steady_turns import SteadyTurn
from analysis.coefficients.strut_phasors import MOTION_ASKED, STRUT_ASKED
from hardware.description.body import Body
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.campaign.campaign import Campaign
from pmm.campaign.plausibility import implausible
from pmm.coefficients.decays import Decay, decays_of
from pmm.coefficients.reading import read_cycle, read_zero
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.solving import Progress
from pmm.coefficients.stated_inputs import chain_of, oscillator_of, stated_of
from pmm.coefficients.taken_off import body_of, in_still_air, with_own_body, without_dry
from pmm.coefficients.tasks import FailedRecording, ReadRecording, Task
from pmm.coefficients.wave_runs import WaveRun, wave_runs
from pmm.coefficients.work import Work, work_of

NO_ROLL_GAUGE: Final = (
    "a missing roll gauge: the channel roll_moment is not recorded, so that no term of K is told; "
    "record it where the model heels"
)
NO_RESTORING: Final = (
    "a model without displaced_kg floats, and what floats has a hydrostatic restoring: none is "
    "stated, so that it stands in the added mass (less by C over the square of the frequency); "
    "state restoring in [hull], or displaced_kg of a model below the surface in [model]"
)


@dataclass(frozen=True, eq=False)
class CampaignCycles:
    """One campaign's recordings, read.

    Attributes
    ----------
    cycles
        Of the runs that can be used.
    stated
        Standard uncertainties that its runs share.
    in_air
        Of the dry runs, where they are not what is taken off: with the model that is.
    """

    campaign: Campaign
    cycles: tuple[BodyCycle, ...]
    runs: tuple[ReadRecording, ...]
    failed: tuple[FailedRecording, ...]
    work: Work
    stated: StatedUncertainties
    body: Body | None
    decays: tuple[Decay, ...]
    in_air: tuple[BodyCycle, ...] = ()

    @property
    def turns(self) -> tuple[SteadyTurn, ...]:
        """Its runs on a circle."""
        return tuple(run.turn for run in self.runs if run.turn is not None)

    @property
    def waves(self) -> tuple[WaveRun, ...]:
        """Its runs in waves."""
        return tuple(wave_runs(self.campaign, self.runs))

    @cached_property
    def implausible(self) -> tuple[Flag, ...]:
        """Units, signs and places of channels that look wrong in all runs."""
        harmonics = [run.run_harmonics for run in self.runs if run.run_harmonics is not None]
        return (*implausible(self.campaign, harmonics), *self._without_restoring)

    @property
    def _without_restoring(self) -> tuple[Flag, ...]:
        """A model that floats, and heaves or pitches without a restoring."""
        model = self.campaign.model
        lacks = any(
            cycle.plane is Plane.VERTICAL and cycle.frequency_hz and not cycle.restoring.any()
            for cycle in self.cycles
        )
        if model is None or model.displaced_kg is not None or not lacks:
            return ()
        return (Flag("restoring_missing", Severity.WARNING, NO_RESTORING),)

    @property
    def without_roll_gauge(self) -> tuple[Flag, ...]:
        """A roll gauge that is not there, though the model heels."""
        names = tuple(dict.fromkeys(cycle.name for cycle in self.cycles if not cycle.has_roll))
        if self.campaign.heel is None or not names:
            return ()
        return (Flag("roll_gauge_missing", Severity.WARNING, NO_ROLL_GAUGE, None, names),)


def campaign_cycles(
    folder: Path,
    campaign: Campaign,
    settings: CoefficientSettings,
    executor: Executor,
    progress: Progress,
    *,
    hashed: bool = False,
) -> CampaignCycles:
    """Read all runs of one campaign, and fit nothing yet.

    Raises
    ------
    ConfigurationError
        If inertia is missing, or a geometry differs.
    """
    oscillator = oscillator_of(campaign, folder)
    work = work_of(
        campaign,
        folder,
        oscillator,
        chain_of(settings),
        harmonics=settings.harmonics,
        leave_out=settings.leave_out,
        hashed=hashed,
    )
    body, models = body_of(campaign, settings.inertia, has_dry=bool(work.dry))
    decays, decay_failures = decays_of(campaign, folder, settings.leave_out)
    recordings = _recordings(work, executor, progress)
    wet, dry = _sorted(recordings, {task.name for task in work.dry})
    wet = [with_own_body(cycle, campaign, settings, body) for cycle in wet]
    in_air = [] if body is None else [in_still_air(run, campaign, settings, body) for run in dry]
    if body is None:  # a dry run is taken off line by line
        wet, dry = (
            [line_cycle for cycle in group for line_cycle in by_lines(cycle)]
            for group in (wet, dry)
        )
    cycles = [cycle.about(settings.point_ahead_m) for cycle in wet]
    if body is None:
        cycles = [
            without_dry(cycle, dry, campaign) if cycle.frequency_hz else cycle for cycle in cycles
        ]
    readings = [outcome for outcome in recordings if isinstance(outcome, ReadRecording)]
    gauges = [reading.calibration for reading in readings if reading.calibration is not None]
    return CampaignCycles(
        campaign,
        tuple(cycles),
        tuple(readings),
        (
            *(outcome for outcome in recordings if isinstance(outcome, FailedRecording)),
            *decay_failures,
        ),
        work,
        stated_of(
            campaign,
            settings,
            models,
            gauges,
            motion_asked=_is_motion_asked(cycles),
            following=[reading.following for reading in readings if reading.following],
            speed_age_s=max((reading.speed_age_u_s for reading in readings), default=0.0),
        ),
        body,
        decays,
        tuple(in_air),
    )


def _recordings(
    work: Work, executor: Executor, progress: Progress
) -> list[ReadRecording | FailedRecording]:
    """Read the zero runs, and then all that they are taken off."""
    zeros = _read_all(read_zero, work.zeros, "reading zero runs", executor, progress)
    by_name = {
        zero.name: zero.zero for zero in zeros if isinstance(zero, ReadRecording) and zero.zero
    }
    tasks = (*work.runs, *work.dry)
    recordings = _read_all(
        read_cycle, [task.with_zeros(by_name) for task in tasks], "reading runs", executor, progress
    )
    return [*zeros, *recordings]


def _is_motion_asked(cycles: Sequence[BodyCycle]) -> bool:
    """Whether a set-point's motion stands in for one that was not measured."""
    codes = {MOTION_ASKED.code, STRUT_ASKED.code}
    return any(flag.code in codes for cycle in cycles for flag in cycle.flags)


def _read_all(
    reader: Callable[[Task], ReadRecording | FailedRecording],
    tasks: Sequence[Task],
    step: str,
    executor: Executor,
    progress: Progress,
) -> list[ReadRecording | FailedRecording]:
    recordings = []
    for recording in executor.map(reader, tasks):
        recordings.append(recording)
        progress(len(recordings), len(tasks), step)
    return recordings


def _sorted(
    recordings: Sequence[ReadRecording | FailedRecording], dry: set[str]
) -> tuple[list[BodyCycle], list[BodyCycle]]:
    cycles = [
        recording.cycle
        for recording in recordings
        if isinstance(recording, ReadRecording) and recording.cycle is not None
    ]
    wet = [cycle for cycle in cycles if cycle.name not in dry]
    return wet, [cycle for cycle in cycles if cycle.name in dry]
