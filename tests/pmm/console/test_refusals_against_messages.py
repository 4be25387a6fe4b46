"""What ``pmm console`` refuses to begin with: one line each, with what to do, and its status."""

import shutil
import socket
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.console.plans import Plans
from pmm.plan.findings import PlanRefusedError
from pmm.plan.rig_file import read_rig_file
from tests.pmm.console.chromium import plan

EXAMPLES = Path(__file__).parents[3] / "examples" / "vertical"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copytree(EXAMPLES, tmp_path / "rig")
    (tmp_path / "token").write_text("a long and secret token", encoding="utf-8")
    (tmp_path / "short").write_text("too short", encoding="utf-8")
    (tmp_path / "table.csv").write_text("frequency_hz,Z_w\n0.5,abc\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _refused(*options: str) -> Result:
    result = CliRunner().invoke(cli, ["console", *options])
    assert not result.stdout
    return result


@pytest.mark.parametrize(
    ("options", "said", "status"),
    [
        (["none.toml"], "none.toml: no such file", 2),
        (["rig/plan.toml"], "is a plan, not a rig; give the rig's file that it names", 2),
        (["rig/rig.toml", "--plans", "none"], "--plans none: no such folder", 2),
        (["rig/rig.toml", "--earlier", "none"], "--earlier none: no such folder", 2),
        (["rig/rig.toml", "--output", "token"], "token is a file, not a folder", 2),
        (["rig/rig.toml", "--reference", "none.csv"], "none.csv: no such file", 2),
        (["rig/rig.toml", "--reference", "table.csv"], "line 2: Z_w is 'abc'", 1),
        (["rig/rig.toml", "--host", "127.0.0.2"], "give --token-file with a secret", 2),
        (["rig/rig.toml", "--token-file", "none"], "--token-file none: no such file", 2),
        (["rig/rig.toml", "--token-file", "short"], "9 characters (limit 16)", 2),
        (["rig/rig.toml", "--certificate", "token"], "--certificate and --key belong together", 2),
        (
            ["rig/rig.toml", "--certificate", "token", "--key", "token"],
            "not a certificate and its key in PEM",
            2,
        ),
        (
            ["rig/rig.toml", "--host", "192.0.2.1", "--token-file", "token"],
            "not an address of this machine",
            2,
        ),
    ],
)
def test_a_wrong_request_is_one_line(
    folder: Path, options: list[str], said: str, status: int
) -> None:
    result = _refused(*options)
    assert said in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert result.exit_code == status


def test_a_port_that_is_taken_is_told_from_other_reasons(folder: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        result = _refused("rig/rig.toml", "--port", str(other.getsockname()[1]))
    assert "the port is taken; is a console running already? --port 0" in result.stderr
    assert result.exit_code == 2


def test_unknown_keys_are_told_with_those_that_are_known(folder: Path) -> None:
    rig = folder / "rig" / "rig.toml"
    rig.write_text(f"rigg = 1\nzzz = 2\n{rig.read_text(encoding='utf-8')}", encoding="utf-8")
    result = _refused(str(rig))
    assert "zzz is not a known key; known: oscillator" in result.stderr
    assert "pydantic" not in result.stderr
    assert result.exit_code == 2


def test_the_text_of_a_plan_that_the_rig_refuses_is_not_kept(folder: Path) -> None:
    rig = folder / "rig" / "rig.toml"
    plans = Plans(rig, read_rig_file(rig).hashes, folder / "rig", folder / "out")
    before = sorted((folder / "rig").iterdir())
    with pytest.raises(PlanRefusedError, match=r"0\.09 is above 0\.06"):
        plans.queue("", plan("far").replace("20.0", "90.0"))
    assert sorted((folder / "rig").iterdir()) == before
    plans.queue("", plan("near"))
    assert len(plans.names()) == len([one for one in before if one.name == "plan.toml"]) + 1
