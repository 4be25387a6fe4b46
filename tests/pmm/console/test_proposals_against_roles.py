"""Who may do what: each role asks for each thing, and the loop is told only what is allowed."""

import json
from contextlib import ExitStack
from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from pmm.console.audit import COMMANDS
from pmm.console.limits import MOST_PROPOSALS
from pmm.console.messages import OrderKind
from pmm.console.proposals import Proposals
from pmm.console.requests import DropPosted
from pmm.console.security import Visitor, VisitorRole
from tests.pmm.console.serving import SESSION, Served, served

TOKENS = {one: f"{one}-0123456789abcdef" for one in ("token", "propose_token", "watch_token")}
REMOTE = "http://rig.tank.example:8063"
PLANS = {"host": "0.0.0.0", "origin": REMOTE, **TOKENS}  # noqa: S104
ALL = (
    ("/api/take-control", {"confirm": True}),
    ("/api/command", {"command": "start"}),
    ("/api/answer", {"question": "?", "answer": "y"}),
    ("/api/proposals/approve", {"number": 1}),
    ("/api/plans/queue", {"name": "plan.toml"}),
    ("/api/plans/drop", {"number": 1}),
    ("/api/plans/move", {"number": 1, "by": 1}),
    ("/api/plans/hold", {"number": 1, "held": True}),
    ("/api/plans/edit", {"number": 1, "run": "r", "periods": 3}),
)


def _enter(one: Served, role: str, name: str) -> None:
    one.browser.cookies.clear()
    assert one.post("/login", {"token": TOKENS[role], "name": name})[0] == 200


@pytest.mark.slow
def test_what_is_proposed_reaches_the_loop_when_it_is_approved(tmp_path: Path) -> None:
    with served(tmp_path, **PLANS) as one:
        _enter(one, "propose_token", "Ann")
        for path, body in ALL[:4]:
            status, said = one.post(path, body)
            assert (status, "for proposing" in str(said["error"])) == (403, True)
        status, said = one.post("/api/plans/queue", {"name": "plan.toml"})
        assert (status, said["plan"]["name"]) == (200, "vertical-run")  # type: ignore[index]
        assert str(said["said"]).startswith("proposal 1, queue vertical-run")
        assert one.post("/api/plans/queue", {"name": "no.toml"})[0] == 409
        assert one.post("/api/plans/hold", {"number": 1, "held": True})[0] == 409  # not there yet
        assert one.post("/api/command", {"command": "quick stop"})[0] == 200
        assert [order.kind for order in one.orders] == [OrderKind.COMMAND]

        _enter(one, "watch_token", "Bob")
        for path, body in (*ALL, ("/api/proposals/refuse", {"number": 1})):
            status, said = one.post(path, body)
            assert (status, "for watching" in str(said["error"])) == (403, True), path
        assert len(one.orders) == 1

        _enter(one, "token", "Eve")
        stream = f"{one.stream}?session={SESSION}"
        with one.browser.websocket_connect(stream, headers={"origin": REMOTE}) as operating:
            (told,) = operating.receive_json()["proposals"]
            assert (told["name"], told["text"]) == ("Ann", "queue vertical-run")
            status, said = one.post("/api/proposals/approve", {"number": 1})
            assert status == 200
            assert "proposed by 'Ann'" in str(said["said"])
            assert one.orders[-1].kind is OrderKind.QUEUE
            assert one.post("/api/proposals/approve", {"number": 1})[0] == 409  # only once

            _enter(one, "propose_token", "Ann")
            for number, (path, body) in enumerate(
                (("edit", {"run": "heave-f0.5-a20", "periods": 9}), ("hold", {"held": True}),
                 ("move", {"by": 1}), ("drop", {})), start=2,
            ):  # fmt: skip
                status, said = one.post(f"/api/plans/{path}", {"number": 1, **body})
                assert (status, number) == (200, number), said
            assert one.post("/api/proposals/refuse", {"number": 2})[0] == 200  # her own
            _enter(one, "propose_token", "Ann")  # another one of that name
            status, said = one.post("/api/proposals/refuse", {"number": 3})
            assert status == 403
            _enter(one, "token", "Eve")
            assert one.post("/api/proposals/refuse", {"number": 3})[0] == 200
            assert one.post("/api/proposals/approve", {"number": 5})[0] == 200
            assert one.orders[-1].kind is OrderKind.DROP
            assert len(one.orders) == 3
    done = [json.loads(line) for line in (tmp_path / COMMANDS).read_text("utf-8").splitlines()]
    approved = [line for line in done if line["action"] == "approve" and line["taken"]]
    assert [(line["name"], line["role"]) for line in approved] == [("Eve", "operate")] * 2
    assert "proposed by 'Ann'" in approved[0]["said"]


