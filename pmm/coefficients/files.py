"""A campaign's coefficients as files: CSV and NetCDF, and what SIMMAN asks of each run."""

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.exchange import to_dataset
from analysis.coefficients.recommendation import table
from analysis.exchange.simman import SimmanDescription, deliverables_of
from analysis.exchange.simman_files import write_simman
from hardware.description.errors import DataError
from pmm.coefficients.workflow import CampaignOutcome
from pmm.whole_file import write_whole


def csv_text(coefficients: CampaignCoefficients) -> str:
    """Return the table as CSV: the system in a comment, then a row for each value."""
    stream = io.StringIO()
    stream.write(f"# system = {coefficients.normalisation}\n# level = {coefficients.level:g}\n")
    rows = list(table(coefficients))
    lines = csv.writer(stream, lineterminator="\n")
    lines.writerow(rows[0] if rows else ())
    for row in rows:
        lines.writerow([_cell(value) for value in row.values()])
    return stream.getvalue()


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


def write_deliverables(outcome: CampaignOutcome, folder: Path, *, overwrite: bool = False) -> int:
    """Write the deliverables of every run that oscillated, a folder each; return how many.

    Raises
    ------
    DataError
        If a run's are there already, or no run oscillated.
    """
    moving = [cycle for cycle in outcome.cycles if cycle.frequency_hz > 0.0]
    if not moving:
        raise DataError("no run oscillates: there is no cycle to deliver")
    rates = {run.name: run.sample_rate_hz for run in outcome.runs}
    periods = {run.name: run.periods for run in outcome.runs}
    body, ship, water = outcome.body, outcome.settings.ship, outcome.water
    for cycle in moving:
        description = SimmanDescription(
            run=cycle.name,
            campaign=", ".join(outcome.names),
            scale=ship.scale,
            length_m=ship.length_m,
            mass_kg=None if body is None else body.mass_kg,
            inertia_kg_m2=None if body is None else body.inertia_kg_m2,
            cg_x_m=None if body is None else body.cg_x_m,
            water_temperature_deg_c=None if water is None else water.temperature_deg_c,
            density_kg_m3=ship.density_kg_m3,
            logging_rate_hz=rates[cycle.name],
            periods=periods[cycle.name],
        )
        write_simman(deliverables_of(cycle, description), folder / cycle.name, overwrite=overwrite)
    return len(moving)
