"""The Python front door against the commands' JSON, a closed form, and its page docs/python.md."""

import inspect
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import get_args

import click
import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner
from matplotlib.axes import Axes

import pmm
from hardware.description.errors import ConfigurationError, DataError
from pmm.cli import cli
from pmm.inertia.jobs import JOBS
from pmm.interface.coefficients import CoefficientsResult
from pmm.interface.design import DesignResult
from pmm.interface.gap import GapResult
from pmm.interface.harmonics import HarmonicsResult
from pmm.interface.inertia import InertiaResult
from pmm.interface.records import Job, Records
from tests.docs.blocks import HOUSE, Block, blocks

EXAMPLES = HOUSE / "examples"
HEAVE = EXAMPLES / "recordings" / "heave.csv.gz"
MAP = str(HEAVE.with_name("heave.toml"))
PAGE = "docs/python.md"
KINDS = (Records, HarmonicsResult, CoefficientsResult, DesignResult, GapResult, InertiaResult)


def _json(*words: str) -> dict[str, object]:
    done = CliRunner().invoke(cli, [*words, "--json"], catch_exceptions=False)
    told: dict[str, object] = json.loads(done.stdout)
    return told


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Records:
    folder = tmp_path_factory.mktemp("front-door") / "campaign"
    runs = ["heave-0.50", "pitch-0.50"]
    return pmm.simulate(EXAMPLES / "vertical" / "campaign.toml", folder, runs=runs)


@pytest.fixture(scope="module")
def heave() -> HarmonicsResult:
    return pmm.open(HEAVE).harmonics(column_map=MAP)


@pytest.fixture(scope="module")
def coefficients(campaign: Records) -> CoefficientsResult:
    return campaign.coefficients()


def test_harmonics_are_those_of_the_command(heave: HarmonicsResult) -> None:
    assert heave.to_dict() == _json("analyse", str(HEAVE), "--map", MAP)


def test_coefficients_are_those_of_the_command(
    campaign: Records, coefficients: CoefficientsResult
) -> None:
    assert coefficients.to_dict() == _json("coefficients", str(campaign.path))


def test_inertia_is_that_of_the_command() -> None:
    file = EXAMPLES / "inertia" / "incline.toml"
    found = pmm.open(file).inertia("incline")
    told = _json("inertia", "incline", str(file))
    assert found.to_dict() == told
    results = told["results"]
    assert isinstance(results, dict)
    frame = found.to_dataframe().set_index("name")
    assert dict(frame["value"]) == {name: one["value"] for name, one in results.items()}
    assert set(found.to_dataset()["name"].values) == set(results)


@pytest.mark.slow
def test_a_design_is_that_of_the_command() -> None:
    file = EXAMPLES / "horizontal" / "design.toml"
    found, told = pmm.open(file).design(), _json("plan", "design", str(file))
    assert found.to_dict() == told
    rows = told["coefficients"]
    assert isinstance(rows, list)
    frame = found.to_dataframe()
    assert list(frame["name"]) == [one["name"] for one in rows]
    assert list(frame["wanted"]) == [one["wanted"] for one in rows]
    assert found.met == told["possible"]
    assert set(found.to_dataset().data_vars) == set(frame.columns)


def test_a_simulated_campaign_is_that_of_the_command(campaign: Records, tmp_path: Path) -> None:
    file = str(EXAMPLES / "vertical" / "campaign.toml")
    run = next(campaign.path.glob("*.nc")).stem
    _json("simulate", file, "--run", run, "--output", str(tmp_path / "again"))
    ours, theirs = (
        xr.load_dataset(folder / f"{run}.nc", engine="h5netcdf")
        for folder in (campaign.path, tmp_path / "again")
    )
    assert ours.equals(theirs)


