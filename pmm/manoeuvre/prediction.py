"""All manoeuvres of a ship, each quantity with its interval and what IMO asks of it."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.manoeuvring import imo
from analysis.manoeuvring.hull import HullLoads
from analysis.manoeuvring.manoeuvres import (
    Spiral,
    TurningCircle,
    ZigZag,
    scale_s,
    spiral,
    turning_circle,
    zigzag,
)
from analysis.manoeuvring.march import Log
from analysis.manoeuvring.ship import Ship
from analysis.manoeuvring.stability import CourseStability, straight_course
from hardware.description.arrays import FloatArray
from hardware.description.oscillator import Plane
from pmm.manoeuvre.derivatives import derivatives_of
from pmm.manoeuvre.plausibility import doubts_of_ship, doubts_of_turns
from pmm.manoeuvre.quantity import FullScale, ManoeuvreQuantity, quantity_of
from pmm.manoeuvre.ship_file import ShipFile

SIDES = {"starboard": 1.0, "port": -1.0}
_HELM, _SPIRAL_LARGEST, _SPIRAL_STEP = (math.radians(angle_deg) for angle_deg in (35.0, 20.0, 5.0))
_SPIRAL_SHIPS = 101
LOOP = "r' loop at rudder 0"

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Prediction:
    """A ship's manoeuvres; index 0 of every array is that of the values themselves."""

    file: ShipFile
    ship: Ship
    level: float
    turns: dict[str, TurningCircle]
    zigzags: dict[tuple[str, int], ZigZag]
    spiral: Spiral
    straight: CourseStability
    logs: dict[str, Log]

    @cached_property
    def length_over_speed_s(self) -> float:
        """L/U of the approach at full scale, s."""
        return scale_s(self.ship) * math.sqrt(self.file.scale)

    @property
    def doubts(self) -> tuple[str, ...]:
        """A sentence on each number of the file, and of its turns, that is not believed."""
        return (*doubts_of_ship(self.file, self.ship), *doubts_of_turns(self.turns))

    @cached_property
    def quantities(self) -> tuple[ManoeuvreQuantity, ...]:
        """All quantities, in the order of the page."""
        return tuple(self._quantities())

    def _quantities(self) -> Iterator[ManoeuvreQuantity]:
        for side, turn in self.turns.items():
            manoeuvre = f"turning circle 35°, {side}"
            yield self._of(manoeuvre, "advance", "L", turn.advance, imo.ADVANCE)
            yield self._of(manoeuvre, "transfer", "L", turn.transfer)
            yield self._of(
                manoeuvre, "tactical diameter", "L", turn.tactical_diameter, imo.TACTICAL
            )
            yield self._of(manoeuvre, "steady diameter", "L", turn.steady_diameter)
            yield self._of(manoeuvre, "steady speed / approach", "1", turn.steady_speed)
            yield self._of(manoeuvre, "steady drift", "°", np.degrees(turn.steady_drift_rad))
        first = imo.first_overshoot_deg(self.length_over_speed_s)
        limits = {
            (10, 0): first,
            (10, 1): imo.second_overshoot_deg(self.length_over_speed_s),
            (20, 0): imo.OVERSHOOT_20,
        }
        for (side, angle), test in self.zigzags.items():
            manoeuvre = f"zig-zag {angle}/{angle}, {side}"
            if angle == 10:
                yield self._of(manoeuvre, "initial turning", "L", test.initial_turning, imo.INITIAL)
            for k, values in enumerate(test.overshoots_rad):
                name = f"overshoot {k + 1}"
                limit = limits.get((angle, k), math.nan)
                yield self._of(manoeuvre, name, "°", np.degrees(values), limit)
        straight = self.straight
        yield self._of("spiral", LOOP, "1", self.spiral.height)
        yield self._of("straight course", "C' of the bare hull", "1", straight.criterion)
        yield self._of("straight course", "C' with rudder", "1", straight.with_rudder)
        yield self._of("straight course", "largest root L/U", "1", straight.root)

    def _of(
        self, manoeuvre: str, name: str, unit: str, values: FloatArray, limit: float = math.nan
    ) -> ManoeuvreQuantity:
        size = FullScale(self.ship.hull.length_m * self.file.scale, "m") if unit == "L" else None
        return quantity_of(manoeuvre, name, unit, values, self.level, size, limit)


def predict(file: ShipFile, trials: int, seed: int, level: float, progress: Progress) -> Prediction:
    """Return all manoeuvres of a ship and of as many draws of its derivatives.

    It raises what :func:`ship_of` raises, and ``ConfigurationError`` if no revolutions keep the
    approach speed.
    """
    ship = ship_of(file, trials, seed)
    logs, turns, zigzags = {}, {}, {}
    for side, sign in SIDES.items():
        progress(f"turning circle to {side}")
        logs[side] = Log()
        turns[side] = turning_circle(ship, sign * _HELM, logs[side])
    for angle in (10, 20):
        for side, sign in SIDES.items():
            progress(f"zig-zag {angle}/{angle} to {side}")
            size = math.radians(angle)
            log = logs.setdefault(f"{angle}", Log()) if side == "starboard" else None
            zigzags[side, angle] = zigzag(ship, sign * size, size, 2, log)
    progress("spiral")
    spiral_ship = replace(ship, hull=_first_draws(ship.hull, _SPIRAL_SHIPS))
    spiral_curve = spiral(spiral_ship, _SPIRAL_LARGEST, _SPIRAL_STEP)
    straight = straight_course(ship)
    return Prediction(file, ship, level, turns, zigzags, spiral_curve, straight, logs)


def ship_of(file: ShipFile, trials: int, seed: int) -> Ship:
    """Return the ship of a file's values, and behind it those of the draws.

    It raises what :func:`pmm.manoeuvre.derivatives.derivatives_of` raises, and
    ``ConfigurationError`` if a derivative is missing.
    """
    body, generator = file.ship, np.random.default_rng(seed)
    values = derivatives_of(file, Plane.HORIZONTAL, trials, generator)
    area = body.length_m * (body.draught_m if file.hull.system == "mmg" else body.length_m)
    hull = HullLoads(body.length_m, area, file.water.density_kg_m3, values)
    mass = (body.mass_kg, body.inertia_kg_m2, body.cg_x_m)
    helm = math.nan if file.rudder_rate_deg_s is None else file.rudder_rate_deg_s
    return Ship(hull, file.propeller, file.rudder, *mass, file.speed_m_s, helm)


def _first_draws(hull: HullLoads, count: int) -> HullLoads:
    return replace(hull, values={name: value[:count] for name, value in hull.values.items()})
