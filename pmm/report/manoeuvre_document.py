"""What ``pmm manoeuvre`` shows: quantities with intervals and criteria, and pictures."""

import math
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Final

from hardware.description.errors import PmmError
from pmm.coefficients.settings import ShipTable
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Figure,
    Note,
    Notes,
    Section,
    Table,
    Text,
    word,
)
from pmm.document.notation import NOT_KNOWN, between, counted, written
from pmm.manoeuvre.defaults import DRAWS, SHIP_FILE
from pmm.manoeuvre.prediction import LOOP, Prediction, predict
from pmm.manoeuvre.quantity import ManoeuvreQuantity
from pmm.manoeuvre.ship_file import SubmergedFile, read_ship
from pmm.manoeuvre.submerged import DepthKeeping, depth_keeping
from pmm.report.conditions import conditions_table
from pmm.report.manoeuvre_figures import spiral_figure, turning_figure, zigzag_figure

SCHEMA: Final = "pmm-manoeuvre-1"
_CAPTIONS: Final = {
    "turning": "Turning circles with 35 degrees of rudder, in ship's lengths from where the rudder "
    "was laid; thin lines are draws of the derivatives.",
    "zigzag": "Heading (and rudder, dashed) of the zig-zags over time; thin lines are draws.",
    "spiral": "Rate of turn over rudder angle, the rudder going to port and coming back, each "
    "angle held until r' changes by less than 1e-6 in L/U; what does not in 600 L/U is not drawn.",
}
_UNSTEADY: Final = (
    "The spiral's turn is not steady after 600 L/U with the rudder amidships: the ship is close to "
    "neutral stability, and no loop is told."
)
_SURE: Final = 0.975


def manoeuvre_document(prediction: Prediction) -> Document:
    """Return what was predicted; ``docs/manoeuvre.md`` has the keys."""
    return Document(
        prediction.file.name,
        "manoeuvres",
        (
            Section("", _contents(prediction)),
            Section("Figures", tuple(figures(prediction))),
            Section("", (Data("rate_hz", float(prediction.ship.rate_hz[0])),)),
        ),
        SCHEMA,
    )


def manoeuvre_story(folder: Path, level: float) -> Iterator[Section]:
    """Yield a report's section on the ship of a campaign that has ``ship.toml`` in its folder."""
    path = folder / SHIP_FILE
    if not path.exists():
        return
    try:
        file = read_ship(path)
        if isinstance(file, SubmergedFile):
            yield Section("Depth keeping", _depth(depth_keeping(file, DRAWS, 0, level)))
            return
        prediction = predict(file, DRAWS, 0, level, lambda _: None)
    except PmmError as error:
        yield Section("Manoeuvres", (Notes([Note("warning", str(error))]),))
        return
    yield Section("Manoeuvres", (*_contents(prediction), *figures(prediction)))


def _contents(prediction: Prediction) -> tuple[Content, ...]:
    head = Text(tuple(_head(prediction)))
    return head, _doubts(prediction), _table(prediction), _criteria(prediction), _at(prediction)


def figures(prediction: Prediction) -> Iterator[Figure]:
    """Yield every figure."""
    draws: dict[str, Callable[[Prediction], object]] = {
        "turning": turning_figure,
        "zigzag": zigzag_figure,
        "spiral": spiral_figure,
    }
    for name, draw in draws.items():
        yield Figure(name, _CAPTIONS[name], partial(draw, prediction))  # type: ignore[arg-type]


def _head(prediction: Prediction) -> Iterator[str]:
    file, draws = prediction.file, prediction.ship.count - 1
    whose = "its" if file.scale == 1.0 else "the model's"
    yield (
        f"approach at {file.speed_m_s:g} m/s, propeller held at "
        f"{float(prediction.ship.rate_hz[0]):.4g} 1/s, which keeps that speed with this "
        f"resistance: {whose} own point of self-propulsion"
    )
    if file.scale != 1.0:
        yield (
            f"full scale by Froude's law, {file.scale:g} times as long: the friction of the model "
            "and the load of its propeller are those of the model, a ship's rudder has less race"
        )
    yield f"intervals from {counted(draws, 'draw')} of the derivatives; propeller and rudder stated"


def _value(quantity: ManoeuvreQuantity) -> str:
    return f"{quantity.value:.4g}"


def _interval(quantity: ManoeuvreQuantity) -> str:
    return between(quantity.low, quantity.high)


