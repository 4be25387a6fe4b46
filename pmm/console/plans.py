"""Plans that the console offers: found in a folder, read and checked as ``pmm run`` does."""

import hashlib
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, date, datetime
from pathlib import Path
from typing import Any

from hardware.description.errors import ConfigurationError, PmmError
from pmm.configuration import read_toml
from pmm.console.encoding import number
from pmm.console.limits import LARGEST_PLAN
from pmm.console.queued_plan import QueuedPlan
from pmm.console.requests import EditPosted, HoldPosted, MovePosted, RunPosted
from pmm.plan.checks import check_plan, require_possible
from pmm.plan.duration import duration_rows
from pmm.plan.findings import PlanFinding, PlanVerdict, largest_stated
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.rig_file import RigFile, read_rig_file
from pmm.plan.run_changes import edited, moved
from pmm.plan.run_plan import RunPlan
from pmm.recorder.files import sha256
from pmm.run.campaign_folder import check_names, chosen_runs, folder_of

_SHOWN = 60  # characters of a name that is no rig's


@dataclass(frozen=True)
class CheckedPlan:
    """A plan, read against its rig.

    Attributes
    ----------
    durations_s
        Of the runs in :attr:`waiting`, at most.
    """

    waiting: QueuedPlan
    rig: RigFile
    findings: tuple[PlanFinding, ...]
    durations_s: tuple[float, ...]

    @property
    def refused(self) -> bool:
        """Whether the rig cannot run it."""
        return any(finding.verdict is PlanVerdict.REFUSE for finding in self.findings)


@dataclass(frozen=True)
class Plans:
    """Reads plans of one rig.

    Attributes
    ----------
    rig_path
        The rig's file; plans that name another one are refused.
    rig_hashes
        Of the files of the rig that is open: once they are others, plans are refused too.
    folder
        Where plans lie; by default beside the rig's file.
    output
        Where campaigns are recorded, one folder each; by default as ``pmm run`` does.
    """

    rig_path: Path
    rig_hashes: Mapping[str, str]
    folder: Path
    output: Path | None

    @property
    def rigs(self) -> tuple[str, ...]:
        """What a plan may name as its rig: no other file is looked for."""
        return (_relative(self.rig_path, self.folder),)

    def names(self) -> list[str]:
        """Return the files in the folder that hold a plan, by their names."""
        paths = sorted(self.folder.glob("*.toml"))
        return [path.name for path in paths if _size(path) <= LARGEST_PLAN and is_plan(path)]

    def check(self, name: str, text: str) -> CheckedPlan:
        """Read and check a plan: one of the folder's files, or the text of one.

        Raises
        ------
        ConfigurationError
            With everything that is wrong with it.
        """
        if text:
            with self._written(text) as path:
                return self._read(path)
        return self._read(self._plan_path(name))

    def possible(self, name: str, text: str) -> CheckedPlan:
        """Read a plan that might be run; nothing is kept.

        Raises
        ------
        ConfigurationError, PlanRefusedError
            If it is wrong, or the rig cannot run it.
        """
        if text:
            with self._written(text) as path:
                return self._possible(path)
        return self._possible(self._plan_path(name))

    def queue(self, name: str, text: str) -> CheckedPlan:
        """Read a plan that is to be run; a text is kept beside the other plans.

        Raises
        ------
        ConfigurationError, PlanRefusedError
            If it is wrong, or the rig cannot run it.
        """
        if text:
            self.possible(name, text)  # what is refused is not kept
            name = f"console-{_digest(text)}.toml"
            (self.folder / name).write_text(text, encoding="utf-8")
        return self._possible(self._plan_path(name))

    def changed(self, plan: QueuedPlan, posted: RunPosted) -> CheckedPlan:
        """Return a queued plan with what was posted changed in it.

        Raises
        ------
        ConfigurationError, PlanRefusedError
            If it has no such run, a plan could not say so, or the rig cannot run it.
        """
        if plan.chooses:
            raise ConfigurationError(
                f"{plan.plan.name}: its runs are chosen one after the other; choose among them "
                "when they are proposed"
            )
        if posted.run:
            check_names(plan.plan, [posted.run])
        rig = read_rig_file(self.rig_path)
        self._check_unchanged(rig)
        runs, held = plan.plan.runs, plan.held_runs
        findings: tuple[PlanFinding, ...] = ()
        if isinstance(posted, EditPosted):
            settings = posted.model_dump(exclude={"number", "run"}, exclude_none=True)
            (run,) = (run for run in runs if run.name == posted.run)
            now = edited(run, settings, plan.plan)
            findings = require_possible(replace(plan.plan, runs=(now,)), rig, _today())
            runs = tuple(now if planned_run is run else planned_run for planned_run in runs)
        elif isinstance(posted, MovePosted):
            runs = moved(runs, posted.run, posted.by)
        elif isinstance(posted, HoldPosted):
            names = {posted.run} if posted.run else {run.name for run in runs}
            held = held | names if posted.held else held - names
        made = {run.name for run in plan.runs}
        rest = tuple(run for run in runs if run.name in made)
        waiting = replace(plan, plan=replace(plan.plan, runs=runs), runs=rest, held_runs=held)
        return CheckedPlan(waiting, rig, findings, duration_rows(rest, rig))

    def _check_rig(self, path: Path) -> None:
        """Hold the plan's rig against this console's; no file of another name is opened."""
        named = read_toml(path).get("rig", "rig.toml")
        if named not in self.rigs:
            choices = " or ".join(f'rig = "{rig}"' for rig in self.rigs)
            rig_name = str(named)[:_SHOWN]
            raise ConfigurationError(
                f"{path}: rig = {rig_name!r} is no rig of this console; write {choices}"
            )

    def _check_unchanged(self, rig: RigFile) -> None:
        """Refuse to hold a plan against another rig than the one that is open."""
        if rig.hashes != self.rig_hashes:
            raise ConfigurationError(
                f"{rig.path}: the file, or its calibration, was changed after this console had "
                "opened the rig; put it back, or leave and start the console anew"
            )

    def _possible(self, path: Path) -> CheckedPlan:
        checked = self._read(path)
        if not checked.waiting.chooses:
            require_possible(checked.waiting.plan, checked.rig, _today())
        return checked

    def _plan_path(self, name: str) -> Path:
        names = self.names()
        if name not in names:
            choices = ", ".join(names) or "none"
            raise ConfigurationError(f"{self.folder}: no plan {name!r}; there are: {choices}")
        return self.folder / name

    @contextmanager
    def _written(self, text: str) -> Iterator[Path]:
        path = self.folder / f".console-{_digest(text)}.toml"
        try:
            path.write_text(text, encoding="utf-8")
            yield path
        except OSError as error:
            raise ConfigurationError(f"{self.folder}: cannot keep the plan: {error}") from error
        finally:
            path.unlink(missing_ok=True)

    def _read(self, path: Path) -> CheckedPlan:
        self._check_rig(path)
        if "grid" in read_toml(path):
            return self._read_design(path)
        plan, rig = read_plan_and_rig(path)
        self._check_unchanged(rig)
        folder = folder_of(plan, rig.recorder.folder, None)
        if self.output is not None:
            folder = self.output / plan.name
        runs = chosen_runs(plan, rig, folder, resume=True)
        waiting = QueuedPlan(0, plan, folder, runs)
        return CheckedPlan(waiting, rig, check_plan(plan, rig, _today()), duration_rows(runs, rig))

    def _read_design(self, path: Path) -> CheckedPlan:
        """Read a design: its runs are chosen one after the other, and checked then."""
        from pmm.design.design_file import read_design
        from pmm.sequential.growing_plan import check_design

        file = read_design(path)
        self._check_unchanged(file.rig)
        folder = file.rig_path.parent / file.rig.recorder.folder / file.name
        if self.output is not None:
            folder = self.output / file.name
        check_design(file)  # refuses what has no end
        operator = file.plan_table.get("operator", "")
        plan = Plan(file.name, path, file.rig_path, (), operator, sha256(path))
        return CheckedPlan(QueuedPlan(0, plan, folder, (), chooses=True), file.rig, (), ())


