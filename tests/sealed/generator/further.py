"""Further runs, carried out in a case's own reality."""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tests.sealed.generator.case import Case, make
from tests.sealed.generator.recordings import write_netcdf
from tests.sealed.generator.rig import Run

# Number of the noise of a further run; those of the campaign count from 0.
FIRST = 1000
_KEYS = {
    "oscillation": ("frequency_hz", "eccentricity_m", "strut_phase_rad", "carriage_speed_m_s",
                    "medium", "preload_n", "periods"),
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


def possible(case_toml: Path, rng: np.random.Generator) -> dict[str, Any]:
    """Return a random further run that the rig of a case can do: the control of a proposal."""
    rig = tomllib.loads(case_toml.read_text())["rig"]
    kinds = ["oscillation"] * 6 + list(rig["special"])
    kind = str(rng.choice(kinds))
    if kind == "rest":
        return {"kind": kind}
    if kind == "check-weight":
        return {"kind": kind, "weight_n": 50.0, "strut": str(rng.choice(["aft", "fore"]))}
    frequency = float(rng.uniform(rig["frequency_hz"]["low"], rig["frequency_hz"]["high"]))
    if kind == "injection":
        return {"kind": kind, "frequency_hz": frequency, "force_n": 50.0}
    spans = {name: rig[name] for name in ("eccentricity_m", "carriage_speed_m_s")}
    drawn = {name: float(rng.uniform(span["low"], span["high"])) for name, span in spans.items()}
    medium = str(rng.choice(rig["media"]))
    if medium == "air":
        drawn["carriage_speed_m_s"] = 0.0
    phase = float(rng.choice(rig["strut_phase_rad"]))
    return {"kind": kind, "frequency_hz": frequency, "strut_phase_rad": phase, "medium": medium,
            **drawn}  # fmt: skip
