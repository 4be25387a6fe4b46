"""The files of each job of ``pmm init``, and how they are tried before they are kept."""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import PRESETS
from pmm.campaign.campaign_file import read_campaign
from pmm.start.found_campaign import FoundRun
from pmm.start.questions import CAMPAIGN, NAME
from pmm.start.recordings import find_campaign
from pmm.start.writing import check_free, render, write_tried

SIMULATED: Final = "pmm-simulated"
FILES: Final[Mapping[str, tuple[str, ...]]] = {
    "rig": ("rig.toml", "plan.toml", "simulated.toml"),
    "campaign": ("campaign.toml",),
    "swing": ("swing.toml",),
    "bifilar": ("bifilar.toml",),
    "ship": ("ship.toml",),
    "steering": ("steering.toml",),
}


@dataclass(frozen=True)
class StartTask:
    """What a job is to write: its answers, for which folder, from which recordings.

    Attributes
    ----------
    assumed
        Names of the answers that nobody gave.
    """

    job: str
    answers: Mapping[str, Any]
    folder: Path
    recordings: tuple[Path, ...] = ()
    assumed: frozenset[str] = frozenset()

    def values(self, **more: object) -> dict[str, Any]:
        """Return what the templates are filled in with."""
        vertical = self.answers.get("plane") == "vertical"
        return {**self.answers, "folder": self.folder.as_posix(), "vertical": vertical, **more}


@dataclass(frozen=True)
class Draft:
    """Texts by their files' names, and what reads them in a folder to see whether they hold."""

    files: Mapping[str, str]
    trial: Callable[[Path], object]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class WrittenFiles:
    """Files that were written, and what to look at in them."""

    paths: Sequence[Path]
    notes: tuple[str, ...] = ()


def write(task: StartTask, *, force: bool = False) -> WrittenFiles:
    """Write a job's files.

    Raises
    ------
    ConfigurationError
        If a file is there and ``force`` is not given, a recording is not there, or the answers make
        no file that can be read; then nothing is written.
    DataError
        If a recording cannot be read.
    """
    check_free(task.folder, FILES[task.job], force=force)
    missing = [str(path) for path in task.recordings if not path.is_file()]
    if missing:
        raise ConfigurationError(f"{', '.join(missing)}: no such recording")
    draft = _DRAFTS[task.job](task)
    paths = write_tried(task.folder, draft.files, draft.trial, force=force)
    return WrittenFiles(paths, draft.notes)


def _rig(task: StartTask) -> Draft:
    from pmm.plan.plan import read_plan_and_rig

    simulated = task.answers["interface"] == SIMULATED
    names = FILES["rig"] if simulated else FILES["rig"][:2]
    files = {name: render(name, task.values(simulated=simulated)) for name in names}
    return Draft(files, lambda tried: read_plan_and_rig(tried / "plan.toml"))


def _campaign(task: StartTask) -> Draft:
    campaign = find_campaign(task.recordings, task.folder) if task.recordings else None
    widened = _widened(task.answers["plane"], campaign.runs if campaign else ())
    assumed = task.assumed if campaign else frozenset[str]()  # a simulation may be of any model
    values = task.values(found=campaign, widened=widened, assumed=assumed)
    notes = (*campaign.notes(), *_assumed(task)) if campaign else ()

    def trial(tried: Path) -> None:
        """Read it with what is commented out for want of a number."""
        path = tried / "trial-campaign.toml"
        path.write_text(render("campaign.toml", {**values, "trial": True}), encoding="utf-8")
        read_campaign(path)

    text = render("campaign.toml", {**values, "trial": False})
    return Draft({"campaign.toml": text}, trial, notes)


def _assumed(task: StartTask) -> Iterator[str]:
    """Say what of the rig and the model nobody stated."""
    for name in (question.name for question in CAMPAIGN if question is not NAME):
        if name in task.assumed:
            yield f"nobody stated {name}, put it in: {task.answers[name]} is a guess"


def _widened(plane: str, runs: Sequence[FoundRun]) -> dict[str, tuple[float, float]]:
    """Return the preset's ranges made wide enough for what was recorded."""
    preset = PRESETS[f"{plane}-1963"]
    runs = [run for run in runs if not run.doubt]
    wanted = {
        "frequency_hz": ([run.frequency_hz for run in runs], preset.frequency_hz),
        "eccentricity_m": ([1e-3 * run.eccentricity_mm for run in runs], preset.eccentricity_m),
    }
    return {
        key: (min(*values, limits.low), float(f"{1.1 * max(*values, limits.high):.2g}"))
        for key, (values, limits) in wanted.items()
        if any(value not in limits for value in values)
    }


def _inertia(task: StartTask) -> Draft:
    """Do the test once with the records where they lie: a file that gives no number is no start."""
    from pmm.inertia import bifilar, swing

    name = FILES[task.job][0]
    run = swing.run if task.job == "swing" else bifilar.run
    near = [Path(os.path.relpath(path, task.folder)).as_posix() for path in task.recordings]
    full_paths = [path.resolve().as_posix() for path in task.recordings]

    def trial(tried: Path) -> None:
        path = tried / f"trial-{name}"
        path.write_text(render(name, task.values(records=full_paths)), encoding="utf-8")
        run(str(path))

    return Draft({name: render(name, task.values(records=near))}, trial)


def _ship(task: StartTask) -> Draft:
    from pmm.manoeuvre.prediction import ship_of
    from pmm.manoeuvre.ship_file import ShipFile, read_ship

    def trial(tried: Path) -> None:
        read = read_ship(tried / "ship.toml")
        if isinstance(read, ShipFile):
            _ = ship_of(read, 0, 0).rate_hz

    return Draft({"ship.toml": render("ship.toml", task.values())}, trial)


def _steering(task: StartTask) -> Draft:
    from pmm.steering.settings import read_steering_settings

    files = {"steering.toml": render("steering.toml", task.values())}
    return Draft(files, lambda tried: read_steering_settings(tried / "steering.toml"))


_DRAFTS: Final[Mapping[str, Callable[[StartTask], Draft]]] = {
    "rig": _rig,
    "campaign": _campaign,
    "swing": _inertia,
    "bifilar": _inertia,
    "ship": _ship,
    "steering": _steering,
}
