"""A small campaign folder as plain values: recordings and campaign file, to be spoiled at will."""

import copy
import json
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np
from click.testing import CliRunner

from analysis.readers import read_recording
from hardware.description.arrays import FloatArray
from pmm.cli import cli
from pmm.configuration import read_toml
from pmm.toml_text import toml_value

# Two motions, three frequencies, a run in air: as few as a diagnosis takes, and short ones.
_RUNS: Final = (
    ("heave-0.50", 0.5, 0.0, "water"),
    ("heave-0.80", 0.8, 0.0, "water"),
    ("pitch-0.80", 0.8, 180.0, "water"),
    ("air-1.10", 1.1, 0.0, "air"),
)
_HEAD: Final = """name = "mutated"
oscillator = { preset = "vertical-1963" }
model = { mass_kg = 70.0, inertia_kg_m2 = 27.5, cg_x_m = -0.02, cg_z_m = 0.02 }
simulation = { sample_rate_hz = 50.0, settling_periods = 1, seed = 1963 }

[hull]
added_mass = [[75.0, 3.0], [3.0, 22.0]]
damping = [[190.0, 12.0], [12.0, 55.0]]
restoring = [[6900.0, 345.0], [345.0, 2400.0]]

[acquisition]
shaft_angle = { resolution = 9.6e-5 }
displacement_aft = { noise_rms = 5e-6 }
displacement_fore = { noise_rms = 5e-6 }
force_aft = { noise_rms = 0.05, resolution = 0.015, full_scale = 500.0 }
force_fore = { noise_rms = 0.05, resolution = 0.015, full_scale = 500.0 }
"""
_RUN: Final = """
[[runs]]
name = "{0}"
frequency_hz = {1}
strut_phase_deg = {2}
medium = "{3}"
eccentricity_mm = 20.0
carriage_speed_m_s = {4}
periods = 4
zero_before = "zero-1"
zero_after = "zero-2"
number = {5}
"""
_ZERO: Final = """
[[at_rest]]
name = "zero-{0}"
kind = "zero"
file = "zero-{0}.nc"
duration_s = 4.0
number = {1}
"""
# Another system's column and unit for each channel, and what makes it of SI.
FOREIGN: Final[Mapping[str, tuple[str, float]]] = {
    "shaft_angle": ("Kurbel:deg", 180.0 / np.pi),
    "displacement_aft": ("Weg A:mm", 1e3),
    "displacement_fore": ("Weg B:mm", 1e3),
    "force_aft": ("Kraft A:kN", 1e-3),
    "force_fore": ("-Kraft B:kN", -1e-3),
    "carriage_speed": ("Wagen:m/s", 1.0),
}


@dataclass
class Record:
    """A recording.

    Attributes
    ----------
    edges_s
        Of the photocell; ``None`` without one.
    raw
        Bytes that stand in its file instead.
    """

    channels: dict[str, FloatArray]
    units: dict[str, str]
    times_s: FloatArray
    rate_hz: float
    edges_s: FloatArray | None
    attributes: dict[str, str] = field(default_factory=dict)
    raw: bytes | None = None
    is_there: bool = True


@dataclass
class Folder:
    """A campaign's folder; ``foreign`` ones are another system's text files."""

    records: dict[str, Record]
    campaign: dict[str, Any]
    foreign: bool
    files: dict[str, str] = field(default_factory=dict)

    def write(self, folder: Path) -> Path:
        """Write it; the folder is empty before."""
        for name, record in self.records.items():
            if record.is_there:
                self._write(folder, name, record)
        rows = [f"{key} = {toml_value(value)}" for key, value in self.campaign.items()]
        (folder / "campaign.toml").write_text("\n".join([*rows, ""]), encoding="utf-8")
        for file, text in self.files.items():
            (folder / file).write_text(text, encoding="utf-8")
        return folder

    def _write(self, folder: Path, name: str, record: Record) -> None:
        path = folder / f"{name}.{'csv' if self.foreign else 'nc'}"
        if record.raw is not None:
            path.write_bytes(record.raw)
        elif self.foreign:
            _write_text(path, record)
        else:
            _write_netcdf(path, record)


