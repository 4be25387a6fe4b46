"""The mass of the lines that a body hangs from: what it does to gyradii, and taking that off."""

from collections.abc import Iterator, Mapping
from typing import Any

from analysis.inertia.bifilar import sway_period
from analysis.inertia.corrections import lines_factor, pitch_without_lines, yaw_without_lines
from analysis.inertia.double_pendulum import PendulumResult
from analysis.inertia.elementary_functions import Value, sqrt
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.monte_carlo import Assessment, assess
from pmm.inertia.stated_values import stated_value

# Lines over body: up to it rods stand for strings to 4.3e-4 of the gyradius; at twice, 1.4e-3.
_MOST = 0.1


def line_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield what is missing or too much beside ``line_mass_kg``."""
    rows = table.get("suspensions")
    model = table.get("model")
    body = model.get("mass_kg") if isinstance(model, Mapping) else None
    for number, row in enumerate(rows if isinstance(rows, list) else [], 1):
        lines = row.get("line_mass_kg") if isinstance(row, Mapping) else None
        if not isinstance(lines, int | float) or not lines:
            continue
        where = f"suspensions[{number}].line_mass_kg"
        if lines < 0.0:
            yield where, f"= {lines} is below zero"
        elif not isinstance(body, int | float):
            yield "model", "needs mass_kg, of all that hung, beside line_mass_kg"
        elif lines > _MOST * body:
            yield (
                where,
                (
                    f"= {lines} is over {_MOST:g} of mass_kg = {body}: such lines bend as they "
                    "swing; use lighter ones"
                ),
            )


def line_share(table: Any, mass: Estimate) -> Estimate | None:
    """Return the lines' mass over that of what hangs from them; ``None`` for light lines.

    Parameters
    ----------
    table
        The suspension's.
    """
    if not table.line_mass_kg:
        return None
    lines = stated_value(table, "line_mass_kg", table.name)
    return derived("share", lambda lines, mass: lines / mass, lines=lines, mass=mass)


def yaw_off_lines(
    table: Any,
    share: Estimate | None,
    assessment: Assessment,
    *,
    by_sway: bool = False,
    seed: int = 0,
) -> Assessment:
    """Take the lines off a yaw gyradius; it stays where they are light."""
    if share is None:
        return assessment
    spacing = table.half_spacing_m

    def gyradius(gyradius_on_lines_m: Value, line_share: Value) -> Value:
        gyradius_m: Value = yaw_without_lines(
            gyradius_on_lines_m, line_share, spacing, by_sway=by_sway
        )
        return gyradius_m

    inputs = {"gyradius_on_lines_m": assessment.budget.result, "line_share": share}
    return assess(assessment.budget.name, gyradius, inputs, unit="m", seed=seed)


def pitch_off_lines(
    share: Estimate | None, result: PendulumResult, *, seed: int = 0
) -> PendulumResult:
    """Take the lines off a pitch (or roll) gyradius and a depth."""
    if share is None:
        return result
    inputs = {
        "gyradius_on_lines_m": result.gyradius.budget.result,
        "depth_on_lines_m": result.depth.budget.result,
        "line_share": share,
    }
    made = (
        assess(name, _part(part), inputs, unit="m", seed=seed + part)
        for part, name in enumerate((result.gyradius.budget.name, result.depth.budget.name))
    )
    return PendulumResult(*made)


def _part(part: int) -> Any:
    def value(gyradius_on_lines_m: Value, depth_on_lines_m: Value, line_share: Value) -> Value:
        return pitch_without_lines(gyradius_on_lines_m, depth_on_lines_m, line_share)[part]

    return value


def period_of_lines(line: Estimate, gravity: Estimate, share: Estimate | None) -> Estimate:
    """Return the lines' own period, with their mass."""
    inputs = {"line_m": line, "gravity_m_s2": gravity}
    if share is not None:
        inputs["line_share"] = share

    def period(line_m: Value, gravity_m_s2: Value, line_share: Any = 0.0) -> Any:
        return sway_period(line_m, gravity_m_s2) * sqrt(lines_factor(line_share))

    return derived("sway period", period, "s", **inputs)
