"""``pmm manoeuvre``: measured and stated derivatives, intervals, and what it refuses."""

import json
import math
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from analysis.coefficients.campaign_records import HIGHER_ORDER, CoefficientEntry
from analysis.coefficients.campaign_result import CampaignCoefficients, no_trials
from analysis.coefficients.exchange import to_dict
from analysis.coefficients.names import Form
from analysis.manoeuvring.manoeuvres import turning_circle, zigzag
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.oscillator import Plane
from pmm.cli import cli
from pmm.document.content import Figure, Table
from pmm.manoeuvre.prediction import Prediction, predict, ship_of
from pmm.manoeuvre.ship_file import (
    BodyTable,
    PlaneTable,
    ShipBody,
    ShipFile,
    StatedHull,
    SubmergedFile,
    read_ship,
)
from pmm.manoeuvre.submerged import body_of
from pmm.report.manoeuvre_document import manoeuvre_story
from tests.analysis.manoeuvring.published import kcs

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples" / "manoeuvre" / "kvlcc2.toml"
SUBMERGED = EXAMPLE.with_name("submerged.toml")
TEXT = EXAMPLE.read_text(encoding="utf-8")
DEGREES = math.radians(1.0)
MEASURED = ("Y_v", "Y_r", "N_v", "N_r")


def _run(*arguments: str) -> tuple[int, str]:
    ran = CliRunner().invoke(cli, ["manoeuvre", *arguments])
    return ran.exit_code, ran.output


def _written(folder: Path, text: str) -> str:
    path = folder / "ship.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


Rows = dict[tuple[str, str], dict[str, float]]


@pytest.fixture(scope="module")
def predicted() -> tuple[str, Prediction]:
    """What the command prints of the example, and what it made that of."""
    kept: list[Prediction] = []

    def keeping(*arguments: Any) -> Prediction:
        kept.append(predict(*arguments))
        return kept[0]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("pmm.manoeuvre.prediction.predict", keeping)
        status, output = _run(str(EXAMPLE), "--trials", "40", "--json")
    assert status == 0, output
    return output, kept[0]


@pytest.fixture(scope="module")
def rows(predicted: tuple[str, Prediction]) -> Rows:
    """The example's quantities by manoeuvre and name."""
    output, _ = predicted
    found = json.loads(output[output.index("{") :])
    assert found["schema"] == "pmm-manoeuvre-1"
    (row,) = found["conditions"]
    assert row["froude_number"] == pytest.approx(1.179 / math.sqrt(9.80665 * 7.0))
    assert row["reynolds_number"] == pytest.approx(1.179 * 7.0 / 1.1386e-6, rel=1e-4)
    return {(one["manoeuvre"], one["name"]): one for one in found["quantities"]}


@pytest.mark.slow
def test_the_json_has_every_quantity_with_its_interval_and_criterion(rows: Rows) -> None:
    advance = rows["turning circle 35°, starboard", "advance"]
    assert advance["low"] < advance["value"] < advance["high"]
    assert advance["full_scale"] == pytest.approx(advance["value"] * 7.0 * 45.714)
    assert (advance["limit"], advance["within"]) == (4.5, 1.0)
    assert rows["zig-zag 10/10, port", "overshoot 1"]["limit"] == 20.0
    assert rows["turning circle 35°, port", "transfer"]["limit"] is None


@pytest.mark.slow
def test_the_file_of_kcs_turns_as_its_published_numbers() -> None:
    status, output = _run(str(EXAMPLE.with_name("kcs.toml")), "--trials", "0", "--json")
    assert status == 0, output
    rows = {(one["manoeuvre"], one["name"]): one for one in json.loads(output)["quantities"]}
    circle, way = turning_circle(kcs.ship(), 35.0 * DEGREES), "turning circle 35°, starboard"
    for name in ("advance", "transfer", "tactical_diameter"):
        told = rows[way, name.replace("_", " ")]
        assert told["value"] == pytest.approx(getattr(circle, name)[0], rel=1e-4)
    for degrees in (10.0, 20.0):
        swung = zigzag(kcs.ship(), degrees * DEGREES, degrees * DEGREES).overshoots_rad[:, 0]
        way = f"zig-zag {degrees:g}/{degrees:g}, starboard"
        for k, overshoot in enumerate(swung[:2], 1):
            told = rows[way, f"overshoot {k}"]
            assert told["value"] == pytest.approx(overshoot / DEGREES, rel=1e-3)


