"""A campaign that is pursued until its gap is known: what its folder says is planned and made.

Round ``N`` is the plan ``next-N.toml`` beside the campaign file, its runs are ``next-N-1``, ...; a
run is made once the campaign file names it. The folder is all the state there is, so that whoever
was interrupted goes on from it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from analysis.gap.design.proposals import Proposal
from hardware.description.errors import ConfigurationError, PmmError
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.recording_source import RecordingSource, open_recording
from pmm.campaign.runs import AtRest, Run
from pmm.campaign.simulation import simulate_runs
from pmm.configuration import Fault, as_error, read_toml, validate
from pmm.gap.appending import append_tables
from pmm.gap.next_plan import plan_text
from pmm.plan.ordering import runs_of
from pmm.plan.plan_tables import PlanTables
from pmm.plan.plan_units import EXTRA_KEYS, expand_units
from pmm.plan.run_plan import RunPlan
from pmm.recorder.campaign_owner import own_campaign
from pmm.recorder.files import RECORDING
from pmm.toml_text import toml_table
from pmm.whole_file import write_whole
from sim.effects.effect import Effect

Maker = Callable[[Path, Campaign, Sequence[Run]], None]
"""Makes the recordings of runs in a folder; the campaign has the runs that were made."""

_PREFIX: Final = "next-"


@dataclass(frozen=True, eq=False)
class Pursued:
    """A campaign's folder as a pursuit finds it.

    Attributes
    ----------
    plans
        Those of the rounds, in their order.
    open
        Planned runs that the campaign does not have yet.
    """

    folder: Path
    campaign: Campaign
    plans: tuple[Path, ...]
    open: tuple[Run, ...]

    @property
    def set_points(self) -> frozenset[SetPoint]:
        """What was made or is planned."""
        return frozenset(one.set_point for one in (*self.campaign.runs, *self.open))


def pursued(folder: Path) -> Pursued:
    """Read a campaign's folder.

    Raises
    ------
    ConfigurationError
        If it is no campaign's folder, or a plan of it cannot be read.
    """
    file = folder / CAMPAIGN_FILE
    if not file.is_file():
        raise ConfigurationError(f"{folder}: no folder with a {CAMPAIGN_FILE}")
    campaign = read_campaign(file)
    plans = sorted(folder.glob(f"{_PREFIX}*.toml"), key=_number)
    made = {run.name for run in campaign.runs}
    planned = [run for path in plans for run in _planned(path, campaign)]
    opened = tuple(run for run in planned if run.name not in made)
    return Pursued(folder, campaign, tuple(plans), opened)


def _number(path: Path) -> int:
    number = path.stem.removeprefix(_PREFIX)
    if not number.isdecimal():
        raise ConfigurationError(
            f"{path}: the plans of a pursuit are {_PREFIX}1.toml, {_PREFIX}2.toml, ...; give this "
            "one another name"
        )
    return int(number)


def _planned(path: Path, campaign: Campaign) -> list[Run]:
    """Return the oscillations of a plan; its rig is the campaign's oscillator."""
    table = read_toml(path)
    faults: list[Fault] = []
    expand_units(table, faults)
    tables = validate(PlanTables, table, faults, EXTRA_KEYS)
    if tables is None or faults:
        raise as_error(path, faults, table)
    if campaign.oscillator is None:
        raise ConfigurationError(
            f"{path.parent / CAMPAIGN_FILE}: no table [oscillator]; proposed runs need it"
        )
    return [_run(one) for one in runs_of(tables, campaign.oscillator, ()) if one.oscillates]


def _run(one: RunPlan) -> Run:
    point = one.set_point
    return Run(
        one.name,
        point.frequency_hz,
        point.eccentricity_m,
        point.strut_phase_rad,
        point.carriage_speed_m_s,
        point.medium,
        one.periods,
        point.drift_rad,
        kind=one.kind,
        motion=one.motion,
    )


