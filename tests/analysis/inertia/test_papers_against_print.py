"""Every figure of the papers that follows from others of their own."""

from pathlib import Path

import pytest

from tests.analysis.inertia.papers import Figure, all_figures, check_figure, comparison_table

FIGURES = all_figures()
PAGE = Path(__file__).parents[3] / "docs" / "inertia.md"
SHARED = Path(__file__).parents[3].parent / "shared" / "reference" / "tables.toml"


@pytest.mark.parametrize("figure", FIGURES, ids=[f"{f.where}: {f.what}" for f in FIGURES])
def test_figure_lies_within_what_rounding_allows(figure: Figure) -> None:
    checked = check_figure(figure)
    assert checked.low <= checked.ours <= checked.high
    assert checked.holds or figure.note, (checked.low, checked.high)


def test_misprints_are_named_and_are_wrong() -> None:
    wrong = {f.what for f in FIGURES if not check_figure(f).holds}
    for word in ("offset in degrees", "C6", "R as printed", "pivots", "envelope", "put right"):
        assert any(word in what for what in wrong), word
    assert "forward mass" in wrong
    assert not [f for f in FIGURES if f.what in wrong and not f.note]


def test_page_holds_the_table() -> None:
    assert comparison_table() in PAGE.read_text(encoding="utf-8")


@pytest.mark.skipif(not SHARED.exists(), reason="no shared reference tables beside the project")
def test_our_copy_of_the_papers_inputs_is_the_reference_one() -> None:
    import tomllib

    from tests.analysis.inertia import papers_bifilar, papers_swing

    tables = tomllib.loads(SHARED.read_text(encoding="utf-8"))
    for part, row in zip(tables["swing"]["table1"]["parts"], papers_swing.PARTS, strict=True):
        keys = ("mass_kg", "cg_m", "i_p1_kg_m2", "i_p2_kg_m2")
        assert [part[key] for key in keys] == [number.value for number in row[1:]]
    for case in tables["swing"]["table2"]["cases"]:
        assert papers_swing.TABLE_2[case["case"]] == (case["d_f1_mm"], case["d_f2_mm"])
    table = tables["bifilar"]["table1"]
    columns = (table["added_mass_kg"], table["yaw_period_s"], table["yaw_gyradius_mm"])
    assert tuple(zip(*columns, strict=True)) == papers_bifilar.TABLE_1
