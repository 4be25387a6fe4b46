"""A campaign's coefficients for programs: one JSON document, a CSV, a NetCDF file."""

import csv
import io
import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from analysis.coefficients.campaign_budget import budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.exchange import to_dataset, to_dict
from analysis.coefficients.recommendation import table
from pmm.coefficients.workflow import Outcome
from pmm.whole_file import write_whole

JSON_SCHEMA: Final = "pmm-coefficients-1"


def document(outcome: Outcome, *, with_budgets: bool = True) -> dict[str, Any]:
    """Return what ``--json`` prints; ``docs/coefficients-command.md`` describes it."""
    found = outcome.result
    budgets = range(len(found.entries)) if with_budgets else ()
    text: dict[str, Any] = _plain(
        {
            "schema": JSON_SCHEMA,
            "campaigns": list(outcome.names),
            "recommended": [row for row in table(found) if row["recommended"]],
            "coefficients": to_dict(found),
            "budgets": [asdict(budget(found, k)) for k in budgets],
            "stated": asdict(outcome.stated),
            "body": None if outcome.body is None else asdict(outcome.body),
            "runs": [
                {
                    "name": one.name,
                    "file": one.file,
                    "periods": one.periods,
                    "sample_rate_hz": one.sample_rate_hz,
                    "duration_s": one.duration_s,
                    "flags": [asdict(flag) for flag in one.flags],
                }
                for one in outcome.runs
            ],
            "failed": [asdict(one) for one in outcome.failed],
            "not_recorded": list(outcome.not_recorded),
            "left_out": [asdict(flag) for flag in outcome.left_out],
        }
    )
    return text


def csv_text(found: CampaignCoefficients) -> str:
    """Return the table as CSV: the system in a comment, then a row for each value."""
    written = io.StringIO()
    written.write(f"# system = {found.normalisation}\n# level = {found.level:g}\n")
    rows = list(table(found))
    lines = csv.writer(written, lineterminator="\n")
    lines.writerow(rows[0] if rows else ())
    for row in rows:
        lines.writerow([_cell(value) for value in row.values()])
    return written.getvalue()


def write_netcdf(outcome: Outcome, path: Path, provenance: Mapping[str, str]) -> None:
    """Write the table, every input's contribution and all findings as NetCDF4."""
    dataset = to_dataset(outcome.result)
    dataset.attrs["provenance"] = json.dumps(dict(provenance))
    # By way of memory: HDF5 does not outlive a disk that fills up under it.
    write_whole(path, bytes(dataset.to_netcdf(engine="h5netcdf")))


def _cell(value: Any) -> Any:
    if isinstance(value, tuple):
        return " ".join(map(str, value))
    return repr(value) if isinstance(value, float) else value


def _plain(value: Any) -> Any:
    """Return the same with ``None`` for every number that JSON does not have."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: _plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    return value
