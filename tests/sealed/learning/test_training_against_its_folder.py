"""Training campaigns kept in a file are those of the folder, to three digits."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from tests.sealed.learning.__main__ import main
from tests.sealed.learning.campaigns import missing
from tests.sealed.learning.features import of_components
from tests.sealed.learning.training import examples

OFF = [20.123456, -1e-9, 0.333333333]


def _written(folder: Path, *indices: int) -> Path:
    folder.mkdir()
    for index in indices:
        seen = {
            "cell": ["force_aft|mean|0"] * 3,
            "run": [0, 1, 2],
            "off": [index * one for one in OFF],
            "settings": [[0.1 * index, -3.0, 1.0, 1.0, 1.0]] * 3,
        }
        numbers = {"components": seen, "hypotheses": {"zero-offset|share": 0.98765432}}
        made = {"index": index, "right": ["none"], "stages": [], "numbers": numbers}
        (folder / f"{index:05d}.json").write_text(json.dumps(made))
    return folder


def test_a_kept_file_has_the_features_of_its_folders(tmp_path: Path) -> None:
    one, other = _written(tmp_path / "one", 1, 3), _written(tmp_path / "other", 2)
    file = tmp_path / "training.jsonl.xz"
    for places in ([one], [file, other]):
        words = ["keep", *map(str, places), "--output", str(file)]
        assert CliRunner().invoke(main, words, catch_exceptions=False).exit_code == 0
    kept = examples(file)
    assert [example.index for example in kept] == [1, 2, 3]
    seen = json.loads((one / "00003.json").read_text())["numbers"]["components"]
    assert kept[2].features["components"] == pytest.approx(of_components(seen), rel=5e-3)
    assert kept[1].features["hypotheses"] == {"zero-offset|share": 0.988}
    assert [job.index for job in missing(one, 5, {2})] == [4, 5]