def base(*, foreign: bool) -> Folder:
    """Return the sound campaign, which belongs to the caller."""
    return copy.deepcopy(_base(foreign))


@cache
def _base(foreign: bool) -> Folder:
    runs = [
        _RUN.format(*run, 0.0 if run[3] == "air" else 1.2, at) for at, run in enumerate(_RUNS, 2)
    ]
    text = "".join([_HEAD, _ZERO.format(1, 1), *runs, _ZERO.format(2, len(_RUNS) + 2)])
    with tempfile.TemporaryDirectory() as scratch:
        source = Path(scratch) / "campaign.toml"
        source.write_text(text, encoding="utf-8")
        made = CliRunner().invoke(cli, ["simulate", str(source), "--output", scratch])
        if made.exit_code:
            raise RuntimeError(made.output)
        campaign = dict(read_toml(source))
        records = {path.stem: _record(path) for path in sorted(Path(scratch).glob("*.nc"))}
    if foreign:
        campaign["columns"] = {
            "time": "Zeit:s",
            "separator": ";",
            "decimal": ",",
            "channels": {name: FOREIGN[name][0] for name in records["air-1.10"].channels},
            "photocell": {"edges_file": "{stem}_edges.csv"},
        }
        for one in (*campaign["runs"], *campaign["at_rest"]):
            one["file"] = f"{one['name']}.csv"
    return Folder(records, campaign, foreign)


def _record(path: Path) -> Record:
    found = read_recording(path)
    point = found.set_point
    kept = {"run_name": path.stem, "provenance": "{}", "flags": "[]", "schema": "pmm-run-1"}
    if point is not None:
        kept["set_point"] = json.dumps(
            {
                "frequency_hz": point.frequency_hz,
                "eccentricity_m": point.eccentricity_m,
                "strut_phase_rad": point.strut_phase_rad,
                "carriage_speed_m_s": point.carriage_speed_m_s,
                "medium": str(point.medium),
            }
        )
    names = [one for one in found.channel_names if one in FOREIGN]
    units = {one.name: one.unit or "1" for one in found.channels}
    values = {name: np.array(found.values(name)) for name in names}
    return Record(
        values, units, found.time_s(), found.sample_rate_hz, found.photocell_edges_s, kept
    )


def _write_netcdf(path: Path, record: Record) -> None:
    """Write it with h5py alone, so that what the product would not write is written too."""
    import h5py

    with h5py.File(path, "w") as file:
        file.attrs.update({**record.attributes, "sample_rate_hz": record.rate_hz})
        time = _variable(file, "time", "s", record.times_s, None)
        for name, values in record.channels.items():
            _variable(file, name, record.units[name], values, time)
        if record.edges_s is not None:
            edge = file.create_dataset("photocell_edge", len(record.edges_s), np.float32)
            edge.make_scale("This is a netCDF dimension but not a netCDF variable.")
            _variable(file, "photocell_edge_time", "s", record.edges_s, edge)


def _variable(file: Any, name: str, unit: str, values: FloatArray, along: Any) -> Any:
    """Write a variable along a dimension; one without is a dimension itself."""
    made = file.create_dataset(name, data=values)
    made.attrs["units"] = unit
    if along is None:
        made.make_scale(name)
    else:
        made.dims[0].attach_scale(along)
    return made


def _write_text(path: Path, record: Record) -> None:
    """Write it as another system would: its names and units, semicolons, decimal commas."""
    heads, columns = ["Zeit"], [record.times_s]
    for name, values in record.channels.items():
        source, factor = FOREIGN.get(name, (name, 1.0))
        heads.append(source.removeprefix("-").partition(":")[0])
        columns.append(values * factor)
    rows = [";".join(f"{one:.9g}" for one in row) for row in np.column_stack(columns).tolist()]
    text = "\n".join([";".join(heads), *rows, ""]).replace(".", ",")
    path.write_text(text, encoding="utf-8")
    if record.edges_s is not None:
        lines = "\n".join(f"{edge:.9f}" for edge in record.edges_s.tolist())
        path.with_name(f"{path.stem}_edges.csv").write_text(f"edge [s]\n{lines}\n")
