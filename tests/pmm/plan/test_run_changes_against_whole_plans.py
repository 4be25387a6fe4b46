"""Runs that are changed in the queue, against plans whose files say the same from the start."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from pmm.plan.plan import Plan, read_plan
from pmm.plan.run_changes import edited, moved
from pmm.plan.run_plan import RunPlan

EXAMPLE = Path(__file__).parents[3] / "examples" / "vertical"
HEAD = """name = "changed"
rig = "rig.toml"
[defaults]
periods = 6
pause_s = 30.0
[zero]
every = 2
"""
ENTRY = """[[runs]]
motion = "{motion}"
name = "{name}"
frequencies_hz = {frequency_hz}
amplitudes_mm = {amplitude_mm}
speeds_m_s = {speed_m_s}
"""


def _entry(
    name: str,
    frequency_hz: float = 1.0,
    amplitude_mm: float = 20.0,
    speed_m_s: float = 1.0,
    more: str = "",
) -> str:
    motion = "phase" if "strut" in more else "heave"
    return ENTRY.format(**locals()) + more


def _plan(folder: Path, *entries: str) -> Plan:
    for name in ("rig.toml", "simulated.toml"):
        shutil.copy(EXAMPLE / name, folder)
    path = folder / "plan.toml"
    path.write_text(HEAD + "".join(entries), encoding="utf-8")
    return read_plan(path)


def _of(plan: Plan, name: str) -> RunPlan:
    (found,) = (run for run in plan.runs if run.entry == name)
    return found


@pytest.mark.parametrize(
    ("settings", "written"),
    [
        ({"frequency_hz": 0.75}, {"frequency_hz": 0.75}),
        ({"eccentricity_m": 0.015}, {"amplitude_mm": 15.0}),
        ({"periods": 9}, {"more": "periods = 9\n"}),
        ({"carriage_speed_m_s": 0.5}, {"speed_m_s": 0.5}),
        ({"frequency_hz": 1.0}, {}),
    ],
)
def test_an_edited_run_is_the_one_that_the_file_would_have_said(
    settings: dict[str, float], written: dict[str, object], tmp_path: Path
) -> None:
    before = _plan(tmp_path, _entry("one"))
    wanted = _of(_plan(tmp_path, _entry("one", **written)), "one")  # type: ignore[arg-type]
    found = edited(_of(before, "one"), settings, before)
    assert replace(found, name="", changed=()) == replace(wanted, name="")
    assert len(found.changed) == len(written)
    assert RunPlan.from_json(found.to_json(), "here") == found


def test_the_strut_phase_is_edited_where_the_motion_has_one(tmp_path: Path) -> None:
    plan = _plan(tmp_path, _entry("one", 1.0, more="strut_phases_deg = 90.0\n"), _entry("two", 1.0))
    assert edited(_of(plan, "one"), {"strut_phase_rad": 0.5}, plan).set_point.strut_phase_rad == 0.5
    with pytest.raises(ConfigurationError, match="strut_phases"):
        edited(_of(plan, "two"), {"strut_phase_rad": 0.5}, plan)


@pytest.mark.parametrize(
    ("settings", "why"),
    [({"frequency_hz": -1.0}, "frequencies_hz"), ({"periods": 0}, "periods")],
)
def test_what_no_plan_could_say_is_refused(
    settings: dict[str, float], why: str, tmp_path: Path
) -> None:
    plan = _plan(tmp_path, _entry("one", 1.0))
    with pytest.raises(ConfigurationError, match=why):
        edited(_of(plan, "one"), settings, plan)
    zero = plan.runs[0]
    with pytest.raises(ConfigurationError, match="only oscillations"):
        edited(zero, {"frequency_hz": 1.0}, plan)


NAMES = ("a", "b", "c", "d")


@pytest.mark.parametrize(
    ("name", "by", "order"),
    [("a", 4, "bcda"), ("d", -3, "adbc"), ("c", -2, "acbd"), ("b", 2, "acbd"), ("a", 1, "bacd")],
)
def test_a_moved_run_rests_on_the_zero_runs_that_it_stands_between(
    name: str, by: int, order: str, tmp_path: Path
) -> None:
    """The order of the file is zero, a, b, zero, c, d, zero."""
    plan = _plan(tmp_path, *(_entry(one, 1.0 + 0.1 * k) for k, one in enumerate(NAMES)))
    kinds = [str(run.kind) for run in plan.runs]
    assert [k for k, kind in enumerate(kinds) if kind == "zero"] == [0, 3, 6]
    runs = moved(plan.runs, _of(plan, name).name, by)
    assert "".join(run.entry for run in runs if run.entry != "zero") == order
    for place, run in enumerate(runs):
        if run.entry == "zero":
            continue
        before = [one.name for one in runs[:place] if one.entry == "zero"]
        after = [one.name for one in runs[place:] if one.entry == "zero"]
        assert (run.zero_before, run.zero_after) == (before[-1], after[0])
    (now,) = (run for run in runs if run.entry == name)
    assert now.pause_before_s == 30.0  # it does not follow the zero run at once any more


def test_zero_runs_stay_and_no_run_leaves_them(tmp_path: Path) -> None:
    plan = _plan(tmp_path, _entry("a", 1.0), _entry("b", 1.1))
    with pytest.raises(ConfigurationError, match="zero runs stay"):
        moved(plan.runs, "zero-01", 1)
    for name, by in (("a", -1), ("b", 1)):
        with pytest.raises(ConfigurationError, match="move it less far"):
            moved(plan.runs, _of(plan, name).name, by)
