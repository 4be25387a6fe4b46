"""The folders of a case: what whoever answers may see, and the key."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tests.sealed.generator.case import Case
from tests.sealed.generator.design import REGIMES
from tests.sealed.generator.features import (
    ORDERS,
    Reference,
    harmonics,
    line_sigma,
    recorded,
    resampled,
)
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.priors import STATED
from tests.sealed.generator.recordings import FOREIGN, set_point, write_csv, write_netcdf
from tests.sealed.generator.rig import CHANNELS, DITHER, Record, Rig, Run
from tests.sealed.generator.told import further_truth
from tests.sealed.generator.toml import table
from tests.sealed.generator.water import table_text
from tests.sealed.generator.worlds import stated

FOREIGN_SHARE = 0.2


def _matrix(p: FloatArray, first: P) -> list[list[float]]:
    values = [float(p[first + i]) for i in range(4)]
    return [values[:2], values[2:]]


def _oscillator(rig: Rig) -> dict[str, Any]:
    rows: dict[str, Any] = {
        "plane": rig.plane,
        "half_spacing_m": rig.half_spacing_m,
        "frequency_hz": {"low": 0.05, "high": 2.0},
        "eccentricity_m": {"low": 0.0, "high": 0.1 if rig.plane == "vertical" else 0.35},
        "force_per_strut_n": rig.full_scale_n,
    }
    if rig.rod_length_m is not None:
        rows["rod_length_m"] = rig.rod_length_m
    if rig.arrangement is not None:
        rows |= dict(zip(("joint", "pivot", "gauges"), rig.arrangement, strict=True))
        rows["drift_by"] = rig.drift_by
    return rows


def _acquisition(rig: Rig) -> dict[str, Any]:
    noise = rig.noise
    force = {"noise_rms": round(noise.white_n, 3), "resolution": noise.step_n}
    if not rig.noise_stated:
        del force["noise_rms"]
    strut = {"noise_rms": noise.displacement_m}
    if noise.step_m > 0.0:
        strut["resolution"] = noise.step_m
    all_rows = {
        "shaft_angle": {"noise_rms": DITHER * noise.step_rad, "resolution": noise.step_rad},
        "displacement_aft": strut,
        "displacement_fore": strut,
        "force_aft": force,
        "force_fore": force,
        "carriage_speed": {"noise_rms": noise.carriage_m_s},
    }
    there: dict[str, Any] = {n: row for n, row in all_rows.items() if n in rig.sensors}
    return there if "force_fore" in rig.sensors else {**there, "force_fore": False}


def _run(run: Run, **more: Any) -> dict[str, Any]:
    return {"name": run.name, **set_point(run), "periods": run.periods, **more}


def _columns(rig: Rig) -> str:
    names = [CHANNELS[row] for row in recorded(rig.sensors)]
    text = table("[columns]", {"time": "Zeit [s]"})
    text += table("\n[columns.channels]", {name: FOREIGN[name][0] for name in names})
    if "photocell" in rig.sensors:
        text += table("\n[columns.photocell]", {"edges_file": "{stem}_edges.csv"})
    return text


def _hull(case: Case) -> dict[str, Any]:
    p = case.campaign.believed
    hull = {
        "added_mass": _matrix(p, P.ADDED_00),
        "damping": _matrix(p, P.DAMPING_00),
        "restoring": _matrix(p, P.RESTORING_00),
    }
    if case.campaign.table is not None:  # it has the diagonals, but for the damping that lasts
        hull["added_mass"] = _crossed(hull["added_mass"])
        lasting = case.situation.parameters
        hull["damping"] = _crossed(hull["damping"], lasting[P.DAMPING_00], lasting[P.DAMPING_11])
    return hull


def _more_water(case: Case) -> Iterator[str]:
    if case.campaign.table is not None:
        yield table("[radiation]", {"file": "radiation.csv"})
    if case.campaign.believed[P.SURGE_UU]:
        yield table("[surge]", {"x_uu": case.campaign.believed[P.SURGE_UU]})


def campaign_text(case: Case, *, foreign: bool) -> str:
    """Return campaign.toml: what is believed, and the runs."""
    rig, p = case.campaign.rig, case.campaign.believed
    model = {
        "mass_kg": p[P.MASS],
        "inertia_kg_m2": p[P.INERTIA],
        "cg_x_m": p[P.CG_X],
        "cg_z_m": p[P.CG_Z],
    }
    scale = {"full_scale_n": rig.full_scale_n}
    head = table(f'name = "{case.name}"', {})
    if "photocell" not in rig.sensors:
        head += "photocell = false\n"
    parts = [
        head,
        table("[oscillator]", _oscillator(rig)),
        table("[model]", model),
        table("[hull]", _hull(case)),
        *_more_water(case),
        table("[dynamometers]", {"aft": scale, "fore": scale}),
        table("[acquisition]", _acquisition(rig)),
        table("[simulation]", {"sample_rate_hz": rig.sample_rate_hz}),
    ]
    if not tells_turns(rig.sensors):
        parts.append(table("[reference]", {"channel": "displacement_aft"}))
    if foreign:
        parts.append(_columns(rig))
    for run in case.campaign.runs:
        rows = _run(run)
        if foreign:
            rows["file"] = f"{run.name}.csv.gz"
        parts.append(table("[[runs]]", rows))
    return "\n".join(parts)


def case_text(case: Case) -> str:
    """Return case.toml: tolerances, withheld set-points and what the rig can do."""
    rig = case.campaign.rig
    fast = [run.frequency_hz for run in case.campaign.runs]
    wide = [run.eccentricity_m for run in case.campaign.runs]
    speed = max(run.carriage_speed_m_s for run in case.campaign.runs)
    can = {
        "frequency_hz": {"low": 0.7 * min(fast), "high": 1.15 * max(fast)},
        "eccentricity_m": {"low": 0.5 * min(wide), "high": max(wide)},
        "carriage_speed_m_s": {"low": 0.0, "high": 1.3 * speed},
        "strut_phase_rad": [0.0, 1.0471975512, 1.5707963268, 2.0943951024, 3.1415926536],
        "media": ["water", "air"],
        "special": ["rest", "check-weight", "injection"],
    }
    parts = [
        table('schema = "sealed-case-1"', {"sensors": list(rig.sensors)}),
        table("[tolerances]", STATED | stated(case.campaign.world)),
        table("[rig]", can),
    ]
    for run, regime in zip(case.campaign.held_out, REGIMES, strict=True):
        parts.append(table("[[held_out]]", _run(run, regime=regime)))
    return "\n".join(parts)


def _held_out(case: Case, run: Run, record: Record, ref: Reference) -> dict[str, Any]:
    """Return the harmonics of a withheld run without noise, with sigma as if it had some."""
    rig = case.campaign.rig
    means, in_phase, quadrature = harmonics(resampled(record, ref, run.periods), run.periods)
    if not tells_turns(rig.sensors):
        in_phase, quadrature = from_fundamental(in_phase, quadrature)
    own = np.arange(1, ORDERS + 1) * run.periods
    channels = {}
    for row in recorded(rig.sensors):
        channels[CHANNELS[row]] = {
            "mean": float(means[row]),
            "in_phase": in_phase[row].tolist(),
            "quadrature": quadrature[row].tolist(),
            "sigma": line_sigma(rig, run, row)[own].tolist(),
        }
    return {"frequency_hz": 1.0 / ref.period_s, "channels": channels}


def _crossed(matrix: list[list[float]], *diagonal: float) -> list[list[float]]:
    """Return a matrix with another diagonal, of nothing if none is given."""
    first, last = diagonal or (0.0, 0.0)
    return [[float(first), matrix[0][1]], [matrix[1][0], float(last)]]


def tells_turns(sensors: tuple[str, ...]) -> bool:
    """Tell whether a sensor counts the shaft's own turns: photocell or encoder."""
    return "photocell" in sensors or "shaft_angle" in sensors


