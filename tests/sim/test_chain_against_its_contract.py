"""Oracle: what a chain promises: checked wiring, substituted signals, changed stages."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.arrangement import DriftBy, Joint
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.chain import Chain
from sim.rig import horizontal_rig, vertical_rig
from sim.signals import Signal, Signals
from sim.stage import Block, Stage

SET_POINT = SetPoint(1.0, 0.03, 0.5)


def ideal_chain() -> Chain:
    return vertical_rig().ideal().chain(SET_POINT)


@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig(), horizontal_rig(2.0)])
def test_every_stage_writes_what_it_declares(rig: Any) -> None:
    chain = rig.chain(SET_POINT)
    state = chain.start(200.0, seed=0)
    hash(state)  # numbers, tuples and frozen dataclasses only
    _, run = chain.run(state, 100)
    for stage, stage_state in zip(chain.stages, state.stages, strict=True):
        fed = {one.name: run[one.name].copy() for one in stage.reads}
        for values in fed.values():
            values.flags.writeable = False  # a stage never changes its inputs
        _, written = stage.run(stage_state, Block(0, 100, 200.0), fed)
        assert list(written) == [one.name for one in stage.writes]
        for one in stage.writes:
            assert one.unit
            assert written[one.name].dtype == np.float64
            assert not one.sampled or written[one.name].shape == (100,)


def test_a_signal_name_has_one_unit() -> None:
    units: dict[str, str] = {}
    for value in vars(signals).values():
        if isinstance(value, Signal):
            assert units.setdefault(value.name, value.unit) == value.unit
    assert len(units) >= 13


def test_a_stage_before_its_source_is_refused() -> None:
    drive, carriage, mechanism, hull, *_ = ideal_chain().stages
    with pytest.raises(ConfigurationError, match="'mechanism' reads 'shaft_angle'"):
        Chain((mechanism, drive))
    with pytest.raises(ConfigurationError, match="'hull' reads 'carriage_speed'"):
        Chain((drive, mechanism, hull, carriage))


def test_a_turntable_is_refused() -> None:
    rig = horizontal_rig()
    table = replace(rig, oscillator=replace(rig.oscillator, joint=Joint.YAW_TABLE))
    with pytest.raises(ConfigurationError, match='simulate "slides_on_model" or "slides_on_rig"'):
        table.chain(SET_POINT)


def test_struts_further_apart_than_the_model_reaches_are_refused() -> None:
    """0.3 m to either side of 0.4 m: less than 1 of the spacing but for the drift."""
    rig = horizontal_rig()
    given = {"joint": Joint.SLIDES_ON_RIG, "drift_by": DriftBy.STRUTS_OFFSET, "half_spacing_m": 0.4}
    short = replace(rig, oscillator=replace(rig.oscillator, **given))
    short.chain(SetPoint(0.2, 0.3, math.pi, drift_rad=0.2))
    with pytest.raises(ConfigurationError, match=r"differ by 1\.05 of their spacing \(limit 1"):
        short.chain(SetPoint(0.2, 0.3, math.pi, drift_rad=0.3))


def test_two_writers_or_two_namesakes_are_refused() -> None:
    drive = ideal_chain().stage("drive")
    with pytest.raises(ConfigurationError, match="two stages are called 'drive'"):
        Chain((drive, drive))
    with pytest.raises(ConfigurationError, match="'drive' writes 'shaft_angle', which is already"):
        Chain((drive,), inputs=(signals.SHAFT_ANGLE,))


def test_unknown_names_are_answered_with_near_ones() -> None:
    chain = ideal_chain()
    with pytest.raises(ConfigurationError, match="did you mean mechanism"):
        chain.stage("mechanismus")
    with pytest.raises(ConfigurationError, match="no signal 'forceaft'; did you mean force_aft"):
        chain.run(chain.start(100.0, 0), 3, {"forceaft": np.zeros(3)})


def test_substituted_signal_feeds_everything_downstream_and_nothing_upstream() -> None:
    chain = ideal_chain()
    start = chain.start(100.0, seed=0)
    _, nominal = chain.run(start, 300)
    measured = 7.0 * np.cos(np.linspace(0.0, 9.0, 300))
    _, fed = chain.run(start, 300, {"force_aft": measured})
    np.testing.assert_array_equal(fed["force_aft"], measured)
    np.testing.assert_array_equal(fed["recorded_force_aft"], measured)
    for name in ("acceleration_aft", "force_fore", "recorded_force_fore", "photocell_edge_time"):
        np.testing.assert_array_equal(fed[name], nominal[name])


@given(cut=st.integers(1, 299))
def test_substituted_motion_gives_its_own_force_in_blocks_too(cut: int) -> None:
    """A measured motion (its harmonics) instead of the mechanism's: F = Z y for that motion."""
    chain = ideal_chain()
    t, omega, amplitude = np.arange(300) / 100.0, 5.0, 0.011
    motion: dict[str, Any] = {}
    for strut in ("aft", "fore"):
        motion[f"displacement_{strut}"] = amplitude * np.sin(omega * t)
        motion[f"velocity_{strut}"] = amplitude * omega * np.cos(omega * t)
        motion[f"acceleration_{strut}"] = -amplitude * omega**2 * np.sin(omega * t)
    state, first = chain.run(
        chain.start(100.0, seed=0), cut, {name: values[:cut] for name, values in motion.items()}
    )
    _, second = chain.run(state, 300 - cut, {n: values[cut:] for n, values in motion.items()})
    force = np.concatenate([part["force_aft"] + part["force_fore"] for part in (first, second)])
    rig = vertical_rig()
    stiffness = rig.water.restoring[0][0] - omega**2 * (
        rig.body.mass_kg + rig.water.added_mass[0][0]
    )
    expected = amplitude * (
        stiffness * np.sin(omega * t) + rig.water.damping[0][0] * omega * np.cos(omega * t)
    )
    np.testing.assert_allclose(force, expected, atol=1e-11)


