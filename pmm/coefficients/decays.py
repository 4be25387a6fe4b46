"""Free decays of a campaign: what ``pmm run`` or another system recorded, read into roll decays."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from analysis.coefficients.alike import is_same_speed, speed_classes
from analysis.coefficients.roll_decay import RollDecay
from analysis.inertia.damping import small_damping_of
from analysis.inertia.record import RecordAnalysis, analyse_record, from_runs
from analysis.inertia.series import series_from_recording
from analysis.uncertainty.estimate import Estimate
from hardware.description.channels import HEEL_ANGLE
from hardware.description.errors import PmmError
from hardware.description.flags import Flag, Severity
from hardware.description.heel import Heel
from hardware.description.kinds import RunKind
from pmm.campaign.campaign import Campaign
from pmm.campaign.recording_source import COMPLETE, RecordingSource, open_recording
from pmm.campaign.runs import AtRest
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.tasks import FailedRecording


@dataclass(frozen=True, eq=False)
class Decay:
    """The decays at one speed.

    Attributes
    ----------
    speed_m_s
        At which the model was towed, the median of the runs.
    records
        One for each run, in their order.
    period, ratio
        Damped period, s, and the share of critical damping, of small rolls.
    """

    speed_m_s: float
    runs: tuple[AtRest, ...]
    records: tuple[RecordAnalysis, ...]
    period: Estimate
    ratio: Estimate

    @property
    def flags(self) -> tuple[Flag, ...]:
        """What was noticed, with the runs' names."""
        pairs = zip(self.runs, self.records, strict=True)
        return tuple(flag.of(run.name) for run, record in pairs for flag in record.flags)


def decays_of(
    campaign: Campaign, folder: Path, leave_out: Sequence[str] = ()
) -> tuple[tuple[Decay, ...], tuple[FailedRecording, ...]]:
    """Return a campaign's free decays by speed, and the records that could not be used."""
    pairs: list[tuple[AtRest, RecordAnalysis]] = []
    failures = []
    for record in campaign.at_rest:
        is_used = record.outcome == COMPLETE and record.name not in leave_out
        if record.kind is RunKind.FREE_DECAY and is_used:
            source = RecordingSource.of(campaign, record, folder.resolve())
            try:
                series = series_from_recording(open_recording(source), HEEL_ANGLE.name)
                pairs.append((record, analyse_record(replace(series, name=record.name))))
            except PmmError as error:
                failures.append(
                    FailedRecording(record.name, str(source.path), str(error), error.exit_status)
                )
    groups = speed_classes(pairs, lambda pair: pair[0].carriage_speed_m_s)
    return tuple(_joined(group, speed) for group, speed in groups), tuple(failures)


def _joined(pairs: Sequence[tuple[AtRest, RecordAnalysis]], speed_m_s: float) -> Decay:
    """Join the records of one speed, at the amplitudes at which GM is what rights the model."""
    runs, records = zip(*pairs, strict=True)
    return Decay(speed_m_s, runs, records, from_runs(records).estimate, small_damping_of(records))


def with_recorded(
    settings: CoefficientSettings, decays: Sequence[Decay], heel: Heel | None
) -> tuple[CoefficientSettings, tuple[Flag, ...]]:
    """Return settings whose roll decays have those that were recorded too.

    A decay of a speed that the settings have one of themselves is theirs. Without metacentric
    height and inertia nothing follows but period and damping ratio, and a flag says so.
    """
    stated = [decay.speed_m_s for decay in settings.roll_decays]
    new_decays = [
        decay
        for decay in decays
        if not any(is_same_speed(speed, decay.speed_m_s) for speed in stated)
    ]
    if new_decays and (heel is None or heel.gm_m is None or heel.inertia_kg_m2 is None):
        text = (
            "free decays: period and damping ratio alone; state gm_m and inertia_kg_m2 in [heel] "
            "of the campaign file for K_p and K_pdot"
        )
        names = tuple(run.name for decay in new_decays for run in decay.runs)
        return settings, (Flag("decay_alone", Severity.NOTE, text, None, names),)
    uncertainties = settings.decays
    roll_decays = [
        RollDecay(
            decay.period.value,
            decay.ratio.value,
            decay.period.uncertainty,
            decay.ratio.uncertainty,
            uncertainties.u_gm_m,
            uncertainties.u_inertia_kg_m2,
            decay.speed_m_s,
            decay.period.degrees_of_freedom,
            decay.ratio.degrees_of_freedom,
        )
        for decay in new_decays
    ]
    return replace(settings, roll_decays=(*settings.roll_decays, *roll_decays)), ()
