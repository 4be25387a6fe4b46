"""At which Froude and Reynolds numbers was measured: of each carriage speed, or in each row."""

from collections.abc import Callable, Iterable, Iterator
from typing import Final, TypeVar

from analysis.water import Water, froude_number, reynolds_number
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.campaign.water import TankWater
from pmm.coefficients.settings import ShipTable
from pmm.document.content import Column, Table
from pmm.document.notation import written

Row = TypeVar("Row")
NOTE: Final = "Fn = U / sqrt(g L), Re = U L / nu, F_nh = U / sqrt(g h)."


def conditions_table(
    speeds_m_s: Iterable[float], ship: ShipTable, water: Water | None
) -> Table[float]:
    """Return the numbers at every speed but 0, with the water that they hold for.

    There are no rows where neither the model's length nor the water's depth is known.
    """
    has_scale = ship.length_m is not None or _depth_m(water) is not None
    rows = sorted(set(speeds_m_s) - {0.0}) if has_scale else []
    columns: tuple[Column[float], ...] = (
        Column("U", _itself, "speed_m_s", written("g"), "m/s", number=True),
        *condition_columns(_itself, ship.length_m, water, ship.gravity_m_s2),
    )
    notes = (NOTE, _water_text(water, ship))
    return Table("Conditions", columns, rows, "conditions", titled=True, notes=notes, filled=True)


def condition_columns(
    speed_m_s: Callable[[Row], float],
    length_m: float | None,
    water: Water | None,
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2,
) -> Iterator[Column[Row]]:
    """Yield Fn, Re and F_nh of a row with a speed; of a filled table those that are known.

    Programs get ``None`` where length, water or depth are not known.
    """

    def froude(over_m: float | None) -> Callable[[Row], float | None]:
        if over_m is None:
            return lambda _: None
        return lambda row: froude_number(speed_m_s(row), over_m, gravity_m_s2)

    def reynolds(row: Row) -> float | None:
        if length_m is None or water is None:
            return None
        return reynolds_number(speed_m_s(row), length_m, water)

    yield Column("Fn", froude(length_m), "froude_number", _formatter(".4f"), number=True)
    yield Column("Re", reynolds, "reynolds_number", _formatter(".4g"), number=True)
    yield Column(
        "F_nh", froude(_depth_m(water)), "depth_froude_number", _formatter(".3f"), number=True
    )


def _itself(speed_m_s: float) -> float:
    return speed_m_s


def _formatter(form: str) -> Callable[[float | None], str]:
    return lambda value: "" if value is None else written(form)(value)


def _depth_m(water: Water | None) -> float | None:
    return water.depth_m if isinstance(water, TankWater) else None


def _water_text(water: Water | None, ship: ShipTable) -> str:
    if water is None:
        return "Re needs [water] in the campaign file, Fn length_m in coefficients.toml."
    kind = f"salt water of {water.salinity_g_kg:g} g/kg" if water.salinity_g_kg else "fresh water"
    return (
        f"{kind.capitalize()} at {water.temperature_deg_c:.4g} °C: nu = "
        f"{water.kinematic_viscosity_m2_s:.4e} m²/s, rho = {water.density_kg_m3:.2f} kg/m³"
        + (
            ""
            if ship.density == water.density_kg_m3
            else f"; rho = {ship.density:.2f} kg/m³ is stated and was taken"
        )
        + "."
    )
