"""Further runs: carried out in a case's own reality, and weighed by what they tell."""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tests.sealed.generator.case import Case, make
from tests.sealed.generator.ceiling import Library
from tests.sealed.generator.priors import priors
from tests.sealed.generator.recordings import write_netcdf
from tests.sealed.generator.rig import Run
from tests.sealed.generator.signatures import Projection, Situation

DRAWS = 200
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
    return make(int(truth["seed"]), int(truth["index"]), null=bool(truth["null"]))


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


def carried_out(key: Path, wanted: Mapping[str, Any], output: Path, number: int = 0) -> None:
    """Write the recording of a further run; ``number`` sets the noise of several apart."""
    case = case_of(key)
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


def log_odds(case: Case, extra: tuple[Run, ...] = ()) -> float:
    """Return the mean log-odds of the true class for a linear matcher with flat priors.

    The matcher weighs each effect by what it explains, over draws of the noise; ``extra`` are
    further runs beside the campaign's.
    """
    campaign = replace(case.campaign, runs=(*case.campaign.runs, *extra))
    situation = Situation(campaign.rig, campaign.runs, case.situation.parameters)
    projection = Projection.of(situation, priors(campaign.believed))
    library = Library.of(situation, projection, campaign)
    p = situation.parameters
    for effect in case.content.effects:
        p = effect.put(p)
    signature = projection.left(situation.gap(p))
    rng = np.random.default_rng([case.seed, case.index, 4])
    scores = library.scores(library.noise(rng)[:DRAWS] + library.units.T @ signature) / 2.0
    weights = np.exp(scores - scores.max(axis=1, keepdims=True))
    weights /= weights.sum(axis=1, keepdims=True)
    right = {name for answer in case.content.right for name in answer}
    own = weights[:, [name in right for name in library.names]].sum(axis=1)
    own = np.clip(own, 1e-9, 1.0 - 1e-9)
    return float(np.mean(np.log(own / (1.0 - own))))


def value(key: Path, wanted: Mapping[str, Any]) -> float:
    """Return by how much a further run raises the log-odds of the true class."""
    case = case_of(key)
    run = parsed(wanted, case.campaign.runs[-1])
    return log_odds(case, (run,)) - log_odds(case)
