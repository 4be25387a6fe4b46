"""Wrong plans and rigs: each error with its place and what was meant, all of them at once."""

from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from pmm.plan.plan import read_plan
from pmm.plan.rig_file import read_rig_file
from tests.pmm.plan.plans import GAUGES_TEXT, HEAVE, HORIZONTAL_TEXT, RIG_TEXT, write_plan

PLANS = [
    ("runs = []", "the plan has no runs; add a table [[runs]] for each motion"),
    ("name = 'a/b'\n" + HEAVE, "name = 'a/b' cannot be the name of a file or folder"),
    ("oder = 3\n" + HEAVE, "oder is not a known key; did you mean order?"),
    (
        HEAVE + "amplitude_mm = 3",
        "runs[1].amplitude_mm is not a known key; did you mean amplitudes_mm",
    ),
    (
        HEAVE + "frequency_hz = 3",
        "runs[1].frequency_hz is not a known key; did you mean frequencies_hz",
    ),
    (
        HEAVE + "stroke_mm = 40.0",
        "runs[1].stroke_mm is not taken: give the amplitude, half the stroke",
    ),
    (HEAVE + "amplitudes_m = 0.02", "runs[1].amplitudes_mm and amplitudes_m are both given"),
    (HEAVE.replace("20.0", "'20'"), "runs[1].amplitudes_mm = '20' should be a number or a list"),
    (HEAVE.replace("20.0", "0.0"), "amplitudes_m has 0, which should be above 0"),
    (HEAVE.replace("0.8", "[0.8, -1.0]"), "frequencies_hz has -1, which should be above 0"),
    (HEAVE + "speeds_m_s = -1.0", "speeds_m_s has -1, which should be 0 or more"),
    (HEAVE + "periods = 0", "runs[1].periods = 0 should be above 0"),
    (HEAVE + "repeats = 0", "runs[1].repeats = 0 should be above 0"),
    (HEAVE + "settling_periods = -1", "settling_periods = -1 should be 0 or more"),
    (HEAVE + "target_relative = 0.01", "runs[1] has a target_relative and needs max_periods"),
    (HEAVE + "max_periods = 20", "runs[1] has max_periods and needs target_relative"),
    (
        HEAVE + "target_relative = 0.01\nmax_periods = 5",
        "runs[1] has max_periods = 5, which is below periods = 10",
    ),
    (HEAVE + "target_relative = 2.0\nmax_periods = 20", "= 2 should be between 0 and 1"),
    (HEAVE.replace("heave", "heav"), 'runs[1].motion = "heav" should be'),
    (HEAVE.replace("heave", "none"), 'motion = "none" is for runs at rest'),
    (HEAVE.replace("heave", "sway"), 'motion = "sway" is a motion of the horizontal oscillator'),
    (HEAVE.replace("heave", "phase"), 'runs[1] needs strut_phases_deg for the motion "phase"'),
    (HEAVE + "strut_phases_deg = 90.0", 'follows from the motion; give it with motion = "phase"'),
    (HEAVE + "drifts_deg = 4.0", "drifts_deg is of no use to heave; yaw-drift has a drift"),
    (HEAVE + "duration_s = 4.0", "runs[1].duration_s is of no use to a run of kind oscillation"),
    (HEAVE + "kind = 'control'", 'kind = "control" belongs into the table [control]'),
    (HEAVE + "kind = 'osc'", 'runs[1].kind = "osc" should be'),
    ("[[runs]]\nmotion = 'heave'", "runs[1] needs frequencies_hz for a run of kind oscillation"),
    ("[[runs]]\nmotion = 'heave'", "runs[1] needs amplitudes_mm for a run of kind oscillation"),
    ("[[runs]]\nkind = 'check-weight'", "runs[1] needs loads_n for a run of kind check-weight"),
    ("[[runs]]\nkind = 'push'\nloads_n = [5.0, 6.0]", "loads_n should be one number"),
    (
        "[[runs]]\nkind = 'push'\nloads_n = 5.0\nchannels = 'force_ft'",
        "channels has 'force_ft', which is not a force channel of the rig; did you mean force_aft?",
    ),
    ("[[runs]]\nkind = 'straight-tow'\nspeeds_m_s = 0.0", "a tow needs a speed above 0"),
    (
        "[[runs]]\nkind = 'known-mass'\nmotion = 'heave'",
        "runs[1] needs known_mass for a run of kind",
    ),
    (HEAVE + "known_mass = { mass_kg = 0.0 }", "known_mass.mass_kg = 0 should be above 0"),
    (HEAVE + HEAVE, "2 runs would be called 'heave-f0.8-a20'"),
    (HEAVE + "name = 'a/b'", "= 'a/b' cannot be the name of a file"),
    ("[zero]\nevery = 0\n" + HEAVE, "zero.every = 0 should be above 0"),
    ("[defaults]\nperiods = 0\n" + HEAVE, "defaults.periods = 0 should be above 0"),
    ("[order]\nscheme = 'snak'\n" + HEAVE, 'order.scheme = "snak" should be'),
    (
        "[control]\nmotion = 'heave'\nfrequency_hz = 0.0\namplitude_mm = 5.0\nevery = 3\n" + HEAVE,
        "control.frequency_hz = 0 should be above 0",
    ),
    (
        "[control]\nmotion = 'phase'\nfrequency_hz = 1.0\namplitude_mm = 5.0\nevery = 3\n" + HEAVE,
        'control needs strut_phase_deg for the motion "phase"',
    ),
    (
        "[control]\nmotion = 'yaw'\nfrequency_hz = 1.0\nstroke_mm = 5.0\nevery = 3\n" + HEAVE,
        "control.stroke_mm is not taken: give the amplitude, half the stroke (amplitude_mm)",
    ),
]
RIGS = [
    ("tankk = 3\n", "tankk is not a known key; did you mean tank?"),
    ("shft = 3\n", "shft is not a known key; did you mean shaft?"),
    ("[limits]\nstrok_m = 0.1", "limits.strok_m is not a known key; did you mean stroke_m?"),
    ("[tank]\nlength_m = 0.0", "tank.length_m = 0 should be above 0"),
    ("[tank]\nlength_m = 10.0", "tank.width_m is missing"),
    ("modes_file = 'none.toml'", "modes_file = 'none.toml'"),
    ("[campaign]\nanalyis = 3", "campaign.analyis is not a known key; did you mean analysis?"),
    (
        "[campaign.analysis]\nharmonic = 3",
        "campaign.analysis.harmonic is not a known key; did you mean harmonics?",
    ),
    ("[campaign.model_uncertainty]\nmass_kg = -1.0", "mass_kg = -1 should be 0 or more"),
    (
        "[[gauges]]\nchannel = 'force_ft'\nfull_scale_n = 100.0",
        "= 'force_ft' is not a force channel; did you mean force_aft?",
    ),
    (
        "[[gauges]]\nchannel = 'force_aft'\nfull_scale_n = 100.0\nsafe_load_n = 50.0",
        "safe_load_n = 50 should not be below full_scale_n = 100",
    ),
]


