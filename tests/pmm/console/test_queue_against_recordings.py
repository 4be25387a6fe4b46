"""The queue over HTTP: what was edited, moved, held and released, by what was recorded then."""

from pathlib import Path

import pytest

import pmm
from analysis.readers import read_recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from pmm.interface.console_requests import ConsoleRefusalError
from tests.pmm.console.chromium import console, plan, rig_in

WITHIN_S = 600.0
RUNS = [f"run-f{one}-a20" for one in ("1", "1.1", "1.2", "1.3")]
FOUR = plan("four", periods=4).replace("= 1.0", "= [1.0, 1.1, 1.2, 1.3]")


@pytest.mark.slow
def test_a_queue_is_edited_moved_and_held_before_and_while_it_runs(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    rig.with_name("four.toml").write_text(FOUR, encoding="utf-8")
    first, second, third, fourth = RUNS
    with console(rig, out, "--speed", "6") as one, pmm.connect(one.address) as client:
        client.queue("four.toml")
        client.queue(plan("later"))
        client.wait(lambda known: len(known["frame"]["queue"]) == 1, WITHIN_S)
        changed = client.edit(1, second, frequency_hz=1.05, periods=90)
        assert changed["runs"][1]["changed"] == ["frequency_hz 1.1 -> 1.05", "periods 4 -> 90"]
        with pytest.raises(ConsoleRefusalError, match=r"20 .*Hz|frequency"):
            client.edit(1, second, frequency_hz=20.0)  # beyond the rig, as of any plan
        with pytest.raises(ConsoleRefusalError, match="no run 'run-f9'"):
            client.edit(1, "run-f9", frequency_hz=1.0)
        with pytest.raises(ConsoleRefusalError, match="no plan 7"):
            client.hold(7)
        client.move(1, 2, first)
        client.hold(1, fourth)
        client.wait(lambda known: known["plans"]["1"]["held"] == [fourth], WITHIN_S)
        assert [run["name"] for run in client.known["plans"]["1"]["runs"]] == [
            second, third, first, fourth,
        ]  # fmt: skip
        assert client.frame["state"] == "idle"  # nothing moves by it

        client.command("start")
        client.wait(lambda known: known["frame"]["gate"] == "open", WITHIN_S)
        with pytest.raises(ConsoleRefusalError, match=f"{second} has begun"):
            client.edit(1, second, frequency_hz=1.0)
        with pytest.raises(ConsoleRefusalError, match="nothing changes"):
            client.hold(1, second)
        client.edit(1, first, frequency_hz=0.95)  # waits still
        client.command("hold")  # enough periods
        client.wait(lambda known: len(known["finished"]) == 4, WITHIN_S)
        assert [run["run"] for run in client.known["finished"]] == [
            second, third, first, "run-f1-a20",
        ]  # fmt: skip
        client.wait(lambda known: known["frame"]["state"] == "done", WITHIN_S)
        before = client.frame["n"]
        client.release(1, fourth)  # its plan gave way to the one behind
        client.wait(lambda known: known["frame"]["n"] > before + 20, WITHIN_S)
        assert client.frame["run"] in ("", "run-f1-a20")
        client.command("start")
        client.wait(lambda known: len(known["finished"]) == 5, WITHIN_S)
        assert client.known["finished"][-1]["run"] == fourth
    for run, frequency_hz, periods in (
        (second, 1.05, range(1, 90)), (third, 1.2, [4]), (first, 0.95, [4]), (fourth, 1.3, [4]),
    ):  # fmt: skip
        recording = read_recording(out / "four" / run / "run.nc")
        found = analyse(recording, settings=ResolverSettings()).readings[0]
        assert found.periods in periods
        assert found.frequency_hz == pytest.approx(frequency_hz, rel=1e-3)
    log = (out / "four" / "commands.jsonl").read_text(encoding="utf-8")
    assert log.count('"action": "edit"') == 5


@pytest.mark.slow
def test_what_was_edited_is_complete_when_the_plan_is_queued_anew(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    two = FOUR.replace(", 1.2, 1.3]", "]")
    rig.with_name("four.toml").write_text(two, encoding="utf-8")
    with console(rig, out, "--speed", "8") as one, pmm.connect(one.address) as client:
        client.queue("four.toml")
        client.edit(1, RUNS[0], frequency_hz=0.9)
        client.hold(1, RUNS[1])
        client.command("start")
        client.wait(lambda known: bool(known["finished"]), WITHIN_S)
        client.wait(lambda known: known["frame"]["state"] == "done", WITHIN_S)
    with console(rig, out, "--speed", "8") as one, pmm.connect(one.address) as client:
        assert [run["name"] for run in client.check("four.toml")["runs"]] == [RUNS[1]]


@pytest.mark.slow
def test_plans_change_places_and_a_watcher_changes_nothing(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    with console(rig, out) as one, pmm.connect(one.address) as client:
        for name in ("present", "first", "second", "third"):
            client.queue(plan(name))
        client.move(4, -2)
        client.wait(lambda known: known["frame"]["queue"] == [4, 2, 3], WITHIN_S)
        with pmm.connect(one.address) as other:
            for refused in (
                lambda: other.move(4, 1), lambda: other.hold(1),
                lambda: other.edit(1, RUNS[0], frequency_hz=1.1),
            ):  # fmt: skip
                with pytest.raises(ConsoleRefusalError, match="only watches"):
                    refused()
        client.hold(1)
        client.wait(lambda known: known["frame"]["plan"] == 4, WITHIN_S)  # all of it is held
        assert client.frame["queue"] == [1, 2, 3]