def test_the_dataset_gives_back_a_known_signal(tmp_path: Path) -> None:
    """Order by order as the attribute ``conventions`` has it, from a signal written down here."""
    time_s = np.arange(4000) / 100.0
    theta = 2.0 * np.pi * 0.5 * time_s
    force = 3.0 + 2.0 * np.sin(theta) - 1.5 * np.cos(theta) + 0.25 * np.sin(3.0 * theta)
    rows = np.column_stack([time_s, 0.02 * np.sin(theta), force])
    path = tmp_path / "known.csv"
    header = "time [s],stroke [m],force [N]"
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.12g")
    told = pmm.open(path).harmonics(reference="stroke").to_dataset()
    assert told.sizes == {"run": 1, "gate": 1, "channel": 1, "order": 4}
    assert told["unit"].item() == "N"
    assert told["frequency_hz"].item() == pytest.approx(0.5)
    assert told["frequency_hz"].attrs["units"] == "Hz"
    one = told.isel(run=0, gate=0, channel=0).fillna(0.0)
    n = one["order"].values[:, None]
    series = (
        one["in_phase"].values[:, None] * np.where(n == 0, 1.0, np.sin(n * theta))
        + one["quadrature"].values[:, None] * np.cos(n * theta)
    ).sum(axis=0)
    np.testing.assert_allclose(series, force, atol=1e-6)


def test_the_frame_has_an_interval_for_each_number(heave: HarmonicsResult) -> None:
    frame = heave.to_dataframe()
    assert len(frame) == 2 * 4
    firsts = frame[frame["order"] > 0]
    for name in ("in_phase", "quadrature", "amplitude"):
        assert (firsts[f"{name}_half_width"] > 0.0).all()
    hypotenuse = np.hypot(firsts["in_phase"], firsts["quadrature"])
    np.testing.assert_allclose(firsts["amplitude"], hypotenuse)


def test_a_notebook_shows_the_commands_tables(
    heave: HarmonicsResult, coefficients: CoefficientsResult
) -> None:
    for one in (heave, coefficients):
        shown = one._repr_html_()
        assert "<table" in shown
        assert not re.search(r"<(?:html|style|svg|script)", shown)
    assert "force_aft" in heave._repr_html_()


@pytest.mark.slow
def test_figures_are_axes(heave: HarmonicsResult, coefficients: CoefficientsResult) -> None:
    drawn = [*heave.plot_phasors(), *(one for axes in coefficients.plot_budget().values()
                                      for one in axes)]  # fmt: skip
    assert len(drawn) >= 2
    assert all(isinstance(one, Axes) for one in drawn)
    phasors = heave.plot_phasors()
    assert phasors.figure is phasors[0].get_figure(root=True)
    assert phasors._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(ConfigurationError, match="no figure 'gate-9'; there are: gate, phasors"):
        heave.plot("gate-9")


@pytest.mark.slow
def test_a_figure_of_several_runs_asks_which(campaign: Records) -> None:
    found = campaign.harmonics(channels=["force_aft"], harmonics=1)
    assert len(found.runs) > 1
    with pytest.raises(ConfigurationError, match="say which run; there are: "):
        found.plot_gate()
    with pytest.raises(ConfigurationError, match="no run 'nine'; there are: "):
        found.plot_gate("nine")


