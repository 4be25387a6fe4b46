"""``docs/devices.md`` names the jobs, limits and words that the commands have."""

import re
from pathlib import Path

from click.testing import CliRunner

from pmm.cli import cli
from pmm.cli.devices import devices
from pmm.devices.pulses import EXTRA, MISSED
from pmm.devices.push_test import ALONE_SHARE, LEAST_SHARE, NOISE_TIMES
from pmm.report.devices_document import SCHEMA

PAGE = (Path(__file__).parents[3] / "docs" / "devices.md").read_text(encoding="utf-8")


def test_every_job_is_on_the_page_and_no_other() -> None:
    named = set(re.findall(r"pmm devices ([a-z]+)", PAGE))
    assert named == set(devices.names)


def test_every_option_on_the_page_is_one_of_a_job() -> None:
    shown = "".join(
        CliRunner().invoke(cli, ["devices", job, "--help"]).stdout for job in devices.names
    )
    for option in set(re.findall(r"--[a-z][a-z-]+", PAGE)):
        assert option in shown, option


def test_the_limits_are_those_of_the_code() -> None:
    assert f"above {NOISE_TIMES:g} standard deviations" in PAGE
    assert f"above {100.0 * LEAST_SHARE:g} % of full scale" in PAGE
    assert ALONE_SHARE == 0.5
    assert "more than half as much" in PAGE
    assert f"more than {MISSED} turns" in PAGE
    assert f"less than {EXTRA} turns" in PAGE
    assert SCHEMA in PAGE
