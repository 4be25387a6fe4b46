"""Coefficients: do their intervals hold, do hulls come back, is the form told that was put in."""

import math
from collections import Counter
from dataclasses import replace

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.form_choice import BOTH, CUBIC, NOT_SEPARABLE, QUADRATIC, choose_form
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.normalisation import mmg
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.strut_cycle import measured_cycle
from analysis.coefficients.terms import term_of
from analysis.readers.dataset import from_dataset
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from benchmarks.coefficients_campaigns import HORIZONTAL, Made, amplitudes, made_up
from benchmarks.coefficients_coverage import CASES, cubic_rates, linear_rates, monte_carlo_ratio
from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from sim.model.hull import HullCoefficients
from sim.model.water.table_files import read_heave_csv, read_hull_csv
from sim.model.water.tables import RadiationTable
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate
from tests.analysis.manoeuvring.published import Published, kcs, kvlcc2

_TABLES = ROOT.parent / "shared" / "reference" / "hydrodynamics"
_HULLS = ("wigley_L3.0_B0.3_T0.1875", "box_L2.0_B0.4_T0.15")
_CLOSE = 5e-3
_CHANNELS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")
_FORMS = {
    CUBIC: {"Y_vvv": -900.0},
    QUADRATIC: {"Y_v|v|": -250.0},
}


def run(quick: bool, report: Report) -> Outcome:
    """Count intervals, put hulls in, and hold Monte Carlo and forms against what was put in."""
    measured: dict[str, float] = {}
    coverage: list[Row] = []
    for case in CASES:
        report(f"coverage: {case.name}")
        rates = linear_rates(case, 20 if quick else 2000)
        _count(measured, coverage, case.name, rates)
    _count(measured, coverage, "cubic", cubic_rates(3 if quick else 1000, report))
    for name, ship in (("kvlcc2", kvlcc2), ("kcs", kcs)):
        report(f"coverage: {name}")
        _count(measured, coverage, name, cubic_rates(3 if quick else 2000, report, _hull(ship)))
    ratio, ratios = monte_carlo_ratio(2_000 if quick else 50_000)
    report("forms")
    forms, wrong = _forms(4 if quick else 200)
    tables = {
        "Part of 95 % intervals that hold the truth": coverage,
        "Standard uncertainty by Monte Carlo over the linear budget's": ratios,
        "Which form was named, campaigns": forms,
    }
    if not quick:
        measured |= {"monte_carlo_ratio": ratio, "wrong_form": wrong}
    notes = [
        "Each campaign draws scatter of 8 periods and one error of everything stated: mass, CG, "
        "inertia, lag, gain, amplitude.",
        "kvlcc2 and kcs: sway, yaw and drift at 1.2 m/s of a model of 2.9 m with the published "
        "derivatives (tests/analysis/manoeuvring/published.py), 2,000 campaigns each; a table in "
        "the Abkowitz form has the same intervals times a number.",
    ]
    if _TABLES.is_dir():
        report("hulls")
        rows = [row for table in _hulls(quick) for row in _hull_rows(*table)]
        tables["Hulls put into the simulator, rig with noise"] = _worst(rows)
        measured["hulls_missed"] = float(sum(bool(row["missed"]) for row in rows))
    else:
        notes.append("The tables of hulls are not at hand.")
    return Outcome(tables, measured, tuple(notes))


def _hull(ship: Published) -> dict[str, float]:
    """Return a ship's derivatives of sway and yaw, as published, for a model of 2.9 m."""
    system = mmg(2.9091, ship.D * 2.9091 / ship.L, 1.2, ship.RHO)
    own = {name: one for name, one in ship.HULL.items() if name[0] in "YN"}
    own |= {"Y_vdot": -ship.M_Y, "N_rdot": -ship.J_Z}
    return {
        name: one * system.term_factor(term_of(name, Plane.HORIZONTAL)) for name, one in own.items()
    }


def _count(measured: dict[str, float], rows: list[Row], case: str, rates: dict[str, float]) -> None:
    least, greatest = float(min(rates.values())), float(max(rates.values()))
    measured |= {f"{case}_least": least, f"{case}_greatest": greatest}
    mean = float(np.mean(list(rates.values())))
    rows.append({"case": case, "mean": mean, "least": least, "greatest": greatest})


