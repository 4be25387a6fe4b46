"""Angles of any size: the loop's forces against points of a rig that are differentiated as jets."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint, Pivot
from hardware.description.oscillator import Plane
from tests.exact.forces import at_rest, state
from tests.exact.hull import Loads, Motion
from tests.exact.rig import ExactBody, ExactRig
from tests.sealed.closed_forms import HEAVE, RIG, still
from tests.sealed.generator.arranged import ARRANGED, arranged
from tests.sealed.generator.effect import heavier
from tests.sealed.generator.mechanism import happen, set_run
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.rig import Run

pytestmark = pytest.mark.slow  # the time loop takes 20 s to compile

STRUTS = [
    Arrangement(*one)
    for one in product((Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG), Pivot, Gauges, DriftBy)
]
RUN = replace(HEAVE, frequency_hz=0.3, eccentricity_m=0.14, strut_phase_rad=2.0,
              carriage_speed_m_s=1.2, periods=2)  # fmt: skip


def _model(plane: Plane) -> FloatArray:
    p = still()
    heavier(p, 4e4)  # a shaft that the load does not move: the oracle's turns evenly
    p[P.CG_X] = 0.03
    p[P.SURGE_UU] = -5.5
    p[P.ADDED_01], p[P.ADDED_10], p[P.DAMPING_01], p[P.DAMPING_10] = 3.0, -4.0, 25.0, -45.0
    if plane is Plane.HORIZONTAL:
        p[P.AFT_SIGN] = p[P.INCIDENCE] = -1.0
        p[P.GRAVITY] = 0.0
        p[P.RESTORING_00] = p[P.RESTORING_11] = 0.0
    else:
        p[P.CG_Z] = 0.02
    return p


def _hull(p: FloatArray, motion: Motion) -> Loads:
    v, r, z, angle = ("w", "q", "z", "theta") if "w" in motion else ("v", "r", "y", "psi")
    rows = []
    for row in (0, 2):
        load = np.zeros_like(motion["u"])
        for first, pair in ((P.ADDED_00, (f"{v}dot", f"{r}dot")), (P.DAMPING_00, (v, r)),
                            (P.RESTORING_00, (z, angle))):  # fmt: skip
            for column, name in enumerate(pair):
                load = load - p[first + row + column] * motion[name]
        rows.append(load)
    return p[P.SURGE_UU] * motion["u"] * np.abs(motion["u"]), rows[0], rows[1]


def _rig(plane: Plane, one: Arrangement, p: FloatArray, run: Run, drift_rad: float) -> ExactRig:
    e, wet = run.eccentricity_m, run.medium == "water"
    body = ExactBody(
        float(p[P.MASS]), float(p[P.INERTIA]), float(p[P.CG_X]), float(p[P.CG_Z]),
        float(p[P.MASS]) if wet else 0.0, float(p[P.CG_X]), 0.0,
    )  # fmt: skip
    coordinates = np.array([[0.0, 0.0], [e, e * np.exp(1j * run.strut_phase_rad)]])

    def hull(motion: Motion) -> Loads:
        none = np.zeros_like(motion["u"])
        return _hull(p, motion) if wet else (none, none, none)

    return ExactRig(coordinates, run.frequency_hz, run.carriage_speed_m_s, drift_rad, plane,
                    0.5, one, body, hull)  # fmt: skip


def _agree(plane: Plane, one: Arrangement, run: Run, drift_rad: float) -> None:
    p = arranged(_model(plane), one.joint, one.pivot, one.gauges)
    p = set_run(p, replace(run, drift_rad=drift_rad, drift_by=one.drift_by))
    truth = happen(p, replace(run, drift_rad=drift_rad, drift_by=one.drift_by),
                   replace(RIG, sample_rate_hz=200.0), settling=0.5)  # fmt: skip
    rig = _rig(plane, one, p, run, drift_rad)
    expected = state(rig, truth.samples[0]).readings
    if run.medium == "air":
        expected = expected - at_rest(rig)[:, None]
    largest = np.abs(expected[:2]).max()
    assert np.abs(truth.samples[3:5] - expected[:2]).max() < 3e-4 * largest
    assert np.abs(state(rig, truth.samples[0]).motion["r" if plane is Plane.HORIZONTAL else "q"]
                  ).max() > 0.3  # fmt: skip


@pytest.mark.parametrize("one", STRUTS, ids=lambda a: "-".join(vars(a).values()))
def test_yaw_at_any_drift(one: Arrangement) -> None:
    for drift_rad in (0.0, 0.15):
        _agree(Plane.HORIZONTAL, one, RUN, drift_rad)


@pytest.mark.parametrize("medium", ["water", "air"])
@pytest.mark.parametrize("one", [a for a in STRUTS if a.drift_by is DriftBy.RIG_TURNED],
                         ids=lambda a: "-".join(vars(a).values()))  # fmt: skip
def test_pitch_with_its_weight(one: Arrangement, medium: str) -> None:
    _agree(Plane.VERTICAL, one, replace(RUN, medium=medium), 0.0)  # type: ignore[arg-type]


@pytest.mark.sample(2)
@pytest.mark.parametrize("medium", ["water", "air"])
@pytest.mark.parametrize("plane", Plane)
def test_stiff_gauges_read_what_rigid_ones_do(plane: Plane, medium: str) -> None:
    """What is left is the gauges' own give: half of it with twice the stiffness."""
    for joint, pivot, gauges in ARRANGED:
        p = arranged(_model(plane), joint, pivot, gauges)
        run = replace(RUN, medium=medium, eccentricity_m=0.07)  # type: ignore[arg-type]
        rigid = happen(p, run, RIG, settling=0.5)
        off = [np.abs(happen(_on_springs(p, k), run, RIG, settling=0.5).samples[3:5, rigid.before:]
                      - rigid.samples[3:5, rigid.before:]).max() for k in (1e6, 2e6)]  # fmt: skip
        largest = np.abs(rigid.samples[3:5]).max()
        assert off[1] == pytest.approx(0.5 * off[0], rel=0.1)
        assert off[0] < 5e-3 * largest


def _on_springs(p: FloatArray, stiffness: float) -> FloatArray:
    q = p.copy()
    q[P.GAUGE_STIFFNESS], q[P.GAUGE_DAMPING] = stiffness, 2e4
    return q


def test_angles_are_large() -> None:
    assert math.degrees(math.atan(0.14 / 0.5 * math.sin(1.0))) > 13.0