@pytest.mark.slow
def test_the_page_beside_the_free_running_model_says_what_is_computed(rows: Rows) -> None:
    page = (ROOT / "docs" / "manoeuvre.md").read_text(encoding="utf-8")
    row = r"^\| ([^|`]+?) \| ([\d.]+)[^|]+\| [\d.]+[^|]+\| ([\d.]+)[^|]+\| [\d.]+[^|]+\|$"
    told = re.findall(row, page, re.MULTILINE)
    assert len(told) == 5
    for what, *values in told:
        angle, _, name = what.rpartition(", ")
        manoeuvre = f"zig-zag {angle}" if angle else "turning circle 35°"
        order = {"first overshoot": "overshoot 1", "second overshoot": "overshoot 2"}
        for side, value in zip(("starboard", "port"), values, strict=True):
            computed = rows[f"{manoeuvre}, {side}", order.get(name, name)]["value"]
            assert f"{computed:.{len(value.split('.')[1])}f}" == value, what


@pytest.mark.slow
def test_draws_spread_as_the_slope_says() -> None:
    """One uncertain derivative: the spread of the advance against its slope by differences."""
    file, spread = read_ship(EXAMPLE), 0.004

    def advance(value: float, uncertainty: float, trials: int) -> np.ndarray:
        hull = StatedHull("mmg", file.hull.values | {"Y_v": value}, {"Y_v": uncertainty})
        ship = ship_of(_with(file, hull=hull), trials, 1)
        return turning_circle(ship, 35.0 * DEGREES, step=0.1).advance

    value = file.hull.values["Y_v"]
    ends = [advance(value + change, 0.0, 0)[0] for change in (spread, -spread)]
    found = float(np.std(advance(value, spread, 300)[1:]))
    assert found == pytest.approx(abs(ends[0] - ends[1]) / 2.0, rel=0.15)


def _with(file: ShipFile, **change: object) -> ShipFile:
    told = {one.name: getattr(file, one.name) for one in fields(ShipFile)}
    return ShipFile(**(told | change))  # type: ignore[arg-type]


def _campaign(file: ShipFile) -> CampaignCoefficients:
    """What a campaign at twice the speed would report of four derivatives, with one covariance."""
    ship, speed = file.ship, 2.0 * file.speed_m_s
    half = 0.5 * file.water.density_kg_m3 * ship.length_m * ship.draught_m * speed
    units = dict(zip(MEASURED, (1.0, ship.length_m, ship.length_m, ship.length_m**2), strict=True))
    entries = tuple(
        CoefficientEntry(name, "", HIGHER_ORDER, 0.2, speed, 0.1, 0.1, ("a",), math.nan, 1.0)
        for name in MEASURED
    )
    values = np.array([file.hull.values[name] * half * units[name] for name in MEASURED])
    parts = 0.02 * values[:, None]  # all of them 2 % off together
    uncertain = UncertainValues(values, (Contribution("gauge", np.inf, np.arange(4), parts),))
    return CampaignCoefficients(
        Form.MANOEUVRING, Plane.HORIZONTAL, "dimensional", 0.95, entries, uncertain, no_trials(4)
    )


