"""``docs/coefficients-command.md`` names every option, key and flag; its examples are read."""

import re
import tomllib
from dataclasses import fields
from pathlib import Path

from pmm.cli.coefficients import coefficients
from pmm.cli.report import report
from pmm.coefficients.settings import (
    AmplifierTable,
    CoefficientSettings,
    ReferenceFile,
    ShipTable,
    read_settings,
)
from tests.sim.devices.benches import ROOT

PAGE = (ROOT / "docs" / "coefficients-command.md").read_text(encoding="utf-8")


def test_options() -> None:
    known = {name for one in (coefficients, report) for p in one.params for name in p.opts}
    known = {name for name in known if name.startswith("--")}
    named = set(re.findall(r"--[a-z]+(?:-[a-z]+)*", PAGE))
    assert known <= named
    assert named - known == set()


def test_keys() -> None:
    for kind in (CoefficientSettings, ShipTable, AmplifierTable, ReferenceFile):
        for one in fields(kind):
            assert re.search(rf"\b{one.name}\b", PAGE), one.name


def test_the_example_is_read(tmp_path: Path) -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.S)
    (tmp_path / "coefficients.toml").write_text(text)
    found = read_settings(tmp_path / "coefficients.toml")
    assert found.ship.length_m == tomllib.loads(text)["ship"]["length_m"]
    assert found.inertia == str(tmp_path / "model.toml")
    assert found.references[0].file == str(tmp_path / "strip.csv")


def test_flags() -> None:
    source = "".join(
        path.read_text(encoding="utf-8")
        for place in ("pmm/coefficients", "pmm/report")
        for path in sorted((ROOT / place).glob("*.py"))
    )
    codes = set(re.findall(r'(?:Flag|_note)\(\s*"([a-z_]+)"', source))
    assert codes >= {"nothing_stated", "run_left_out"}
    for code in codes:
        assert f"`{code}`" in PAGE, code
