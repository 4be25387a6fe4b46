"""The folder of a campaign that is pursued, its runs made by whoever can: plans, what was recorded.

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
from pmm.configuration import Fault, as_error, read_toml, validate
from pmm.gap.appended_tables import append_tables
from pmm.gap.next_plan import plan_text
from pmm.plan.ordering import runs_of
from pmm.plan.plan_tables import PlanTables
from pmm.plan.plan_units import EXTRA_KEYS, expand_units
from pmm.plan.run_plan import RunPlan
from pmm.recorder.files import RECORDING
from pmm.toml_text import toml_table
from pmm.whole_file import write_whole

Maker = Callable[[Path, Campaign, Sequence[Run]], None]
"""Makes the recordings of runs in a folder; the campaign has the runs that were made."""

_PREFIX: Final = "next-"


@dataclass(frozen=True, eq=False)
class PursuedFolder:
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
    open: tuple[RunPlan, ...]

    @property
    def set_points(self) -> frozenset[SetPoint]:
        """What was made or is planned."""
        made = {run.set_point for run in self.campaign.runs}
        return frozenset(made | {run.set_point for run in self.open})


def read_pursued_folder(folder: Path) -> PursuedFolder:
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
    return PursuedFolder(folder, campaign, tuple(plans), opened)


def _number(path: Path) -> int:
    number = path.stem.removeprefix(_PREFIX)
    if not number.isdecimal():
        raise ConfigurationError(
            f"{path}: the plans of a pursuit are {_PREFIX}1.toml, {_PREFIX}2.toml, ...; give this "
            "one another name"
        )
    return int(number)


def _planned(path: Path, campaign: Campaign) -> list[RunPlan]:
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
    return [run for run in runs_of(tables, campaign.oscillator, ()) if run.oscillates]


def _run(plan: RunPlan) -> Run:
    point = plan.set_point
    return Run(
        plan.name,
        point.frequency_hz,
        point.eccentricity_m,
        point.strut_phase_rad,
        point.carriage_speed_m_s,
        point.medium,
        plan.periods,
        point.drift_rad,
        kind=plan.kind,
        motion=plan.motion,
    )


def write_round(pursuit: PursuedFolder, proposals: Sequence[Proposal]) -> Path:
    """Write the plan of the next round, whole or not at all, and return where it is."""
    name = f"{_PREFIX}{_number(pursuit.plans[-1]) + 1 if pursuit.plans else 1}"
    path = pursuit.folder / f"{name}.toml"
    write_whole(path, plan_text(f"{pursuit.campaign.name}-{name}", proposals, name))
    return path


def recorded(folder: Path, make: Maker | None, appear: Callable[[], bool]) -> dict[str, str]:
    """Take in what has been recorded of the open runs; return those that are missing, and why.

    Parameters
    ----------
    make
        Makes the recordings; ``None`` where somebody else does.
    appear
        Waits until recordings may have appeared; returns whether to look again.
    """
    while True:
        pursuit = read_pursued_folder(folder)
        if pursuit.open and make is not None:
            make(folder, pursuit.campaign, [_run(plan) for plan in pursuit.open])
        missing = take_in(pursuit)
        if not missing or not appear():
            return missing


def take_in(pursuit: PursuedFolder) -> dict[str, str]:
    """Append the open runs whose recordings have appeared; return the others with the reason.

    A recording that cannot be read has not appeared yet: it may still be copied.

    Raises
    ------
    ConfigurationError
        If the campaign file takes no further ``[[runs]]``; it stays as it was then.
    """
    missing: dict[str, str] = {}
    tables: list[str] = []
    for run in map(_run, pursuit.open):
        file = recording_of(pursuit.folder, run)
        try:
            if file is None:
                missing[run.name] = f"no {run.name}.nc"
                continue
            recorded = replace(run, file=file)
            open_recording(RecordingSource.of(pursuit.campaign, recorded, pursuit.folder))
        except (PmmError, OSError) as error:
            missing[run.name] = str(error)
            continue
        tables.append("\n" + toml_table("runs", _keys(recorded, pursuit, len(tables)), array=True))
    if tables:
        append_tables(pursuit.folder / CAMPAIGN_FILE, tables, read_campaign)
    return missing


def recording_of(folder: Path, run: Run) -> str | None:
    """Return where a run's recording lies in the folder; ``None`` where it is not there."""
    names = (f"{run.name}.nc", f"{run.name}/{RECORDING}")
    return next((name for name in names if (folder / name).is_file()), None)


def _keys(run: Run, pursuit: PursuedFolder, before: int) -> dict[str, Any]:
    """Return a run as the campaign file has it, ``before`` others having been appended with it."""
    records: tuple[Run | AtRest, ...] = (*pursuit.campaign.runs, *pursuit.campaign.at_rest)
    numbers = [record.number for record in records if record.number]
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
        "number": max(numbers) + 1 + before if numbers else None,
    }