def plan_picture(checked: CheckedPlan) -> dict[str, Any]:
    """Return a plan for the browser."""
    plan = checked.waiting
    return {
        "name": plan.plan.name,
        "file": plan.plan.path.name,
        "folder": str(plan.folder),
        "runs": [_run(run, s) for run, s in zip(plan.runs, checked.durations_s, strict=True)],
        "chooses": plan.chooses,
        "held": sorted(plan.held_runs),
        "complete": len(plan.plan.runs) - len(plan.runs),
        "refused": checked.refused,
        "findings": [
            {"verdict": str(f.verdict), "run": f.run, "message": f.message}
            for f in (
                *(finding for finding in checked.findings if not finding.is_stated),
                *largest_stated(checked.findings),
            )
        ],
    }


def _run(run: RunPlan, duration_s: float) -> dict[str, Any]:
    point = run.set_point
    return {
        "name": run.name,
        "kind": str(run.kind),
        "motion": str(run.motion),
        "frequency_hz": number(point.frequency_hz),
        "eccentricity_m": number(point.eccentricity_m),
        "phase_rad": number(point.strut_phase_rad),
        "speed_m_s": number(point.carriage_speed_m_s),
        "medium": str(point.medium),
        "periods": run.max_periods,
        "duration_s": round(duration_s, 1),
        "changed": run.changed,
    }


def is_plan(path: Path) -> bool:
    """Whether a file is a plan, right or wrong: it names a rig and has runs, or some to choose."""
    try:
        table = read_toml(path)
    except PmmError:
        return False
    return "rig" in table and bool({"runs", "grid"} & set(table)) and "oscillator" not in table


def _size(path: Path) -> int:
    """Return a file's size in bytes; 0 for what cannot be read."""
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _relative(rig: Path, folder: Path) -> str:
    """Return how a plan in a folder names its rig."""
    rig = rig.resolve()
    try:
        return Path(os.path.relpath(rig, folder.resolve())).as_posix()
    except ValueError:  # on another drive
        return rig.as_posix()


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def _today() -> date:
    return datetime.now(UTC).date()
