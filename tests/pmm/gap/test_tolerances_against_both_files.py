"""The tolerances that a diagnosis uses, against what ``campaign.toml`` and ``case.toml`` state."""

from pathlib import Path

import pytest

from analysis.gap.forward.tolerances import Tolerances
from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign_file import read_campaign
from pmm.gap.case import read_case, stated_tolerances
from tests.pmm.gap.rigs import short


def written(folder: Path, campaign: str = "", case: str = "") -> Path:
    """Write a campaign file with a table of tolerances, and one beside it."""
    file = folder / "campaign.toml"
    head, runs = short().split("[[runs]]", 1)
    file.write_text(f"{head}\n[tolerances]\n{campaign}\n[[runs]]{runs}")
    (folder / "case.toml").write_text(f"[tolerances]\n{case}\n")
    return file


def test_each_file_states_its_own_keys(tmp_path: Path) -> None:
    file = written(tmp_path, "zero_n = 0.2\ngain_relative = 0.01", "cg_m = 0.003\nzero_n = 0.2")
    expected = Tolerances(zero_n=0.2, gain_relative=0.01, cg_m=0.003)
    assert read_case(file).tolerances == expected
    assert stated_tolerances(file) == {
        "zero_n": (0.2, "case.toml"),
        "gain_relative": (0.01, "campaign.toml"),
        "cg_m": (0.003, "case.toml"),
    }


def test_nothing_stated_is_as_usual(tmp_path: Path) -> None:
    assert read_case(written(tmp_path)).tolerances == Tolerances()


def test_two_values_of_one_key_are_refused(tmp_path: Path) -> None:
    file = written(tmp_path, "zero_n = 0.2", "zero_n = 0.1")
    with pytest.raises(ConfigurationError, match=r"zero_n = 0\.1, and 0\.2 in campaign\.toml"):
        read_case(file)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("zero_nn = 0.1", r"tolerances\.zero_nn is not a known key; did you mean zero_n\?"),
        ("zero_n = -0.1", r"tolerances\.zero_n = -0\.1 must not be negative"),
        ("zero_n = nan", r"tolerances\.zero_n = nan "),
        ('zero_n = "0.1"', r"tolerances\.zero_n = .* number"),
    ],
)
def test_wrong_values_are_refused_in_either_file(table: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=said):
        read_campaign(written(tmp_path, campaign=table))
    with pytest.raises(ConfigurationError, match=said):
        read_case(written(tmp_path, case=table))
