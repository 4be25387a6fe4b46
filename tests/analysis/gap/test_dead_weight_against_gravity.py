"""Oracle: a weight that is lifted and lowered once a turn; no other torque has that order."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.forward.dead_weight import with_dead_weight
from analysis.gap.observe.components import GapRun
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.catalogue import build
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.run import steady_run


@pytest.mark.parametrize("medium", list(Medium))
@pytest.mark.parametrize("dead_weight_n", [0.0, 80.0])
def test_shaft_lifts_what_hangs_on_it_once(
    rig: SimulatedRig, clean: tuple[GapRun, ...], medium: Medium, dead_weight_n: float
) -> None:
    set_point = SetPoint(0.5, 0.02, medium=medium)
    run = replace(clean[0], set_point=set_point, preload_n=dead_weight_n)
    unmoved = build("load-ripple:inertia_kg_m2=1e6,hold_hz=0.001")
    weighted = with_dead_weight((unmoved,), rig, run)
    on_rig, to_run = switch_on(*weighted, set_point, run.place)
    steady = steady_run(on_rig, to_run)
    hanging_n = 9.80665 * rig.body.mass_kg if medium is Medium.AIR else 0.0  # else it floats
    lifted_n_m = -hanging_n * 0.02 + dead_weight_n * 0.02 * _side(weighted[1], set_point)
    assert steady.spectra["load_torque"][1] == pytest.approx(lifted_n_m, abs=2e-3, rel=1e-3)


def _side(rig: SimulatedRig, set_point: SetPoint) -> float:
    """Return which way the weight pulls, from what both gauges read of it."""
    total = sum(
        steady_run(rig, set_point).spectra[f"force_{end}"][0].real for end in ("aft", "fore")
    )
    return float(np.sign(total)) if rig.forces else 0.0
