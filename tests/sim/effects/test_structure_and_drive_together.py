"""Several effects at once: small ones add up, and any of them go together."""

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import SetPoint
from sim.effects.agreement import phasor
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect
from sim.effects.situation import Situation
from sim.effects.switching import switch_on
from sim.rig import vertical_rig
from sim.run import steady_run

SET_POINT = SetPoint(0.7, 0.03, 1.0)
KEYS = [(name, order) for name in ("force_aft", "force_fore") for order in range(6)]


def own(text: str) -> list[Effect]:
    return [kind() for kind in catalogue().values() if kind.code[0] in text]


# A motor, a gear, joints on springs and an entirely different linkage change what the others start
# from.
SMALL = [one for one in own("DKS") if one.code not in ("D1b", "D2", "D3", "D4", "K1", "K6b")]


def test_small_effects_add_up() -> None:
    rig = vertical_rig().ideal()
    situation = Situation.of(rig, SET_POINT)
    stated = np.zeros(len(KEYS), dtype=complex)
    for effect in SMALL:
        theory = effect.signature(situation)
        stated += [theory.get(key, 0.0) for key in KEYS]
    nominal = steady_run(rig, SET_POINT)
    changed = steady_run(*switch_on(SMALL, rig, SET_POINT))
    found = np.array([phasor(changed, *key) - phasor(nominal, *key) for key in KEYS])
    # Each by itself changes the forces by up to a few percent: so much they change each other.
    assert np.linalg.norm(found - stated) < 0.05 * np.linalg.norm(stated)


# Where teeth meet is solved sample by sample with the load, which friction in a joint cannot be.
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("groups", "without"), [("D", ""), ("DKS", "D4"), ("K", ""), ("S", ""), ("DKS", "K6")]
)
def test_all_go_together(groups: str, without: str) -> None:
    effects = [one for one in own(groups) if one.code != without]
    rig, set_point = switch_on(effects, vertical_rig().ideal(), SET_POINT)
    chain = rig.chain(set_point)
    _, run = chain.run(chain.start(200.0, 0), 1500)
    steady = steady_run(rig, set_point)
    assert all(np.isfinite(values).all() for values in run.values())
    real_hz = steady.period.frequency_hz
    last = run["force_aft"][-round(200.0 / real_hz) :]
    turned = np.exp(-2j * np.pi * real_hz / 200.0 * np.arange(last.size))
    first = 2.0 * abs(np.mean(last * turned))
    # The last period holds no whole number of samples, and a soft motor may still swing a little.
    assert first == pytest.approx(abs(steady.spectra["force_aft"][1]), rel=0.02)


def test_a_gear_with_backlash_says_what_it_cannot_go_with() -> None:
    both = [one for one in own("DK") if one.code in ("D4", "K6")]
    rig, set_point = switch_on(both, vertical_rig().ideal(), SET_POINT)
    chain = rig.chain(set_point)
    with pytest.raises(ConfigurationError, match="leave out play that friction holds"):
        chain.run(chain.start(200.0, 0), 10)