def _full(quantity: ManoeuvreQuantity) -> str:
    shown = math.isfinite(quantity.full_scale)
    return f"{quantity.full_scale:.4g} {quantity.full_scale_unit}" if shown else ""


def depth_document(keeping: DepthKeeping) -> Document:
    """Return what was found of a body below the surface."""
    return Document(keeping.file.name, "depth keeping", (Section("", _depth(keeping)),), SCHEMA)


def _depth(keeping: DepthKeeping) -> tuple[Content, ...]:
    file = keeping.file
    head = (
        f"roots at {file.speed_m_s:g} m/s; weight and buoyancy are taken as equal",
        f"intervals from {counted(keeping.draws, 'draw')} of the derivatives",
    )
    return (
        Text(head),
        _doubts(keeping),
        _table(keeping),
        Text((_stability_sentence(keeping),)),
        _at(keeping),
    )


def _doubts(result: Prediction | DepthKeeping) -> Notes:
    return Notes([Note("doubt", doubt) for doubt in result.doubts], "doubts")


def _at(result: Prediction | DepthKeeping) -> Table[float]:
    """Return the numbers of the approach, of what the file describes."""
    file = result.file
    length_m = file.body.length_m if isinstance(file, SubmergedFile) else file.ship.length_m
    ship = ShipTable(length_m).within(file.water)
    return conditions_table([file.speed_m_s], ship, file.water)


def _stability_sentence(keeping: DepthKeeping) -> str:
    low, high = keeping.stable_m_s
    if math.isnan(low):
        return "stable at no speed"
    if math.isfinite(high):
        return f"stable below {high:.4g} m/s, where its weight rights it; not above"
    return f"stable above {low:.4g} m/s alone" if low > 0.0 else "stable at every speed"


def _table(result: Prediction | DepthKeeping) -> Table[ManoeuvreQuantity]:
    columns: tuple[Column[ManoeuvreQuantity], ...] = (
        Column("manoeuvre", lambda quantity: quantity.manoeuvre, "manoeuvre", once=True),
        word("quantity", "name"),
        word("unit", "unit"),
        Column(
            "value", lambda quantity: quantity.value, "value", written=written(".4g"), number=True
        ),
        Column(f"{100.0 * result.level:g} % interval", _interval, number=True),
        Column("at full scale", _full, number=True),
        *(
            Column[ManoeuvreQuantity](None, partial(_key, key), key)
            for key in ("low", "high", "full_scale", "full_scale_unit", "limit", "within", "failed")
        ),
    )
    failed = max(quantity.failed for quantity in result.quantities)
    loop = next((quantity for quantity in result.quantities if quantity.name == LOOP), None)
    unsteady = loop is not None and not math.isfinite(loop.value)
    note = f"Up to {failed} draws are in no interval: they came to no end, or have no such speed."
    notes = (*((note,) if failed else ()), *((_UNSTEADY,) if unsteady else ()))
    name = "Manoeuvres"
    return Table(name, columns, result.quantities, "quantities", titled=True, notes=notes)


def _key(key: str, quantity: ManoeuvreQuantity) -> object:
    return getattr(quantity, key)


def _criteria(prediction: Prediction) -> Table[ManoeuvreQuantity]:
    columns: tuple[Column[ManoeuvreQuantity], ...] = (
        Column("criterion", lambda quantity: f"{quantity.name}, {quantity.manoeuvre}"),
        word("unit", "unit"),
        Column("value", _value, number=True),
        Column("limit", lambda quantity: f"{quantity.limit:.4g}", number=True),
        Column("", _verdict),
        Column("draws within", lambda quantity: quantity.within, written=_share, number=True),
    )
    rows = [quantity for quantity in prediction.quantities if math.isfinite(quantity.limit)]
    notes = (
        f"L/V = {prediction.length_over_speed_s:.3g} s at full scale sets the limits of the 10/10 "
        "zig-zag.",
    )
    name = "IMO MSC.137(76)"
    return Table(name, columns, rows, titled=True, notes=notes)


def _share(share: float) -> str:
    return f"{100.0 * share:.1f} %" if math.isfinite(share) else NOT_KNOWN


def _verdict(quantity: ManoeuvreQuantity) -> str:
    if not math.isfinite(quantity.value):
        return "NOT REACHED"
    sure = (
        not math.isfinite(quantity.within)
        or quantity.within >= _SURE
        or quantity.within <= 1.0 - _SURE
    )
    verdict = "within" if quantity.value <= quantity.limit else "BEYOND"
    return verdict if sure else f"{verdict}, not sure"