def worth_making(
    there: Pursued, proposals: Sequence[Proposal], least: float
) -> tuple[Proposal, ...]:
    """Return the runs that the rig can make by itself, are new, and worth ``least`` log odds."""
    return tuple(
        one
        for one in proposals
        if one.set_point is not None
        and not one.force_n
        and one.gain >= least
        and one.set_point not in there.set_points
    )


def write_round(there: Pursued, proposals: Sequence[Proposal]) -> Path:
    """Write the plan of the next round, whole or not at all, and return where it is."""
    name = f"{_PREFIX}{_number(there.plans[-1]) + 1 if there.plans else 1}"
    path = there.folder / f"{name}.toml"
    write_whole(path, plan_text(f"{there.campaign.name}-{name}", proposals, name))
    return path


def simulated_by(path: Path, campaign: Campaign) -> Maker:
    """Return what makes runs on a simulated rig.

    Parameters
    ----------
    path
        The rig as it truly is: a campaign file, its effects among it.
    campaign
        That is pursued.

    Raises
    ------
    ConfigurationError
        If the file cannot be read or describes another oscillator.
    """
    truth = read_campaign(path)
    if truth.oscillator != campaign.oscillator:
        raise ConfigurationError(
            f"{path}: describes another oscillator than campaign {campaign.name!r}; simulate on "
            "the rig that the campaign was made on"
        )
    truth.rig()  # refuses what cannot be simulated, before anything is diagnosed
    return _Simulated(truth, truth.effects_on())


@dataclass(frozen=True)
class _Simulated:
    truth: Campaign
    effects: tuple[Effect, ...]

    def __call__(self, folder: Path, campaign: Campaign, runs: Sequence[Run]) -> None:
        whole = replace(self.truth, runs=(*campaign.runs, *runs), at_rest=campaign.at_rest)
        missing = [one for one in runs if _recording(folder, one) is None]
        seed = self.truth.simulation.seed
        with own_campaign(folder):
            list(simulate_runs(whole, missing, folder, seed, overwrite=False, effects=self.effects))


def take_in(there: Pursued) -> dict[str, str]:
    """Append the open runs whose recordings have appeared; return the others with the reason.

    A recording that cannot be read has not appeared yet: it may still be copied.

    Raises
    ------
    ConfigurationError
        If the campaign file takes no further ``[[runs]]``; it stays as it was then.
    """
    missing: dict[str, str] = {}
    tables: list[str] = []
    for run in there.open:
        file = _recording(there.folder, run)
        try:
            if file is None:
                missing[run.name] = f"no {run.name}.nc"
                continue
            recorded = replace(run, file=file)
            open_recording(RecordingSource.of(there.campaign, recorded, there.folder))
        except (PmmError, OSError) as error:
            missing[run.name] = str(error)
            continue
        tables.append("\n" + toml_table("runs", _keys(recorded, there, len(tables)), array=True))
    if tables:
        append_tables(there.folder / CAMPAIGN_FILE, tables, read_campaign)
    return missing


def _recording(folder: Path, run: Run) -> str | None:
    """Return where a run's recording lies in the folder; ``None`` where it is not there."""
    names = (f"{run.name}.nc", f"{run.name}/{RECORDING}")
    return next((name for name in names if (folder / name).is_file()), None)


def _keys(run: Run, there: Pursued, before: int) -> dict[str, Any]:
    """Return a run as the campaign file has it, ``before`` others having been appended with it."""
    every: tuple[Run | AtRest, ...] = (*there.campaign.runs, *there.campaign.at_rest)
    known = [one.number for one in every if one.number]
    return {
        "name": run.name,
        "frequency_hz": run.frequency_hz,
        "eccentricity_m": run.eccentricity_m,
        "strut_phase_rad": run.strut_phase_rad,
        "carriage_speed_m_s": run.carriage_speed_m_s,
        "medium": run.medium,
        "drift_rad": run.drift_rad,
        "periods": run.periods,
        "kind": run.kind,
        "motion": run.motion,
        "file": None if run.file == f"{run.name}.nc" else run.file,
        "number": max(known) + 1 + before if known else None,
    }
