"""Coefficients of finished runs beside earlier ones and a reference, in a process apart."""

from collections.abc import Iterator
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

from analysis.coefficients.campaign_result import CampaignCoefficients
from hardware.description.errors import DataError, PmmError


class _SameProcessExecutor(Executor):
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
    result: CampaignCoefficients | None = None
    for folder, of in [
        *((path, "now") for path in folders),
        *((path, "earlier") for path in earlier),
    ]:
        try:
            if of == "earlier" or _has_runs(folder):
                result = _result(folder)
                points += [
                    {**point, "of": of, "campaign": folder.name} for point in _points(result)
                ]
        except (PmmError, OSError) as error:
            problems.append(f"{folder.name}: {error}")
    if reference is not None and result is not None:
        try:
            points += list(_reference_points(reference, result))
        except (PmmError, OSError) as error:
            problems.append(str(error))
    for point in points:
        for key in ("value", "half_width", "frequency_hz", "speed_m_s"):
            point[key] = number(point[key])
    return {"points": points, "problems": problems}


def _has_runs(folder: Path) -> bool:
    """Whether a campaign under way has a complete run in water: before that all is silent."""
    from pmm.campaign.file_names import CAMPAIGN_FILE
    from pmm.configuration import read_toml

    runs = read_toml(folder / CAMPAIGN_FILE).get("runs") or []
    wanted = {"outcome": "complete", "medium": "water"}
    return any(all(run.get(key, must) == must for key, must in wanted.items()) for run in runs)


def _result(folder: Path) -> CampaignCoefficients:
    from pmm.coefficients.settings import CoefficientSettings
    from pmm.coefficients.workflow import coefficients_of

    settings = CoefficientSettings(nonlinear=False, zero_frequency=False)
    return coefficients_of([folder], settings, _SameProcessExecutor(), _silent).result


def _points(result: CampaignCoefficients) -> Iterator[dict[str, Any]]:
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


def _reference_points(path: Path, result: CampaignCoefficients) -> Iterator[dict[str, Any]]:
    """Return what a table has of the coefficients that a campaign has, in the same system."""
    from pmm.coefficients.references import read_references
    from pmm.coefficients.settings import ReferenceFile

    units = {entry.name: entry.unit for entry in result.entries}
    for reference in read_references((ReferenceFile(str(path)),), result.plane, result.form):
        if str(reference.system) != result.normalisation:
            raise DataError(
                f"reference {path}: is in the system {reference.system}, the page shows "
                f"{result.normalisation} values; give it in that system"
            )
        for name in units.keys() & reference.table.values.keys():
            for k, frequency_hz in enumerate(reference.table.frequency_hz):
                yield {
                    "name": name,
                    "unit": units[name],
                    "frequency_hz": float(frequency_hz),
                    "speed_m_s": reference.table.speed_m_s,
                    "value": float(reference.table.values[name][k]),
                    "half_width": float("nan"),
                    "runs": [],
                    "of": "reference",
                    "campaign": reference.table.name,
                }