def test_measured_derivatives_are_made_without_dimensions_and_keep_what_they_share(
    tmp_path: Path,
) -> None:
    file = read_ship(EXAMPLE)
    measured = tmp_path / "coefficients.json"
    measured.write_text(json.dumps({"coefficients": to_dict(_campaign(file))}))
    rest = {name: one for name, one in file.hull.values.items() if name not in MEASURED}
    mixed = _with(file, hull=StatedHull("mmg", rest), coefficients=str(measured))
    found = ship_of(mixed, 50, 2).hull.values
    first = found["Y_v"] / file.hull.values["Y_v"]
    for name in MEASURED:
        drawn = found[name] / file.hull.values[name]
        assert drawn[0] == pytest.approx(1.0, rel=1e-12)
        np.testing.assert_allclose(drawn, first, rtol=1e-12)
    assert np.std(drawn[1:]) == pytest.approx(0.02, rel=0.3)


@pytest.mark.parametrize(
    ("old", "new", "status", "said"),
    [
        ("X_udot = -0.022\n", "", 2, "no X_udot: a turning ship needs them"),
        ("X_0 = -0.022", "X_0 = 0.022", 2, "no revolutions balance a resistance"),
        ("wake = 0.40", "wak = 0.40", 2, "propeller.wak is not a known key; did you mean wake?"),
        ("temperature_deg_c = 15.0", "temperature_deg_c = 55.0", 2, "outside 0 to 40 degrees"),
        ('system = "mmg"', 'system = "bis"', 2, "hull.system should be one of mmg, prime"),
        ("N_rrr = -0.013", "N_rxr = -0.013", 2, "hull.values.N_rxr is no derivative"),
        ("N_r = 0.0010", "N_rr = 0.0010", 2, "N_rr has no value in [hull.values]"),
        ("speed_m_s = 1.179", "speed_m_s = 1.179\nrudder_rate_deg_s = 15.8", 2,
         "rudder should be a table with the rudder's parameters, or rudder_rate_deg_s in its"),
        ("X_0 = -0.022", "X_0 = -0.022\nY_d = -0.05", 2, "Y_d: terms of the rudder's angle are"),
        ("# coefficients =", "coefficients =", 1, "not what `pmm coefficients --json` printed"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_by_a_sentence(
    tmp_path: Path, old: str, new: str, status: int, said: str
) -> None:
    assert old in TEXT
    found, output = _run(_written(tmp_path, TEXT.replace(old, new)), "--trials", "0")
    assert (found, said in " ".join(output.split())) == (status, True), output


def test_a_rudder_stands_among_the_derivatives_where_its_table_is_left_out(tmp_path: Path) -> None:
    text = TEXT[: TEXT.index("[rudder]")]
    text = text.replace("speed_m_s = 1.179", "speed_m_s = 1.179\nrudder_rate_deg_s = 15.8")
    text = text.replace("X_0 = -0.022", "X_0 = -0.022\nY_d = -0.055\nN_d = 0.026\nX_dd = -0.03")
    file = read_ship(Path(_written(tmp_path, text)))
    assert isinstance(file, ShipFile)
    ship = ship_of(file, 0, 0)
    assert (ship.rudder, ship.rudder_rate_deg_s) == (None, 15.8)
    ahead, still = np.full(1, 1.179), np.zeros(1)
    state = np.array([ahead, still, still, still, still, still])
    laid = ship.loads(state, np.full(1, 0.1)) - ship.loads(state, still)
    unit = 0.5 * file.water.density_kg_m3 * 7.0 * 0.455 * 1.179**2
    expected = unit * np.array([-0.03 * 0.01, -0.055 * 0.1, 7.0 * 0.026 * 0.1])
    np.testing.assert_allclose(laid[:, 0], expected, rtol=1e-6)


def test_a_body_below_the_surface_keeps_depth_up_to_its_critical_speed() -> None:
    status, output = _run(str(SUBMERGED), "--trials", "200", "--json")
    assert status == 0, output
    rows = {one["name"]: one for one in json.loads(output)["quantities"]}
    critical = rows["critical speed"]
    assert critical["low"] < critical["value"] < critical["high"]
    assert critical["full_scale"] == pytest.approx(critical["value"] * math.sqrt(20.0))
    body = body_of(read_ship(SUBMERGED), 0, 0)  # type: ignore[arg-type]
    assert body.root(critical["value"])[0] == pytest.approx(0.0, abs=1e-9)
    assert rows["reversal speed"]["value"] < critical["value"]
    status, output = _run(str(SUBMERGED), "--trials", "0")
    assert f"stable below {critical['value']:.4g} m/s" in output


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('plane = "vertical"', 'plane = "horizontal"', "plane should be vertical, or left out"),
        ("M_qdot = -0.0008\n", "", "no M_qdot: stability in the vertical plane needs them"),
        ("Z_q = -0.0060", "Y_r = -0.0060", "hull.values.Y_r is no derivative"),
        ('system = "prime"', 'system = "mmg"', "hull.system should be one of prime"),
    ],
)
def test_what_a_body_cannot_be_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = SUBMERGED.read_text(encoding="utf-8")
    assert old in text
    status, output = _run(_written(tmp_path, text.replace(old, new, 1)), "--trials", "0")
    assert (status, said in " ".join(output.split())) == (2, True), output


def test_coefficients_of_the_other_plane_are_refused(tmp_path: Path) -> None:
    found = to_dict(_campaign(read_ship(EXAMPLE)))  # type: ignore[arg-type]
    (tmp_path / "coefficients.json").write_text(json.dumps({"coefficients": found}))
    text = SUBMERGED.read_text(encoding="utf-8").replace("# coefficients =", "coefficients =")
    status, output = _run(_written(tmp_path, text))
    assert status == 2
    assert "needed are those of the vertical plane in SI units" in " ".join(output.split())


def test_the_page_names_every_key() -> None:
    page = (ROOT / "docs" / "manoeuvre.md").read_text(encoding="utf-8")
    file = read_ship(EXAMPLE)
    kinds = (
        ShipFile, ShipBody, SubmergedFile, BodyTable, PlaneTable,
        type(file.propeller), type(file.rudder),
    )  # fmt: skip
    for kind in kinds:
        for one in fields(kind):
            assert re.search(rf"\b{one.name}\b", page), one.name


def test_doubts_stand_before_the_results_of_the_command(tmp_path: Path) -> None:
    text = SUBMERGED.read_text(encoding="utf-8").replace("mass_kg = 576.0", "mass_kg = 0.576")
    status, output = _run(_written(tmp_path, text), "--trials", "0")
    assert status == 0
    assert output.index("m/(rho/2 L³) = 1.8e-05") < output.index("critical speed")
    told = json.loads(_run(str(tmp_path / "ship.toml"), "--trials", "0", "--json")[1])["doubts"]
    assert len(told) == 6  # mass, and by it inertia, added mass and three derivatives
    assert json.loads(_run(str(SUBMERGED), "--trials", "0", "--json")[1])["doubts"] == []


@pytest.mark.slow
def test_a_report_has_the_manoeuvres_of_the_ship_beside_its_campaign(
    predicted: tuple[str, Prediction], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pmm.report.manoeuvre_document.predict", lambda *_: predicted[1])
    assert list(manoeuvre_story(tmp_path, 0.95)) == []
    _written(tmp_path, TEXT)
    (section,) = manoeuvre_story(tmp_path, 0.95)
    tables = [one for one in section.contents if isinstance(one, Table)]
    (advance,) = [
        row
        for row in tables[0].rows
        if (row.manoeuvre, row.name) == ("turning circle 35°, port", "advance")
    ]
    assert advance.value == pytest.approx(3.09, abs=0.005)  # as docs/manoeuvre.md has it
    pictures = [one.name for one in section.contents if isinstance(one, Figure)]
    assert pictures == ["turning", "zigzag", "spiral"]
    _written(tmp_path, SUBMERGED.read_text(encoding="utf-8"))
    (section,) = manoeuvre_story(tmp_path, 0.95)
    assert section.title == "Depth keeping"
