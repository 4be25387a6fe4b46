"""One rod on four suspensions, its light gates' files read by a job."""

from pathlib import Path

import pytest

from pmm.inertia import bifilar

DATA = Path(__file__).parents[3].parent / "shared" / "data" / "bifilar"
GEOMETRIES = ((0.396, 0.6245), (0.6, 0.830421), (1.092, 0.466593), (1.092, 1.26893))


@pytest.mark.skipif(not DATA.is_dir(), reason="the measured data are not beside the project")
def test_the_spread_is_reported_with_its_likeliest_cause(tmp_path: Path) -> None:
    text = "gravity_m_s2 = 9.81\nu_gravity_m_s2 = 0.001\n"
    for spacing, line in GEOMETRIES:
        name = f"s{spacing:.3f}_l{line}"
        text += (
            f'[[suspensions]]\nname = "{name}"\nhalf_spacing_m = {spacing / 2}\n'
            f"u_half_spacing_m = 2.5e-4\nline_m = {line}\nu_line_m = 5e-4\n"
            f'yaw = {{ gates = ["{(DATA / name).as_posix()}.csv"] }}\n'
        )
    path = tmp_path / "rod.toml"
    path.write_text(text)
    outcome = bifilar.run(str(path))
    found = {one.name: one.estimate for one in outcome.findings}
    each = [one.value for name, one in found.items() if name.endswith("by_period_m")]
    assert len(each) == 4
    assert all(0.339 <= round(one, 3) <= 0.348 for one in each)
    assert found["k_yaw_m"].uncertainty == pytest.approx(0.0034, abs=2e-4)
    messages = {flag.code: flag.message for flag in outcome.flags}
    assert "likeliest cause: the lines are longer than measured" in messages["unexplained_spread"]
    assert "single_run" in messages
