"""One table as loggers and spreadsheets of several countries write it is one recording."""

from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording

TIMES_S = 0.05 * np.arange(40)
VALUES_M = np.round(0.02 * np.sin(3.0 * TIMES_S) + 0.5, 5)


def _written(
    path: Path, form: str, header: str, *, comma: bool = False, day_s: float = 0.0
) -> Path:
    rows = []
    for time_s, value in zip(TIMES_S, VALUES_M, strict=True):
        hours, rest = divmod(day_s + time_s, 3600.0)
        minutes, seconds = divmod(rest, 60.0)
        clock = f"{int(hours):02d}:{int(minutes):02d}:{seconds:05.2f}"
        row = form.format(t=f"{time_s:.2f}", x=f"{value:.5f}", clock=clock)
        rows.append(row.replace(".", ",") if comma else row)
    path.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("form", "header", "how"),
    [
        ("{t}|{x}", "t [s]|x [m]", {}),
        ("{t}|{x}", "t [s]|x [m]", {"comma": True}),
        ('"{t}";"{x}"', '"t [s]";"x [m]"', {"comma": True}),
        ("{t},{x}", "Heave test\nby hand\nt [s],x [m]", {}),
        ("{t};{x};", "Heave test\nt [s];x [m];", {"comma": True}),
        ("{clock};{x}", "t [s];x [m]", {"day_s": 43_000.0}),
        ("{clock}\t{x}", "t [s]\tx [m]", {"day_s": 3.0, "comma": True}),
    ],
)
def test_it_is_the_same(tmp_path: Path, form: str, header: str, how: dict[str, float]) -> None:
    found = read_recording(_written(tmp_path / "run.csv", form, header, **how))  # type: ignore[arg-type]
    assert found.channel_names == ("x",)
    assert found.channels[0].unit == "m"
    assert found.sample_rate_hz == pytest.approx(20.0, rel=1e-9)
    assert found.start_s == pytest.approx(how.get("day_s", 0.0), abs=1e-9)
    np.testing.assert_array_equal(found.values("x"), VALUES_M)


def test_quoted_decimal_commas_between_commas(tmp_path: Path) -> None:
    rows = [
        f'"{t:.2f}","{x:.5f}"'.replace(".", ",") for t, x in zip(TIMES_S, VALUES_M, strict=True)
    ]
    path = tmp_path / "run.csv"
    path.write_text("\n".join(['"t [s]","x [m]"', *rows, ""]), encoding="utf-8")
    np.testing.assert_array_equal(read_recording(path).values("x"), VALUES_M)
