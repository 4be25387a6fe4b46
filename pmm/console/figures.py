"""Coefficients of finished runs beside earlier ones and a reference, in a process apart."""

from collections.abc import Iterator
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

from hardware.description.errors import PmmError


class _Here(Executor):
    """Does what it is given at once: this process is a worker already."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> "Future[Any]":
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def figures_of(
    folders: tuple[Path, ...], earlier: tuple[Path, ...], reference: Path | None
) -> dict[str, Any]:
    """Return the coefficients of campaigns, each a list of points, and what went wrong.

    Parameters
    ----------
    folders, earlier
        Of campaigns under way, and of those that they are compared with.
    reference
        A table of coefficients; see :mod:`pmm.coefficients.references`.
    """
    from pmm.console.encoding import number

    points: list[dict[str, Any]] = []
    problems: list[str] = []
    for folder, of in [*((one, "now") for one in folders), *((one, "earlier") for one in earlier)]:
        try:
            if of == "earlier" or _has_runs(folder):
                points += [{**one, "of": of, "campaign": folder.name} for one in _points(folder)]
        except (PmmError, OSError) as error:
            problems.append(f"{folder.name}: {error}")
    if reference is not None and points:
        try:
            points += list(_reference_points(reference, points))
        except (PmmError, OSError) as error:
            problems.append(f"{reference.name}: {error}")
    for one in points:
        for key in ("value", "half_width", "frequency_hz", "speed_m_s"):
            one[key] = number(one[key])
    return {"points": points, "problems": problems}


def _has_runs(folder: Path) -> bool:
    """Whether a campaign under way has a complete run yet: before that there is nothing to say."""
    from pmm.campaign import CAMPAIGN_FILE
    from pmm.configuration import read_toml

    return bool(read_toml(folder / CAMPAIGN_FILE).get("runs"))


def _points(folder: Path) -> Iterator[dict[str, Any]]:
    from pmm.coefficients.settings import Settings
    from pmm.coefficients.workflow import coefficients_of

    settings = Settings(nonlinear=False, zero_frequency=False)
    found = coefficients_of([folder], settings, _Here(), _silent)
    result = found.result
    widths = result.half_widths
    for row, entry in enumerate(result.entries):
        yield {
            "name": entry.name,
            "unit": entry.unit,
            "frequency_hz": entry.frequency_hz,
            "speed_m_s": entry.speed_m_s,
            "value": float(result.values[row]),
            "half_width": float(widths[row]),
            "runs": list(entry.runs),
        }


def _silent(_done: int, _total: int, _what: str) -> None:
    """Show no progress."""


def _reference_points(path: Path, points: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Read the columns of a CSV by the names of the coefficients."""
    import csv

    with path.open(encoding="utf-8-sig", newline="") as file:
        lines = [line for line in file if not line.startswith("#")]
    units = {one["name"]: one["unit"] for one in points}
    for row in csv.DictReader(lines):
        for name, unit in units.items():
            if row.get(name) and row.get("frequency_hz"):
                yield {
                    "name": name,
                    "unit": unit,
                    "frequency_hz": float(row["frequency_hz"]),
                    "speed_m_s": float(row.get("speed_m_s") or "nan"),
                    "value": float(row[name]),
                    "half_width": float("nan"),
                    "runs": [],
                    "of": "reference",
                    "campaign": path.stem,
                }