def test_what_a_path_is_not_is_said(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r"heave.csv.gz: this is a recording, and what"):
        pmm.open(HEAVE).coefficients()
    with pytest.raises(ConfigurationError, match="the file of a pendulum test"):
        pmm.open(EXAMPLES / "vertical" / "campaign.toml").inertia("swing")
    with pytest.raises(ConfigurationError, match="no such file or folder"):
        pmm.open(tmp_path / "nothing")
    with pytest.raises(ConfigurationError, match=r"a folder without a campaign\.toml"):
        pmm.open(tmp_path)
    with pytest.raises(ConfigurationError, match=r"heave\.toml: says how the columns of a record"):
        pmm.open(EXAMPLES / "recordings" / "heave.toml")
    (tmp_path / "broken.toml").write_text("name = ")
    with pytest.raises(ConfigurationError, match=r"broken\.toml"):
        pmm.open(tmp_path / "broken.toml")
    (tmp_path / "flat.csv").write_text("time [s],force [N]\n0,1\n0.1,1\n")
    with pytest.raises(DataError, match=r"flat\.csv"):
        pmm.open(tmp_path / "flat.csv").harmonics(frequency_hz=1.0)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (lambda: pmm.open(None), "open: path = None should be"),
        (lambda: pmm.open(HEAVE).harmonics(level=95), "level = 95 should be less than 1"),
        (
            lambda: pmm.open(HEAVE).harmonics(harmonics=2.5),
            r"2\.5 should be a valid int",
        ),
        (lambda: pmm.open(HEAVE).harmonics(channels="force_aft"), "is one text; give a list"),
        (
            lambda: pmm.open(EXAMPLES / "inertia" / "swing.toml").inertia("swim"),
            "should be 'swing'",
        ),
        (
            lambda: pmm.open(EXAMPLES / "foreign").coefficients(form="best"),
            "be 'manoeuvring'",
        ),
        (lambda: pmm.open(EXAMPLES / "foreign").coefficients(trials=-5), "trials = -5 should be"),
        (lambda: pmm.simulate("campaign.toml", seed=-1), "seed = -1 should be"),
        (
            lambda: pmm.connect("https://127.0.0.1:1", certificate="no.pem"),
            "no certificate",
        ),
        (lambda: pmm.open(EXAMPLES / "vertical" / "plan.toml").harmonics(), "this is a plan"),
        (lambda: pmm.open(EXAMPLES / "vertical" / "rig.toml").gap(), "this is the file of a rig"),
    ],
)
def test_a_wrong_argument_is_named(asked: Callable[[], object], said: str) -> None:
    with pytest.raises(ConfigurationError, match=said):
        asked()


def test_a_wrong_name_tells_those_that_there_are() -> None:
    with pytest.raises(AttributeError, match="no attribute 'load'; there are connect, open, simul"):
        pmm.load  # noqa: B018
    with pytest.raises(TypeError, match=r"inertia: missing .*'job'; it takes job"):
        pmm.open(EXAMPLES / "inertia" / "swing.toml").inertia()
    with pytest.raises(TypeError, match=r"harmonics: .*'map'; it takes .* column_map"):
        pmm.open(HEAVE).harmonics(map=MAP)


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    with pytest.raises(ConfigurationError, match="cannot be written to"):
        pmm.simulate(EXAMPLES / "vertical" / "campaign.toml", file, runs=["heave-0.50"])


def test_the_jobs_are_those_of_the_command() -> None:
    group = cli.get_command(click.Context(cli), "inertia")
    assert isinstance(group, click.Group)
    assert set(get_args(Job)) == set(JOBS) == set(group.commands)


def test_the_import_loads_no_library() -> None:
    code = "import pmm, sys; print({'numpy', 'pandas', 'pydantic', 'xarray'} & {*sys.modules})"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=HOUSE, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "set()"


def test_the_page_lists_what_there_is() -> None:
    text = (HOUSE / PAGE).read_text(encoding="utf-8")
    for kind in KINDS:
        assert kind.__name__ in text
        for name, _ in inspect.getmembers(kind, inspect.isfunction):
            if not name.startswith("_"):
                assert f"{name}(" in text, f"{kind.__name__}.{name}"
    for name in pmm.__all__:
        assert f"`pmm.{name}(" in text


@pytest.mark.slow
@pytest.mark.parametrize(
    "block", [one for one in blocks("python") if one.page == PAGE and not one.reason], ids=str
)
def test_the_examples_of_the_page_run(block: Block, tmp_path: Path) -> None:
    (tmp_path / "examples").symlink_to(EXAMPLES)
    assert len(block.text.split("\n\n", 1)[1].strip().splitlines()) <= 5
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", block.text],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(HOUSE)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout
    if "phasors.png" in block.text:
        assert (tmp_path / "phasors.png").stat().st_size > 10_000