def _forms(campaigns: int) -> tuple[list[Row], float]:
    """Sway at three amplitudes with one form or the other; what was named."""
    linear = {name: HORIZONTAL[name] for name in ("Y_vdot", "Y_v", "N_vdot", "N_v")}
    rows: list[Row] = []
    wrong = 0
    points = [(name, point) for name, point in amplitudes() if name.startswith("sway")]
    for form, terms in _FORMS.items():
        generator = np.random.default_rng(3)
        made = Made(linear | terms)
        named = Counter(
            choose_form([made_up(point, made, name, generator) for name, point in points], 0)[
                0
            ].verdict
            for _ in range(campaigns)
        )
        other = QUADRATIC if form == CUBIC else CUBIC
        wrong += named[other]
        row: Row = {"put in": form}
        row |= {name: named[name] for name in (CUBIC, QUADRATIC, BOTH, NOT_SEPARABLE)}
        rows.append(row)
    return rows, wrong / (len(_FORMS) * campaigns)


def _hulls(quick: bool) -> list[tuple[str, RadiationTable]]:
    sphere = read_heave_csv(_TABLES / "hemisphere_heave.csv").froude_scaled(0.25)
    found = [("hemisphere, R = 0.25 m", sphere)]
    for body in _HULLS[: 1 if quick else 2]:
        path = _TABLES / "hulls.csv"
        found += [(f"{body}, {plane}", read_hull_csv(path, plane, body)) for plane in Plane]
    return found


def _hull_rows(name: str, table: RadiationTable) -> list[Row]:
    """Every frequency that the oscillator reaches, both motions, with the rig's own noise."""
    rig = vertical_rig() if table.plane is Plane.VERTICAL else horizontal_rig()
    rows: list[Row] = []
    for k, omega in enumerate(table.omega_rad_s):
        frequency = float(omega) / (2.0 * math.pi)
        if not 0.1 <= frequency <= 2.0:
            continue
        water = _water(table, k)
        own = replace(rig, water=water)
        eccentricity = min(0.04, 0.03 / frequency**2)
        runs = [
            _measured(own, SetPoint(frequency, eccentricity, phase), f"{phase:.0f}", k)
            for phase in (0.0, math.pi)
        ]
        fit = linear_fit(runs, Form.SEAKEEPING, StatedUncertainties()).fit
        modes = "35" if table.plane is Plane.VERTICAL else "26"
        for letter, put_in in (("a", water.added_mass), ("b", water.damping)):
            for place, mode in enumerate(modes):
                if put_in[place][place] == 0.0:
                    continue
                rows.append(_hull_row(name, letter + 2 * mode, put_in[place][place], fit))
    return rows


def _hull_row(hull: str, name: str, expected: float, fit: CycleFit) -> Row:
    error = fit[name] - expected
    half = float(fit.uncertain.half_width()[fit.names.index(name)])
    return {
        "hull": hull,
        "coefficient": name,
        "error": error / expected,
        "half_width": half / abs(expected),
        "missed": abs(error) > max(_CLOSE * abs(expected), half),
    }


def _water(table: RadiationTable, k: int) -> HullCoefficients:
    restoring = ((1926.0, 0.0), (0.0, 600.0)) if table.plane is Plane.VERTICAL else None
    a, b = table.added_mass[k].tolist(), table.damping[k].tolist()
    added, damping = (tuple(map(tuple, matrix)) for matrix in (a, b))
    if restoring is None:
        return HullCoefficients(added_mass=added, damping=damping)  # type: ignore[arg-type]
    return HullCoefficients(added_mass=added, damping=damping, restoring=restoring)  # type: ignore[arg-type]


def _measured(rig: SimulatedRig, point: SetPoint, name: str, seed: int) -> BodyCycle:
    record = simulate(rig, point, periods=30, sample_rate_hz=100.0, seed=seed, name=name)
    analysis = analyse(
        from_dataset(record), settings=ResolverSettings(channels=_CHANNELS, harmonics=3)
    )
    cycle = measured_cycle(analysis, rig.oscillator).model()
    return cycle.without(rig.body, np.array(rig.water.restoring))


def _worst(rows: list[Row]) -> list[Row]:
    """A row per hull and coefficient: errors at their largest, and how many were missed."""
    found: list[Row] = []
    for hull, coefficient in dict.fromkeys((row["hull"], row["coefficient"]) for row in rows):
        own = [r for r in rows if (r["hull"], r["coefficient"]) == (hull, coefficient)]
        largest = max(own, key=lambda row: abs(float(row["error"])))
        found.append(
            {
                "hull": hull,
                "coefficient": coefficient,
                "frequencies": len(own),
                "median error": float(np.median([abs(float(row["error"])) for row in own])),
                "largest error": abs(float(largest["error"])),
                "its half-width": float(largest["half_width"]),
                "missed": sum(bool(row["missed"]) for row in own),
            }
        )
    return found


BENCHMARK = Benchmark("coefficients", "Coefficients", run)
