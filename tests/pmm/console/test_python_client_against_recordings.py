"""``pmm.connect`` drives a console in a process of its own; what was recorded says whether."""

import json
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import pmm
from analysis.readers import read_recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.errors import ConfigurationError
from pmm.cli import cli
from pmm.interface.console import ConsoleClient
from pmm.interface.console_requests import ConsoleRefusalError
from pmm.interface.console_run import FollowedPlan
from tests.docs.blocks import blocks
from tests.pmm.console.chromium import Console, console, plan, rig_in
from tests.pmm.console.test_campaigns_that_choose_in_chromium import HULL
from tests.pmm.sequential.campaigns import DESIGN

PERIODS = 6
WITHIN_S = 600.0
TOKEN = "0123456789abcdef-token"  # noqa: S105 - of this test alone
TWO_RUNS = plan("whole", periods=PERIODS).replace("= 1.0", "= [1.0, 1.1]")


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Console]:
    """A console of several tests: each queues plans of its own, and leaves the rig at rest."""
    folder = tmp_path_factory.mktemp("desk")
    with console(rig_in(folder / "rig"), folder / "out", "--speed", "8") as one:
        yield one


def stopped(client: ConsoleClient, name: str) -> dict[str, Any]:
    """Stop the run of a plan; return what is said of it once it is written, behind the state."""
    client.command("stop")
    client.wait(lambda known: known["frame"]["state"] == "stopped", WITHIN_S)
    client.wait(lambda known: _ended(known, name) != [], WITHIN_S)
    return dict(_ended(client.known, name)[-1])


