"""A body below the surface: whether it keeps depth, up to which speed, and its planes' reversal."""

import math
from dataclasses import dataclass

import numpy as np

from analysis.manoeuvring.depth import SubmergedBody
from hardware.description.oscillator import Plane
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.manoeuvre.derivatives import derivatives_of
from pmm.manoeuvre.plausibility import doubts_of_body
from pmm.manoeuvre.quantity import FullScale, ManoeuvreQuantity, quantity_of
from pmm.manoeuvre.ship_file import SubmergedFile


@dataclass(frozen=True)
class DepthKeeping:
    """What was found of a body, with an interval each.

    Attributes
    ----------
    stable_m_s
        Speeds between which it is stable; NaN where it is at none.
    """

    file: SubmergedFile
    level: float
    draws: int
    quantities: tuple[ManoeuvreQuantity, ...]
    doubts: tuple[str, ...]
    stable_m_s: tuple[float, float]


def depth_keeping(file: SubmergedFile, trials: int, seed: int, level: float) -> DepthKeeping:
    """Return the stability of a body, and of as many draws of its derivatives.

    It raises what :func:`pmm.manoeuvre.derivatives.derivatives_of` raises, and
    ``ConfigurationError`` if a derivative is missing.
    """
    body = body_of(file, trials, seed)
    speed, root = file.speed_m_s, math.sqrt(file.scale)
    knots = FullScale(root, "m/s")
    time = body.length_m / speed
    quantities = [
        quantity_of("depth", "index G_v", "1", body.index, level),
        quantity_of("depth", "critical speed", "m/s", body.critical_speed_m_s, level, knots),
        quantity_of("depth", "largest root L/U", "1", body.root(speed) * time, level),
    ]
    for name, plane in file.planes.items():
        speeds = body.reversal_speed_m_s(plane.force, plane.moment)
        quantities.append(
            quantity_of(f"planes {name}", "reversal speed", "m/s", speeds, level, knots)
        )
    low, high = (float(speeds[0]) for speeds in body.stable_speeds_m_s)
    doubts = doubts_of_body(file, body)
    return DepthKeeping(file, level, trials, tuple(quantities), doubts, (low, high))


def body_of(file: SubmergedFile, trials: int, seed: int) -> SubmergedBody:
    """Return the body of a file's values, and behind it those of the draws."""
    particulars = file.body
    values = derivatives_of(file, Plane.VERTICAL, trials, np.random.default_rng(seed))
    righting = particulars.mass_kg * STANDARD_GRAVITY_M_S2 * particulars.centre_distance_m
    mass = (particulars.mass_kg, particulars.inertia_kg_m2, particulars.cg_x_m)
    return SubmergedBody(particulars.length_m, file.water.density_kg_m3, *mass, righting, values)
