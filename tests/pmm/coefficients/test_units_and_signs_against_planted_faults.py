"""A force in kilonewtons and a gauge with its sign turned are said with the coefficients."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli
from tests.pmm.coefficients.campaigns import vertical_campaign
from tests.pmm.coefficients.test_set_points_and_tare_against_planted_slips import as_text


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("column", "source", "said"),
    [
        ("force_fore", "force_fore [N]:kN", "force_fore: units look wrong"),
        ("force_aft", "-force_aft [N]:N", "force_aft: its sign is opposite to expectation"),
    ],
)
def test_a_wrong_column_is_said(tmp_path: Path, column: str, source: str, said: str) -> None:
    vertical_campaign(tmp_path, (0.6, 0.9))
    for path in sorted(tmp_path.glob("*.nc")):
        as_text(path)
    text = (tmp_path / "campaign.toml").read_text()
    names = ("displacement_aft [m]", "displacement_fore [m]", "force_aft [N]", "force_fore [N]")
    sources = {one.split(" ")[0]: one for one in names} | {column: source}
    channels = "\n".join(f'{name} = "{one}"' for name, one in sources.items())
    for name in ("one", "two"):
        for frequency in ("0.6", "0.9"):
            run = f"{name}-{frequency}-20"
            text = text.replace(f'name = "{run}"\n', f'name = "{run}"\nfile = "{run}.csv"\n')
    columns = f'\n[columns]\ntime = "time [s]"\n[columns.channels]\n{channels}\n'
    (tmp_path / "campaign.toml").write_text(text + columns)
    shown = CliRunner().invoke(cli, ["coefficients", str(tmp_path)])
    assert shown.exit_code == 0, shown.output
    assert said in " ".join(shown.output.split())