def _ended(known: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    return [one for one in known["finished"] if Path(one["folder"]).name == name]


@pytest.mark.slow
def test_a_whole_campaign_is_driven_without_a_browser(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    rig.with_name("whole.toml").write_text(TWO_RUNS, encoding="utf-8")
    with console(rig, out, "--speed", "8") as one, pmm.connect(one.address) as client:
        assert client.plans() == ["whole.toml"]
        checked = client.check("whole.toml")
        assert [run["name"] for run in checked["runs"]] == ["run-f1-a20", "run-f1.1-a20"]
        assert client.frame["state"] == "idle"
        runs = client.run("whole.toml", WITHIN_S)
        assert [(run["run"], run["outcome"]) for run in runs] == [
            ("run-f1-a20", "complete"),
            ("run-f1.1-a20", "complete"),
        ]
        client.note(1, "ballast moved", author="N. N.")
        client.note(1, "a wave at the end", "run-f1.1-a20")
        with pytest.raises(ConsoleRefusalError, match="no run 'run-9'"):
            client.note(1, "nowhere", "run-9")
        with pytest.raises(ConsoleRefusalError, match="all its runs are complete"):
            client.queue(rig.with_name("whole.toml"))
        for run in runs:  # what was shown last is what the file holds
            found = analyse(
                read_recording(out / "whole" / run["run"] / "run.nc"), settings=ResolverSettings()
            ).readings[0]
            assert found.periods == PERIODS
    archive = ["--archive", str(tmp_path / "archive.sqlite")]
    for words in (["add", str(out / "whole")], ["show", "run-f1.1-a20", "--json"]):
        done = CliRunner().invoke(cli, ["archive", *words, *archive], catch_exceptions=False)
        assert done.exit_code == 0, done.output
    notes = json.loads(done.stdout)["notes"]
    assert [(one["run"], one["text"]) for one in notes] == [
        ("", "ballast moved"),
        ("run-f1.1-a20", "a wave at the end"),
    ]
    assert notes[0]["author"] == "N. N."
    log = (out / "whole" / "commands.jsonl").read_text(encoding="utf-8")
    assert '"action": "queue"' in log.splitlines()[0]  # from the first
    assert log.count('"action": "command"') == 1


@pytest.mark.slow
def test_the_program_of_the_page_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = (one for one in blocks("python") if one.page == "docs/console-api.md")
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    rig.with_name("plan.toml").write_text(plan("page"), encoding="utf-8")
    with console(rig, out, "--speed", "8") as one:
        for made in (1, 0):  # it may be run again, and makes nothing twice
            exec(block.text.replace("http://127.0.0.1:8063", one.address))  # noqa: S102 - our page
            said = capsys.readouterr().out
            assert said.count("[('run-f1-a20', 'complete', 5)]") == made


def test_a_run_is_stopped_what_had_no_turn_taken_out_and_control_given_back(desk: Console) -> None:
    with pmm.connect(desk.address) as client:
        client.queue(plan("held", periods=500))
        client.queue(plan("other"))
        client.wait(lambda known: len(_named(known, "held", "other")) == 2, WITHIN_S)
        (number,) = _named(client.known, "other")
        assert "other" in client.drop(number)
        client.command("start")
        for name, timeout_s in (("late", 0.5), ("later", 0.0)):
            with pytest.raises(ConsoleRefusalError, match=rf"not come in .*; {name} is taken"):
                client.run(plan(name), timeout_s)
        client.wait(lambda known: known["frame"]["gate"] == "open", WITHIN_S)
        assert stopped(client, "held")["outcome"] == "stopped"
        assert client.frame["queue"] == []
        with pytest.raises(ConsoleRefusalError, match=r"did not come in 0\.2 s"):
            client.wait(lambda known: known["frame"]["state"] == "gate open", 0.2)
    with pmm.connect(desk.address) as again:
        assert again.known["desk"]["holder"] == "you"


def _named(known: Mapping[str, Any], *names: str) -> list[int]:
    return [int(number) for number, one in known["plans"].items() if one["name"] in names]


@pytest.mark.slow
def test_a_plan_waits_for_its_turn_behind_the_one_that_is_under_way(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    with console(rig, out, "--speed", "8") as one, pmm.connect(one.address) as client:
        client.queue(plan("first"))
        client.command("start")
        client.wait(lambda known: known["frame"]["gate"] == "open", WITHIN_S)
        (made,) = client.run(plan("second"), WITHIN_S)
        assert (Path(made["folder"]).name, made["outcome"]) == ("second", "complete")
        ended = [Path(entry["folder"]).name for entry in client.known["finished"]]
        assert ended == ["first", "second"]


@pytest.mark.slow
def test_a_design_is_approved_of_and_carried_out(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    design = DESIGN.format(repeat=0.007) + HULL
    rig.with_name("design.toml").write_text(design, encoding="utf-8")
    asked: list[str] = []

    def answer(question: str) -> str:
        asked.append(question)
        return "y 1" if len(asked) == 1 else "n"

    with console(rig, out, "--speed", "12") as one, pmm.connect(one.address) as client:
        runs = client.run("design.toml", WITHIN_S, answer)
        assert len(asked) == 2
        assert all(question.startswith("Approve of these runs?") for question in asked)
        recorded = {path.parent.name for path in (out / "heave-pitch").glob("*/run.nc")}
        assert {run["run"] for run in runs} == recorded != set()


def press_ctrl_c(client: ConsoleClient, when: Callable[[Mapping[str, Any]], bool]) -> None:
    """Wait until what is known fulfils a condition, then do as the terminal does."""
    client.wait(when, WITHIN_S)
    os.kill(os.getpid(), signal.SIGINT)


def said_at_ctrl_c(
    client: ConsoleClient, text: str, when: Callable[[Mapping[str, Any]], bool]
) -> str:
    """Follow a plan until Ctrl-C, and return what is said of the plan."""
    pressing = threading.Thread(target=press_ctrl_c, args=(client, when))
    pressing.start()
    with pytest.raises(KeyboardInterrupt) as raised:
        client.run(text, WITHIN_S)
    pressing.join()
    (note,) = raised.value.__notes__
    return note


@pytest.fixture
def _interruptible() -> Iterator[None]:
    """Take interrupts, which a program that was started in the background ignores."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("_interruptible")
def test_ctrl_c_takes_out_what_waits_and_says_what_goes_on(
    desk: Console, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pmm.connect(desk.address) as client:
        long = plan("long", periods=500)
        said = said_at_ctrl_c(client, long, lambda known: known["frame"]["gate"] == "open")
        assert said.startswith("long has begun and goes on; command('stop') of a client")
        said = said_at_ctrl_c(client, plan("late"), lambda known: _named(known, "late") != [])
        assert said == "late is taken out of the queue"
        ask = client.queue

        def slow(text: str | Path) -> dict[str, Any]:
            """Interrupt the program before it has read the console's answer."""
            answer = ask(text)
            os.kill(os.getpid(), signal.SIGINT)
            return answer

        monkeypatch.setattr(client, "queue", slow)
        with pytest.raises(KeyboardInterrupt) as raised:
            client.run(plan("later"), WITHIN_S)
        assert raised.value.__notes__ == ["later is taken out of the queue"]
        client.wait(lambda known: known["frame"]["queue"] == [], WITHIN_S)
        assert client.frame["gate"] == "open"
        stopped(client, "long")


@pytest.mark.slow
def test_an_error_of_the_answers_leaves_nothing_in_the_queue(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    rig.with_name("design.toml").write_text(DESIGN.format(repeat=0.007) + HULL, encoding="utf-8")

    def answer(question: str) -> str:
        raise LookupError(question)

    with console(rig, out) as one, pmm.connect(one.address) as client:
        with pytest.raises(LookupError) as raised:
            client.run("design.toml", WITHIN_S, answer)
        assert raised.value.__notes__ == ["heave-pitch is taken out of the queue"]
        client.wait(lambda known: known["frame"]["plan"] == 0, WITHIN_S)


@pytest.mark.parametrize(
    ("frame", "ended", "over", "begun"),
    [
        ({"plan": 1, "queue": [2], "state": "gate open"}, [], False, False),
        ({"plan": 2, "state": "idle"}, [], False, False),
        ({"plan": 2, "state": "starting"}, [], False, True),
        ({"plan": 2, "state": "done"}, ["r"], True, True),
        ({"plan": 2, "state": "done"}, [], False, True),  # its recording is being completed
        ({"plan": 2, "state": "done", "next": ["s"]}, ["r"], False, True),
        ({"plan": 3, "state": "idle"}, ["r"], True, False),
        ({"plan": 1, "state": "done"}, [], True, False),  # somebody has taken it out
    ],
)
def test_where_a_plan_stands_follows_from_a_frame(
    frame: dict[str, object], ended: list[str], over: bool, begun: bool
) -> None:
    entry = {"name": "b", "number": 2, "folder": "b", "chooses": False}
    before = {"finished": [{"run": "r", "folder": "b"}], "notices": []}
    followed = FollowedPlan(entry, before)
    others = [{"run": "r", "folder": "a"}]
    state = {
        "frame": {"queue": [], "next": [], "run": "r", **frame},
        "finished": [*before["finished"], *others, *({"run": r, "folder": "b"} for r in ended)],
        "notices": [],
    }
    assert (followed.over(state), followed.begun(state)) == (over, begun)
    assert [one["run"] for one in followed.runs(state)] == ended


@pytest.mark.slow
def test_who_watches_acts_only_once_it_has_control(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    token = tmp_path / "token"
    token.write_text(TOKEN, encoding="utf-8")
    with console(rig, out, "--token-file", str(token), "--speed", "4") as one:
        with pytest.raises(ConfigurationError, match="token"):
            pmm.connect(one.address)
        with pytest.raises(ConfigurationError, match="not the token"):
            pmm.connect(one.address, TOKEN + "x")
        with pmm.connect(one.address, TOKEN) as first, pmm.connect(one.address, TOKEN) as second:
            with pytest.raises(ConsoleRefusalError, match="only watches"):
                second.queue(plan("taken"))
            second.take_control()
            second.queue(plan("taken", periods=500))
            second.command("start")
            first.wait(lambda known: known["frame"]["gate"] == "open", WITHIN_S)
            assert first.known["desk"]["holder"] == "other"
            first.command("quick stop")  # everybody's right
            second.wait(lambda known: bool(known["finished"]), WITHIN_S)
            assert second.frame["state"] in ("stopping", "stopped", "fault")
            with pytest.raises(ConsoleRefusalError, match="nothing is asked"):
                second.answer("yes")


def test_where_no_console_is_is_said() -> None:
    began = time.monotonic()
    with pytest.raises(ConfigurationError, match="no console that lets this program in"):
        pmm.connect("http://127.0.0.1:9")
    assert time.monotonic() > began
