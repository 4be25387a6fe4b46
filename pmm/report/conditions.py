"""At which Froude and Reynolds numbers a campaign was measured: a row for each carriage speed."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

from analysis.water import Water, froude_number, reynolds_number
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Table, number
from pmm.document.notation import NOT_KNOWN, written


@dataclass(frozen=True)
class ConditionRow:
    """The numbers of one speed; ``None`` where length, water or depth are not known."""

    speed_m_s: float
    froude_number: float | None
    reynolds_number: float | None
    depth_froude_number: float | None


def _known(form: str) -> Callable[[float | None], str]:
    return lambda value: NOT_KNOWN if value is None else written(form)(value)


_COLUMNS: Final[tuple[Column[ConditionRow], ...]] = (
    number("U", "speed_m_s", written("g"), "m/s"),
    number("Fn", "froude_number", _known(".4f")),
    number("Re", "reynolds_number", _known(".4g")),
    number("F_nh", "depth_froude_number", _known(".3f")),
)
_NOTE: Final = "Fn = U / sqrt(g L), Re = U L / nu, F_nh = U / sqrt(g h)."


def conditions_table(outcome: CampaignOutcome) -> Table[ConditionRow]:
    """Return the numbers at every speed of the campaign, with the water that they hold for.

    There are no rows where neither the model's length nor the water's depth is known.
    """
    rows = tuple(_rows(outcome))
    notes = (_NOTE, _water_text(outcome.water, outcome.settings.ship.density))
    return Table("Conditions", _COLUMNS, rows, "conditions", titled=True, notes=notes)


def _rows(outcome: CampaignOutcome) -> Iterator[ConditionRow]:
    ship, water = outcome.settings.ship, outcome.water
    length, depth = ship.length_m, None if water is None else water.depth_m
    if length is None and depth is None:
        return
    for speed in sorted({one.speed_m_s for one in outcome.result.entries} - {0.0}):
        yield ConditionRow(
            speed,
            None if length is None else froude_number(speed, length, ship.gravity_m_s2),
            None if length is None or water is None else reynolds_number(speed, length, water),
            None if depth is None else froude_number(speed, depth, ship.gravity_m_s2),
        )


def _water_text(water: Water | None, density_kg_m3: float) -> str:
    if water is None:
        return "Re needs [water] in the campaign file, Fn length_m in coefficients.toml."
    kind = f"salt water of {water.salinity_g_kg:g} g/kg" if water.salinity_g_kg else "fresh water"
    return (
        f"{kind.capitalize()} at {water.temperature_deg_c:.4g} °C: nu = "
        f"{water.kinematic_viscosity_m2_s:.4e} m²/s, rho = {water.density_kg_m3:.2f} kg/m³"
        + (
            ""
            if density_kg_m3 == water.density_kg_m3
            else f"; rho = {density_kg_m3:.2f} kg/m³ is stated and was taken"
        )
        + "."
    )
