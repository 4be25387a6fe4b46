"""Limits, advice, durations: each against its formula, on both sides of its bound."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.kinds import RunKind
from hardware.description.known_loads import LoadStep
from hardware.description.lines import Line
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963
from hardware.description.setpoint import Medium
from hardware.rig_configuration import RigConfiguration, read_rig
from pmm.plan.checks import check_plan, require_possible
from pmm.plan.duration import duration_rows, run_s, tank_length_m
from pmm.plan.field_checks import field_findings, tank_modes_hz
from pmm.plan.findings import PlanFinding, PlanRefusedError, PlanVerdict
from pmm.plan.limits import bus_finding, limit_findings
from pmm.plan.motion_peaks import acceleration_peak_m_s2, velocity_peak_m_s
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import Gauge, Limits, StructuralMode, TankTable
from pmm.plan.run_plan import RunPlan
from tests.pmm.plan.plans import rig_file, run

G = 9.80665


def _only(found: list[PlanFinding], quantity: str) -> PlanFinding:
    (one,) = [finding for finding in found if finding.quantity == quantity]
    return one


def _refused(one: RunPlan, rig: RigFile) -> list[PlanFinding]:
    return [finding for finding in limit_findings(one, rig) if finding.verdict == "refuse"]


# The rig of the tests, the run at its bound, and just beyond it: quantity, value, limit.
BOUNDS: list[tuple[dict[str, Any], dict[str, Any], str, float, float]] = [
    ({"amplitude_m": 0.06}, {"amplitude_m": 0.061}, "stroke [m]", 0.122, 0.12),
    (
        {"frequency_hz": 1.0, "amplitude_m": 0.02},
        {"frequency_hz": 1.0, "amplitude_m": 0.022},
        "strut velocity [m/s]",
        2.0 * math.pi * 0.022,
        0.13,
    ),
    (
        {"frequency_hz": 1.0, "amplitude_m": 0.025},
        {"frequency_hz": 1.0, "amplitude_m": 0.026},
        "strut acceleration [m/s^2]",
        4.0 * math.pi**2 * 0.026,
        1.0,
    ),
]


@pytest.mark.parametrize(("within", "beyond", "quantity", "value", "limit"), BOUNDS)
def test_the_motion_s_limits(
    within: dict[str, Any], beyond: dict[str, Any], quantity: str, value: float, limit: float
) -> None:
    key = {"stroke": "stroke_m", "strut v": "velocity_m_s", "strut a": "acceleration_m_s2"}
    name = next(one for start, one in key.items() if quantity.startswith(start))
    rig = rig_file(limits=Limits(**{name: limit}))
    assert not _refused(run(**{"frequency_hz": 0.3, **within}), rig)
    one = _only(_refused(run(**{"frequency_hz": 0.3, **beyond}), rig), quantity)
    assert (one.value, one.limit) == (pytest.approx(value), limit)
    assert f"= {value:.4g} is above {limit:.4g}" in one.message


def test_frequency_and_amplitude_of_oscillator_and_drives() -> None:
    rig = rig_file(limits=Limits())
    for frequency, limit in ((2.1, 2.0), (0.05, 0.1)):
        (one,) = [
            one
            for one in _refused(run(frequency, 1e-3), rig)
            if "oscillator" in one.message and one.quantity == "frequency [Hz]"
        ]
        assert (one.value, one.limit) == (frequency, limit)
    by_axis = [one.message for one in _refused(run(amplitude_m=0.07), rig)]
    assert any("0.07 is above 0.06 (the eccentricity's axis)" in one for one in by_axis)
    one = _only(_refused(run(phase_rad=3.3), rig), "strut phase [rad]")
    assert (one.value, one.limit) == (3.3, 3.2)


def test_the_way_of_the_carriage() -> None:
    """13 periods, one for the pulse, 15 cycles to wait, 1 Hz/s of the shaft, 0.5 m/s^2 twice."""
    rig = rig_file()
    one = run(0.5, speed_m_s=2.0)
    way = 2.0 * (14 / 0.5 + 0.15 + 0.5 / 1.0 + 2.0 / 0.5)
    assert tank_length_m(one, rig) == pytest.approx(way)
    assert not _refused(one, rig)
    short = rig_file(tank=TankTable(way - 0.1, 4.0, 0.5, 4.0))
    finding = _only(_refused(one, short), "tank length [m]")
    assert (finding.value, finding.limit) == (pytest.approx(way), way - 0.1)
    fast = _only(_refused(run(speed_m_s=4.5), rig), "speed [m/s]")
    assert (fast.value, fast.limit) == (4.5, 4.0)
    tow = replace(one, kind=RunKind.STRAIGHT_TOW, set_point=replace(one.set_point, frequency_hz=0),
                  duration_s=20.0)  # fmt: skip
    assert tank_length_m(tow, rig) == pytest.approx(2.0 * (20.0 + 0.15 + 4.0))


def test_a_mass_in_air_needs_half_its_inertia_at_each_strut() -> None:
    rig = rig_file(gauges=(Gauge("force_aft", 17.6),), limits=Limits())
    air = run()
    air = replace(air, kind=RunKind.DRY, set_point=replace(air.set_point, medium=Medium.AIR))
    expected = 70.0 / 2.0 * (2.0 * math.pi * 0.8) ** 2 * 0.02
    assert expected > 17.6
    one = _only(_refused(air, rig), "gauge force, estimate [N]")
    assert one.value == pytest.approx(expected)
    wide = rig_file(gauges=(Gauge("force_aft", 1.1 * expected),), limits=Limits())
    (warning,) = limit_findings(air, wide)
    assert (warning.verdict, warning.limit) == ("warn", pytest.approx(0.88 * expected))
    oscillator = replace(VERTICAL_1963, force_per_strut_n=15.0)
    struts = _refused(air, rig_file(oscillator, gauges=(), limits=Limits()))
    assert _only(struts, "strut force, estimate [N]").limit == 15.0


def test_a_load_beyond_its_gauge() -> None:
    one = replace(run(0.0, 0.0), kind=RunKind.CHECK_WEIGHT, load=LoadStep("force_fore", 501.0))
    finding = _only(_refused(one, rig_file()), "load on force_fore [N]")
    assert (finding.value, finding.limit) == (501.0, 500.0)


def test_the_bus_load_is_told() -> None:
    (one,) = bus_finding(rig_file())
    # Counted by hand: 3 drives with 2 TPDOs and 1 RPDO each, and the shaft's probe, at 100 Hz.
    assert one.verdict == "note"
    assert 0.0 < one.value < one.limit == 0.7
    assert not list(bus_finding(rig_file(hardware=read_rig({}))))


@given(st.floats(0.1, 0.9), st.floats(0.0, 2.0 * math.pi))
def test_no_instant_of_a_crank_is_faster_than_its_peaks(ratio: float, angle: float) -> None:
    e, rod, omega = 0.3 * ratio, 0.3, 2.0
    oscillator = replace(HORIZONTAL_1963, rod_length_m=rod)
    one = run(omega / (2.0 * math.pi), e)
    h = 1e-4

    def d(theta: float) -> float:
        return e * math.sin(theta) + math.sqrt(rod**2 - (e * math.cos(theta)) ** 2) - rod

    velocity = omega * (d(angle + h) - d(angle - h)) / (2.0 * h)
    assert abs(velocity) <= velocity_peak_m_s(one, oscillator) * (1.0 + 1e-5)
    top = omega**2 * abs(d(math.pi / 2 + h) - 2.0 * d(math.pi / 2) + d(math.pi / 2 - h)) / h**2
    assert acceleration_peak_m_s2(one, oscillator) == pytest.approx(top, rel=1e-5)


def test_transverse_modes_have_the_wavelengths_of_the_tank() -> None:
    deep = tank_modes_hz(TankTable(100.0, 4.0, 0.5, 4.0))
    # omega^2 = g k with the wavelength 2 W / n, so f^2 = g / (2 pi lambda).
    for n, mode in enumerate(deep, 1):
        assert mode**2 == pytest.approx(G / (2.0 * math.pi * (8.0 / n)))
    shallow = tank_modes_hz(TankTable(100.0, 4.0, 0.5, 4.0, depth_m=0.01))
    assert shallow[0] == pytest.approx(math.sqrt(G * 0.01) / 8.0, rel=1e-4)
    at = [f for f in field_findings(run(1.01 * deep[1]), rig_file()) if "tank" in f.quantity]
    assert [(f.verdict, f.value) for f in at] == [("warn", pytest.approx(0.01))]
    assert "mode 2" in at[0].message
    towed = field_findings(run(deep[1], speed_m_s=0.1), rig_file())
    assert [f.verdict for f in towed if "tank" in f.quantity] == ["note"]
    between = run(math.sqrt(deep[1] * deep[2]))
    assert not [f for f in field_findings(between, rig_file()) if "tank" in f.quantity]


def test_harmonics_near_a_structural_mode() -> None:
    rig = rig_file(modes=(StructuralMode("yaw of the frame", 4.0),))
    found = {
        f: [one.verdict for one in field_findings(run(f, 1e-3), rig) if "struct" in one.quantity]
        for f in (1.3, 0.85, 1.7, 1.9)
    }
    # 3 x 1.3 = 3.9; 5 x 0.85 = 4.25; 2 x 1.7 = 3.4 and 3 x 1.7 = 5.1; 2 x 1.9 = 3.8.
    assert found == {1.3: ["warn"], 0.85: ["note"], 1.7: [], 1.9: ["warn"]}
    damped = rig_file(modes=(StructuralMode("a", 4.0, damping_ratio=0.06),))
    assert [f.limit for f in field_findings(run(1.7, 1e-3), damped)] == [pytest.approx(0.18)]


def test_cycles_and_samples() -> None:
    rig = rig_file()
    few = field_findings(replace(run(0.82), periods=2, settling_periods=0), rig)
    assert [(f.quantity, f.value, f.limit) for f in few] == [
        ("periods after the transient", 2.0, 3.0),
        ("settling periods", 0.0, 1.0),
    ]
    slow = rig_file(hardware=RigConfiguration(cycle_rate_hz=12.0))
    (one,) = [f for f in field_findings(run(1.01), slow) if "6th" in f.quantity]
    assert (one.value, one.limit) == (pytest.approx(6.06), 6.0)


def _many(base_hz: float, orders: tuple[int, ...], speed_m_s: float = 0.0) -> RunPlan:
    one = run(base_hz, 1e-3, speed_m_s=speed_m_s)
    lines = tuple(Line(order, 1.0 / len(orders)) for order in orders)
    return replace(one, set_point=replace(one.set_point, lines=lines))


def test_each_of_many_lines_is_looked_at() -> None:
    """Lines at 0.5 and 0.8 Hz; the base of 0.05 Hz is none of them, and has nothing near it."""
    path = _many(0.05, (10, 16))
    # 3 x 0.8 = 2.4 Hz; 1 x 0.5 and 6 x 0.05 = 0.3 Hz; 5 x 0.8 = 4 Hz is a note.
    frame = (StructuralMode("a", 2.45), StructuralMode("b", 0.3), StructuralMode("c", 4.0))
    found = [f for f in field_findings(path, rig_file(modes=frame)) if "struct" in f.quantity]
    assert [(f.verdict, f.value) for f in found] == [
        ("warn", pytest.approx(0.05 / 2.45)),
        ("note", pytest.approx(0.0, abs=1e-12)),
    ]
    assert (
        "harmonic 3 of the line at 0.8 Hz at 2.4 Hz is -2.0% off the mode 'a'" in found[0].message
    )
    slow = rig_file(hardware=RigConfiguration(cycle_rate_hz=9.0))
    (one,) = [f for f in field_findings(path, slow) if "6th" in f.quantity]
    assert (one.value, one.limit) == (pytest.approx(4.8), 4.5)
    # A tank whose second mode, of the wavelength W, is at 0.8 Hz; the line of 0.5 Hz is at none.
    tank = TankTable(100.0, G / (2.0 * math.pi * 0.8**2), 0.5, 4.0)
    at = [f for f in field_findings(path, rig_file(tank=tank)) if "tank" in f.quantity]
    assert [(f.verdict, "mode 2" in f.message) for f in at] == [("warn", True)]


def test_the_time_of_a_run_is_the_sum_of_its_parts() -> None:
    rig = rig_file()
    first = run(0.5, 0.02, speed_m_s=2.0, pause_before_s=60.0)
    ramps = 2.0 * (0.5 / 1.0 + 2.0 / 0.5)
    still = 14 / 0.5 + 0.15  # 15 cycles behind the gate, at 100 Hz
    back = tank_length_m(first, rig) / 2.0
    # Axes: 20 mm at 5 mm/s and 50 mm/s^2; then half a turn at 0.2 rad/s and 1 rad/s^2.
    setting = 0.02 / 0.005 + 0.005 / 0.05
    assert run_s(first, None, rig) == pytest.approx(60.0 + setting + still + ramps + back)
    second = run(0.5, 0.02, math.pi)
    turned = math.pi / 0.2 + 0.2 / 1.0
    times = duration_rows((first, second), rig)
    assert times[1] == pytest.approx(turned + still + 1.0)
    near = run(0.5, 0.0201)
    tiny = 2.0 * math.sqrt(0.0001 / 0.05)
    assert run_s(near, run(0.5, 0.02), rig) == pytest.approx(tiny + still + 1.0)


def _plan(*runs: RunPlan) -> Plan:
    return Plan("a", Path("plan.toml"), Path("rig.toml"), runs, "", "0")


def test_a_plan_beyond_the_rig_is_refused_with_every_run_value_and_limit() -> None:
    good, fast, wide = (
        run(0.9, name="good"),
        run(2.4, 1e-3, name="fast"),
        run(0.3, 0.1, name="wide"),
    )
    assert require_possible(_plan(good), rig_file())
    with pytest.raises(PlanRefusedError) as caught:
        require_possible(_plan(good, fast, wide), rig_file())
    message = str(caught.value)
    assert "fast: frequency [Hz] = 2.4 is above 2 (oscillator)" in message
    assert "wide: stroke [m] = 0.2 is above 0.12 (limits.stroke_m)" in message
    assert "good:" not in message
    assert caught.value.exit_status == 1


def test_a_path_beyond_the_rig_is_refused_at_its_place() -> None:
    """Two lines whose fastest instant is known: both at once, a quarter into the period, aft."""
    lines = (Line(1, 0.5, math.pi), Line(3, 0.5, math.pi, strut_phase_rad=0.1))
    fast = run(0.5, 0.05, name="fast")
    path = replace(fast, set_point=replace(fast.set_point, lines=lines))
    limits = replace(rig_file().limits, velocity_m_s=0.3, acceleration_m_s2=None)
    with pytest.raises(PlanRefusedError) as caught:
        require_possible(_plan(path), replace(rig_file(), limits=limits))
    largest = math.pi * 0.05 * (0.5 + 1.5)
    assert f"= {largest:.4g} is above 0.3 (of a strut: aft, 0 s into the period)" in str(
        caught.value
    )


def test_what_cannot_be_checked_is_said() -> None:
    bare = RigFile(
        path=Path("rig.toml"), sha256="0", oscillator=VERTICAL_1963, hardware=read_rig({})
    )
    found = check_plan(_plan(run(speed_m_s=1.0)), bare)
    missing = [f.message for f in found if f.quantity == "not checked"]
    for table in ("[model]", "model.length_m", "[tank]", "[[modes]]", "[[gauges]]", "limits.vel"):
        assert any(table in one for one in missing)
    assert all(math.isnan(f.value) for f in found if f.quantity == "not checked")
    whole = check_plan(_plan(run(0.82)), rig_file(modes=(StructuralMode("a", 30.0),)))
    assert [f.quantity for f in whole] == ["bus load"]
    ranks = [list(PlanVerdict).index(f.verdict) for f in found]
    assert ranks == sorted(ranks)
    assert np.isfinite([f.value for f in whole]).all()
