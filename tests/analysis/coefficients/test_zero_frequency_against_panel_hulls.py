"""Oracle: added mass and damping of hulls by a panel method, which knows zero frequency itself.

The numbers of the extrapolation were set on two other hulls.
"""

import csv
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.coefficients.zero_frequency import at_zero_frequency
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

HULLS = Path(__file__).parents[2] / "data" / "panel" / "hulls.csv"
TYPICAL_RAD_S = 2.0 * math.pi * 0.4


@cache
def responses() -> dict[tuple[str, str], FloatArray]:
    """Frequency, added mass and damping of each hull's motions, zero frequency first."""
    found: dict[tuple[str, str], list[list[float]]] = {}
    with HULLS.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            values = [float(row[key]) for key in ("freq_hz", "added_mass", "damping")]
            found.setdefault((row["body"], row["dof"]), []).append(values)
    return {kind: np.array(values).T for kind, values in found.items()}


def measured(values: FloatArray, spread: FloatArray, shared: float = 0.0) -> UncertainValues:
    own = tuple(
        Contribution(f"scatter {k}", 8.0, np.array([k]), np.array([[one]]))
        for k, one in enumerate(spread)
    )
    return UncertainValues(values, own).plus("mass", np.full(len(values), shared))


def draws(count: int, seed: int) -> list[tuple[str, UncertainValues, float, float]]:
    """Campaigns of two to seven frequencies at 0.1 to 2 %: what is found, and true A and B.

    Friction adds a damping that does not depend on the frequency.
    """
    generator = np.random.default_rng(seed)
    found = []
    for (body, _), (hertz, added_mass, damping) in responses().items():
        for _ in range(count):
            size = int(generator.integers(2, 8))
            runs = np.sort(generator.choice(np.arange(1, len(hertz)), size, replace=False))
            omega = 2.0 * math.pi * hertz[runs]
            friction = 0.3 * generator.uniform() * added_mass[0] * TYPICAL_RAD_S
            noise = 10.0 ** generator.uniform(-3.0, -1.7) * added_mass[0]
            spread = noise * np.concatenate((np.ones(size), omega))
            exact = np.concatenate((added_mass[runs], damping[runs] + friction))
            values = measured(exact + spread * generator.standard_normal(2 * size), spread)
            kinds = np.repeat([True, False], size)
            slow = at_zero_frequency(body, np.tile(hertz[runs], 2), kinds, values)
            found.append((body, slow, float(added_mass[0]), friction))
    return found


@pytest.mark.parametrize(
    ("twin", "least", "most"), [(False, 0.95, (0.1, 0.05)), (True, 0.88, (0.15, 0.08))]
)
def test_intervals_hold_what_the_panel_method_has_at_zero_frequency(
    twin: bool, least: float, most: tuple[float, float]
) -> None:
    """Between twin hulls the water stands in resonance, narrower than what is allowed for."""
    cases = [case for case in draws(20, 1) if case[0].startswith("twin") == twin]
    held = np.mean(
        [
            np.abs(slow.values - (added_mass, friction)) <= slow.half_width(0.95)
            for _, slow, added_mass, friction in cases
        ],
        axis=0,
    )
    assert (held >= least).all(), held
    errors = np.median(
        [
            np.abs(slow.values - (mass, friction)) / mass / (1.0, TYPICAL_RAD_S)
            for _, slow, mass, friction in cases
        ],
        axis=0,
    )
    assert (errors <= most).all(), errors


def test_water_without_memory_costs_no_width() -> None:
    generator = np.random.default_rng(3)
    hertz, held, widths = np.geomspace(0.2, 0.8, 4), [], []
    omega = 2.0 * math.pi * hertz
    spread = 1.0 * np.concatenate((np.ones(4), omega))
    for _ in range(200):
        exact = np.concatenate((np.full(4, 100.0), np.full(4, 60.0)))
        values = measured(exact + spread * generator.standard_normal(8), spread)
        slow = at_zero_frequency("33", np.tile(hertz, 2), np.repeat([True, False], 4), values)
        held.append(np.abs(slow.values - (100.0, 60.0)) <= slow.half_width(0.95))
        widths.append(slow.standard_uncertainty / (1.0, omega[0]))
    assert (np.mean(held, axis=0) >= 0.92).all()
    assert (np.median(widths, axis=0) <= 1.2).all()  # no more than the slowest run's own


def test_what_all_frequencies_share_does_not_average_out() -> None:
    hertz = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    values = measured(np.full(5, 75.0), np.full(5, 1e-6), shared=0.3)
    found = at_zero_frequency("a33", hertz, [True] * 5, values)
    assert found.standard_uncertainty[0] == pytest.approx(0.3, rel=1e-3)
    assert found.shares(0)["mass"] > 0.99


@given(st.floats(1e-3, 1e3), st.floats(0.05, 20.0), st.sampled_from(sorted(responses())))
def test_units_of_mass_and_time_do_not_matter(
    mass: float, pace: float, kind: tuple[str, str]
) -> None:
    hertz, added_mass, damping = responses()[kind][:, [4, 8, 12, 16]]
    spread = np.concatenate((np.full(4, 0.01), 0.01 * hertz)) * added_mass[0]
    kinds, both = np.repeat([True, False], 4), np.concatenate((added_mass, damping))
    plain = at_zero_frequency("x", np.tile(hertz, 2), kinds, measured(both, spread))
    factors = mass * np.where(kinds, 1.0, pace)
    scaled = at_zero_frequency(
        "x", np.tile(hertz, 2) * pace, kinds, measured(both * factors, spread * factors)
    )
    units = mass * np.array([1.0, pace])
    np.testing.assert_allclose(scaled.values, plain.values * units, rtol=1e-5, atol=1e-6 * mass)
    np.testing.assert_allclose(
        scaled.standard_uncertainty, plain.standard_uncertainty * units, rtol=1e-5
    )


@pytest.mark.parametrize("kind", sorted(responses()))
def test_restoring_is_told_from_added_mass(kind: tuple[str, str]) -> None:
    hertz, added_mass, damping = responses()[kind][:, [4, 6, 8, 10, 12, 14]]
    omega = 2.0 * math.pi * hertz
    restoring = 3.0 * added_mass[0]
    both = np.concatenate((added_mass - restoring / omega**2, damping))
    spread = 1e-3 * restoring * np.concatenate((omega**-2, 1.0 / omega))
    kinds = np.repeat([True, False], 6)
    values = measured(both, spread)
    slow = at_zero_frequency("C", np.tile(hertz, 2), kinds, values, restoring=True)
    assert len(slow) == 3
    assert abs(slow.values[2] - restoring) <= slow.half_width(0.95)[2]


def test_one_frequency_is_refused() -> None:
    with pytest.raises(DataError, match=r"a33 at zero frequency needs .* 0\.3 Hz; add runs at a"):
        at_zero_frequency("a33", [0.3], [True], measured(np.array([1.0]), np.array([0.1])))
