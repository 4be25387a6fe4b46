"""What further measurements show of an effect, against what its closed form says."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from analysis.gap.design.beside import NO_GAP
from analysis.gap.design.forecast import next_place, planned
from analysis.gap.design.measurements import INJECTED_HZ, measured_besides
from analysis.gap.design.proposals import OSCILLATION, Choices, Proposal, proposals, set_points
from analysis.gap.forward.candidate import candidates
from analysis.gap.forward.free_numbers import free_numbers
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import Component, GapRun, Observation, Part, Stack
from analysis.gap.search.fit import linearised_at
from hardware.description.oscillator import Range
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.units import STANDARD_GRAVITY_M_S2 as G_M_S2
from sim.effects.campaign import CampaignRun
from sim.effects.catalogue import build, find
from sim.effects.effect import Effect, FurtherMeasurement
from sim.effects.k6_joint_play import JointPlay
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of, record

WEIGHT_N = 100.0
REST = FurtherMeasurement.REST
POINT = SetPoint(0.8, 0.02)


@pytest.fixture(scope="module")
def problem(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Problem:
    return problem_of(rig, clean[:2])


def shown(problem: Problem, runs: Sequence[GapRun], *effects: Effect) -> list[dict[str, complex]]:
    """Return each record's harmonics, ``channel`` and ``channel order``, as H = S + i C."""
    simulator = replace(problem.simulator, stack=Stack.of(runs))
    values = simulator.predict(effects)
    found: list[dict[str, complex]] = [{} for _ in runs]
    for number, one, value in zip(
        simulator.stack.run, simulator.stack.components, values, strict=True
    ):
        key = one.channel if one.part is Part.MEAN else f"{one.channel} {one.order}"
        part = 1j * value if one.part is Part.QUADRATURE else complex(value)
        found[number][key] = found[number].get(key, 0j) + part
    return found


def weights(problem: Problem) -> tuple[GapRun, ...]:
    return tuple(
        made(problem, FurtherMeasurement.CHECK_WEIGHT, WEIGHT_N, strut) for strut in ("aft", "fore")
    )


def made(
    problem: Problem, kind: FurtherMeasurement, force_n: float = 0.0, strut: str = ""
) -> GapRun:
    found = measured_besides(problem, kind, CampaignRun(), force_n, strut)
    assert found is not None
    return found


def test_a_check_weight_goes_on_and_off_at_its_gauge(problem: Problem) -> None:
    aft, fore = shown(problem, weights(problem))
    for one, loaded, other in ((aft, "aft", "fore"), (fore, "fore", "aft")):
        assert one[f"force_{loaded}"] == pytest.approx(WEIGHT_N / 2.0)
        assert one[f"force_{loaded} 1"] == pytest.approx(-0.5j * WEIGHT_N, rel=1e-4)
        assert abs(one[f"force_{loaded} 2"]) < 1e-9 * WEIGHT_N
        assert abs(one[f"force_{other} 1"]) < 1e-9 * WEIGHT_N


def test_a_check_weight_shows_gain_and_cross_talk(problem: Problem) -> None:
    aft, _ = shown(problem, weights(problem), build("gain-error:aft=0.02"))
    assert aft["force_aft 1"] == pytest.approx(-0.5j * 1.02 * WEIGHT_N, rel=1e-4)
    aft, fore = shown(problem, weights(problem), build("cross-talk:aft=0.0,fore=0.01"))
    assert aft["force_fore 1"] == pytest.approx(-0.5j * 0.01 * WEIGHT_N, rel=1e-4)
    assert abs(fore["force_aft 1"]) < 1e-9 * WEIGHT_N


def test_a_check_weight_shows_what_a_curved_gauge_makes_of_it(problem: Problem) -> None:
    """Of (W/2)(1 - cos)^2 k W/2: 3/2, -2 cos, cos(2 ..)/2 times k W^2/4."""
    aft, _ = shown(problem, weights(problem), build("quadratic-gauge:curvature_1_n=1e-5"))
    square_n = 1e-5 * WEIGHT_N**2 / 4.0
    assert aft["force_aft"] == pytest.approx(WEIGHT_N / 2.0 + 1.5 * square_n)
    assert aft["force_aft 2"] == pytest.approx(0.5j * square_n, rel=1e-3)


