"""The options around the resolver, on signals whose content is known: carrier, leakage, 1963."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli

RATE_HZ, FREQUENCY_HZ, CARRIER_HZ = 8000.0, 1.0, 1000.0
IN_PHASE, QUADRATURE, MEAN = 3.0, -1.5, 0.7


def force(times_s: np.ndarray) -> np.ndarray:
    theta = 2.0 * np.pi * FREQUENCY_HZ * times_s
    return MEAN + IN_PHASE * np.sin(theta) + QUADRATURE * np.cos(theta)


def write(folder: Path, values: np.ndarray, times_s: np.ndarray) -> Path:
    path = folder / "run.csv"
    table = np.column_stack((times_s, values))
    np.savetxt(path, table, delimiter=",", header="Time [s],F [N]", comments="", fmt="%.12g")
    return path


def analyse(*arguments: str | Path) -> dict[str, Any]:
    result = CliRunner().invoke(cli, ["analyse", "--json", *map(str, arguments)])
    assert result.exit_code == 0, result.stderr
    run: dict[str, Any] = json.loads(result.stdout)["runs"][0]
    return run


def first_harmonic(run: dict[str, Any]) -> tuple[float, float]:
    harmonic = run["gates"][0]["channels"][0]["harmonics"][0]
    return harmonic["in_phase"]["value"], harmonic["quadrature"]["value"]


def test_a_signal_on_a_carrier_is_detected_first(tmp_path: Path) -> None:
    times_s = np.arange(0.0, 6.0, 1.0 / RATE_HZ)
    path = write(tmp_path, force(times_s) * np.sin(2.0 * np.pi * CARRIER_HZ * times_s), times_s)
    run = analyse(
        path, "--frequency", FREQUENCY_HZ, "--channel", "F", "--carrier", CARRIER_HZ,
        "--bandwidth", 20,
    )  # fmt: skip
    # The record loses half a filter at its start, and with it the phase of the first sample.
    turned = complex(*first_harmonic(run))
    assert abs(turned) == pytest.approx(np.hypot(IN_PHASE, QUADRATURE), rel=1e-6)
    mean = run["gates"][0]["channels"][0]["mean"]["value"]
    assert abs(mean) == pytest.approx(MEAN, rel=1e-6)
    assert {"carrier_phase_estimated", "carrier_ends_dropped"} <= {
        flag["code"] for flag in run["flags"]
    }


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--carrier", "1000"), "--channel"),
        (("--bandwidth", "20"), "--carrier"),
        (("--let-through", "5000"), "4000 Hz"),
    ],
)
def test_what_cannot_be_done_is_said(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    times_s = np.arange(0.0, 3.0, 1.0 / RATE_HZ)
    path = write(tmp_path, force(times_s), times_s)
    result = CliRunner().invoke(cli, ["analyse", str(path), "--frequency", "1", *options])
    assert result.exit_code == 2
    assert words in result.stderr


def test_what_a_gate_lets_through_is_the_closed_form(tmp_path: Path) -> None:
    times_s = np.arange(0.0, 4.0, 1.0 / 400.0)
    path = write(tmp_path, force(times_s), times_s)
    run = analyse(
        path, "--frequency", 1, "--opens-at", 0, "--periods", 3, "--no-drift", "--let-through", 5.37
    )
    (leak,) = run["let_through"]
    sinc = [abs(np.sinc(3 * (5.37 - n))) + abs(np.sinc(3 * (5.37 + n))) for n in (1, 2, 3)]
    assert leak["frequency_hz"] == 5.37
    assert leak["parts"] == pytest.approx(sinc, rel=0.01)


def test_modes_of_1963_stand_beside_the_new_estimator(tmp_path: Path) -> None:
    times_s = np.arange(0.0, 12.0, 1.0 / 100.0)
    path = write(tmp_path, force(times_s), times_s)
    run = analyse(path, "--frequency", 1.0137, "--classic", "--harmonics", 1)
    rows = {row["mode"]: row["parts"] for row in run["classic"]}
    assert list(rows) == [
        "new: whole periods",
        *(f"gated integration, m = {m}" for m in (1, 2, 3, 4)),
        "gate cut to whole samples, m = 1",
        "running average, 1.5 periods",
    ]
    assert rows["new: whole periods"] == pytest.approx(first_harmonic(run), abs=1e-12)


def test_a_mode_without_time_to_settle_reads_nothing(tmp_path: Path) -> None:
    times_s = np.arange(0.0, 4.0, 1.0 / 100.0)
    run = analyse(
        write(tmp_path, force(times_s), times_s), "--frequency", 1, "--classic", "--harmonics", 1
    )
    rows = {row["mode"]: row["parts"] for row in run["classic"]}
    assert rows["running average, 1.5 periods"] == [None, None]
    assert rows["gated integration, m = 4"] == [None, None]
    assert rows["gated integration, m = 1"] == pytest.approx((IN_PHASE, QUADRATURE), abs=1e-2)