def _message(path: Path) -> str:
    with pytest.raises(ConfigurationError) as caught:
        read_plan(path)
    return str(caught.value)


@pytest.mark.parametrize(("text", "said"), PLANS)
def test_a_wrong_plan_is_refused_in_words(text: str, said: str, tmp_path: Path) -> None:
    assert said in _message(write_plan(tmp_path, text, GAUGES_TEXT))


@pytest.mark.parametrize(("text", "said"), RIGS)
def test_a_wrong_rig_is_refused_in_words(text: str, said: str, tmp_path: Path) -> None:
    rig = f"{GAUGES_TEXT}\n{text}" if text.startswith("[") else f"{text}\n{GAUGES_TEXT}"
    write_plan(tmp_path, HEAVE, rig)
    with pytest.raises(ConfigurationError) as caught:
        read_rig_file(tmp_path / "rig.toml")
    assert said in str(caught.value)


def test_all_errors_of_both_files_come_at_once(tmp_path: Path) -> None:
    rig = RIG_TEXT.replace("stroke_m", "strok_m").replace("counts_per_turn", "count_per_turn")
    rig = rig.replace("mass_kg = 70.0", "mass_kg = -70.0")
    text = HEAVE.replace("heave", "yaw") + "period = 3\n" + HEAVE + "stroke_m = 1.0\n"
    message = _message(write_plan(tmp_path, text, rig))
    for said in (
        "plan.toml: 3 errors",
        'runs[1].motion = "yaw" is a motion of the horizontal',
        "runs[1].period is not a known key; did you mean periods?",
        "runs[2].stroke_m is not taken",
        "limits.strok_m is not a known key; did you mean stroke_m?",
        "shaft.count_per_turn is not a known key; did you mean counts_per_turn?",
        "model.mass_kg = -70 should be above 0",
    ):
        assert said in message


def test_a_bus_that_cannot_carry_it_is_refused_with_load_and_limit(tmp_path: Path) -> None:
    rig = RIG_TEXT.replace("sync_rate_hz = 100.0", "sync_rate_hz = 1000.0")
    message = _message(write_plan(tmp_path, HEAVE, rig))
    assert "bus.sync_rate_hz = 1000 loads the bus with 172% of its 1000000 bit/s" in message
    assert "the limit is 70%" in message


def test_files_that_are_not_there_are_named(tmp_path: Path) -> None:
    assert "plan.toml: no such file" in _message(tmp_path / "plan.toml")
    path = write_plan(tmp_path, "rig = 'other.toml'\n" + HEAVE)
    assert "other.toml: no such file" in _message(path)


def test_each_plane_has_its_motions(tmp_path: Path) -> None:
    path = write_plan(tmp_path, HEAVE.replace("heave", "sway"), HORIZONTAL_TEXT)
    assert read_plan(path).runs[0].motion == "sway"