def test_an_injected_sine_shows_the_amplifiers_and_nothing_before_them(problem: Problem) -> None:
    runs = (made(problem, FurtherMeasurement.INJECTION, 20.0),)
    (plain,) = shown(problem, runs)
    assert plain["force_aft 1"] == pytest.approx(20.0, rel=1e-9)
    (lags,) = shown(problem, runs, build("amplifier-lag:cutoff_hz=80.0"))
    pole = 1.0 / (1.0 + 1j * INJECTED_HZ / 80.0)
    assert lags["force_fore 1"] == pytest.approx(20.0 * pole, rel=1e-6)
    for name in ("gain-error", "zero-offset", "coulomb-friction", "campaign-drift"):
        (other,) = shown(problem, runs, build(name))
        assert other == pytest.approx(plain, rel=1e-9, abs=1e-9)


def test_a_sine_tells_a_low_pass_from_the_delay_that_it_is_to_the_shaft(problem: Problem) -> None:
    """Both are late by 1/(2 pi cutoff); at ten hertz the low-pass of 80 Hz is 0.8 % smaller."""
    runs = (made(problem, FurtherMeasurement.INJECTION, 20.0),)
    late_s = 1.0 / (2.0 * math.pi * 80.0)
    (lag,) = shown(problem, runs, build("amplifier-lag:cutoff_hz=80.0"))
    (skew,) = shown(problem, runs, build(f"channel-skew:aft_s={late_s},fore_s={late_s}"))
    smaller = abs(lag["force_aft 1"]) / abs(skew["force_aft 1"])
    assert smaller == pytest.approx(1.0 / math.hypot(1.0, INJECTED_HZ / 80.0), rel=1e-6)
    (known,) = runs
    at_ = known.observed.components.index(Component("force_aft", Part.QUADRATURE, 1))
    off_n = (1.0 - smaller) * 20.0
    assert off_n > 3.0 * known.observed.uncertainty[at_]


def test_a_record_at_rest_shows_the_day_that_gets_warmer_at_its_time(problem: Problem) -> None:
    place = CampaignRun(9, 2.0 * 3600.0, 300.0, POINT)
    run = replace(made(problem, REST), place=place)
    (rest,) = shown(problem, (run,), build("temperature:rate_k_h=0.5,zero_n_k=0.1"))
    assert rest["force_aft"] == pytest.approx(0.1)  # after two hours, one kelvin
    assert set(rest) == {"force_aft", "force_fore"}


def swing(point: SetPoint) -> float:
    """Return ``w^2 e / g``, by which share of its weight a mass pulls where it is moved."""
    return float((2.0 * math.pi * point.frequency_hz) ** 2 * point.eccentricity_m / G_M_S2)


def test_a_record_is_as_sure_as_it_is_long_and_its_weight_is_known(problem: Problem) -> None:
    """White noise: one over the root of the length; the weight is off on the gauge it is on."""
    near = next(one for one in problem.simulator.stack.runs if one.set_point.frequency_hz == 1.0)
    lasts_s = near.periods / 1.0
    mean_n = {
        name: near.observed.uncertainty[near.observed.components.index(Component(name, Part.MEAN))]
        * math.sqrt(lasts_s / 60.0)
        for name in ("force_aft", "force_fore")
    }
    rest, (aft, fore) = made(problem, REST), weights(problem)
    for name, noise_n in mean_n.items():
        assert sure(rest, name, Part.MEAN) == pytest.approx(noise_n)
        for run, loaded in ((aft, "force_aft"), (fore, "force_fore")):
            off_n = 1e-4 * WEIGHT_N / 2.0 if name == loaded else 0.0
            known_n = pytest.approx(math.hypot(noise_n, off_n))
            assert sure(run, name, Part.MEAN) == known_n
            assert sure(run, name, Part.QUADRATURE, 1) == known_n
            assert sure(run, name, Part.QUADRATURE, 2) == pytest.approx(noise_n)


