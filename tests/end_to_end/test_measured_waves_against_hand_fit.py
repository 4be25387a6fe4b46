"""Measured wave forces on a fixed ship section, from text to table.

The record is public (its source is in ``docs/formats.md``); the figures of eight periods were found
by hand with a least-squares fit.
"""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from pmm.cli import cli

RECORD = Path(__file__).parents[2].parent / "shared" / "data" / "wave_forces" / "2091_1.csv.gz"

pytestmark = pytest.mark.skipif(
    not RECORD.exists(), reason="the measured wave forces are not beside the project"
)


def analysed(*options: str) -> dict[str, Any]:
    arguments = ["analyse", str(RECORD), "--reference", "WM_Position", "--channel", "Fy", "--json"]
    done = CliRunner().invoke(cli, [*arguments, *options], catch_exceptions=False)
    assert done.exit_code == 0
    (rows,) = json.loads(done.stdout)["runs"]
    return dict(rows)


def amplitudes(rows: dict[str, Any]) -> list[float]:
    (channel,) = rows["gates"][0]["channels"]
    assert (channel["name"], channel["unit"]) == ("Fy", "N")
    return [one["amplitude"]["value"] for one in channel["harmonics"]]


def test_the_given_window_agrees_with_the_fit_by_hand_and_is_flagged() -> None:
    rows = analysed("--opens-at", "33.23", "--periods", "8")
    first, second, third = amplitudes(rows)
    assert 15.7 < first < 15.9
    assert 0.218 < second < 0.257
    assert 0.110 < third < 0.144
    assert rows["window"] == "given"
    # The force is still building up there, so the number is no steady one.
    flags = {flag["code"]: flag for flag in rows["gates"][0]["flags"]}
    assert flags["transient"]["severity"] == "warning"
    assert flags["transient"]["channel"] == "Fy"
    assert rows["gates"][0]["channels"][0]["harmonics"][0]["amplitude"]["half_width"] > 1.0


def test_the_steady_stretch_is_found() -> None:
    rows = analysed()
    assert rows["window"] == "found steady"
    assert rows["window_periods"] >= 8
    assert rows["window_opened_s"] > 36.0
    assert amplitudes(rows)[0] == pytest.approx(19.6, abs=0.15)
    assert "transient" not in {flag["code"] for flag in rows["gates"][0]["flags"]}
    assert (rows["reference"], rows["reference_channel"]) == ("signal", "WM_Position")
    assert rows["reference_frequency_hz"] == pytest.approx(1.0 / 1.036, rel=2e-3)


def test_the_table_warns_in_words() -> None:
    arguments = ["analyse", str(RECORD), "--reference", "WM_Position", "--channel", "Fy"]
    done = CliRunner().invoke(cli, [*arguments, "--opens-at", "33.23", "--periods", "8"])
    (line,) = (line for line in done.stdout.splitlines() if "[transient]" in line)
    assert line.startswith("WARNING Fy: ")
