"""Oracles: areas and moments by hand, and the weight of the water that a moved box displaces."""

import math

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from sim.model.water.hydrostatics import Waterplane, restoring

RHO, G = 1000.0, 9.81


@pytest.mark.parametrize(
    ("exact", "breadth"),
    [
        (Waterplane.box(3.0, 0.4), lambda x: 0.4 + 0.0 * x),
        (Waterplane.ellipse(3.0, 0.4), lambda x: 0.4 * np.sqrt(1.0 - (x / 1.5) ** 2)),
        (Waterplane.parabola(3.0, 0.4), lambda x: 0.4 * (1.0 - (x / 1.5) ** 2)),
    ],
)
def test_shapes_against_their_stations(exact: Waterplane, breadth) -> None:  # type: ignore[no-untyped-def]
    x = 1.5 * np.sin(np.linspace(-math.pi / 2, math.pi / 2, 2001))
    area, first, second = (np.trapezoid(np.maximum(breadth(x), 0.0) * x**n, x) for n in (0, 1, 2))
    assert exact.area_m2 == pytest.approx(area, rel=1e-5)
    assert exact.second_moment_m4 == pytest.approx(second, rel=1e-5)
    assert exact.first_moment_m3 == pytest.approx(first, abs=1e-12)


def test_a_triangle_about_its_centroid() -> None:
    """With its point forward: B L/2, centroid L/3 from the base, B L^3/12 and B L^3/36."""
    moved = Waterplane(0.9, 0.9, 0.6 * 27.0 / 12.0).shifted(-1.0)
    assert moved.first_moment_m3 == pytest.approx(0.0, abs=1e-12)
    assert moved.second_moment_m4 == pytest.approx(0.6 * 27.0 / 36.0)


def test_hemisphere_turns_freely_about_its_centre() -> None:
    """rho g pi R^2 against heave; pitch about the centre leaves the immersed shape as it is."""
    matrix = restoring(Waterplane.ellipse(2.0, 2.0), 2 / 3 * math.pi, 3.0 / 8.0, RHO, G)
    assert matrix[0][0] == pytest.approx(RHO * G * math.pi)
    assert matrix[1][1] == pytest.approx(0.0, abs=1e-9)


def test_box_against_its_displaced_water() -> None:
    """Sunk and turned by small amounts, about a point off its middle: volume and its centre."""
    length, breadth, draught, ahead = 2.0, 0.4, 0.15, 0.3
    plane = Waterplane.box(length, breadth).shifted(-ahead)
    matrix = np.array(restoring(plane, length * breadth * draught, draught / 2.0, RHO, G))
    rest = pressure_load(length, breadth, draught, ahead, 0.0, 0.0)
    for z, pitch in ((1e-4, 0.0), (0.0, 1e-4), (1e-4, -2e-4)):
        load = pressure_load(length, breadth, draught, ahead, z, pitch) - rest
        np.testing.assert_allclose(matrix @ [z, pitch], -load, rtol=2e-3, atol=1e-6)


def pressure_load(
    length: float, breadth: float, draught: float, ahead: float, z: float, pitch: float
) -> np.ndarray:  # type: ignore[type-arg]
    """Return heave force (down) and pitch moment (bow up) of buoyancy: volume and its centre."""
    x = np.linspace(-length / 2.0 - ahead, length / 2.0 - ahead, 20001)
    # Immersion of the keel, measured along the body's own vertical, and where its middle goes.
    depth = (draught * math.cos(pitch) - x * math.sin(pitch) + z) / math.cos(pitch)
    keel = draught
    middle = keel - depth / 2.0
    arm = x * math.cos(pitch) + middle * math.sin(pitch)
    weight = RHO * G * breadth * depth
    return np.array([-np.trapezoid(weight, x), np.trapezoid(weight * arm, x)])


def test_waterplanes_that_cannot_be() -> None:
    with pytest.raises(ConfigurationError, match="area_m2 = 0"):
        Waterplane(0.0, 0.0, 1.0)
    with pytest.raises(ConfigurationError, match="take both about the midpoint"):
        Waterplane(1.0, 2.0, 1.0)
    with pytest.raises(ConfigurationError, match="volume_m3 = -1"):
        restoring(Waterplane.box(1.0, 1.0), -1.0, 0.0)
