"""Which runs are charted as repeats of one: by hand, from what ``docs/archive.md`` states."""

from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from pmm.archive.database import open_archive
from pmm.archive.results import AnalysedCampaign, Analyses, CoefficientValue, HarmonicValue
from pmm.archive.trends import coefficient_trends, repeat_trends
from tests.pmm.archive.one_folder import add_folder

NOW = "2026-01-01T00:00:00+00:00"
BASE = {
    "frequency_hz": 0.5, "eccentricity_m": 0.02, "carriage_speed_m_s": 1.2, "heel_deg": 0.0,
    "rudder_angle_deg": 0.0, "revolutions_hz": 8.0,
}  # fmt: skip
# What is changed in each run, and whether it is a repeat of the first all the same.
RUNS: dict[str, tuple[dict[str, object], bool]] = {
    "base": ({}, True),
    "a little faster": ({"carriage_speed_m_s": 1.2008}, True),
    "rudder read again": ({"rudder_angle_deg": 0.01}, True),
    "faster": ({"carriage_speed_m_s": 1.21}, False),
    "rudder": ({"rudder_angle_deg": 8.0}, False),
    "revolutions": ({"revolutions_hz": 12.0}, False),
    "heeled": ({"heel_deg": 5.0}, False),
    "in waves": ({"wave_frequency_hz": 0.8, "wave_amplitude_m": 0.02}, False),
    "in air": ({"medium": "air"}, False),
    "steady ahead": ({"steady_ahead": True}, False),
    "with a mass": ({"known_mass": {"mass_kg": 5.0, "x_m": 0.1}}, False),
    "of lines": ({"lines": [{"order": 1, "share": 0.7}, {"order": 3, "share": 0.3}]}, False),
}


def _value(value: object) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_value(one)}" for key, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else repr(value)


def _campaign(folder: Path) -> Path:
    folder.mkdir()
    tables = ['[oscillator]\npreset = "horizontal-1963"']
    for name, (changed, _) in RUNS.items():
        fields = {"name": name, "periods": 10, **BASE, **changed}
        lines = (f"{key} = {_value(value)}" for key, value in fields.items())
        tables.append("\n".join(("[[runs]]", *lines)))
    text = f'name = "{folder.name}"\n' + "\n".join(tables) + "\n"
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder


def _harmonics(unit: str) -> Analyses:
    return Analyses(
        lambda _: AnalysedCampaign(
            tuple(HarmonicValue(run, 1, "gauge", 1, unit, 1.0, 2.0, 0.1, 0.1) for run in RUNS)
        )
    )


def test_repeats_agree_in_all_that_the_rig_was_set_to(tmp_path: Path) -> None:
    with open_archive(tmp_path / "a.sqlite", create=True) as connection:
        add_folder(connection, _campaign(tmp_path / "first"), _harmonics("N"), NOW)
        charted = repeat_trends(connection, "base", None, "gauge", 1, 0.99)
        alone = repeat_trends(connection, "rudder", None, "gauge", 1, 0.99)
    wanted = {name for name, (_, repeats) in RUNS.items() if repeats}
    for trend in charted:
        assert {row["run"] for row in trend.rows} == wanted, trend.name
    assert [[row["run"] for row in trend.rows] for trend in alone] == [["rudder"]] * 2


def test_a_gauge_read_in_two_units_has_a_chart_of_each(tmp_path: Path) -> None:
    with open_archive(tmp_path / "a.sqlite", create=True) as connection:
        for folder, unit in (("first", "N"), ("second", "V")):
            add_folder(connection, _campaign(tmp_path / folder), _harmonics(unit), NOW)
        charted = repeat_trends(connection, "base", "first", "gauge", 1, 0.99)
    units = [(trend.unit, {row["campaign"] for row in trend.rows}) for trend in charted]
    assert units == [("N", {"first"}), ("V", {"second"})] * 2
    assert {row["unit"] for row in charted[1].rows} == {"V"}


def test_an_archive_without_whole_settings_is_refused_with_what_to_do(tmp_path: Path) -> None:
    path = tmp_path / "a.sqlite"
    with open_archive(path, create=True) as connection:
        connection.execute("PRAGMA user_version = 2")
    with pytest.raises(ConfigurationError, match="add the folders to it"), open_archive(path):
        pass


def test_coefficients_of_one_speed_as_it_was_measured_are_one_trend(tmp_path: Path) -> None:
    """A carriage strays by up to 1 %, a shaft by 0.5 %; what lies further apart was set apart."""
    conditions = [(1.2000, 0.5000), (1.2080, 0.5020), (1.2200, 0.5000), (1.2080, 0.5040)]
    with open_archive(tmp_path / "a.sqlite", create=True) as connection:
        for k, (speed_m_s, frequency_hz) in enumerate(conditions):
            value = CoefficientValue("Y_v", "N s/m", speed_m_s, frequency_hz, 1.0, 0.1, 0.2)
            found = AnalysedCampaign((), (value,))
            folder = _campaign(tmp_path / f"c{k}")
            add_folder(connection, folder, Analyses(lambda _, found=found: found), NOW)
        trends = coefficient_trends(connection, "Y_v", 0.99)
    charted = [[row["campaign"] for row in trend.rows] for trend in trends]
    assert charted == [["c0", "c1"], ["c3"], ["c2"]]
