"""``pmm analyse --response-to`` on a load that is written down: a gain, a delay and a square."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli

BASE_HZ, RATE_HZ, PERIODS = 0.5, 100.0, 8
LINES = (1, 3, 7, 9)
GAIN, LATER_S, SQUARE = 40.0, 0.03, 25.0


def written(folder: Path) -> Path:
    times_s = np.arange(0.0, PERIODS / BASE_HZ + 0.5 / RATE_HZ, 1.0 / RATE_HZ)

    def motion(at_s: np.ndarray) -> np.ndarray:
        theta = 2.0 * np.pi * BASE_HZ * at_s
        return np.asarray(sum(0.1 * np.sin(n * theta + n**2) for n in LINES))

    noise = 0.02 * np.random.default_rng(1).normal(size=len(times_s))
    load = GAIN * motion(times_s - LATER_S) + SQUARE * motion(times_s) ** 2 + noise
    path = folder / "run.csv"
    table = np.column_stack((times_s, motion(times_s), load))
    np.savetxt(path, table, delimiter=",", header="Time [s],y [m],F [N]", comments="", fmt="%.9g")
    return path


@pytest.mark.slow
def test_table_figure_and_json(tmp_path: Path) -> None:
    path, plots = written(tmp_path), tmp_path / "plots"
    asked = ["analyse", str(path), "--frequency", str(BASE_HZ), "--harmonics", "10",
             "--local-polynomials", "--response-to", "y", "--opens-at", "0"]  # fmt: skip
    shown = CliRunner().invoke(cli, [*asked, "--plot", str(plots)])
    assert shown.exit_code == 0, shown.output
    assert "Response to y" in shown.stdout
    assert "more than noise" in shown.stdout
    assert (plots / "run-response.svg").exists()
    told = json.loads(CliRunner().invoke(cli, [*asked, "--json"]).stdout)["runs"][0]["response"]
    assert tuple(row["line"] for row in told["lines"]) == LINES
    for row in told["lines"]:
        assert row["gain"] == pytest.approx(GAIN, abs=2.0 * row["gain_half_width"])
        phase_deg = -360.0 * row["line"] * BASE_HZ * LATER_S
        assert row["phase_deg"] == pytest.approx(phase_deg, abs=2.0 * row["phase_half_width_deg"])
    even = next(one for one in told["distortions"] if one["degree"] == "even")
    assert even["told"]
    assert even["lines"] == [2, 4, 6, 8, 10]
    a = 0.1 * np.exp(1j * np.array(LINES) ** 2) / 2j
    lines = np.zeros(2 * 10 + 1, dtype=complex)
    lines[[10 + n for n in LINES]], lines[[10 - n for n in LINES]] = a, a.conj()
    square = 2.0 * np.abs(np.convolve(lines, lines)[20:])[[2, 4, 6, 8, 10]]
    assert even["level"] == pytest.approx(SQUARE * np.sqrt((square**2).mean()), rel=0.05)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--line", "3"), "--response-to"),
        (("--response-to", "x"), "'x'"),
        (("--hann", "--local-polynomials"), "two estimators"),
        (("--response-to", "y", "--line", "5"), "resolve 5 harmonics"),
    ],
)
def test_what_cannot_be_is_said(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    asked = ["analyse", str(written(tmp_path)), "--frequency", str(BASE_HZ), *options]
    result = CliRunner().invoke(cli, asked)
    assert result.exit_code != 0
    assert words in result.stderr