def test_control_of_a_session_that_died_is_free_for_the_next_and_logged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pmm.console.hub.SILENT_S", 0.0)
    with served(tmp_path, **PLANS) as one:
        _enter(one, "token", "Eve")
        other, own = SESSION[::-1], {"origin": REMOTE}
        with ExitStack() as held:
            first = one.browser.websocket_connect(f"{one.stream}?session={other}", headers=own)
            assert held.enter_context(first).receive_json()["desk"]["holder"] == "you"
            stream = one.browser.websocket_connect(f"{one.stream}?session={SESSION}", headers=own)
            watching = held.enter_context(stream)
            assert watching.receive_json()["desk"]["holder"] == "other"
            assert one.post("/api/command", {"command": "start"})[0] == 403
            first.close()
            told = watching.receive_json()
            while told["type"] != "audit" or told["entry"]["action"] != "control lapses":
                told = watching.receive_json()
            assert (told["entry"]["name"], told["entry"]["session"]) == ("Eve", other[:8])
            assert one.post("/api/take-control", {"confirm": True})[0] == 200
            assert one.post("/api/command", {"command": "start"})[0] == 200
        assert [order.text for order in one.orders] == ["start"]
    done = [json.loads(line) for line in (tmp_path / COMMANDS).read_text("utf-8").splitlines()]
    lapse = next(line for line in done if line["action"] == "control lapses")
    assert lapse["said"].endswith("nobody has control")


def test_so_many_may_wait_and_no_more() -> None:
    proposals, ann = Proposals(), Visitor(VisitorRole.PROPOSE, "Ann")
    for number in range(1, MOST_PROPOSALS + 1):
        assert proposals.add("drop", DropPosted(number=1), "p", ann, "utc").number == number
    with pytest.raises(ConfigurationError, match=f"{MOST_PROPOSALS} proposals wait"):
        proposals.add("drop", DropPosted(number=1), "p", ann, "utc")
    proposals.take(1)
    assert proposals.add("drop", DropPosted(number=1), "p", ann, "utc").number > MOST_PROPOSALS


@pytest.mark.slow
def test_a_text_that_is_proposed_leaves_no_file_until_it_is_approved(tmp_path: Path) -> None:
    with served(tmp_path, **PLANS) as one:
        before = sorted((tmp_path / "rig").iterdir())
        text = (tmp_path / "rig" / "plan.toml").read_text(encoding="utf-8")
        _enter(one, "propose_token", "Ann")
        assert one.post("/api/plans/queue", {"text": text + "# of Ann's own\n"})[0] == 200
        assert sorted((tmp_path / "rig").iterdir()) == before


@pytest.mark.parametrize("kind", ["propose", "watch"])
def test_no_token_is_that_of_another_role(tmp_path: Path, kind: str) -> None:
    from click.testing import CliRunner

    from pmm.cli import cli
    from tests.pmm.console.serving import EXAMPLES

    file = tmp_path / "token"
    file.write_text("0123456789abcdef", encoding="utf-8")
    given = ["console", str(EXAMPLES / "rig.toml"), f"--{kind}-token-file", str(file)]
    assert "give --token-file, too" in CliRunner().invoke(cli, given).stderr
    same = CliRunner().invoke(cli, [*given, "--token-file", str(file), "--port", "0"])
    assert "two hold the same token" in same.stderr
