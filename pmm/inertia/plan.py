"""``pmm inertia plan``: what a test would give, before it is made."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from analysis.inertia.double_pendulum import LineLengthReading, gyradius_error_per_period
from analysis.inertia.suspension_plan import SUSPENSION_OPTIONS, forecast_suspension
from analysis.inertia.swing import SwingState, forecast_swing
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from pmm.configuration import STRICT_TABLE
from pmm.inertia.outcome import Finding, Outcome, TargetTable, compare, without_repeats
from pmm.inertia.reading import read_job
from pmm.inertia.stated_values import flags_of, gravity_of, stated_value


@dataclass(frozen=True)
class ExpectedTable:
    """Design or CAD values of the model; ``depth_m`` is its CG's below the suspension points."""

    mass_kg: float
    u_mass_kg: float = 0.0
    k_roll_m: float | None = None
    k_pitch_m: float | None = None
    k_yaw_m: float | None = None
    depth_m: float | None = None


@dataclass(frozen=True)
class PlannedSuspension:
    """A bifilar suspension to be judged."""

    half_spacing_m: float
    line_m: float
    u_half_spacing_m: float = 0.0
    u_line_m: float = 0.0
    period_scatter_relative: float = 1e-3


@dataclass(frozen=True)
class PlannedSwing:
    """The empty swing as measured, and where on it the model will be."""

    mass_kg: float
    cg_below_pivot_m: float
    period_s: float
    model_cg_below_pivot_m: float
    u_mass_kg: float = 0.0
    u_cg_below_pivot_m: float = 0.0
    u_period_s: float = 0.0
    period_scatter_relative: float = 1e-3
    moment_relative: float = 1e-3
    axis: Literal["roll", "pitch", "yaw"] = "pitch"


@dataclass(frozen=True)
class PlanJob:
    """The file of ``pmm inertia plan``."""

    expected: ExpectedTable
    name: str = "plan"
    gravity_m_s2: float | None = None
    u_gravity_m_s2: float = 0.0
    bifilar: PlannedSuspension | None = None
    swing: PlannedSwing | None = None
    targets: tuple[TargetTable, ...] = ()

    __pydantic_config__ = STRICT_TABLE

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """A test to plan, with the design values it needs."""
        if not {"bifilar", "swing"} & set(table):
            yield "", "plans nothing; add [bifilar], [swing] or both"
        expected = table.get("expected")
        if "bifilar" in table and isinstance(expected, dict):
            for key in ("k_yaw_m", "k_pitch_m", "depth_m"):
                if key not in expected:
                    yield "expected", f"needs {key} for [bifilar]"


def run(path: str) -> Outcome:
    """Forecast the tests of a plan's file.

    Raises
    ------
    ConfigurationError
        If the file is wrong.
    """
    job = read_job(path, PlanJob)
    table = job.table
    findings: list[Finding] = []
    flags: list[Flag] = list(flags_of(table))
    notes: list[str] = []
    errors = None
    if table.bifilar is not None:
        _plan_bifilar(table, table.bifilar, findings, flags, notes)
        errors = _line_errors(table)
    if table.swing is not None:
        _plan_swing(table, table.swing, findings, flags, notes)
    return Outcome(
        "plan",
        table.name,
        tuple(findings),
        without_repeats(flags),
        missing=("a measurement (a plan is none)",),
        comparisons=compare(findings, table.targets),
        notes=tuple(notes),
        line_errors=errors,
    )


def _design(table: PlanJob, key: str) -> float:
    value: float | None = getattr(table.expected, key)
    if value is None:
        raise ConfigurationError(f"{table.name}: expected.{key} is missing")
    return value


def _plan_bifilar(
    table: PlanJob,
    plan: PlannedSuspension,
    findings: list[Finding],
    flags: list[Flag],
    notes: list[str],
) -> None:
    forecast = forecast_suspension(
        _design(table, "k_yaw_m"),
        _design(table, "k_pitch_m"),
        _design(table, "depth_m"),
        stated_value(plan, "half_spacing_m"),
        stated_value(plan, "line_m"),
        gravity_of(table),
        period_scatter_relative=plan.period_scatter_relative,
    )
    scatter = plan.period_scatter_relative
    for name, words, period in (
        ("sway", "sway", forecast.sway_s),
        ("yaw", "yaw", forecast.yaw_s),
        ("pitch_slow", "slow pitch mode", forecast.slow_s),
        ("pitch_fast", "fast pitch mode", forecast.fast_s),
    ):
        estimate = Estimate.of(period, scatter * period, "s")
        findings.append(Finding(f"bifilar_{name}_period_s", f"bifilar: {words}, period", estimate))
    findings += [
        Finding("bifilar_k_yaw_m", "bifilar: yaw gyradius", forecast.yaw_gyradius),
        Finding("bifilar_k_pitch_m", "bifilar: pitch gyradius", forecast.pitch_gyradius),
    ]
    by_reading = {
        "fixed": "best line for pitch, depth known (fig 17)",
        "joint": "best line for pitch, depth measured along",
    }
    findings += [
        Finding(f"bifilar_best_line_{reading}_m", by_reading[reading], exactly(length, "m"))
        for reading, length in forecast.best_line_m.items()
    ]
    flags += forecast.flags
    notes += [
        f"points {pair}: {', '.join(result for result in gives if result)}"
        for pair, gives in SUSPENSION_OPTIONS.items()
    ]


def _plan_swing(
    table: PlanJob,
    plan: PlannedSwing,
    findings: list[Finding],
    flags: list[Flag],
    notes: list[str],
) -> None:
    mass, cg = stated_value(plan, "mass_kg"), stated_value(plan, "cg_below_pivot_m")
    moment = derived("S", lambda cg, mass: cg * mass, "kg m", cg=cg, mass=mass)
    state = SwingState(stated_value(plan, "period_s"), mass, moment, gravity_of(table))
    forecast = forecast_swing(
        state,
        stated_value(table.expected, "mass_kg"),
        plan.model_cg_below_pivot_m,
        _design(table, f"k_{plan.axis}_m"),
        period_scatter_relative=plan.period_scatter_relative,
        moment_relative=plan.moment_relative,
    )
    period = Estimate.of(forecast.period_s, plan.period_scatter_relative * forecast.period_s, "s")
    findings += [
        Finding("swing_period_s", "swing: period with model", period),
        Finding(f"swing_k_{plan.axis}_m", f"swing: {plan.axis} gyradius", forecast.gyradius),
        Finding("swing_share", "swing: model's part of the total", exactly(forecast.share)),
    ]
    notes.append(f"swing: {'worth' if forecast.worth_swinging else 'not worth'} swinging")
    flags += forecast.flags


def _line_errors(table: PlanJob) -> dict[str, list[tuple[float, float]]]:
    """Return the error of the pitch gyradius per error of the periods over the lines' length."""
    gyradius, depth = _design(table, "k_pitch_m"), _design(table, "depth_m")
    gravity = gravity_of(table).value
    lines = np.geomspace(0.1 * depth, 20.0 * depth, 161).tolist()
    return {
        str(reading): [
            (line, gyradius_error_per_period(gyradius, depth, line, gravity, reading))
            for line in lines
        ]
        for reading in LineLengthReading
    }