def sure(run: GapRun, channel: str, part: Part, order: int = 0) -> float:
    at = run.observed.components.index(Component(channel, part, order))
    return float(run.observed.uncertainty[at])


def test_no_weight_is_put_on_a_gauge_that_is_not_read(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    one = problem_of(rig, [without_aft(run) for run in clean[:2]])
    weight = (FurtherMeasurement.CHECK_WEIGHT, CampaignRun(), WEIGHT_N)
    assert measured_besides(one, *weight, "aft") is None
    assert measured_besides(one, *weight, "fore") is not None


def test_a_weight_is_proposed_on_the_strut_whose_gauge_it_tells_of(problem: Problem) -> None:
    effect = build("gain-error:aft=0.0,fore=0.05")
    part = next(one for one in candidates(type(effect), (0.5, 1.0)))
    units = np.array([axis.unit(getattr(effect, axis.parameter.name)) for axis in part.axes])
    leading = ((linearised_at(problem, (part,), units), 0.5), (NO_GAP, 0.5))
    choices = Choices(Range(0.5, 1.0), Range(0.01, 0.02), media=())
    free = free_numbers(problem.simulator.rig, Tolerances())
    first, *_ = proposals(problem, leading, choices, free, Tolerances())
    assert (first.kind, first.strut) == (FurtherMeasurement.CHECK_WEIGHT, "fore")
    assert str(first) == f"a check weight of {first.force_n:g} N on the fore dynamometer"


def test_a_dead_weight_takes_up_the_play_and_is_moved_with_the_model(problem: Problem) -> None:
    run = planned(problem, POINT, 0)
    loaded = replace(run, preload_n=60.0)
    (bare,), (pressed,) = shown(problem, (run,)), shown(problem, (loaded,))
    for name in ("force_aft", "force_fore"):
        assert abs(pressed[name] - bare[name]) == pytest.approx(30.0)
        moved_n = pressed[f"{name} 1"] - bare[f"{name} 1"]
        assert moved_n == pytest.approx(-30.0 * swing(POINT), rel=1e-4)
    play = build("joint-play:half_play_m=1e-4")
    assert shown(problem, (loaded,), play) == [pytest.approx(pressed)]
    assert shown(problem, (run,), play) != [pytest.approx(bare)]


def test_the_next_run_is_made_after_the_last(problem: Problem) -> None:
    place = next_place(problem)
    made = problem.simulator.stack.runs
    assert place.index == len(made)
    assert place.since_start_s == 2.0 * made[-1].place.since_start_s  # two runs, one lapse
    assert place.before == made[-1].set_point


def pressed(problem: Problem, choices: Choices) -> list[Proposal]:
    """Return what is proposed with a dead weight, where play or no gap may be."""
    play = next(iter(candidates(find("joint-play"), (0.5, 1.0))))
    leading = ((linearised_at(problem, (play,), play.start), 0.5), (NO_GAP, 0.5))
    free = free_numbers(problem.simulator.rig, Tolerances())
    found = proposals(problem, leading, choices, free, Tolerances())
    return [one for one in found if one.set_point is not None and one.force_n]


def largest_n(problem: Problem, point: SetPoint) -> float:
    """Return the first harmonic of the strut that is loaded more."""
    (one,) = shown(problem, (planned(problem, point, 0),))
    return max(abs(one["force_aft 1"]), abs(one["force_fore 1"]))


@pytest.mark.slow
def test_a_dead_weight_presses_both_struts_beside_its_own_inertia(problem: Problem) -> None:
    choices = Choices(Range(1.0, 2.39), Range(0.015, 0.06), (0.0,), media=(Medium.AIR,))
    found = pressed(problem, choices)
    assert len(found) == 5  # of six: at 2.39 Hz and 60 mm any weight is thrown off
    for one in found:
        assert one.set_point is not None
        force_n, share = largest_n(problem, one.set_point), swing(one.set_point)
        least_n = 2.0 * 1.25 * force_n / (1.0 - share)
        assert least_n <= one.force_n <= 1.1 * least_n, str(one)
        limit_n = force_n + one.force_n / 2.0 * (1.0 + share)
        (same,) = pressed(problem, only(choices, one.set_point, 1.001 * limit_n))
        assert same.force_n == one.force_n
        assert not pressed(problem, only(choices, one.set_point, 0.999 * limit_n))


@pytest.mark.slow
def test_a_dead_weight_is_proposed_where_the_most_telling_runs_would_throw_it_off(
    problem: Problem,
) -> None:
    fast = Choices(Range(1.0, 8.0), Range(0.01, 0.04), media=(Medium.AIR,))
    found = pressed(problem, fast)
    thrown = [one for one in set_points(fast) if swing(one) >= 1.0]
    assert len(thrown) > 6  # of 18
    assert len(found) == 6
    assert not {one.set_point for one in found} & {*thrown}


def only(choices: Choices, point: SetPoint, limit_n: float) -> Choices:
    """Return one set-point as all that can be run, below a strut's limit."""
    frequency = Range(point.frequency_hz, point.frequency_hz)
    radius = Range(point.eccentricity_m, point.eccentricity_m)
    preload = (FurtherMeasurement.PRELOAD,)
    return replace(
        choices,
        frequency_hz=frequency,
        eccentricity_m=radius,
        special=preload,
        force_limit_n=limit_n,
    )


@pytest.mark.slow
def test_the_strut_that_is_not_recorded_has_its_limit_too(
    rig: SimulatedRig, clean: tuple[GapRun, ...], problem: Problem
) -> None:
    """The centre of gravity is aft, so that the aft strut carries more."""
    one = problem_of(rig, [without_aft(run) for run in clean[:2]])
    point = SetPoint(0.8, 0.02, medium=Medium.AIR)
    most_n = largest_n(problem, point)
    alone = Choices(Range(0.8, 0.8), Range(0.02, 0.02), (0.0,), media=(Medium.AIR,), special=())
    for share, can in ((0.999, False), (1.001, True)):
        limited = replace(alone, force_limit_n=share * most_n)
        leading = ((NO_GAP, 0.5), (NO_GAP, 0.5))
        found = proposals(one, leading, limited, free_numbers(rig, Tolerances()), Tolerances())
        assert bool(found) is can


def without_aft(run: GapRun) -> GapRun:
    seen = run.observed
    kept = [at for at, one in enumerate(seen.components) if one.channel != "force_aft"]
    parts = tuple(seen.components[at] for at in kept)
    return replace(run, observed=Observation(parts, seen.values[kept], seen.uncertainty[kept]))


class Twin(JointPlay):
    """What moves the struts just as play does, and has nothing that a weight could take up."""

    name = "twin"
    taken_up = False


@pytest.mark.slow
def test_a_dead_weight_tells_play_from_its_twin_and_no_other_run_does(rig: SimulatedRig) -> None:
    problem = problem_of(rig, record(rig, (build("joint-play:half_play_m=2e-5"),), 51)[:3])
    parts = [next(iter(candidates(kind, (0.5, 1.0)))) for kind in (find("joint-play"), Twin)]
    fits = [(linearised_at(problem, (one,), one.start), 0.5) for one in parts]
    choices = Choices(Range(0.5, 1.0), Range(0.01, 0.02), force_limit_n=500.0)
    ask = partial(
        proposals, problem, fits, free=free_numbers(rig, Tolerances()), tolerances=Tolerances()
    )
    found = ask(choices)
    for one in found:
        assert (one.gain > 5.0) is (one.kind == OSCILLATION and one.force_n > 0.0), str(one)
    assert f"with a dead weight of {found[0].force_n:g} N on the model" in str(found[0])
    kinds = {(one.kind, one.force_n) for one in ask(replace(choices, special=(REST,)))}
    assert kinds == {(OSCILLATION, 0.0), (REST, 0.0)}
