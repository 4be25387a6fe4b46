"""What campaign folders say, read by hand: TOML, JSON and HDF5 by their own libraries.

No reader of the archive or of campaigns is used. What an analysis finds is read from what the
commands print as JSON. Defaults are those of ``docs/campaigns.md``.
"""

import hashlib
import json
import math
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

import h5py
from click.testing import CliRunner

from pmm.cli import cli

# As they are written: no campaign of the tests writes one of them in two ways.
_MORE = (
    "lines", "known_mass", "load", "steady_ahead", "wave_frequency_hz", "wave_amplitude_m",
    "wave_heading_deg", "wave_heading_rad",
)  # fmt: skip


@dataclass(frozen=True)
class HandRun:
    """A run or a record at rest as the campaign's file has it, in SI units."""

    folder: Path
    hull: str
    name: str
    kind: str
    outcome: str
    medium: str
    frequency_hz: float
    eccentricity_m: float
    strut_phase_rad: float
    carriage_speed_m_s: float
    drift_rad: float
    heel_rad: float
    rudder_angle_rad: float
    revolutions_hz: float
    turn_rate_rad_s: float
    release_rad: float
    more: tuple[str, ...]
    file: str

    @property
    def recording(self) -> Path | None:
        """Its recording, if there is one."""
        own = self.folder / f"{self.name}.nc"
        path = own if own.exists() else self.folder / self.file
        return path if self.file and path.is_file() else None

    def repeats(self, other: "HandRun") -> bool:
        """Whether the other is a repeat, by the distances that ``docs/archive.md`` states."""
        words = ("hull", "kind", "medium", "more")
        near = {
            "frequency_hz": 1e-4, "eccentricity_m": 1e-5, "strut_phase_rad": 2e-3,
            "carriage_speed_m_s": 1e-3, "drift_rad": 2e-4, "heel_rad": 2e-4,
            "rudder_angle_rad": 2e-4, "revolutions_hz": 1e-3, "turn_rate_rad_s": 2e-4,
            "release_rad": 2e-4,
        }  # fmt: skip
        return all(getattr(self, one) == getattr(other, one) for one in words) and all(
            abs(getattr(self, one) - getattr(other, one)) <= limit for one, limit in near.items()
        )


def runs_of(folder: Path) -> list[HandRun]:
    """Return all runs of a folder, those at rest last."""
    table = tomllib.loads((folder / "campaign.toml").read_text(encoding="utf-8"))
    every = [*table.get("runs", []), *table.get("at_rest", [])]
    return [_run(folder, table.get("model_name", ""), one) for one in every]


def _run(folder: Path, hull: str, told: dict[str, Any]) -> HandRun:
    def si(key: str, unit: str, factor: float, si_unit: str) -> float:
        if f"{key}_{unit}" in told:
            return float(told[f"{key}_{unit}"]) * factor
        return float(told.get(f"{key}_{si_unit}", 0.0))

    degree = math.pi / 180.0
    return HandRun(
        folder, hull, told["name"], told.get("kind", "oscillation"),
        told.get("outcome", "complete"), told.get("medium", "water"),
        float(told.get("frequency_hz", 0.0)), si("eccentricity", "mm", 1e-3, "m"),
        si("strut_phase", "deg", degree, "rad"), float(told.get("carriage_speed_m_s", 0.0)),
        si("drift", "deg", degree, "rad"), si("heel", "deg", degree, "rad"),
        si("rudder_angle", "deg", degree, "rad"), float(told.get("revolutions_hz", 0.0)),
        si("turn_rate", "deg_s", degree, "rad_s"), si("release", "deg", degree, "rad"),
        tuple(repr(told.get(key)) for key in _MORE), told.get("file", f"{told['name']}.nc"),
    )  # fmt: skip


def began(recording: Path) -> datetime:
    """Return when a recording began, or when its file was last changed."""
    told = ""
    if recording.suffix == ".nc" and h5py.is_hdf5(recording):
        with h5py.File(recording) as file:
            told = str(file.attrs.get("started_utc", ""))
    if told:
        return datetime.fromisoformat(told)
    return datetime.fromtimestamp(recording.stat().st_mtime, UTC)


def hashes_of(folder: Path) -> dict[str, str]:
    """Return the hashes of all recordings of a folder, by the runs' names."""
    return {
        run.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for run in runs_of(folder)
        if (path := run.recording) is not None
    }


def notes_of(folder: Path) -> list[dict[str, str]]:
    """Return the lines that people wrote."""
    path = folder / "notes.jsonl"
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line]


def _printed(*words: str) -> Any:
    done = CliRunner().invoke(cli, [*words, "--json"])
    return json.loads(done.stdout) if done.stdout.startswith("{") else {}


@cache
def coefficients_of(folder: Path) -> list[dict[str, Any]]:
    """Return the recommended coefficients that ``pmm coefficients`` prints."""
    every = _printed("coefficients", str(folder)).get("recommended", [])
    return [one for one in every if one["recommended"] and one["value"] is not None]


@cache
def _analysis_of(folder: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = _printed("analyse", str(folder)).get("runs", [])
    return found


def first_harmonics_of(folder: Path) -> dict[str, dict[str, tuple[float, float]]]:
    """Return the first harmonics of each run's first gate, by run and channel."""
    return {
        run["run"]: dict(_first(run["gates"][0]["channels"]))
        for run in _analysis_of(folder)
        if run["gates"]
    }


def _first(channels: list[dict[str, Any]]) -> Iterator[tuple[str, tuple[float, float]]]:
    for one in channels:
        for harmonic in one["harmonics"]:
            if harmonic["order"] == 1:
                yield one["name"], (harmonic["in_phase"]["value"], harmonic["quadrature"]["value"])


def verdict_of(folder: Path) -> str | None:
    """Return the verdict that ``pmm gap`` prints, if it has one."""
    verdict: str | None = _printed("gap", str(folder), "--jobs", "1").get("verdict")
    return verdict
