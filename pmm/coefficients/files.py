"""A campaign's coefficients as files for programs: a CSV and a NetCDF file."""

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.exchange import to_dataset
from analysis.coefficients.recommendation import table
from pmm.coefficients.workflow import CampaignOutcome
from pmm.whole_file import write_whole


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


def write_netcdf(outcome: CampaignOutcome, path: Path, provenance: Mapping[str, str]) -> None:
    """Write the table, every input's contribution and all findings as NetCDF4."""
    dataset = to_dataset(outcome.result)
    dataset.attrs["provenance"] = json.dumps(dict(provenance))
    # By way of memory: HDF5 does not outlive a disk that fills up under it.
    write_whole(path, bytes(dataset.to_netcdf(engine="h5netcdf")))


def _cell(value: Any) -> Any:
    if isinstance(value, tuple):
        return " ".join(map(str, value))
    return repr(value) if isinstance(value, float) else value