def test_a_chain_cut_off_upstream_runs_on_supplied_inputs() -> None:
    whole = ideal_chain()
    _, run = whole.run(whole.start(100.0, seed=0), 200)
    hull = whole.stage("hull")
    cut = Chain((hull, whole.stage("dynamometers")), inputs=hull.reads)
    given_signals = {signal.name: run[signal.name] for signal in cut.inputs}
    _, again = cut.run(cut.start(100.0, seed=0), 200, given_signals)
    np.testing.assert_array_equal(again["dynamometer_force_aft"], run["dynamometer_force_aft"])
    with pytest.raises(ConfigurationError, match=r"'displacement_aft' \(m\) is an input"):
        cut.run(cut.start(100.0, seed=0), 200)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.zeros(4), r"shape \(4,\) was given where \(5,\)"),
        (np.zeros((5, 2)), r"shape \(5, 2\)"),
        (np.array([0.0, math.nan, 0.0, math.inf, 0.0]), "2 of 5 substituted values are not finite"),
    ],
)
def test_bad_substitutes_are_refused(values: np.ndarray, message: str) -> None:
    chain = ideal_chain()
    with pytest.raises(DataError, match=message):
        chain.run(chain.start(100.0, seed=0), 5, {"force_aft": values})


@dataclass(frozen=True)
class Changed:
    """A stage whose outputs are altered: how an effect from outside plugs in."""

    inner: Stage[Any]
    alter: Callable[[Signals], Signals]

    @property
    def name(self) -> str:
        return self.inner.name

    @property
    def reads(self) -> tuple[Signal, ...]:
        return self.inner.reads

    @property
    def writes(self) -> tuple[Signal, ...]:
        return self.inner.writes

    def start(self, sample_rate_hz: float, seed: int) -> Any:
        return self.inner.start(sample_rate_hz, seed)

    def run(self, state: Any, block: Block, inputs: Signals) -> tuple[Any, Signals]:
        after, written = self.inner.run(state, block, inputs)
        return after, {**written, **self.alter(written)}


def test_effects_compose_and_leave_the_nominal_chain_alone() -> None:
    chain = ideal_chain()
    start = chain.start(100.0, seed=0)
    name = "dynamometer_force_aft"

    def gain(stage: Stage[Any]) -> Stage[Any]:
        return Changed(stage, lambda out: {name: 1.1 * out[name]})

    def square(stage: Stage[Any]) -> Stage[Any]:
        return Changed(stage, lambda out: {name: out[name] + 1e-3 * out[name] ** 2})

    with_both = chain.change("dynamometers", gain).change("dynamometers", square)
    _, nominal = chain.run(start, 100)
    _, changed = with_both.run(with_both.start(100.0, seed=0), 100)
    reading = 1.1 * nominal[name]
    np.testing.assert_allclose(changed["recorded_force_aft"], reading + 1e-3 * reading**2)
    np.testing.assert_array_equal(nominal[name], chain.run(start, 100)[1][name])
    kept = replace(chain)
    assert kept == chain
