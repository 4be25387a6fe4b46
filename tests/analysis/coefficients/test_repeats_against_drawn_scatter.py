"""Repeats: what lies between runs is found, pooled and counted; a run that stands off is named."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.phasors import interleaved
from analysis.coefficients.repeats import outliers, repeatability, with_repeats
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.ideal_rig import mass_matrix
from benchmarks.coefficients_campaigns import BODY, RESTORING, VERTICAL, Made, Scatter, made_up
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint

HEAVE = Made(VERTICAL, Plane.VERTICAL, orders=1, restoring=RESTORING)
QUIET = Scatter(motion_m=1e-6, force_n=0.035)


def solved(cycles: list[BodyCycle]) -> CycleFit:
    return linear_fit(cycles, Form.SEAKEEPING, StatedUncertainties()).fit


def repeats(
    count: int, between: float, generator: np.random.Generator, *, frequency_hz: float = 0.8
) -> list[BodyCycle]:
    """Heave runs whose loads are off by a common relative error each."""
    point = SetPoint(frequency_hz, 0.02)
    found = []
    for k in range(count):
        one = made_up(point, HEAVE, "heave", generator, QUIET)
        factors = np.ones(len(one.phasors.names), dtype=complex)
        for place, name in enumerate(one.phasors.names):
            if name.split()[0] in ("force", "moment"):
                draws = generator.standard_normal(2)
                factors[place] += between * complex(*draws)
        real = one.phasors.real
        own = replace(real.contributions[0], label=f"s {k}")
        renamed = replace(one.phasors, real=replace(real, contributions=(own,)))
        found.append(
            replace(one, name=f"{frequency_hz:g} {k}", phasors=renamed.mapped(np.diag(factors)))
        )
    return found


@pytest.mark.slow
def test_scatter_between_runs_is_found() -> None:
    found = repeatability(repeats(200, 0.01, np.random.default_rng(0)))
    (one,) = repeats(1, 0.0, np.random.default_rng(0))
    omega = 2.0 * np.pi * 0.8
    part = abs(one.loads[0]) / (max(omega**2 * BODY.mass_kg, RESTORING[0, 0]) * 0.02)
    assert found.relative[0] == pytest.approx(0.01 * part, rel=0.1)
    assert found.degrees_of_freedom == 199


@pytest.mark.slow
def test_runs_that_differ_by_their_own_scatter_add_nothing_much() -> None:
    found = repeatability(repeats(200, 0.0, np.random.default_rng(0)))
    assert found.relative.max() < 2e-4


@pytest.mark.slow
def test_intervals_hold_where_runs_differ_between_each_other() -> None:
    generator = np.random.default_rng(5)
    hits, without = np.zeros(4), np.zeros(4)
    for _ in range(60):
        cycles = repeats(5, 0.01, generator)
        known = repeatability(cycles)
        fit = solved([with_repeats(one, known) for one in cycles])
        truth = [-VERTICAL[n] for n in ("Z_wdot", "Z_w", "M_wdot", "M_w")]
        hits += np.abs(fit.values - truth) <= fit.uncertain.half_width()
        bare = solved(cycles)
        without += np.abs(bare.values - truth) <= bare.uncertain.half_width()
    assert np.all(hits / 60 >= 0.85)
    assert np.all(hits / 60 <= 1.0)
    assert without.mean() / 60 < 0.8


def test_a_run_that_stands_off_is_named() -> None:
    generator = np.random.default_rng(6)
    cycles = repeats(5, 0.002, generator) + repeats(4, 0.002, generator, frequency_hz=1.0)
    assert outliers(repeatability(cycles)) == ()
    far = cycles[2]
    factors = np.diag([1.1 if n.startswith("force") else 1.0 for n in far.phasors.names])
    cycles[2] = replace(far, phasors=far.phasors.mapped(factors))
    named = outliers(repeatability(cycles))
    assert {one.run for one in named} == {"0.8 2"}
    assert named[0].ratio > named[0].limit
    assert "look at its record" in named[0].message


@pytest.mark.slow
def test_good_campaigns_seldom_name_anybody() -> None:
    generator = np.random.default_rng(8)
    named = sum(bool(outliers(repeatability(repeats(5, 0.005, generator)))) for _ in range(60))
    assert named <= 4  # 0.6 expected


def test_a_run_without_repeats_stays_as_it_is() -> None:
    one = repeats(1, 0.01, np.random.default_rng(0))
    known = repeatability(one)
    assert with_repeats(one[0], known) is one[0]
    assert known.kinds == ()


@pytest.mark.parametrize(
    "other",
    [
        {"frequency_hz": 0.82},
        {"speed_m_s": 0.1},
        {"drift_rad": 0.01},
        {"heel_rad": 0.2},
        {"rudder_rad": 0.1},
    ],
    ids=lambda other: next(iter(other)),
)
def test_runs_at_another_set_point_are_no_repeats(other: dict[str, float]) -> None:
    cycles = repeats(3, 0.01, np.random.default_rng(0))
    (kind,) = repeatability(cycles).kinds
    assert len(kind.runs) == 3
    (kind,) = repeatability([*cycles[:2], replace(cycles[2], **other)]).kinds  # type: ignore[arg-type]
    assert len(kind.runs) == 2


def test_a_run_with_another_body_is_a_repeat_of_the_same_water() -> None:
    """Its gross loads differ by what the heavier body takes, and the water's do not."""
    cycles = repeats(3, 0.0, np.random.default_rng(3))
    body = cycles[2].body
    assert body is not None
    heavier = replace(body, mass_kg=body.mass_kg + 20.0)
    mass = mass_matrix(heavier, Plane.VERTICAL) - mass_matrix(body, Plane.VERTICAL)
    more = -((2.0 * np.pi * cycles[2].frequency_hz) ** 2) * mass @ cycles[2].motion
    moved = np.zeros(len(cycles[2].phasors.names), dtype=complex)
    for load, change in zip(("force 1", "moment 1"), more, strict=True):
        moved[cycles[2].phasors.index(load)] = change
    own = cycles[2].phasors
    heavy = replace(own, real=replace(own.real, values=own.real.values + interleaved(moved)))
    found = repeatability([*cycles[:2], replace(cycles[2], phasors=heavy, body=heavier)])
    assert found.relative.max() < 1e-3
    assert outliers(found) == ()
