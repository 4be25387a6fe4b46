"""What can be wrong with a campaign's folder: one function each, which spoils it in place."""

from collections.abc import Mapping
from typing import Any, Final

from benchmarks.boards.folder import Folder
from benchmarks.boards.spoiled_samples import OF_SAMPLES, Mutation, Random, channel, pick, some


def _bytes(folder: Folder, rng: Random) -> None:
    texts = (b"", b"\n", b"a;b;c\n", b"\x00" * 64, b"\x89HDF\r\n\x1a\n" + b"\x01" * 90, b"1;2\n3\n",
             b"Zeit;Kraft A\n0,0;x\n", b"\xff\xfe" + "Zeit".encode("utf-16-le"))  # fmt: skip
    for record in some(folder, rng):
        record.raw = texts[int(rng.integers(len(texts)))]


def _gone(folder: Folder, rng: Random) -> None:
    for record in some(folder, rng):
        record.is_there = False


def _units(folder: Folder, rng: Random) -> None:
    record = pick(folder, rng)
    name = channel(record, rng)
    if name is not None:
        record.units[name] = str(rng.choice(["kN", "", "furlong", "V", "s", "mm"]))


def _attributes(folder: Folder, rng: Random) -> None:
    record = pick(folder, rng)
    key = str(rng.choice(["set_point", "flags", "provenance", "run_name", "schema"]))
    record.attributes[key] = str(rng.choice(["", "{", "[]", "{}", "null", "pmm-run-9", '{"a": 1}']))


def _runs(folder: Folder, rng: Random) -> None:
    """Set a run's key to what it cannot be, or is not."""
    changes: tuple[tuple[str, Any], ...] = (
        ("frequency_hz", 0.0), ("frequency_hz", 1.6), ("frequency_hz", 0.4), ("frequency_hz", 1e-9),
        ("frequency_hz", 1e6), ("eccentricity_mm", 0.0), ("eccentricity_mm", 2e4),
        ("eccentricity_mm", 1e-6), ("strut_phase_deg", 90.0), ("strut_phase_deg", 1e6),
        ("carriage_speed_m_s", 0.0), ("carriage_speed_m_s", 1e3), ("medium", "air"),
        ("medium", "rest"), ("periods", 0), ("periods", 100000), ("zero_before", "nobody"),
        ("zero_after", "heave-0.80"), ("number", 1), ("outcome", "fault"), ("kind", "known-mass"),
        ("kind", "restoring"), ("kind", "dry"), ("drift_rad", 1.5), ("file", "nowhere.nc"),
        ("file", "zero-1.nc"), ("name", "air-1.10"), ("name", "../air"), ("name", ""),
    )  # fmt: skip
    own = folder.campaign.get("runs", [{}])
    for run in own if rng.random() < 0.3 else [own[int(rng.integers(len(own)))]]:
        key, value = changes[int(rng.integers(len(changes)))]
        run[key] = value


def _rest(folder: Folder, rng: Random) -> None:
    changes: tuple[tuple[str, Any], ...] = (
        ("kind", "push"), ("kind", "straight-tow"), ("duration_s", 0.0), ("duration_s", 1e-6),
        ("outcome", "stopped"), ("carriage_speed_m_s", 1.2), ("medium", "air"), ("number", 3),
        ("file", "heave-0.50.nc"), ("file", "nowhere.csv"), ("name", "zero-2"),
    )  # fmt: skip
    own = folder.campaign.get("at_rest", [{}])
    key, value = changes[int(rng.integers(len(changes)))]
    own[int(rng.integers(len(own)))][key] = value


def _without_table(folder: Folder, rng: Random) -> None:
    tables = [key for key in folder.campaign if key != "name"]
    folder.campaign.pop(tables[int(rng.integers(len(tables)))])


def _believed(folder: Folder, rng: Random) -> None:
    """State of channels, model or analysis what is not so."""
    changes: tuple[tuple[str, Any], ...] = (
        ("acquisition", {}), ("acquisition", {"force_aft": {"noise_rms": 0.0}}),
        ("acquisition", {"force_aft": {"noise_rms": 1e6}}),
        ("acquisition", {"force_aft": {"resolution": 1e3}}),
        ("acquisition", {"force_fore": {"full_scale": 1e-3}}),
        ("acquisition", {"wave": {"noise_rms": 1e-3}}),
        ("acquisition", {"force_aft": {"drift_per_s": 10.0}}),
        ("reference", {"channel": "displacement_aft"}), ("reference", {"channel": "wave"}),
        ("reference", {"channel": "force_aft"}), ("reference", {"frequency_hz": 0.7}),
        ("analysis", {"harmonics": 40}), ("analysis", {"harmonics": 1}),
        ("analysis", {"channels": ["force_aft"]}), ("analysis", {"channels": ["nobody"]}),
        ("analysis", {"window": 50}), ("photocell", False),
        ("model", {"mass_kg": 0.0, "inertia_kg_m2": 27.5}),
        ("model", {"mass_kg": 1e-3, "inertia_kg_m2": 1e-3}),
        ("hull", {}), ("hull", {"added_mass": [[-200.0, 0.0], [0.0, -90.0]]}),
        ("effects", [{"name": "nobody"}]), ("oscillator", {"preset": "horizontal-1963"}),
        ("simulation", {"sample_rate_hz": 1e-3}),
    )  # fmt: skip
    key, value = changes[int(rng.integers(len(changes)))]
    folder.campaign[key] = value


def _columns(folder: Folder, rng: Random) -> None:
    columns = folder.campaign.get("columns")
    if not columns:
        folder.campaign["columns"] = {"channels": {"force_aft": "Kraft A"}}
        return
    kind = int(rng.integers(6))
    names = list(columns["channels"])
    name = names[int(rng.integers(len(names)))] if names else "force_aft"
    if kind == 0:
        columns["channels"].pop(name, None)
    elif kind == 1:
        columns["channels"][name] = "Kraft C:kN"
    elif kind == 2:
        columns["time"] = "Uhr:s"
    elif kind == 3:
        columns["separator"] = ","
    elif kind == 4:
        columns["channels"][name] = "Kraft A:mm"
    else:
        columns["photocell"] = {"edges_file": "nowhere.csv"}


def _beside(folder: Folder, rng: Random) -> None:
    """Put another file beside the campaign's."""
    files = (
        ("case.toml", "[tolerances]\nadded_mass_relative = 0.0\ndamping_relative = 0.0\n"),
        ("case.toml", "[tolerances]\nzero_n = -1.0\n"),
        ("case.toml", "schema = 1\n"),
        ("case.toml", "[tolerances]\nmass_relative = 1e9\n"),
        ("coefficients.toml", "harmonics = 0\n"),
        ("coefficients.toml", 'system = "prime"\n'),
        ("coefficients.toml", "tared = true\n"),
    )
    file, text = files[int(rng.integers(len(files)))]
    folder.files[file] = text


MUTATIONS: Final[Mapping[str, Mutation]] = {
    **OF_SAMPLES,
    "other bytes": _bytes,
    "no file": _gone,
    "unit's name": _units,
    "attribute": _attributes,
    "run's key": _runs,
    "key of a record at rest": _rest,
    "table not there": _without_table,
    "what is believed": _believed,
    "columns": _columns,
    "file beside": _beside,
}
