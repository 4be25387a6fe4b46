"""Bodies put together and taken apart, against sums over points and the keelboat's table."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.inertia.ballast import BallastTarget, Weight, place_ballast
from analysis.inertia.parts import BodyPart, combine, part
from analysis.uncertainty.estimate import Estimate, exactly
from analysis.uncertainty.values import UncertainValues
from hardware.description.errors import ConfigurationError, DataError

finite = st.floats(-2.0, 2.0)
points = st.lists(st.tuples(st.floats(0.1, 9.0), finite, finite, finite), min_size=2, max_size=6)


def point(name: str, m: float, x: float, y: float, z: float, u: float = 0.0) -> BodyPart:
    zero = exactly(0.0, "m")
    place = (Estimate.of(x, u, "m"), Estimate.of(y, u, "m"), Estimate.of(z, u, "m"))
    return part(name, Estimate.of(m, u, "kg"), place, (zero, zero, zero))


@given(points)
def test_combined_points_are_the_sums(rows: list[tuple[float, float, float, float]]) -> None:
    whole = combine("all", [point(str(k), *row) for k, row in enumerate(rows)])
    m, r = np.array([row[0] for row in rows]), np.array([row[1:] for row in rows])
    centre = (m @ r) / m.sum()
    x, y, z = (r - centre).T
    expected = [m @ (y**2 + z**2), m @ (z**2 + x**2), m @ (x**2 + y**2)]
    expected += [m @ (x * y), m @ (x * z), m @ (y * z)]
    assert whole.parameters[1:4] == pytest.approx(centre, abs=1e-9)
    assert whole.parameters[4:] == pytest.approx(expected, abs=1e-8)


@given(points)
def test_taking_away_undoes_putting_on(rows: list[tuple[float, float, float, float]]) -> None:
    parts = [point(str(k), *row) for k, row in enumerate(rows)]
    rest = combine("rest", [combine("all", parts)], without=parts[1:])
    assert rest.parameters == pytest.approx(parts[0].parameters, rel=1e-6, abs=1e-6)


def test_keelboat_of_table_4() -> None:
    zero = exactly(0.0, "m")

    def body(name: str, m: float, x: float, z: float, kp: float, ky: float) -> BodyPart:
        place = (exactly(x, "m"), zero, exactly(-z, "m"))
        return part(name, exactly(m, "kg"), place, (zero, exactly(kp, "m"), exactly(ky, "m")))

    keel = body("keel", 306.2, 3.141, -0.934, 0.339, 0.263)
    hull = body("hull", 316.5, 3.083, -0.011, 1.448, 1.459)
    boat = combine("boat", [keel, hull])
    _, pitch, yaw = boat.gyradii
    assert boat.mass.value == pytest.approx(622.7)
    assert boat.centre_of_gravity[0].value == pytest.approx(3.112, abs=1e-3)
    assert pitch.value == pytest.approx(1.156, abs=1e-3)
    assert yaw.value == pytest.approx(1.057, abs=1e-3)
    back = combine("hull", [boat], without=[keel])
    assert back.gyradii[1].value == pytest.approx(1.448, abs=1e-6)


@pytest.mark.slow
def test_covariance_against_monte_carlo() -> None:
    rng = np.random.default_rng(0)
    a, b = point("a", 3.0, 0.5, 0.1, 0.2, 0.01), point("b", 2.0, -0.8, 0.0, -0.1, 0.01)
    drawn = []
    for _ in range(4000):
        pair = [BodyPart(p.name, UncertainValues(p.uncertain.draw(1, rng)[:, 0])) for p in (a, b)]
        drawn.append(combine("w", pair).parameters)
    whole = combine("w", [a, b])
    seen = np.cov(np.array(drawn).T)
    assert np.sqrt(np.diag(whole.uncertain.covariance())) == pytest.approx(
        np.sqrt(np.diag(seen)), rel=0.06, abs=1e-3
    )


def test_impossible_parts_are_refused() -> None:
    small, large = point("small", 1.0, 0.0, 0.0, 0.0), point("large", 2.0, 0.0, 0.0, 0.0)
    with pytest.raises(DataError, match="weigh more than the whole"):
        combine("rest", [small], without=[large])
    with pytest.raises(ConfigurationError, match="mass_kg = 0"):
        point("none", 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(ConfigurationError, match="no parts"):
        combine("none", [])


def hull() -> BodyPart:
    zero = exactly(0.0, "m")
    place = (exactly(0.02, "m"), zero, exactly(0.05, "m"))
    return part(
        "hull",
        exactly(40.0, "kg"),
        place,
        (exactly(0.2, "m"), exactly(0.6, "m"), exactly(0.6, "m")),
    )


BOX = ((-1.2, 0.0, -0.1), (1.2, 0.0, 0.2))


def test_ballast_meets_a_target_that_can_be_met() -> None:
    weights = [Weight(f"w{k}", 10.0, *BOX) for k in range(3)]
    target = BallastTarget(70.0, (0.0, None, 0.06), (None, 0.62, None))
    found = place_ballast(hull(), weights, target, seed=1)
    assert found.feasible, found.message
    assert found.errors["mass_kg"] == pytest.approx(0.0)
    assert abs(found.errors["pitch_m"]) < 1e-3
    assert (found.positions_m >= np.array(BOX[0]) - 1e-12).all()
    assert (found.positions_m <= np.array(BOX[1]) + 1e-12).all()
    again = place_ballast(hull(), weights, target, seed=1)
    assert again.positions_m == pytest.approx(found.positions_m)


def test_ballast_says_what_cannot_be_met_and_how_near_it_gets() -> None:
    weights = [Weight("w", 10.0, *BOX)]
    found = place_ballast(hull(), weights, BallastTarget(70.0, (0.5, None, None)), seed=1)
    assert not found.feasible
    assert "mass off by -20 kg" in found.message
    assert "x off by -" in found.message
    assert found.positions_m[0, 0] == pytest.approx(1.2, abs=1e-6)


def test_of_many_equal_solutions_the_one_nearest_the_middles_is_found() -> None:
    """Four equal weights in equal boxes, x alone asked for: each goes as far as the others."""
    weights = [Weight(f"w{k}", 10.0, (-2.0, -0.3, -0.1), (2.0, 0.3, 0.2)) for k in range(4)]
    found = place_ballast(hull(), weights, BallastTarget(80.0, (0.2, None, None)), seed=4)
    needed = (80.0 * 0.2 - 40.0 * 0.02) / 40.0
    assert found.positions_m == pytest.approx(np.tile([needed, 0.0, 0.05], (4, 1)), abs=1e-5)


def test_ballast_meets_what_some_places_give() -> None:
    """Twelve coordinates, all six targets, made from places within the boxes."""
    weights = [Weight(f"w{k}", 10.0, (-1.0, -0.3, -0.1), (1.0, 0.3, 0.2)) for k in range(4)]
    places = np.random.default_rng(6).uniform((-0.9, -0.25, -0.08), (0.9, 0.25, 0.15), (4, 3))
    zero = exactly(0.0, "m")
    some = [
        part(f"w{k}", exactly(10.0, "kg"), (x, y, z), (zero, zero, zero))
        for k, (x, y, z) in enumerate([[exactly(v, "m") for v in row] for row in places])
    ]
    made = combine("made", [hull(), *some])
    x, y, z = (one.value for one in made.centre_of_gravity)
    roll, pitch, yaw = (one.value for one in made.gyradii)
    found = place_ballast(
        hull(), weights, BallastTarget(80.0, (x, y, z), (roll, pitch, yaw)), seed=2
    )
    assert found.feasible, found.message
    assert max(map(abs, found.errors.values())) < 1e-6


def test_fixed_ballast_and_bad_boxes() -> None:
    fixed = Weight("w", 10.0, (0.1, 0.0, 0.0), (0.1, 0.0, 0.0))
    assert place_ballast(hull(), [fixed], BallastTarget(50.0)).feasible
    with pytest.raises(ConfigurationError, match="swapped in: x"):
        place_ballast(hull(), [Weight("w", 1.0, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))], BallastTarget())
    with pytest.raises(ConfigurationError, match="no weights"):
        place_ballast(hull(), [], BallastTarget())
