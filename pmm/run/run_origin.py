"""What a recorded run was made from, beside what plan and rig say now.

A campaign that is resumed after an edit holds runs of both. Each keeps the values that it was
recorded with: its plan and its calibration lie in its header, its rig's file in ``made-from``,
found by the hash that the header has.
"""

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from hardware.description.body import DIMENSIONS
from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.calibrated_recording import CARRIED
from pmm.campaign.calibration import as_table
from pmm.campaign.model_uncertainty import expand_preset
from pmm.configuration import place_text, read_toml
from pmm.places import Place
from pmm.plan.campaign_writer import FinishedRun
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import PhotocellOffset
from pmm.plan.run_plan import RunPlan
from pmm.recorder.header import RunHeader

KEPT: Final = "made-from"  # copies of plan and rig, as they were
_MOST: Final = 8  # changes of a file that are told one by one
_MOST_RUNS: Final = 20  # runs whose changes a refusal tells one by one
# Of a campaign, that tell how a run is to be read: the keys of pmm.campaign.runs.RecordedWith.
_TABLES: Final = ("oscillator", "model", "model_uncertainty", "hull", "reference")


@dataclass(frozen=True)
class RunOrigin:
    """What a run was made from, seen from what plan and rig say now.

    Attributes
    ----------
    differs
        What has changed since, in words; empty where nothing has.
    recorded_with
        Tables of the campaign that were others, as they were.
    """

    differs: tuple[str, ...] = ()
    recorded_with: Mapping[str, Any] | None = None


class Sources:
    """What the runs of a folder are made from now."""

    def __init__(self, folder: Path, plan: Plan, rig: RigFile) -> None:
        self._folder, self._plan, self._rig = folder, plan, rig
        self._planned = {run.name: run for run in plan.runs}

    def origin(self, header: RunHeader, run: RunPlan) -> RunOrigin:
        """Return what a recorded run was made from.

        Parameters
        ----------
        run
            Its plan, as its header has it.
        """
        changes = [*self._plan_changes(run), *_calibration_changes(header, self._rig)]
        hashed = header.configuration_sha256.get("rig", "")
        if hashed == self._rig.sha256:
            return RunOrigin(tuple(changes))
        name, before = self._rig.path.name, self._copies.get(hashed)
        if before is None:
            text = (
                f"{name} was another file (sha256 {hashed[:12] or 'unknown'}), of which "
                f"{self._folder / KEPT} has no copy"
            )
            return RunOrigin((*changes, text))
        changes += _changes(name, before, dict(self._rig.tables))
        return RunOrigin(tuple(changes), _tables_before(before, self._rig.tables) or None)

    @cached_property
    def _copies(self) -> dict[str, dict[str, Any]]:
        """The copies of rig and plan that can be read, by their hashes."""
        copies = {}
        for path in sorted((self._folder / KEPT).glob("*.toml")):
            try:
                copies[hashlib.sha256(path.read_bytes()).hexdigest()] = read_toml(path)
            except (OSError, ConfigurationError):
                continue  # then there is no copy of that file
        return copies

    def _plan_changes(self, run: RunPlan) -> Iterator[str]:
        now, name = self._planned.get(run.name), self._plan.path.name
        if self._plan.grows or run.changed:
            return
        if now is None:
            yield f"{name} has no run {run.name!r} any more"
        else:
            yield from _changes(name, _plain(asdict(run)), _plain(asdict(now)))


def check_unchanged(folder: Path, runs: Sequence[FinishedRun], plan: Plan) -> None:
    """Refuse to add to runs that plan, rig, model and calibration say something else of now.

    Raises
    ------
    ConfigurationError
        Naming each run with what changed.
    """
    lines = change_lines(runs)
    if lines:
        shown = lines[:_MOST_RUNS]
        more = f"\n  ... and {len(lines) - len(shown)} runs more" if len(lines) > len(shown) else ""
        raise ConfigurationError(
            f"{folder}: {len(lines)} of its runs were recorded with other values than {plan.path} "
            "and its rig have now:\n  " + "\n  ".join(shown) + f"{more}\nput the values back "
            f"(copies of the files are in {folder / KEPT}), record to another folder with "
            "--output, or go on with `pmm run --accept-changes`: each run then keeps the values "
            "that it was recorded with"
        )


def change_lines(runs: Sequence[FinishedRun]) -> list[str]:
    """Return a line for each run that was recorded with other values than those of now."""
    return [f"{run.plan.name}: {'; '.join(run.differs)}" for run in runs if run.differs]


def _calibration_changes(header: RunHeader, rig: RigFile) -> Iterator[str]:
    try:
        calibration = dict(json.loads(header.provenance.get(CARRIED, "{}")))
    except (ValueError, TypeError) as error:
        raise DataError(f"{header.run_name}: its calibration cannot be read: {error}") from error
    before = {key: value for key, value in calibration.items() if key not in ("file", "sha256")}
    if calibration.get("sha256", "") != (rig.calibration.sha256 if rig.calibration else ""):
        now = as_table(rig.calibration) if rig.calibration else {}
        file = rig.calibration.file if rig.calibration else calibration.get("file", "")
        yield from _changes(file or "calibration", before, now)


def _tables_before(before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any]:
    """Return the campaign's tables that a rig's file told otherwise; what it left open is left."""
    old, new = _campaign_tables(before), _campaign_tables(now)
    return {key: value for key, value in old.items() if value is not None and value != new[key]}


def _campaign_tables(rig: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of a campaign that tell of the runs, as a rig's file has them."""
    table = deepcopy(dict(rig))
    expand_preset(table, [])
    handed_on = table.get("campaign", {})
    tables = {key: table.get(key, handed_on.get(key)) for key in _TABLES}
    tables["reference"] = asdict(PhotocellOffset()) | table.get("reference", {})
    for name in ("model", "model_uncertainty"):  # what is infinite there is so by default
        if tables[name] is not None:
            pairs = tables[name].items()
            tables[name] = {
                key: value for key, value in pairs if key not in DIMENSIONS and value != math.inf
            }
    return tables


def _changes(where: str, before: Any, now: Any) -> list[str]:
    """Return in words where two files differ, key by key."""
    old, new = dict(_leaves(before)), dict(_leaves(now))
    places = [key for key in {**old, **new} if old.get(key, _UNSET) != new.get(key, _UNSET)]
    lines = [
        f"{where} {place_text(key, now if key in new else before)}"
        f"{_change_text(old.get(key, _UNSET), new.get(key, _UNSET))}"
        for key in places[:_MOST]
    ]
    more = len(places) - _MOST
    return [*lines, f"{where} {more} keys more"] if more > 0 else lines


def _leaves(value: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    if isinstance(value, Mapping | list) and value:
        pairs = value.items() if isinstance(value, Mapping) else enumerate(value)
        for key, item in pairs:
            yield from _leaves(item, (*place, key))
    else:
        yield place, value


def _change_text(before: Any, now: Any) -> str:
    if before is _UNSET:
        return f"was not set, is {_value_text(now)}"
    if now is _UNSET:
        return f"was {_value_text(before)}, is not set"
    return f"was {_value_text(before)}, is {_value_text(now)}"


def _value_text(value: Any) -> str:
    return "none" if value is None else json.dumps(value, default=str, ensure_ascii=False)


def _plain(value: Any) -> Any:
    """Return a table with the lists and plain words of a file."""
    return json.loads(json.dumps(value))


_UNSET: Final = object()
