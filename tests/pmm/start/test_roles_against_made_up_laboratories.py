"""``pmm init campaign`` on recordings whose truth is known: of laboratories that never were."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pmm.start.found_campaign import CHANNELS, FoundCampaign
from pmm.start.recordings import find_campaign
from tests.pmm.start.laboratories import NAMES, STYLES, Laboratory, laboratory, write

STRUTS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")
RIGS = (
    STRUTS,
    (*STRUTS, "shaft_angle", "carriage_speed", "photocell"),
    ("force_aft", "force_fore"),
    ("displacement_aft", "force_aft"),
    ("shaft_angle", "force_aft", "force_fore", "carriage_speed"),
    ("force_aft",),
)
BESIDES = ("Roll", "Tension", "WP_1", "WP_2", "Temperature", "Acceleration", "Spare", "Reserve",
           "Moment", "Position", "Counter", "Hum")  # fmt: skip


def taken(found: FoundCampaign, *, sure: bool = True) -> dict[str, str]:
    """Return the column of each channel that is sure, or of each that is not."""
    return {
        one.name: one.column
        for one in found.columns
        if one.name in CHANNELS and bool(one.doubt) != sure
    }


def some_laboratory(seed: int, folder: Path) -> tuple[Laboratory, Path, bool]:
    rng = np.random.default_rng(seed)
    language = str(rng.choice(list(NAMES)))
    sensors = RIGS[int(rng.integers(len(RIGS)))]
    besides = tuple(str(one) for one in rng.choice(BESIDES, rng.integers(0, 6), replace=False))
    made = laboratory(rng, language, sensors, besides)
    bare = tuple(made.columns) if rng.uniform() < 0.2 else ()
    path = write(
        made,
        folder / "run.csv",
        rng,
        bare=bare,
        style=int(rng.integers(len(STYLES))),
        comma=bool(rng.integers(2)),
        missing=0.001 if rng.uniform() < 0.3 else 0.0,
    )
    return made, path, bool(bare)


@pytest.mark.slow
def test_what_is_sure_is_right_and_what_the_header_says_is_sure(tmp_path: Path) -> None:
    count: Counter[str] = Counter()
    for seed in range(40):
        made, path, bare = some_laboratory(seed, tmp_path)
        found = find_campaign([path], tmp_path)
        (run,) = found.runs
        assert run.doubt == "", seed
        assert run.frequency_hz == pytest.approx(made.frequency_hz, rel=2e-3), seed
        for channel, column in taken(found).items():
            count["right" if made.truth.get(channel) == column else "wrong"] += 1
        if not bare:
            count["had"] += len(made.truth)
            count["found"] += len(made.truth.keys() & taken(found).keys())
    assert count["wrong"] == 0
    assert count["found"] == count["had"] > 80


@pytest.mark.slow
def test_the_set_point_is_what_the_struts_did(tmp_path: Path) -> None:
    for seed in range(8):
        rng = np.random.default_rng([7, seed])
        made = laboratory(rng, "german", (*STRUTS, "carriage_speed"))
        found = find_campaign([write(made, tmp_path / "run.csv", rng)], tmp_path)
        (run,) = found.runs
        assert run.eccentricity_mm == pytest.approx(1e3 * made.eccentricity_m, rel=0.02)
        assert run.strut_phase_deg == pytest.approx(made.strut_phase_deg, abs=1.0)
        assert run.carriage_speed_m_s == pytest.approx(made.speed_m_s, rel=1e-3)
        assert run.remarks == {}


def test_what_the_model_has_of_its_own_is_told_by_name_and_unit(tmp_path: Path) -> None:
    rng = np.random.default_rng(8)
    time_s = np.arange(4000) / 100.0
    swing = np.sin(2.0 * np.pi * 0.25 * time_s)
    noise = rng.standard_normal((13, 4000))
    struts = [200.0 * swing, 200.0 * swing, 30.0 * swing + noise[0], 25.0 * swing + noise[1]]
    own = {
        "Ruderwinkel [deg]": 10.0 + 1e-3 * noise[2],
        "Ruder Normalkraft [N]": 12.0 + 2.0 * swing + 0.1 * noise[3],
        "Propellerschub [N]": 40.0 + 0.5 * swing + 0.1 * noise[4],
        "Drehmoment [N m]": 1.2 + 1e-3 * noise[5],
        "Drehzahl [rpm]": 600.0 + 0.1 * noise[6],
        "Absenkung hinten [mm]": 9.0 + 0.2 * noise[7],
        "Absenkung vorn [mm]": 4.0 + 0.2 * noise[8],
        "Rollmoment [N m]": 3.0 * swing + 0.05 * noise[9],
        "Krängung [deg]": 10.0 + 1e-3 * noise[10],
    }
    rows = np.stack((time_s, *struts, *own.values()), axis=1)
    names = "Zeit [s],Weg hinten [mm],Weg vorn [mm],Kraft hinten [N],Kraft vorn [N]"
    path = tmp_path / "run.csv"
    np.savetxt(path, rows, "%.6f", ",", header=",".join((names, *own)), comments="")
    found = find_campaign([path], tmp_path)
    assert taken(found) == {
        "displacement_aft": "Weg hinten", "displacement_fore": "Weg vorn",
        "force_aft": "Kraft hinten", "force_fore": "Kraft vorn",
        "rudder_angle": "Ruderwinkel", "rudder_normal_force": "Ruder Normalkraft",
        "propeller_thrust": "Propellerschub", "propeller_torque": "Drehmoment",
        "revolutions": "Drehzahl", "position_aft": "Absenkung hinten",
        "position_fore": "Absenkung vorn", "roll_moment": "Rollmoment",
        "heel_angle": "Krängung",
    }  # fmt: skip
    assert not {"rudder_angle", "position_aft", "roll_moment"} & set(found.sensors)


@pytest.mark.parametrize(
    ("aft", "fore"),
    [("command_aft [m]", "command_fore [m]"), ("Weg Soll hinten [mm]", "Weg Soll vorn [mm]"),
     ("Demand aft (mm)", "Demand fore (mm)")],
)  # fmt: skip
def test_commands_stand_beside_what_was_measured_of_them(
    tmp_path: Path, aft: str, fore: str
) -> None:
    rng = np.random.default_rng(9)
    factor = 1e-3 if "[m]" in aft else 1.0
    time_s = np.arange(4000) / 100.0
    told = [200.0 * np.sin(2.0 * np.pi * 0.25 * time_s + ahead) for ahead in (0.0, 0.4)]
    held = [np.interp(time_s - 0.05, time_s, one) for one in told]
    forces = [30.0 * one / 200.0 + rng.standard_normal(4000) for one in held]
    held = [one + 0.02 * rng.standard_normal(4000) for one in held]
    rows = np.stack((time_s, *(factor * one for one in told), *held, *forces), axis=1)
    names = f"Time [s],{aft},{fore},Strut aft [mm],Strut fore [mm],F aft [N],F fore [N]"
    path = tmp_path / "run.csv"
    np.savetxt(path, rows, "%.6f", ",", header=names, comments="")
    found = taken(find_campaign([path], tmp_path))
    named = [one.rpartition(" ")[0] for one in (aft, fore)]
    assert [found["command_aft"], found["command_fore"]] == named
    assert [found["displacement_aft"], found["displacement_fore"]] == ["Strut aft", "Strut fore"]


@pytest.mark.parametrize("header", ["pos mm", "pos_mm", "pos / mm", "pos [mm]", "pos"])
def test_a_stroke_in_millimetres_is_one_of_millimetres(tmp_path: Path, header: str) -> None:
    time_s = np.arange(2000) / 100.0
    stroke = 25.0 * np.sin(2.0 * np.pi * 0.7 * time_s)
    force = 8.0 * np.cos(2.0 * np.pi * 0.7 * time_s) + 0.05 * np.cos(40.0 * time_s**2)
    rows = np.stack((time_s, force, stroke), axis=1)
    path = tmp_path / "run.csv"
    np.savetxt(path, rows, "%.6f", ",", header=f"Time [s],F [N],{header}", comments="")
    (run,) = find_campaign([path], tmp_path).runs
    assert run.eccentricity_mm == pytest.approx(25.0, rel=1e-3)


def test_forces_alone_tell_the_frequency(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    time_s = np.arange(4000) / 100.0
    swing = 40.0 * np.sin(2.0 * np.pi * 0.6998 * time_s) + 3.0 * rng.standard_normal(4000)
    np.savetxt(tmp_path / "run.csv", np.stack((time_s, swing), axis=1), "%.4f", ",",
               header="Time [s],F [N]", comments="")  # fmt: skip
    (run,) = find_campaign([tmp_path / "run.csv"], tmp_path).runs
    assert run.frequency_hz == pytest.approx(0.6998, abs=2e-4)
    assert "NOT FOUND" in run.remarks["eccentricity_mm"]


def test_a_wave_record_has_no_shaft_and_no_gauge_that_is_sure(tmp_path: Path) -> None:
    """A wave maker, a floating model that rolls, its mooring, a balance: none of a rig's."""
    rng = np.random.default_rng(5)
    made = laboratory(rng, "english", (), ("Roll", "Tension", "WP_1", "WP_2", "Moment"))
    time_s = made.columns["Time"][0]
    turns = 1.114 * time_s
    made.columns["WM_Position"] = (0.03 * np.sin(2.0 * np.pi * turns), "m")
    for name, size in (("Fx", 1.0), ("Fy", 9.0), ("Fz", 4.0)):
        rough = 0.1 * size * rng.standard_normal(turns.size)
        made.columns[name] = (size * np.sin(2.0 * np.pi * turns + size) + rough, "N")
    for name in ("Roll", "Tension", "WP_1", "WP_2", "Moment"):
        values, unit = made.columns[name]
        swing = np.cos(2.0 * np.pi * turns + len(name)) + 0.2 * rng.standard_normal(turns.size)
        made.columns[name] = (float(np.std(values)) * swing, unit)
    found = find_campaign([write(made, tmp_path / "run.csv", rng)], tmp_path)
    assert found.runs[0].frequency_hz == pytest.approx(1.114, rel=1e-3)
    assert taken(found) == {"displacement_aft": "WM_Position"}
    assert set(taken(found, sure=False).values()) <= {"Fx", "Fy", "Fz", "WP_1", "WP_2"}
    reasons = {one.column: one.doubt for one in found.columns if one.doubt}
    assert "balance's axes (x, y, z)" in reasons["Fy"]
    # What carries the line is still analysed, under its own name.
    assert {"Fy", "Fz"} <= {one.name for one in found.columns if not one.doubt}


