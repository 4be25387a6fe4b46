"""Effects of measurement, signal chain and water over their ranges, and all of them at once."""

from dataclasses import replace

import numpy as np
import pytest

from hardware.description.setpoint import Medium, SetPoint
from sim.effects.agreement import mismatch
from sim.effects.campaign import in_order
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect
from sim.effects.h14_vortex_shedding import VortexShedding
from sim.effects.m7_saturation import Saturation
from sim.effects.situation import Situation
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate, steady_run
from tests.sim.blocks import join
from tests.sim.effects.in_time import between, in_time

KINDS = [kind for kind in catalogue().values() if kind.code[0] in "MAH"]
CODES = [
    *(f"M{i}" for i in range(1, 10)),
    "M6b",
    *(f"A{i}" for i in range(1, 9)),
    *("H1", "H2", "H3", "H3b", *(f"H{i}" for i in range(4, 16))),
]
SET_POINT = SetPoint(0.8, 0.005, 1.2, 1.6)


def test_every_row_of_the_tables_has_an_effect() -> None:
    assert sorted(kind.code for kind in KINDS) == sorted(CODES)


@pytest.mark.sample(12)
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.code)
def test_ends_of_the_ranges(kind: type[Effect]) -> None:
    """Every parameter at either end of its range still gives a run, and a signature, of numbers."""
    rig = vertical_rig()
    for one in kind.parameters():
        about_zero = (-one.least, one.least) if one.least else ()
        for value in (one.low, *about_zero, one.high):
            effect = kind(**{one.name: value})
            changed = steady_run(effect.change(rig, SET_POINT), SET_POINT)
            assert all(np.isfinite(values).all() for values in changed.spectra.values())
            situation = Situation.of(rig, SET_POINT)
            stated = (*effect.signature(situation).values(), *effect.lines(situation).values())
            assert np.isfinite(np.array(stated, dtype=complex)).all()


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.code)
def test_rig_with_few_channels(kind: type[Effect]) -> None:
    """No photocell and one force only: an effect of what is not there changes nothing."""
    rig = vertical_rig()
    few = replace(rig, photocell=None, acquisition=replace(rig.acquisition, force_fore=None))
    changed = kind().change(few, SET_POINT)
    assert changed.photocell is None
    assert changed.acquisition.force_fore is None
    assert np.isfinite(steady_run(changed, SET_POINT).spectra["recorded_force_aft"]).all()


@pytest.mark.parametrize(
    "kind", [kind for kind in KINDS if not kind.repeats], ids=lambda kind: kind.code
)
def test_what_does_not_repeat_is_not_in_the_periodic_steady_state(kind: type[Effect]) -> None:
    effect = kind()
    assert np.isnan(mismatch(effect, vertical_rig().ideal(), [SET_POINT]))
    rig = vertical_rig()
    nominal, changed = (
        steady_run(rig, SET_POINT),
        steady_run(effect.change(rig, SET_POINT), SET_POINT),
    )
    for name, values in nominal.spectra.items():
        np.testing.assert_array_equal(changed.spectra[name], values)


@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig(rod_length_m=1.5)])
@pytest.mark.parametrize("medium", list(Medium))
def test_all_at_once(rig: SimulatedRig, medium: Medium) -> None:
    """A record of a campaign's run with every effect on, in any order of switching them on."""
    set_point = replace(SET_POINT, medium=medium)
    effects = [kind() for kind in KINDS]
    place = in_order([set_point] * 3, 60.0, 300.0)[-1]
    real = switch_on(effects, rig, set_point, place)
    record = simulate(*real, periods=6, seed=3)
    assert all(np.isfinite(values).all() for values in record.data_vars.values())
    plain = simulate(rig, set_point, periods=6, seed=3)
    for name in ("force_aft", "force_fore"):
        assert np.abs(record[name].values - plain[name].values).max() > 0.1
    backwards = switch_on(effects[::-1], rig, set_point, place)
    one, other = steady_run(*real), steady_run(*backwards)
    largest = np.abs(one.spectra["recorded_force_aft"]).max()
    gap = np.abs(one.spectra["recorded_force_aft"] - other.spectra["recorded_force_aft"]).max()
    # Effects relative to what is there already (added mass, damping, gain) act on one another.
    assert gap < 0.05 * largest


@pytest.mark.parametrize("cuts", [(1, 2, 50), (137,), (300, 301)])
def test_blocks_give_the_whole_run(cuts: tuple[int, ...]) -> None:
    rig, set_point = switch_on([kind() for kind in KINDS], vertical_rig(), SET_POINT)
    chain = rig.chain(set_point)
    whole = chain.run(chain.start(100.0, seed=7), 400)[1]
    state, parts = chain.start(100.0, seed=7), []
    for count in np.diff([0, *cuts, 400]):
        state, part = chain.run(state, int(count))
        parts.append(part)
    for name, values in join(parts).items():
        scale = np.abs(whole[name]).max()
        np.testing.assert_allclose(values, whole[name], rtol=0.0, atol=1e-12 * scale)


# What a pulse does that is not on a sample is a matter of the photocell's own tests.
IN_TIME = [kind() for kind in KINDS if kind.repeats and kind.code not in ("A3", "A4", "M7", "H14")]
IN_TIME += [Saturation(3.0, 5.0), VortexShedding(lift_n_s2_m2=0.0, step_n=0.3)]


@pytest.mark.sample(7)
@pytest.mark.parametrize("effect", IN_TIME, ids=lambda effect: effect.code)
def test_the_time_domain_has_the_same_signature(effect: Effect) -> None:
    """The last cycle of a hundred, when what the water remembers of the start has died out.

    By 400 samples a period: corners, and turns between two samples, (pi/400)^2 and less.
    """
    set_point = SetPoint(0.8, 0.02, 1.2, 1.6)
    rig = vertical_rig().ideal()
    theory = effect.signature(Situation.of(rig, set_point))
    changed, nominal = (
        in_time(one, set_point, 100, 400) for one in (effect.change(rig, set_point), rig)
    )
    names = sorted({name for name, _ in theory})
    last = {name: between(changed.less(nominal), name, *nominal.edges[-2:], 1.0) for name in names}
    gap = [last[name][order] - value for (name, order), value in theory.items() if order < 5]
    assert np.linalg.norm(gap) < 1e-3 * np.linalg.norm(list(theory.values()))
