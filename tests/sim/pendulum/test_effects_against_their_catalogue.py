"""Oracle: the page that documents the effects, and what each says of itself."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from sim.effects.parameter import parameters_of
from sim.pendulum.benches import (
    KVLCC2_ROLL,
    MODEL_HULL_2014,
    bifilar_bench,
    decay_bench,
)
from sim.pendulum.effects import CATALOGUE, make_effect
from sim.pendulum.record import record
from sim.pendulum.resistance import Resistance

PAGE = Path(__file__).parents[3] / "docs" / "pendulums.md"


def effects_table() -> str:
    """Return the catalogue as a table in Markdown, one row per effect."""
    rows = [
        "| effect | stage | parameters: plausible range (typical) | what it does | signature |",
        "|---|---|---|---|---|",
    ]
    for effect in CATALOGUE:
        known = [
            f"`{one.name}` {one.plausible}{f' {one.unit}' * (one.unit != '1')} ({one.typical:g})"
            for one in parameters_of(effect)
        ]
        cells = (
            f"`{effect.name}`",
            effect.stage,
            "; ".join(known) or "none",
            effect.summary,
            effect.signature,
        )
        rows.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(rows) + "\n"


def test_the_page_holds_the_table_of_the_classes() -> None:
    assert effects_table() in PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda one: one.name)
def test_every_effect_is_described_and_typical_values_are_plausible(effect) -> None:  # type: ignore[no-untyped-def]
    made = make_effect(effect.name)
    assert made.summary
    assert made.signature
    for known in parameters_of(effect):
        assert known.meaning
        assert known.low <= known.typical <= known.high
        assert getattr(made, known.name) == known.typical


@pytest.mark.sample(11)
@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda one: one.name)
def test_every_effect_changes_the_record_of_a_yaw_and_sway_test(effect) -> None:  # type: ignore[no-untyped-def]
    if effect.name in ("force", "force_sign"):
        pytest.skip("nothing drives this body")
    damped = replace(MODEL_HULL_2014, linear=True, yaw=Resistance(viscous=1e-3))
    quiet = bifilar_bench(damped, sway_m=0.03, flag_width_m=0.02)
    coordinate = {"coordinate": "yaw"} if "coordinate" in effect.__dataclass_fields__ else {}
    strong = {"missed_share": 0.3} if effect.name == "missed_passages" else {}
    bench = make_effect(effect.name, **coordinate, **strong)(quiet)
    kept = {"duration_s": 20.0, "sample_rate_hz": 50.0, "seed": 1}
    before, after = record(quiet, **kept), record(bench, **kept)
    same = [
        np.array_equal(before.dataset[name].values, after.dataset[name].values)
        for name in ("stern_displacement", "yaw", "sway")
    ]
    edges = [gate.time_s.tolist() for gate in before.gates]
    if all(same):
        assert edges != [gate.time_s.tolist() for gate in after.gates]


_SMALL = (
    "line_stretch",
    "line_creep",
    "off_level",
    "air",
    "sensor_lag",
    "sensor_offset",
    "sensor_gain",
    "wrong_clock",
)


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", _SMALL)
def test_an_effect_adds_to_what_the_test_has_already(name: str) -> None:
    effect = make_effect(name)
    twice = make_effect(
        name, **{one.name: 2.0 * one.typical for one in parameters_of(type(effect))}
    )
    bench = bifilar_bench(MODEL_HULL_2014, sway_m=0.03)
    rows = []
    for effects in ((), (effect,), (effect, effect), (twice,)):
        run = record(bench.with_effects(effects), duration_s=10.0, sample_rate_hz=50.0, seed=1)
        rows.append(run.dataset["stern_displacement"].values)
    change = np.linalg.norm(rows[1] - rows[0])
    assert np.linalg.norm(rows[2] - rows[3]) < 0.1 * change
    assert np.linalg.norm(rows[2] - rows[1]) > 0.8 * change


def test_wrong_names_and_values_are_refused_with_what_is_near() -> None:
    with pytest.raises(ConfigurationError, match="did you mean bearing_friction"):
        make_effect("bearing_frction")
    with pytest.raises(ConfigurationError, match="did you mean dead_zone"):
        make_effect("bearing_friction", dead_zon=1e-3)
    with pytest.raises(ConfigurationError, match=r"clock_error = 0.5 is outside .* -0.01 to 0.01"):
        make_effect("wrong_clock", clock_error=0.5)


def test_an_effect_where_it_cannot_act_is_refused() -> None:
    roll = decay_bench(KVLCC2_ROLL, release=0.1)
    with pytest.raises(ConfigurationError, match="acts on a body on two lines"):
        make_effect("line_stretch")(roll)
    with pytest.raises(ConfigurationError, match="no photogate"):
        make_effect("gate_jitter")(roll)
    with pytest.raises(ConfigurationError, match="none of the body's: surge, sway, yaw, pitch"):
        make_effect("bearing_friction")(bifilar_bench(MODEL_HULL_2014))
    with pytest.raises(ConfigurationError, match="no sensor 'gyro'"):
        make_effect("sensor_lag", channel="gyro")(roll)
