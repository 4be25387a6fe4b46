"""Recordings as docs/formats.md describes them, written by another hand: NetCDF4 or CSV."""

import gzip
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tests.sealed.generator.features import recorded
from tests.sealed.generator.rig import CHANNELS, UNITS, Record, Rig, Run

# A foreign system's headers, and what turns SI into its units.
FOREIGN = {
    "shaft_angle": ("Winkel [deg]", 180.0 / np.pi),
    "displacement_aft": ("WA1 [mm]", 1e3),
    "displacement_fore": ("WA2 [mm]", 1e3),
    "force_aft": ("Kraft1 [N]", 1.0),
    "force_fore": ("Kraft2 [N]", 1.0),
    "carriage_speed": ("Wagen [m/s]", 1.0),
}


def set_point(run: Run) -> dict[str, Any]:
    """Return a run's set-point as a recording keeps it."""
    return {
        "frequency_hz": run.frequency_hz,
        "eccentricity_m": run.eccentricity_m,
        "strut_phase_rad": run.strut_phase_rad,
        "carriage_speed_m_s": run.carriage_speed_m_s,
        "medium": run.medium,
        **({"drift_rad": run.drift_rad} if run.drift_rad else {}),
    }


def write_netcdf(path: Path, record: Record, run: Run, rig: Rig) -> None:
    """Write a recording as NetCDF4."""
    import h5netcdf

    with h5netcdf.File(path, "w") as file:
        file.dimensions["time"] = record.channels.shape[1]
        file.attrs["schema"] = "pmm-run-1"
        file.attrs["run_name"] = run.name
        file.attrs["sample_rate_hz"] = rig.sample_rate_hz
        file.attrs["provenance"] = json.dumps({})
        file.attrs["flags"] = json.dumps([])
        if run.turns:
            file.attrs["set_point"] = json.dumps(set_point(run))
        columns = [("time", "s", record.times_s)]
        columns += [
            (CHANNELS[row], UNITS[row], record.channels[row]) for row in recorded(rig.sensors)
        ]
        for name, unit, values in columns:
            variable = file.create_variable(name, ("time",), np.float64, data=values)
            variable.attrs["units"] = unit
        if "photocell" in rig.sensors:
            file.dimensions["photocell_edge"] = len(record.edges_s)
            edges = file.create_variable("photocell_edge_time", ("photocell_edge",), np.float64)
            edges.attrs["units"] = "s"
            if len(record.edges_s):
                edges[:] = record.edges_s


def _zipped(path: Path, header: Sequence[str], columns: Sequence[Any], digits: str) -> None:
    text = io.StringIO()
    np.savetxt(text, np.column_stack(columns), fmt=digits, delimiter=",",
               header=",".join(header), comments="")  # fmt: skip
    with path.open("wb") as file, gzip.GzipFile("", "wb", fileobj=file, mtime=0) as packed:
        packed.write(text.getvalue().encode())


def write_csv(path: Path, record: Record, run: Run, rig: Rig) -> None:
    """Write a recording as the CSV of a foreign system, and its pulses beside it."""
    rows = recorded(rig.sensors)
    names = [FOREIGN[CHANNELS[row]] for row in rows]
    values = [record.channels[row] * factor for row, (_, factor) in zip(rows, names, strict=True)]
    header = ["Zeit [s]", *(name for name, _ in names)]
    _zipped(path, header, [record.times_s, *values], "%.9g")
    if "photocell" in rig.sensors:
        beside = path.with_name(path.name.removesuffix(".csv.gz") + "_edges.csv")
        lines = "\n".join(f"{edge:.9f}" for edge in record.edges_s)
        beside.write_text(f"edge [s]\n{lines}\n")
