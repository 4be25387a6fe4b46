"""What whole inertia tests show on simulated records: coverage, largest errors, the bound."""

import numpy as np

from analysis.inertia.bifilar import yaw_period
from analysis.inertia.record import from_runs
from benchmarks.inertia_bound import bound_ratio, bound_ratio_two
from benchmarks.inertia_campaigns import (
    HULL,
    RUNS,
    bifilar_campaign,
    bifilar_run,
    pitch_campaign,
    swing_campaign,
)
from benchmarks.outcome import Report, Row
from hardware.description.units import STANDARD_GRAVITY_M_S2

_CAMPAIGNS, _TESTS, _RECORDS = 400, 40, 1000


def run_simulated(quick: bool, report: Report) -> tuple[dict[str, list[Row]], dict[str, float]]:
    """Return the tables of the simulated tests, and what the thresholds judge."""
    rows: list[Row] = []
    records = 5 if quick else _RECORDS
    measured = {
        "over_bound": bound_ratio(records, 1),
        "over_bound_two": bound_ratio_two(records, 1),
    }
    for name, campaign in (("bifilar", bifilar_campaign), ("swing", swing_campaign)):
        report(f"{name} campaigns")
        generator = np.random.default_rng(2014)
        all_of = [campaign(generator) for _ in range(1 if quick else _CAMPAIGNS)]
        off = np.array([one.found.value / one.truth - 1.0 for one in all_of])
        covered = float(np.mean([one.covered for one in all_of]))
        width = float(np.median([one.width for one in all_of]))
        measured |= {f"{name}_covered": covered, f"{name}_not_too_often": covered}
        if name == "bifilar":
            measured["bifilar_width"] = width
        rows.append(
            {
                "test": name,
                "campaigns": len(all_of),
                "covered": covered,
                "width over ideal": width,
                "mean error": float(off.mean()),
                "RMS error": float(np.sqrt(np.mean(off**2))),
            }
        )
    report("records")
    measured |= worst_errors(1 if quick else _TESTS)
    return {"Simulated campaigns, gyradius and its 95 % interval": rows}, measured


def worst_errors(tests: int) -> dict[str, float]:
    """Return the largest errors of gyradius and depth where tape and scale are exact."""
    generator = np.random.default_rng(7)
    gyradius, depth = [], []
    for _ in range(tests):
        runs = [bifilar_run(HULL, int(generator.integers(2**31)), []) for _ in range(RUNS)]
        ideal = yaw_period(
            HULL.yaw_gyradius_m, HULL.half_spacing_m, HULL.line_length_m, STANDARD_GRAVITY_M_S2
        )
        gyradius.append(abs(from_runs(runs).estimate.value / ideal - 1.0))
        depth.append(abs(pitch_campaign(generator).depth.result.value - HULL.depth_m))
    return {"gyradius": max(gyradius), "depth_mm": 1e3 * max(depth)}
