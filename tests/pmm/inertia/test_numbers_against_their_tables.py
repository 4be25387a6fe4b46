"""The document has the numbers of the tables; figures are drawn for all there is."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli
from pmm.document.data import as_data
from pmm.document.style import write_figures
from pmm.inertia import bifilar, swing
from pmm.inertia.outcome import Outcome
from pmm.inertia.period_source import PeriodSource
from pmm.report.inertia_document import document

EXAMPLES = Path(__file__).parents[3] / "examples" / "inertia"


@pytest.fixture(scope="module")
def hull() -> Outcome:
    return bifilar.run(str(EXAMPLES / "hull.toml"))


def test_the_hull_of_the_recipe_comes_back(hull: Outcome) -> None:
    found = {one.name: one for one in hull.findings}
    for name in ("k_yaw_by_period_m", "k_yaw_by_ratio_m"):
        assessment = found[name].assessment
        assert assessment is not None
        low, high = assessment.interval
        assert low < 1.056 < high


def test_shares_add_up_and_json_has_no_nan(hull: Outcome) -> None:
    text = json.loads(json.dumps(as_data(document(hull)), allow_nan=False))
    for row in text["results"].values():
        if "budget" in row:
            assert sum(line["share_percent"] for line in row["budget"]) == pytest.approx(100.0)
    assert text["results"]["k_yaw_m"]["standard_uncertainty"] == next(
        one.estimate.uncertainty for one in hull.findings if one.name == "k_yaw_m"
    )
    assert text["targets"][0]["verdict"] == "pass"


@pytest.mark.slow
def test_the_same_document_twice(hull: Outcome) -> None:
    again = bifilar.run(str(EXAMPLES / "hull.toml"))
    assert as_data(document(hull)) == as_data(document(again))


@pytest.mark.slow
def test_the_table_prints_the_documents_numbers(hull: Outcome) -> None:
    arguments = ["inertia", "bifilar", str(EXAMPLES / "hull.toml")]
    printed = CliRunner().invoke(cli, arguments, catch_exceptions=False).stdout
    row = as_data(document(hull))["results"]["k_yaw_m"]
    assert f"{row['value']:.5f} ± {row['standard_uncertainty']:.5f}" in printed
    assert f"{row['interval_95'][0]:.5g} to {row['interval_95'][1]:.5g}" in printed


@pytest.mark.slow
def test_figures_of_records_are_drawn(hull: Outcome, tmp_path: Path) -> None:
    written = {
        path.name for path in write_figures(document(hull).figures, tmp_path, "hull", ("svg",))
    }
    assert written == {
        "hull-setup.svg",
        "hull-stern-yaw-record.svg",
        "hull-stern-yaw-amplitude.svg",
        "hull-stern-yaw-spectrum.svg",
        "hull-budget.svg",
    }
    spectrum = (tmp_path / "hull-stern-yaw-spectrum.svg").read_text()
    assert "a beat every 25." in spectrum
    assert "mathdefault" not in spectrum


def test_the_swings_period_is_undamped() -> None:
    outcome = swing.run(str(EXAMPLES / "swing.toml"))
    runs = outcome.periods[0]
    damped = [run.period().value for run in runs.records]
    for with_damping, without in zip(damped, runs.single[0], strict=True):
        # lambda = 0.0048 1/s: (lambda T/(2 pi))^2/2
        assert 1.0 - without / with_damping == pytest.approx(1.55e-5, rel=0.05)


def test_a_source_that_knows_its_scatter() -> None:
    source = PeriodSource(period_s=1.0, u_period_s=0.1, known_scatter_s=0.02)
    known = source.known_scatter
    assert known is not None
    assert known.value == 0.02
