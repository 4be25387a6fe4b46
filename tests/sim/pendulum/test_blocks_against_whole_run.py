"""Oracle: the same run in one call; the same run without numba. And: a state is a value."""

import importlib.util
import sys
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sim.solve.compilation
from sim.pendulum import kernel, two_lines
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import MODEL_HULL_2014, bifilar_bench, swing_bench
from sim.pendulum.effects import make_effect
from sim.solve import array_loops
from tests.sim.blocks import join


def busy_suspension() -> PendulumBench:
    """Return a test in which every stage has something to remember or to draw."""
    bench = bifilar_bench(MODEL_HULL_2014, yaw_rad=0.2, sway_m=0.05).with_effects(
        [
            make_effect("bearing_friction", dead_zone=0.002, coordinate="pitch"),
            make_effect("quadratic_drag", loss=0.3, coordinate="yaw"),
            make_effect("line_creep"),
            make_effect("unsteady_release"),
            make_effect("sensor_lag"),
            make_effect("sensor_noise"),
            make_effect("missed_passages", missed_share=0.2),
            make_effect("gate_jitter"),
        ]
    )
    return replace(bench, release=replace(bench.release, after_s=0.3))


def busy_swing() -> PendulumBench:
    """Return the same for a pivot."""
    return swing_bench(upper_pivot=True, release_rad=0.05).with_effects(
        [make_effect("bearing_friction", dead_zone=0.004), make_effect("power_drag")]
    )


@pytest.mark.slow
@settings(deadline=None, max_examples=25)
@given(
    sizes=st.lists(st.integers(0, 150), min_size=1, max_size=10),
    seed=st.integers(0, 2**40),
    make=st.sampled_from([busy_suspension, busy_swing]),
)
def test_any_mix_of_block_sizes_gives_the_samples_of_the_whole_run(sizes, seed, make) -> None:  # type: ignore[no-untyped-def]
    chain = make().chain()
    end, whole = chain.run(chain.start(50.0, seed), sum(sizes))
    state, parts = chain.start(50.0, seed), []
    for size in sizes:
        state, part = chain.run(state, size)
        parts.append(part)
    joined = join(parts)
    for name, values in whole.items():
        scale = np.abs(values).max(initial=0.0)
        np.testing.assert_allclose(joined[name], values, rtol=1e-12, atol=1e-12 * scale)
    assert hash(state.stages) is not None
    if sum(sizes):
        np.testing.assert_allclose(state.stages[1].motion, end.stages[1].motion, rtol=1e-12)


def test_one_state_gives_the_same_samples_twice() -> None:
    chain = busy_suspension().chain()
    state, _ = chain.run(chain.start(50.0, 7), 120)
    _, once = chain.run(state, 80)
    _, twice = chain.run(state, 80)
    for name, values in once.items():
        np.testing.assert_array_equal(values, twice[name])


@pytest.mark.sample(1)
@pytest.mark.parametrize("make", [busy_suspension, busy_swing])
def test_without_numba_the_numbers_are_the_same(make, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def]
    chain = make().chain()
    _, compiled = chain.run(chain.start(50.0, 3), 150)
    monkeypatch.setattr(sim.solve.compilation, "compile_loop", lambda function: function)
    monkeypatch.setattr(sim.solve.compilation, "available", lambda: False)
    for module in (array_loops, two_lines, kernel):
        monkeypatch.setitem(sys.modules, module.__name__, _again(module))
    plain = sys.modules[kernel.__name__]
    assert not hasattr(plain.run, "py_func")
    assert plain.times is np.dot
    monkeypatch.setattr(sim.pendulum, "kernel", plain)
    _, interpreted = chain.run(chain.start(50.0, 3), 150)
    for name, values in compiled.items():
        np.testing.assert_allclose(interpreted[name], values, rtol=1e-9, atol=1e-11)


def _again(module: ModuleType) -> ModuleType:
    """Load a module a second time."""
    spec = importlib.util.spec_from_file_location(module.__name__, module.__file__)
    assert spec is not None
    assert spec.loader is not None
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded
