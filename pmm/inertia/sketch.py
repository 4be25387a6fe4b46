"""The set-up of a test as its file's geometry says: what is drawn, in metres from its upper middle.

x to the right, y up; the ceiling, or the first axis, is at y = 0.
"""

from collections.abc import Mapping
from dataclasses import dataclass

Point = tuple[float, float]


@dataclass(frozen=True)
class Dimension:
    """A measure between two points, with its letter and value."""

    start: Point
    end: Point
    text: str


@dataclass(frozen=True)
class Sketch:
    """One set-up.

    Attributes
    ----------
    lines, bodies
        Strings or arms, and what is rigid and swings, each from point to point.
    axes, centres
        Where it is hung, and centres of gravity, by their names.
    """

    title: str
    lines: tuple[tuple[Point, Point], ...]
    bodies: tuple[tuple[Point, Point], ...]
    axes: Mapping[str, Point]
    centres: Mapping[str, Point]
    dimensions: tuple[Dimension, ...]


def on_two_lines(
    title: str, half_spacing_m: float, line_m: float, depth_m: float | None = None
) -> Sketch:
    """Return a body on two lines.

    Parameters
    ----------
    depth_m
        Of its centre of gravity below the lines' lower ends, where it is known.
    """
    left, right = (-half_spacing_m, 0.0), (half_spacing_m, 0.0)
    lower = (-half_spacing_m, -line_m), (half_spacing_m, -line_m)
    measures = [
        Dimension(left, right, f"2 d = {2.0 * half_spacing_m:.4g} m"),
        Dimension(right, lower[1], f"l = {line_m:.4g} m"),
    ]
    centre = (0.0, -line_m - (depth_m or 0.0))
    if depth_m is not None:
        measures.append(Dimension((0.0, -line_m), centre, f"{1e3 * depth_m:.4g} mm"))
    return Sketch(
        title,
        ((left, lower[0]), (right, lower[1])),
        (lower,),
        {"": left, " ": right},
        {} if depth_m is None else {"CG": centre},
        tuple(measures),
    )


def about_axis(
    title: str,
    depths_m: Mapping[str, float],
    arms_m: Mapping[str, tuple[float, float]],
    second_m: float | None = None,
) -> Sketch:
    """Return a body that swings about an axis.

    Parameters
    ----------
    depths_m
        Of centres of gravity below the axis, by what is on it.
    arms_m
        Of weights that tilt it, sideways and below the axis, by name.
    second_m
        Height of a second axis over the first.
    """
    pivot, axes = (0.0, 0.0), {"axis": (0.0, 0.0)}
    ends = [0.0, *(-depth for depth in depths_m.values())]
    measures = [
        Dimension(pivot, (0.0, -depth), f"{name}: {1e3 * depth:.4g} mm")
        for name, depth in depths_m.items()
    ]
    measures += [
        Dimension((0.0, -drop), (arm, -drop), f"{name}: {arm:.4g} m")
        for name, (arm, drop) in arms_m.items()
    ]
    if second_m is not None:
        axes["second axis"] = (0.0, second_m)
        ends.append(second_m)
        measures.append(Dimension(pivot, (0.0, second_m), f"{second_m:.4g} m"))
    return Sketch(
        title,
        tuple(((0.0, -drop), (arm, -drop)) for arm, drop in arms_m.values()),
        (((0.0, min(ends)), (0.0, max(ends))),),
        axes,
        {f"CG, {name}": (0.0, -depth) for name, depth in depths_m.items()},
        tuple(measures),
    )
