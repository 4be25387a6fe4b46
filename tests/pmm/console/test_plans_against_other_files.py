"""Plans over HTTP: no file but this console's rig is opened, and nothing huge is expanded."""

import os
import tracemalloc
from dataclasses import replace
from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from pmm.console.limits import LARGEST_PLAN
from pmm.console.plans import Plans
from pmm.plan.rig_file import read_rig_file
from tests.pmm.console.chromium import plan, rig_in
from tests.pmm.console.serving import served

CALIBRATION = """
made = "2026-01-01"
expires = "2036-01-01"
channels = ["force_aft", "force_fore"]
matrix = [[1.0, 0.0], [0.0, 1.0]]
standard_uncertainty = [[1e-4, 0.0], [0.0, 1e-4]]
hysteresis = [0.0, 0.0]
nonlinearity = [0.0, 0.0]
"""


@pytest.fixture
def plans(tmp_path: Path) -> Plans:
    """Those of a console; it reads them in a worker, which does the same."""
    rig = rig_in(tmp_path / "rig")
    return Plans(rig, read_rig_file(rig).hashes, rig.parent, tmp_path / "out")


def test_a_rig_is_named_from_the_list_and_no_other_file_is_opened(
    plans: Plans, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    secret = tmp_path / "secret.toml"
    secret.write_text("password = 'x'\nnot toml", encoding="utf-8")
    opened: list[str] = []
    kept = Path.open

    def watched(path: Path, *given: object, **named: object) -> object:
        opened.append(path.name)
        return kept(path, *given, **named)  # type: ignore[call-overload]

    monkeypatch.setattr(Path, "open", watched)
    rigs = ("../secret.toml", str(secret), "./rig.toml", "/dev/zero", "none.toml",
            str(tmp_path / "rig" / "rig.toml"))  # fmt: skip
    for rig in rigs:
        with pytest.raises(ConfigurationError, match='is no rig of this console; write rig = "rig'):
            plans.check("", plan("p").replace('"rig.toml"', f'"{rig}"'))
    assert not {"secret.toml", "zero", "none.toml", "rig.toml"} & set(opened)
    assert not plans.check("", plan("p")).refused
    assert "rig.toml" in opened


@pytest.mark.slow
def test_plans_in_another_folder_name_the_rig_from_there(plans: Plans, tmp_path: Path) -> None:
    folder = tmp_path / "plans"
    folder.mkdir()
    one = replace(plans, folder=folder)
    assert one.rigs == ("../rig/rig.toml",)
    text = plan("p").replace('"rig.toml"', '"../rig/rig.toml"')
    assert one.queue("", text).waiting.plan.rig_path.samefile(plans.rig_path)


@pytest.mark.parametrize("file", ["rig.toml", "calibration.toml"])
def test_a_rig_that_is_edited_while_it_is_open_takes_no_plan(tmp_path: Path, file: str) -> None:
    rig = rig_in(tmp_path / "rig")
    calibration = rig.with_name("calibration.toml")
    calibration.write_text(CALIBRATION, encoding="utf-8")
    text = rig.read_text(encoding="utf-8")
    rig.write_text(f'calibration_file = "calibration.toml"\n{text}', encoding="utf-8")
    plans = Plans(rig, read_rig_file(rig).hashes, rig.parent, tmp_path / "out")
    assert not plans.check("", plan("p")).refused
    edited = rig.with_name(file)
    before = edited.read_text(encoding="utf-8")
    edited.write_text(f"{before}\n# later", encoding="utf-8")
    for take in (plans.check, plans.queue):
        with pytest.raises(ConfigurationError, match=r"rig\.toml: the file, or its calibration"):
            take("", plan("p"))
    edited.write_text(before, encoding="utf-8")
    assert not plans.check("", plan("p")).refused


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("periods = 5", "periods = 5\nrepeats = 3000000", "should be at most 1000"),
        (
            "frequencies_hz = 1.0",
            f"frequencies_hz = {[1.0] * 3000}\nrepeats = 1000",
            "asks for 3000000 runs; the limit is 10000",
        ),
    ],
)
def test_millions_of_runs_are_refused_before_they_are_made(
    plans: Plans, old: str, new: str, said: str
) -> None:
    text = plan("p").replace(old, new)
    assert text != plan("p")
    plans.check("", plan("warm"))
    tracemalloc.start()
    try:
        with pytest.raises(ConfigurationError, match=said):
            plans.check("", text)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 100e6  # bytes; 3,000,000 runs take ten times that


@pytest.mark.slow
def test_a_file_larger_than_a_plan_may_be_is_not_read(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        path = tmp_path / "rig" / "large.toml"
        path.write_text(plan("p"), encoding="utf-8")
        assert "large.toml" in one.browser.get("/api/plans").json()["names"]
        os.truncate(path, LARGEST_PLAN + 1)
        assert "large.toml" not in one.browser.get("/api/plans").json()["names"]