def test_three_like_gauges_are_a_guess(tmp_path: Path) -> None:
    rng = np.random.default_rng(11)
    made = laboratory(rng, "letters", STRUTS)
    made.columns["F3"] = (1.3 * made.columns["F2"][0] + 0.1, "N")
    found = find_campaign([write(made, tmp_path / "run.csv", rng)], tmp_path)
    assert set(taken(found)) == {"displacement_aft", "displacement_fore"}
    guesses = [one.doubt for one in found.columns if one.name.startswith("force") and one.doubt]
    assert guesses == ["F3 may be it as well"] * 2


def test_records_at_rest_are_zero_runs_and_tell_the_noise(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    made = laboratory(rng, "english", (*STRUTS, "carriage_speed"))
    paths = [write(made, tmp_path / "run.csv", rng)]
    still = laboratory(rng, "english", STRUTS, running=False)
    time_s = np.arange(3000) / made.rate_hz
    still.columns = {
        name: (0.01 * rng.standard_normal(3000) if unit == "N" else 1e-5 * np.sin(time_s), unit)
        for name, (_, unit) in made.columns.items()
    }
    still.columns["Time"] = (time_s, "s")
    still.columns["Carriage speed"] = (np.zeros(3000), "m/s")
    paths.append(write(still, tmp_path / "calm.csv", rng))
    found = find_campaign(paths, tmp_path)
    assert [one.name for one in found.runs] == ["run"]
    assert [(one.name, one.kind, one.doubt) for one in found.at_rest] == [("calm", "zero", "")]
    assert found.sensors["force_aft"]["noise_rms"] == pytest.approx(0.01, rel=0.1)


def test_the_step_of_a_converter_is_found_and_none_where_there_is_none(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    made = laboratory(rng, "english", STRUTS)
    step = 400.0 / 2**14
    for name in ("Load cell aft", "Load cell fore"):
        values, unit = made.columns[name]
        made.columns[name] = (np.round(values / step) * step, unit)
    found = find_campaign([write(made, tmp_path / "run.csv", rng)], tmp_path)
    assert found.sensors["force_aft"]["resolution"] == pytest.approx(step, rel=1e-4)
    assert "resolution" not in found.sensors.get("displacement_aft", {})


def test_nothing_that_keeps_time_is_said_to_be_so(tmp_path: Path) -> None:
    rng = np.random.default_rng(6)
    rows = np.column_stack((np.arange(3000) / 100.0, rng.standard_normal((3000, 4))))
    np.savetxt(tmp_path / "run.csv", rows, "%.6f", ",",
               header="Time [s],a [N],b [N],c [mm],d [deg]", comments="")  # fmt: skip
    found = find_campaign([tmp_path / "run.csv"], tmp_path)
    assert found.runs[0].doubt
    assert taken(found) == {}


@pytest.mark.slow
@settings(
    deadline=None,
    max_examples=12,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(seed=st.integers(0, 10_000), order=st.randoms(use_true_random=False))
def test_the_order_of_the_columns_changes_nothing(tmp_path: Path, seed: int, order) -> None:  # type: ignore[no-untyped-def]
    made, path, _ = some_laboratory(seed, tmp_path)
    before = find_campaign([path], tmp_path)
    lines = [
        line.split(";" if made and ";" in line else ",") for line in path.read_text().splitlines()
    ]
    places = list(range(len(lines[0])))
    order.shuffle(places)
    separator = ";" if ";" in path.read_text() else ","
    text = "\n".join(separator.join(line[at] for at in places) for line in lines)
    path.write_text(text + "\n")
    after = find_campaign([path], tmp_path)
    assert set(after.columns) == set(before.columns)
    assert after.runs == before.runs
    assert after.sensors == before.sensors


@pytest.mark.slow
@settings(
    deadline=None,
    max_examples=12,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(seed=st.integers(0, 10_000), other=st.integers(0, 10_000))
def test_the_units_of_the_headers_change_nothing(tmp_path: Path, seed: int, other: int) -> None:
    found = []
    for drawn in (seed, other):
        made = laboratory(np.random.default_rng(seed), "english", RIGS[1], ("Roll", "WP_1"))
        path = write(made, tmp_path / "run.csv", np.random.default_rng(drawn))
        found.append(find_campaign([path], tmp_path))
    one, two = found
    assert taken(one) == taken(two)
    for name in ("frequency_hz", "eccentricity_mm", "strut_phase_deg", "carriage_speed_m_s"):
        values = (getattr(each.runs[0], name) for each in found)
        assert next(values) == pytest.approx(next(values), rel=2e-3, abs=1.0e-6)
