"""``pmm devices`` as typed: on the bus in process, over multicast, over slcan, on a port."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from sim.devices.terminal import PseudoTerminal
from tests.sim.devices.benches import WHOLE, Hosted, amplifier, multicast_works, toml

_VERTICAL = Path(__file__).parents[3] / "examples" / "vertical"
_MOTOR = """
[campaign.drive.motor]
constant_n_m_a = 0.8
gear_inertia_kg_m2 = 0.7
loop = { proportional = 2.0, integral = 10.0 }
"""
PARTS = {**WHOLE, "forces": [amplifier(4, "force_aft", "force_fore")]}


def devices(*words: str, typed: str | None = None) -> Result:
    return CliRunner().invoke(cli, ["devices", *map(str, words)], input=typed)


def document(*words: str, status: int = 0) -> dict[str, Any]:
    result = devices(*words, "--json")
    assert result.exit_code == status, result.output
    found = json.loads(result.stdout)
    assert found["schema"] == "pmm-devices-1"
    assert found["job"] == words[0]
    return found


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    """A rig on the bus in process, whose simulation lies beside its file."""
    return written(tmp_path, PARTS)


@pytest.fixture
def whole(tmp_path: Path) -> Path:
    """The vertical example: a rig's whole file, with its simulation."""
    for name in ("rig.toml", "simulated.toml"):
        shutil.copy(_VERTICAL / name, tmp_path / name)
    return tmp_path / "rig.toml"


def written(folder: Path, parts: dict[str, Any], **more: Any) -> Path:
    bus = {"interface": "pmm-simulated", "channel": "simulated.toml", "receive_thread": False}
    tables = {"bus": bus, **parts, **more}
    (folder / "simulated.toml").write_text('rig = "rig.toml"\n', encoding="utf-8")
    (folder / "rig.toml").write_text(toml(tables), encoding="utf-8")
    return folder / "rig.toml"


def test_a_scan_of_a_rigs_file_names_the_parts(rig: Path) -> None:
    found = document("scan", rig, "--listen", "0.1")
    assert [(one["node_id"], one["part"]) for one in found["nodes"]] == [
        (1, "shaft"),
        (2, "eccentricity"),
        (3, "phase"),
        (4, "forces[0]"),
    ]
    assert found["wrong"] == []
    assert found["nodes"][0]["tpdos"][0] == {
        "cob_id": 0x181,
        "transmission": 1,
        "objects": ["6041:0", "6061:0", "6064:0"],
    }
    shown = devices("scan", rig, "--listen", "0.1")
    assert shown.exit_code == 0
    assert "402 drive" in shown.stdout
    assert "pre-operational" in shown.stdout


def test_who_does_not_answer_is_named(tmp_path: Path) -> None:
    rig = written(tmp_path, PARTS)
    other = tmp_path / "other.toml"
    text = rig.read_text(encoding="utf-8")
    other.write_text(text.replace("node = 3", "node = 33"), encoding="utf-8")
    found = document("scan", other, "--listen", "0.1", status=1)
    assert any("phase: node 33 does not answer" in one for one in found["wrong"])
    assert "node 3 answers and is not in the rig's file" in found["wrong"]


def test_values_are_read_once_from_rig_and_bus(rig: Path) -> None:
    found = document("read", rig, "--once")
    values = {(one["device"], one["what"]): one["value"] for one in found["values"]}
    assert values["shaft", "state"] == "switch on disabled"
    assert values["eccentricity", "position"] is None
    assert abs(values["forces[0]", "force_aft"]) < 1.0
    channel = rig.with_name("simulated.toml")
    alone = document("read", "--interface", "pmm-simulated", "--channel", channel, "--once")
    named = {one["what"]: one["value"] for one in alone["values"] if one["device"] == "node 1"}
    assert named["6041:0 Statusword"] == 0x0250


def test_a_live_table_ends_after_its_seconds(rig: Path) -> None:
    shown = devices("read", rig, "--seconds", "0.3")
    assert shown.exit_code == 0
    assert "force_fore" in shown.stdout


@pytest.mark.slow
def test_an_axis_moves_when_it_is_confirmed_only(rig: Path) -> None:
    words = ("move", "eccentricity", "20mm", rig, "--free-running")
    refused = devices(*words, typed="n\n")
    assert refused.exit_code == 1
    assert "move to 0.02 m. Is the way clear?" in refused.stderr
    assert "stands at" not in refused.stdout
    agreed = devices(*words, typed="y\n")
    assert agreed.exit_code == 0
    assert "eccentricity stands at 0.02 ± 1e-05 m (encoder)" in agreed.stdout
    found = document("move", "phase", "30deg", rig, "--free-running", "--yes")
    assert found["reading"]["value"] == pytest.approx(0.5236, abs=1e-3)


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (("move", "eccentricity", "61mm"), 1, "0.061 m is outside 0 to 0.06 m; nothing was moved"),
        (("move", "eccentricity", "-1mm"), 1, "-0.001 m is outside 0 to 0.06 m"),
        (("move", "eccentricity", "20deg"), 2, "with or without a unit (m, mm)"),
        (("move", "shaft", "1"), 2, "the rig has eccentricity, phase"),
        (("photocell", "--turn", "1"), 2, "rig.toml: oscillator is missing"),
        (("gauges", "--channel", "force_aff"), 2, "the rig has force_aft, force_fore"),
    ],
)
def test_what_is_refused_is_named(rig: Path, words, status, said) -> None:
    result = devices(*words, rig, "--free-running", *(["--yes"] if words[0] != "gauges" else []))
    assert result.exit_code == status
    assert said in result.stderr


