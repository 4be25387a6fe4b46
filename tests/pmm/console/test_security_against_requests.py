"""What the console refuses, asked from outside without a browser."""

import json
from pathlib import Path

import pytest
from starlette.websockets import WebSocketDisconnect

from pmm.console.audit import COMMANDS
from tests.pmm.console.serving import EXAMPLES, OWN, SESSION, served

TOKEN = "a token of more than sixteen"  # noqa: S105 - the test's own
WATCH = "a token for watching alone"
START = {"command": "start"}


def test_a_foreign_origin_is_refused_whatever_it_asks(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        for origin in ("http://evil.example", "null", "https://127.0.0.1:8063", OWN + "0", ""):
            assert one.post("/api/command", START, origin=origin)[0] == 403
        answer = one.browser.get("/api/plans", headers={"origin": "http://evil.example"})
        assert answer.status_code == 403
        for headers in ({"origin": "http://evil.example"}, {}):
            with (
                pytest.raises(WebSocketDisconnect) as refused,
                one.browser.websocket_connect(one.stream, headers=headers),
            ):
                pass
            assert refused.value.code == 1008
        assert not one.orders


def test_a_foreign_name_for_this_machine_is_refused(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        answer = one.browser.get("/", headers={"host": "rig.evil.example:8063"})
        assert answer.status_code == 421
        assert "rig.evil.example" in answer.text


def test_nothing_acts_by_get(tmp_path: Path) -> None:
    paths = ("command", "answer", "take-control", "plans/check", "plans/queue", "plans/drop")
    with served(tmp_path) as one:
        for path in paths:
            assert one.browser.get(f"/api/{path}").status_code == 405
        assert not one.orders


def test_only_who_has_control_acts_and_everybody_may_stop_quickly(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        with one.browser.websocket_connect(
            f"{one.stream}?session={SESSION}", headers={"origin": OWN}
        ) as stream:
            assert stream.receive_json()["desk"]["holder"] == "you"
            assert one.post("/api/command", START) == (200, {"said": "start taken"})
            watcher = {"x_pmm_session": "fedcba9876543210"}
            status, said = one.post("/api/command", START, **watcher)
            assert status == 403
            assert "take control" in str(said["error"])
            assert one.post("/api/command", {"command": "quick stop"}, **watcher)[0] == 200
            assert one.post("/api/take-control", {"confirm": False}, **watcher)[0] == 422
            assert one.post("/api/take-control", {"confirm": True}, **watcher)[0] == 200
            assert one.post("/api/command", START)[0] == 403
        assert [order.text for order in one.orders] == ["start", "quick stop"]


def test_every_command_is_logged_with_time_and_origin(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        one.post("/api/take-control", {"confirm": True})
        one.post("/api/command", START)
        one.post("/api/command", {"command": "fly"})
        lines = (tmp_path / COMMANDS).read_text(encoding="utf-8").splitlines()
    found = [json.loads(line) for line in lines]
    assert [(line["action"], line["taken"]) for line in found] == [
        ("take control", True),
        ("command", True),
        ("command", False),
    ]
    assert {line["address"] for line in found} == {"127.0.0.1"}
    assert {line["session"] for line in found} == {SESSION[:8]}
    assert all(line["utc"].endswith("+00:00") for line in found)


@pytest.mark.parametrize(
    ("path", "body", "named"),
    [
        ("command", {"command": "fly"}, "command"),
        ("command", {"command": "start", "speed": 2}, "speed"),
        ("plans/drop", {"number": "one"}, "number"),
        ("answer", {"question": "", "answer": "x" * 1001}, "answer"),
    ],
)
def test_what_is_no_such_request_is_refused_by_name(
    tmp_path: Path, path: str, body: object, named: str
) -> None:
    with served(tmp_path) as one:
        one.post("/api/take-control", {"confirm": True})
        status, said = one.post(f"/api/{path}", body)
        assert status == 422
        assert named in str(said["error"])
        assert not one.orders


def test_a_plan_is_held_against_the_models_of_plan_toml(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        status, said = one.post("/api/plans/check", {"text": 'rig = "rig.toml"\n[[runz]]\n'})
        assert status == 409
        assert "did you mean runs" in str(said["error"])
        status, said = one.post("/api/plans/check", {"name": "../rig/plan.toml"})
        assert status == 409
        assert "no plan" in str(said["error"])
        status, said = one.post("/api/plans/check", {"name": "plan.toml"})
        assert status == 200
        assert said["plan"]["name"] == "vertical-run"  # type: ignore[index]
        assert one.post("/api/plans/check", {"text": "x" * (2 << 20)})[0] in (409, 422)
    there = {path.name for path in (tmp_path / "rig").glob("*.toml")}
    assert there == {path.name for path in EXAMPLES.glob("*.toml")}


def test_a_token_is_asked_for_where_one_is_set(tmp_path: Path) -> None:
    remote = "http://rig.tank.example:8063"
    with served(tmp_path, token=TOKEN, host="0.0.0.0", origin=remote) as one:  # noqa: S104
        assert one.browser.get("/", follow_redirects=False).headers["location"] == "/login"
        assert one.browser.get("/api/plans").status_code == 401
        assert one.post("/api/command", {"command": "quick stop"})[0] == 401
        with (
            pytest.raises(WebSocketDisconnect) as refused,
            one.browser.websocket_connect(one.stream, headers={"origin": remote}),
        ):
            pass
        assert refused.value.code == 1008
        assert one.post("/login", {"token": "a token of more than sixteeN"})[0] == 401
        assert one.post("/login", {"token": TOKEN}, origin="http://evil.example")[0] == 403
        assert one.post("/login", {"token": TOKEN})[0] == 200
        cookie = next(iter(one.browser.cookies.jar))
        assert cookie.has_nonstandard_attr("HttpOnly")
        assert cookie.get_nonstandard_attr("SameSite").casefold() == "strict"  # type: ignore[union-attr]
        assert TOKEN not in str(cookie.value)
        assert one.browser.get("/api/plans").status_code == 200
        assert one.post("/api/command", {"command": "quick stop"})[0] == 200


def test_a_login_that_is_no_such_body_is_told_what_is_wrong_without_the_token(
    tmp_path: Path,
) -> None:
    with served(tmp_path, token=TOKEN) as one:
        for body, named in (
            ({"token": TOKEN, "name": "a" * 101}, "name: "),
            ({"name": "a"}, "token: "),
            ({"token": TOKEN, "name": "a" * (1 << 15)}, "larger than"),
        ):
            status, said = one.post("/login", body)
            assert status == 422
            assert named in str(said["error"])
            assert TOKEN not in str(said["error"])
        form = one.browser.post("/login", data={"token": TOKEN}, headers={"origin": OWN})
        assert form.status_code == 422
        assert "body: Invalid JSON" in form.json()["error"]
        assert TOKEN not in form.text


def test_who_has_the_token_for_watching_stops_quickly_and_does_nothing_else(
    tmp_path: Path,
) -> None:
    remote = "http://rig.tank.example:8063"
    doors = {"token": TOKEN, "watch_token": WATCH, "host": "0.0.0.0", "origin": remote}  # noqa: S104
    with served(tmp_path, **doors) as one:
        assert one.post("/login", {"token": WATCH, "name": "N. N."})[0] == 200
        stream = f"{one.stream}?session={SESSION}"
        with one.browser.websocket_connect(stream, headers={"origin": remote}) as watching:
            desk = watching.receive_json()["desk"]
            assert (desk["role"], desk["holder"]) == ("watch", "nobody")
            for path, body in (
                ("/api/take-control", {"confirm": True}),
                ("/api/command", {"command": "start"}),
                ("/api/answer", {"question": "?", "answer": "y"}),
                ("/api/plans/queue", {"name": "plan.toml"}),
                ("/api/plans/hold", {"number": 1, "held": True}),
                ("/api/plans/note", {"number": 1, "text": "x", "author": "x"}),
            ):
                status, said = one.post(path, body)
                assert (status, "for watching" in str(said["error"])) == (403, True)
            assert [order.text for order in one.orders] == []
            assert one.post("/api/command", {"command": "quick stop"})[0] == 200
            told = watching.receive_json()
            while told["type"] != "audit" or told["entry"]["action"] != "take control":
                told = watching.receive_json()
            assert told["entry"]["name"] == "N. N."
        one.browser.cookies.clear()
        assert one.post("/login", {"token": TOKEN, "name": "O. O."})[0] == 200
        with one.browser.websocket_connect(stream, headers={"origin": remote}) as operating:
            desk = operating.receive_json()["desk"]
            assert (desk["role"], desk["holder"]) == ("operate", "you")
        lines = (tmp_path / COMMANDS).read_text(encoding="utf-8").splitlines()
        assert one.browser.get("/api/audit").json()["audit"] == [json.loads(one) for one in lines]
    done = [json.loads(line) for line in lines]
    assert [(one["name"], one["role"], one["action"], one["taken"]) for one in done] == [
        ("N. N.", "watch", "log in", True),
        ("N. N.", "watch", "take control", False),
        ("N. N.", "watch", "command", False),
        ("N. N.", "watch", "answer", False),
        ("N. N.", "watch", "queue", False),
        ("N. N.", "watch", "hold", False),
        ("N. N.", "watch", "note", False),
        ("N. N.", "watch", "command", True),
        ("O. O.", "operate", "log in", True),
    ]


def test_pages_are_kept_apart_and_load_nothing_from_elsewhere(tmp_path: Path) -> None:
    (tmp_path / "report.html").write_text("<p>report</p>", encoding="utf-8")
    (tmp_path / "secret.txt").write_text("no", encoding="utf-8")
    with served(tmp_path) as one:
        policy = one.browser.get("/").headers["content-security-policy"]
        assert "default-src 'self'" in policy
        assert "http" not in policy
        listed = one.browser.get("/api/pages").json()["pages"]
        assert [page["name"] for page in listed] == ["report.html"]
        page = one.browser.get(listed[0]["address"])
        assert page.text == "<p>report</p>"
        assert page.headers["content-security-policy"].startswith("sandbox")
        for path in ("/pages/0/secret.txt", "/pages/9/report.html", "/pages/0/..%2Fsecret.txt"):
            assert one.browser.get(path).status_code == 404
        for name in ("console.js", "traces.js", "console.css"):
            text = one.browser.get(f"/page/{name}").text
            assert "//" not in text.replace("://${location.host}", "").replace("// ", "")
        assert "uPlot" in one.browser.get("/charts/uPlot.iife.js").text
