"""Oracle: sweeps over whole blocks in NumPy; and each law's array form."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hardware.description.motor import Cogging, Guides, Servo
from hardware.description.setpoint import SetPoint
from sim.coupled import stage, steady_state
from sim.model import hull
from sim.model import hull_steady_state as hull_steady
from sim.model.compiled_laws import law_force
from sim.model.force_law import ForceLaw
from sim.model.forces import Instants, ModelMotion, law_forces
from sim.model.friction import Coulomb, LoadFriction, RubbingSpring, Stribeck
from sim.model.law_point import Acting, Point
from sim.model.law_table import has_number, table_of
from sim.model.laws import (
    LAWS,
    Cubic,
    Exponential,
    Power,
    Proximity,
    Quadratic,
    Spring,
    Stiffening,
    Tone,
    Viscous,
)
from sim.model.mounting import Mounting
from sim.model.water.force_laws import CrossFlow, SurgeForces
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run
from sim.solve import compilation

EXAMPLES: list[ForceLaw] = [
    Viscous(3.0),
    Quadratic(200.0, 0.02),
    Cubic(90.0),
    Spring(5.0, 30.0, 400.0, 2.0),
    Proximity(3.0, 0.3, 2.0, 1.2),
    Exponential(3.0, 8.0),
    Tone(2.0, 1.7, 0.3, 4.0),
    Coulomb(0.5, 0.1),
    Stribeck(0.4, 0.02),
    LoadFriction(0.02, 3.0, 0.7),
    RubbingSpring(4.0),
    Power(2.0, 0.1, 1.5, 0.02),
    Stiffening(2.0, 0.02, 2.5),
    Stiffening(2.0, 0.02, 1.5, even=True),
    Coulomb(0.5, film_m_s=5e-3),
    Stribeck(0.4, 0.02, tail=3.0),
]
BRISTLES: list[ForceLaw] = [
    Coulomb(0.5, 0.1, presliding_m=1e-3),
    Stribeck(0.4, 0.02, presliding_m=1e-3),
    LoadFriction(0.02, 3.0, 0.7, presliding_m=1e-3),
]
CROSS_FLOW = CrossFlow(((30.0, 5.0, 7.0, 2.0), (4.0, 6.0, 3.0, 9.0)), ((80.0, 9.0, 8.0, 7.0),) * 2)
SET_POINT = SetPoint(0.9, 0.03, 0.8, 1.1)


def test_every_numbered_law_has_an_example() -> None:
    assert list(dict.fromkeys(type(one) for one in EXAMPLES)) == list(LAWS)
    assert all(has_number(one) for one in EXAMPLES)


@pytest.mark.slow
@settings(deadline=None)
@given(
    st.sampled_from([None, *EXAMPLES, *BRISTLES]),
    st.sampled_from(Point),
    st.lists(st.floats(-0.1, 0.1), min_size=6, max_size=6),
    st.floats(-50.0, 50.0),
)
def test_a_compiled_law_is_its_array_form(
    law: ForceLaw | None, point: Point, motion: list[float], load: float
) -> None:
    laws = (Acting(law, point),) if law else ()
    rig = replace(
        vertical_rig(), cross_flow=CROSS_FLOW, surge=SurgeForces(-3.0, -5.0, 4.0, 2.0, 1.0)
    )
    hull = rig.chain(replace(SET_POINT, drift_rad=0.1)).stage("hull")
    system = hull.system  # type: ignore[attr-defined]
    row = np.array([[*motion, load, -0.4 * load]])
    instants = Instants(np.array([1.3]), 0.005, np.array([1.0]))
    at_struts = ModelMotion(*np.split(row, 4, 1))
    expected = law_forces(laws, system.numbers, system, at_struts, instants)[0]
    found = np.zeros((1, 2))
    table = table_of(laws, system)
    along = law_force(table.laws, table.hull, row, 0, 1.3, 0.005, 1.0, found, 0)
    np.testing.assert_allclose([*found[0], along], expected, rtol=1e-11, atol=1e-11)


def _loaded(rig: SimulatedRig, laws: tuple[Acting, ...]) -> SimulatedRig:
    motor = Servo(cogging=(Cogging(3, 0.5),), guides=Guides(1.0, 2.0))
    return replace(
        rig,
        forces=laws,
        cross_flow=CROSS_FLOW,
        mounting=Mounting(2e5, 300.0, 1e6, 4000.0),
        drive=replace(rig.drive, motor=motor),
    )


@pytest.mark.slow
@settings(deadline=None, max_examples=6)
@example(BRISTLES, True, True)
@given(st.lists(st.sampled_from(BRISTLES + EXAMPLES), max_size=3), st.booleans(), st.booleans())
def test_march_gives_what_sweeps_do(laws: list[ForceLaw], motor: bool, cranks: bool) -> None:
    rig = _loaded(horizontal_rig(0.8 if cranks else None), tuple(Acting(one) for one in laws))
    # Bristles push by the acceleration, too: sweeps do not settle them while a start is slow.
    ramp_s = 0.0 if any(one in BRISTLES for one in laws) else 1.0
    drive = replace(rig.drive, start_ramp_s=ramp_s)
    rig = replace(rig, drive=drive if motor else replace(drive, motor=None))
    found = []
    with pytest.MonkeyPatch.context() as patch:
        for swept in (False, True):
            if swept:
                patch.setattr(hull, "marching_of", lambda *_: None)
                patch.setattr(stage, "coupled_march", lambda *_: None)
            chain = rig.chain(SET_POINT)
            found.append(chain.run(chain.start(200.0, 1), 400)[1])
    names = ("force_aft", "force_fore", "force_x", "shaft_speed", "displacement_fore")
    for name in names:
        scale = np.abs(found[1][name]).max()
        np.testing.assert_allclose(found[0][name], found[1][name], rtol=0.0, atol=1e-10 * scale)


def test_balance_gives_what_sweeps_do(monkeypatch: pytest.MonkeyPatch) -> None:
    laws = (*(Acting(one) for one in EXAMPLES[:5]), Acting(EXAMPLES[7], Point.AFT))
    rig = replace(_loaded(vertical_rig().ideal(), laws), drive=vertical_rig().drive)
    found = steady_run(rig, SET_POINT).spectra["force_aft"]
    monkeypatch.setattr(hull_steady, "periodic_laws", lambda *_: None)
    swept = steady_run(rig, SET_POINT).spectra["force_aft"]
    np.testing.assert_allclose(found, swept, rtol=0.0, atol=1e-11 * np.abs(swept).max())


def test_laws_swept_with_the_torque_are_those_balanced_for_each_torque(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    quadratic = Acting(Quadratic(300.0), Point.TRANSLATION, in_water=True)
    rig = replace(
        vertical_rig().ideal(),
        mounting=Mounting(2e5, 300.0),
        forces=(Acting(Coulomb(0.5), Point.AFT), quadratic),
    )
    rig = replace(rig, drive=replace(rig.drive, motor=Servo()))
    together = steady_run(rig, SetPoint(1.0, 0.02, 0.7)).spectra
    monkeypatch.setattr(steady_state, "_with_swept_laws", lambda *_: None)
    nested = steady_run(rig, SetPoint(1.0, 0.02, 0.7)).spectra
    for name in ("shaft_speed", "force_aft", "force_fore", "load_torque"):
        scale = np.abs(nested[name]).max()
        np.testing.assert_allclose(together[name], nested[name], rtol=0.0, atol=1e-10 * scale)


def test_laws_of_ones_own_are_swept_around_the_march() -> None:
    class Doubled(Quadratic):
        pass

    rig = replace(vertical_rig().ideal(), mounting=Mounting(2e5, 300.0))
    runs = []
    for law in (Doubled(300.0), Quadratic(300.0)):
        chain = replace(rig, forces=(Acting(law), Acting(Coulomb(0.5)))).chain(SET_POINT)
        runs.append(chain.run(chain.start(200.0, 1), 400)[1]["force_aft"])
    assert not has_number(Doubled(300.0))
    np.testing.assert_allclose(runs[0], runs[1], rtol=0.0, atol=1e-10 * np.abs(runs[1]).max())


def test_compiled_loops_are_kept_apart_for_every_change_of_their_sources(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A loop keeps what it calls, of which numba does not see that it has changed."""
    package = tmp_path / "sim"
    package.mkdir()
    monkeypatch.setattr(compilation, "__file__", str(package / "solve" / "compilation.py"))
    folders = []
    for called, other in (("1.0", "a"), ("2.0", "a"), ("2.0", "b")):
        (package / "law.py").write_text(f"@compile_loop\ndef law(): return {called}\n")
        (package / "other.py").write_text(f"name = {other!r}\n")
        folders.append(compilation.cache_folder.__wrapped__(""))
    assert folders[0].parent == package / "__pycache__"
    assert folders[0] != folders[1] == folders[2]
    assert compilation.cache_folder.__wrapped__(str(tmp_path)).parent == tmp_path