def test_the_photocell_command_turns_the_shaft_and_judges(rig: Path, whole: Path) -> None:
    words = ("photocell", whole, "--yes", "--free-running", "--turn")
    found = document(*words, "1")
    assert found["good"]
    assert [one["seconds"] for one in found["intervals"]] == pytest.approx([1.0] * 4, abs=0.01)
    assert [one["verdict"] for one in found["intervals"]] == [""] * 4
    nobody = devices("photocell", rig, "--within", "1", "--free-running")
    assert nobody.exit_code == 1
    assert "0 pulses in the time; check lamp, slot, cable and input" in nobody.stderr
    refused = devices(*words, "3")
    assert refused.exit_code == 1
    assert "3 Hz is outside" in refused.stderr


@pytest.mark.parametrize("job", [("photocell", "--turn", "1"), ("tune",)])
def test_what_turns_the_shaft_watches_the_loads(whole: Path, job: tuple[str, ...]) -> None:
    gauge = '\n[[gauges]]\nchannel = "force_aft"\nfull_scale_n = 0.04\nsafe_load_n = 0.05\n'
    whole.write_text(whole.read_text(encoding="utf-8") + _MOTOR + gauge, encoding="utf-8")
    stopped = devices(*job, whole, "--yes", "--free-running")
    assert stopped.exit_code == 1
    assert "is beyond its safe load, 0.05 N" in stopped.stderr


def test_the_push_test_finds_gauges_swapped_in_the_rigs_file(rig: Path) -> None:
    right = document("gauges", rig, "--free-running")
    assert [one["push"]["channel"] for one in right["gauges"]] == ["force_aft", "force_fore"]
    text = rig.read_text(encoding="utf-8")
    (rig.with_name("simulated.toml")).write_text('rig = "right.toml"\n', encoding="utf-8")
    rig.with_name("right.toml").write_text(text, encoding="utf-8")
    for a, b in (("9130:1", "9130:9"), ("9130:2", "9130:1"), ("9130:9", "9130:2")):
        text = text.replace(a, b)
    rig.write_text(text, encoding="utf-8")
    wrong = devices("gauges", rig, "--free-running")
    assert wrong.exit_code == 1
    assert "exchange the plugs of force_aft and force_fore" in wrong.stderr
    assert "came in on force_fore, sign +" in wrong.stdout


def test_a_rig_of_serial_lines_alone_has_its_own_time(tmp_path: Path) -> None:
    port = {"url": "sim://simulated.toml/inclinometer"}
    part = {"driver": "serial-inclinometer", "port": port}
    rig = written(tmp_path, {}, inclinometer=part)
    text = "\n".join(rig.read_text(encoding="utf-8").splitlines()[4:])
    rig.write_text(text, encoding="utf-8")
    assert "interface" not in text
    found = document("scan", rig, "--listen", "0.3")
    assert found["ports"]["inclinometer"]["is"] == "inclinometer"
    assert found["ports"]["inclinometer"]["per_second"] == pytest.approx(256.0, rel=0.1)
    values = document("read", rig, "--once")["values"]
    assert values == [
        {"device": "inclinometer", "what": "inclinometer", "value": 0.0, "unit": "rad"}
    ]


@pytest.mark.slow
@pytest.mark.parametrize("interface", ["udp_multicast", "slcan"])
def test_a_bus_of_another_process_is_scanned(interface: str, tmp_path: Path) -> None:
    if interface == "udp_multicast" and not multicast_works():
        pytest.skip("multicast does not come through on this machine")
    host = Hosted(PARTS, tmp_path, interface)
    try:
        bus = dict(host.said["bus"])
        words = ["--interface", bus.pop("interface"), "--channel", bus.pop("channel")]
        bus |= {"sleep_after_open": 0} if interface == "slcan" else {}
        words += [part for key, value in bus.items() for part in ("--option", f"{key}={value}")]
        found = document("scan", *words, "--listen", "0.3")
        once = document("read", *words, "--once")
    finally:
        host.close()
    assert [one["node_id"] for one in found["nodes"]] == [1, 2, 3, 4]
    assert {one["state"] for one in found["nodes"]} == {"pre-operational"}
    assert {one["value"] for one in once["values"] if "Statusword" in one["what"]} == {0x0250}


def test_a_silent_port_and_a_bus_that_is_not_there_are_told() -> None:
    terminal = PseudoTerminal()
    try:
        silent = devices("scan", "--port", terminal.path, "--listen", "0.1")
    finally:
        terminal.close()
    assert silent.exit_code == 1
    assert "port: silent" in silent.stderr
    missing = devices("scan", "--interface", "no-such-thing", "--channel", "x")
    assert missing.exit_code == 1
    assert "no-such-thing" in missing.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("scan",), "nothing to look at"),
        (("scan", "--interface", "virtual", "--port", "x"), "virtual and x to look at"),
        (("scan", "--interface", "virtual", "--option", "x"), "write NAME=VALUE"),
        (("scna",), "did you mean 'scan'?"),
        (("scan", "no-such.toml"), "no-such.toml: no such file"),
    ],
)
def test_a_wrong_request_ends_with_2(words, said: str) -> None:
    result = devices(*words)
    assert result.exit_code == 2
    assert said in result.stderr


def test_free_running_is_for_simulated_rigs(tmp_path: Path) -> None:
    rig = written(tmp_path, PARTS)
    text = rig.read_text(encoding="utf-8").replace("pmm-simulated", "virtual")
    rig.write_text(text, encoding="utf-8")
    result = devices("move", "phase", "0.1", rig, "--free-running", "--yes")
    assert result.exit_code == 2
    assert "--free-running is for a simulated rig" in result.stderr


def test_ports_are_listed() -> None:
    assert isinstance(document("ports")["ports"], list)
