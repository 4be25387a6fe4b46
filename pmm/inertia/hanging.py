"""``[hanging]``: the centre of gravity from plumb lines, by points on the body or by angles."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from analysis.inertia.elementary_functions import Value, arctan, cos, sin
from analysis.inertia.hanging import HangingCentre, PlumbLine, centre_of_lines
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate
from pmm.inertia.reading import one_of, require_together
from pmm.inertia.stated_values import stated_value


@dataclass(frozen=True)
class HangingLine:
    """One plumb line, by one of three ways; x is forward, z down from the common datum.

    Attributes
    ----------
    x_m, z_m, to_x_m, to_z_m
        Two points of the line, as marked on the body.
    angle_deg, angle_rad
        In place of the second point: of the line, from body z (down) towards body x.
    distance_m
        In place of both points: distance of the line from the datum, forward of it positive where
        the line is upright (``x cos a - z sin a``).
    """

    name: str = ""
    x_m: float = 0.0
    u_x_m: float = 0.0
    z_m: float = 0.0
    u_z_m: float = 0.0
    to_x_m: float | None = None
    u_to_x_m: float = 0.0
    to_z_m: float | None = None
    u_to_z_m: float = 0.0
    angle_deg: float | None = None
    u_angle_deg: float = 0.0
    angle_rad: float | None = None
    u_angle_rad: float = 0.0
    distance_m: float | None = None
    u_distance_m: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Two points, or an angle with a point or a distance."""
        yield from one_of(table, "to_x_m", "angle_deg", "angle_rad")
        yield from require_together(table, "to_x_m", "to_z_m")
        for key in ("x_m", "z_m", "to_x_m"):
            yield from one_of(table, "distance_m", key, needed=False)
        if not {"x_m", "z_m", "distance_m"} & set(table):
            yield "", "needs x_m and z_m of a point, or distance_m"
        first, second = ([table.get(f"{to}{axis}_m", 0.0) for axis in "xz"] for to in ("", "to_"))
        if "to_x_m" in table and first == second:
            yield "to_x_m", "and to_z_m are x_m and z_m again; two points make a line"

    def line(self, place: str, common_angle_rad: float) -> PlumbLine:
        """Return it in SI units.

        Parameters
        ----------
        place
            Of its table, which names it where it has no name.
        common_angle_rad
            Standard uncertainty that all angles share.
        """
        name = self.name or f"line {place}"
        if self.to_x_m is not None:
            x, z, to_x, to_z = (
                stated_value(self, key) for key in ("x_m", "z_m", "to_x_m", "to_z_m")
            )
            return PlumbLine(name, x, z, _direction(x, z, to_x, to_z))
        stated_angle = stated_value(
            self, "angle_deg" if self.angle_deg is not None else "angle_rad"
        )
        angle = stated_angle.widened(common_angle_rad, label="hanging.common_angle")
        if self.distance_m is None:
            return PlumbLine(name, stated_value(self, "x_m"), stated_value(self, "z_m"), angle)
        inputs = {"distance": stated_value(self, "distance_m"), "angle": angle}
        return PlumbLine(
            name,
            derived("x", lambda distance, angle: distance * cos(angle), "m", **inputs),
            derived("z", lambda distance, angle: -distance * sin(angle), "m", **inputs),
            angle,
        )


def _direction(x: Estimate, z: Estimate, to_x: Estimate, to_z: Estimate) -> Estimate:
    """Return the angle of a line through two points; which of them is above is of no matter."""
    flat = abs(to_x.value - x.value) > abs(to_z.value - z.value)

    def angle(x: Value, z: Value, to_x: Value, to_z: Value) -> Value:
        if flat:
            return 0.5 * math.pi - arctan((to_z - z) / (to_x - x))
        return arctan((to_x - x) / (to_z - z))

    return derived("angle", angle, "rad", x=x, z=z, to_x=to_x, to_z=to_z)


@dataclass(frozen=True)
class HangingTable:
    """Plumb lines of the body hung from one point after the other.

    Attributes
    ----------
    u_common_angle_deg, u_common_angle_rad
        Standard uncertainty that all angles share: that of the level they are measured from.
    """

    lines: tuple[HangingLine, ...]
    u_common_angle_deg: float = 0.0
    u_common_angle_rad: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refuse fewer than two lines, and one angle in two units."""
        yield from one_of(table, "u_common_angle_deg", "u_common_angle_rad", needed=False)
        lines = table.get("lines")
        if isinstance(lines, list) and len(lines) < 2:
            yield "lines", f"are {len(lines)}; where they cross takes two or more"

    def centre(self, title: str = "plumb lines") -> HangingCentre:
        """Return where the lines cross.

        Raises
        ------
        DataError
            If they are nearly parallel.
        """
        common = self.u_common_angle_rad + math.radians(self.u_common_angle_deg)
        lines = [line.line(str(k), common) for k, line in enumerate(self.lines, 1)]
        return centre_of_lines(lines, subject=title)


def hanging_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield what is given beside ``[hanging]`` that follows from it."""
    model = table.get("model")
    if "hanging" not in table or not isinstance(model, dict):
        return
    for key in ("cg_x_m", "cg_z_m"):
        if key in model:
            yield f"model.{key}", "and hanging are both given; one is enough"