def from_fundamental(in_phase: FloatArray, quadrature: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return harmonics counted from where the aft strut's fundamental passes zero upwards.

    So docs/conventions.md counts them without a photocell; a crank's displacement, which is no
    sine, passes its middle somewhat beside that.
    """
    aft = CHANNELS.index("displacement_aft")
    turned = np.arange(1, ORDERS + 1) * np.arctan2(quadrature[aft, 0], in_phase[aft, 0])
    cosine, sine = np.cos(turned), np.sin(turned)
    return in_phase * cosine + quadrature * sine, quadrature * cosine - in_phase * sine


def _effects(case: Case) -> list[dict[str, Any]]:
    pair = case.content.kind == "pair"
    return [
        {
            "name": sized.effect.name,
            "stage": sized.effect.stage,
            "form": sized.effect.form,
            "equivalent": sized.equivalent,
            "snr": sized.snr,
            "alone": case.alone(sized) if pair else sized.snr,
        }
        for sized in case.content.effects
    ]


def truth(case: Case, held_out: Mapping[str, Any]) -> dict[str, Any]:
    """Return the key of a case; docs/sealed.md says what each entry means."""
    content, p = case.content, case.parameters
    out: dict[str, Any] = {
        "schema": "sealed-truth-1",
        "case": case.name,
        "seed": str(case.seed),
        "index": case.index,
        "kind": content.kind,
        "null": case.null,
        "verdict": content.verdict,
        "determinable": case.determinable,
        "effects": _effects(case),
        "right": [list(answer) for answer in case.right],
        "stages": list(case.stages),
        "snr": case.snr,
        "angle_deg": None,
        "imitators": [],
        "classes": {},
        "separated_by": content.separated_by,
        "background": case.background,
        "nuisances": [{"name": x.effect.name, "snr": x.snr} for x in case.always],
        "true_hull": {
            "mass_kg": float(p[P.MASS]),
            "inertia_kg_m2": float(p[P.INERTIA]),
            "added_mass": _matrix(p, P.ADDED_00),
            "damping": _matrix(p, P.DAMPING_00),
            "restoring": _matrix(p, P.RESTORING_00),
        },
        "held_out": dict(held_out),
        "ceiling": None,
    }
    if case.campaign.world.name != "A":
        out |= further_truth(case)
    if content.effects and content.verdict != "none":
        absent = {name for answer in case.right for name in answer}
        near = case.templates.imitators(case.signature, sorted(absent))
        out["imitators"] = [{"name": name, "cosine": cosine} for name, cosine in near]
        out["angle_deg"] = float(np.degrees(np.arccos(min(near[0][1], 1.0))))
        out["classes"] = case.templates.classes()
        out["ceiling"] = case.reach()
    return out


def write(case: Case, cases: Path, keys: Path) -> None:
    """Write a case's folder below ``cases`` and its key below ``keys``."""
    write_open(case, cases)
    _write_key(case, keys / case.name)


def write_open(case: Case, cases: Path) -> None:
    """Write a case's folder below ``cases``: what whoever answers may see."""
    folder = cases / case.name
    folder.mkdir(parents=True)
    foreign = bool(np.random.default_rng([case.seed, case.index, 3]).random() < FOREIGN_SHARE)
    rig = case.campaign.rig
    for number, run in enumerate(case.campaign.runs):
        made = case.recorded(run, number)
        if foreign:
            write_csv(folder / f"{run.name}.csv.gz", made, run, rig)
        else:
            write_netcdf(folder / f"{run.name}.nc", made, run, rig)
    (folder / "campaign.toml").write_text(campaign_text(case, foreign=foreign))
    if case.campaign.table is not None:
        (folder / "radiation.csv").write_text(table_text(case.campaign.table, rig.plane))
    (folder / "case.toml").write_text(case_text(case))


def _write_key(case: Case, key: Path) -> None:
    (key / "held-out").mkdir(parents=True)
    held_out = {}
    for run, (clean, ref) in zip(case.campaign.held_out, case.withheld, strict=True):
        write_netcdf(key / "held-out" / f"{run.name}.nc", clean, run, case.campaign.rig)
        held_out[run.name] = _held_out(case, run, clean, ref)
    (key / "truth.json").write_text(json.dumps(truth(case, held_out), indent=1) + "\n")
