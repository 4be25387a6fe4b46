"""Further runs, carried out in a case's own reality."""

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from tests.sealed.generator.case import Case, make
from tests.sealed.generator.recordings import set_point, write_netcdf
from tests.sealed.generator.rig import Run
from tests.sealed.generator.toml import table

# Number of the noise of a further run; those of the campaign count from 0.
FIRST = 1000
_KEYS = {
    "oscillation": ("frequency_hz", "eccentricity_m", "strut_phase_rad", "carriage_speed_m_s",
                    "medium", "drift_rad", "preload_n", "periods"),
    "rest": (),
    "check-weight": ("weight_n", "strut"),
    "injection": ("frequency_hz", "force_n"),
}  # fmt: skip


def case_of(key: Path) -> Case:
    """Return the case that a key's folder belongs to, made again."""
    truth = json.loads((key / "truth.json").read_text())
    return make(int(truth["seed"]), int(truth["index"]), null=bool(truth["null"]),
                where=str(truth.get("world", "A")))  # fmt: skip


def parsed(wanted: Mapping[str, Any], last: Run) -> Run:
    """Return a further run; what an oscillation leaves open is as in the campaign's ``last``.

    Raises
    ------
    ValueError
        For a kind or key that docs/sealed.md does not know.
    """
    kind = wanted.get("kind", "oscillation")
    if kind not in _KEYS:
        raise ValueError(f"kind {kind!r} of a further run: one of {', '.join(_KEYS)}")
    unknown = set(wanted) - {"kind", *_KEYS[kind]}
    if unknown:
        raise ValueError(f"{kind}: unknown {sorted(unknown)}; known: {', '.join(_KEYS[kind])}")
    given = {name: value for name, value in wanted.items() if name != "kind"}
    if kind == "oscillation":
        return replace(last, name="further", hour=last.hour + 0.1, **given)
    return Run(name="further", kind=kind, hour=last.hour + 0.1, **given)


def carried_out(case: Case, wanted: Mapping[str, Any], output: Path, number: int = 0) -> None:
    """Write the recording of a further run; ``number`` sets the noise of several apart."""
    run = parsed(wanted, case.campaign.runs[-1])
    record = case.recorded(run, FIRST + number)
    write_netcdf(output, record, run, case.campaign.rig)


def added(case: Case, run: Run, folder: Path, number: int) -> None:
    """Carry a further run out into a case's folder, and enter it in its campaign file."""
    named = replace(run, name=f"further-{number}")
    record = case.recorded(named, FIRST + number)
    write_netcdf(folder / f"{named.name}.nc", record, named, case.campaign.rig)
    rows = {"name": named.name, **set_point(named), "periods": named.periods}
    with (folder / "campaign.toml").open("a") as file:
        file.write("\n" + table("[[runs]]", rows | {"file": f"{named.name}.nc"}))
