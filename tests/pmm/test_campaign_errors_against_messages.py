"""A wrong campaign file: each error with its path, value and limit, all of them at once."""

from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign_file import read_campaign

RUN = '[[runs]]\nname = "a"\nfrequency_hz = 0.5\neccentricity_m = 0.02\n'
RIG = '[oscillator]\npreset = "vertical-1963"\n'

# What is wrong -> what the message says of it.
CASES = [
    ("hul = 3\n", "hul is not a known key; did you mean hull?"),
    ("hull = 3\n", "hull = 3 should be a table"),
    ("[model]\nmass_kg = '70'\ninertia_kg_m2 = 3", 'model.mass_kg = "70" should be a valid number'),
    ("[model]\nmass_kg = true\ninertia_kg_m2 = 3", "model.mass_kg = true should be a valid number"),
    ("[model]\nmass_kg = -70\ninertia_kg_m2 = 3", "model.mass_kg = -70 should be above 0"),
    ("[model]\nmass_kg = nan\ninertia_kg_m2 = 3", "model.mass_kg = NaN should be a finite number"),
    (
        "[model]\nmass_kg = 70\ninertia_kg_m2 = 3\ndisplaced_kg = -3",
        "model.displaced_kg = -3 should be 0 or more",
    ),
    ("[model]\nmass_kg = 70", "model.inertia_kg_m2 is missing"),
    ("[hull]\ndamping = [[1, 2], [3]]", "hull.damping[2][2] is missing"),
    (
        "[acquisition.force_aft]\nnois_rms = 1",
        "acquisition.force_aft.nois_rms is not a known key; did you mean noise_rms?",
    ),
    (
        "[acquisition.force_aft]\nnoise_rms = -1",
        "acquisition.force_aft.noise_rms = -1 should be 0 or more",
    ),
    ("[oscillator]\npreset = 'vertical'", "oscillator.preset = 'vertical' should be vertical-1963"),
    (
        "[oscillator]\nplane = 'up'",
        "oscillator.plane = \"up\" should be 'vertical' or 'horizontal'",
    ),
    (
        "[oscillator]\npreset = 'vertical-1963'\njoint = 'slides'",
        "oscillator.joint = \"slides\" should be 'slides_on_model', 'slides_on_rig' or 'yaw_table'",
    ),
    (
        "[oscillator]\npreset = 'vertical-1963'\ndrift = 'rig_turned'",
        "oscillator.drift is not a known key; did you mean drift_by?",
    ),
    ("[oscillator]\nplane = 'vertical'", "oscillator.half_spacing_m is missing"),
    ("[columns]\ntim = 't'", "[columns] tim is not a known key; did you mean time?"),
    ("columns = 3", "columns should be a table"),
    ("[simulation]\nseed = 1.5", "simulation.seed = 1.5 should be a valid whole number"),
    ("runs = 3", "runs = 3 should be a valid"),
    ("runs = [3]", "runs[1] = 3 should be a table"),
    (
        RUN + "frequncy_hz = 1",
        'runs["a"].frequncy_hz is not a known key; did you mean frequency_hz?',
    ),
    (RUN + "strut_phase = 1", "did you mean strut_phase_"),
    (RUN + "periods = 0", 'runs["a"].periods = 0 should be above 0'),
    (RUN + "kind = 'dry'", 'runs["a"] needs medium = "air": a run of kind dry is one in air'),
    (RUN + "kind = 'push'", "runs[\"a\"].kind = 'push' is of [[at_rest]]: the shaft stands"),
    (
        RUN + "[[at_rest]]\nname = 'z'\nkind = 'control'\nfile = 'z.nc'\nduration_s = 9",
        "at_rest[\"z\"].kind = 'control' is of [[runs]]: the shaft turns",
    ),
    (RUN + "drift_rad = 10", 'runs["a"].drift_rad = 10 should be at most 3.14159; in degrees?'),
    (RUN + "heel_rad = -5", 'runs["a"].heel_rad = -5 should be -1.5708 or more; in degrees?'),
    (RUN + "medium = 'oil'", "runs[\"a\"].medium = \"oil\" should be 'water' or 'air'"),
    (RUN + "eccentricity_mm = 20", 'runs["a"].eccentricity_mm and eccentricity_m are both given'),
    (RUN + "strut_phase_deg = '90'", "runs[\"a\"].strut_phase_deg = '90' should be a number"),
    ("[[runs]]\nfrequency_hz = 1\neccentricity_m = 0.02", "runs[1].name is missing"),
    (RUN + RUN, 'runs["a"].name is taken already'),
    (RUN.replace('"a"', '"a/b"'), "cannot be the name of a file"),
    (
        RUN.replace("0.5", "2.5") + RIG,
        'runs["a"] frequency_hz = 2.5 is outside 0.1 to 2 of the vertical oscillator',
    ),
    (
        RUN.replace("0.02", "0.2") + RIG,
        'runs["a"] eccentricity_m = 0.2 is outside 0 to 0.06 of the vertical oscillator',
    ),
]


@pytest.mark.parametrize(("text", "message"), CASES)
def test_each_error_says_where_and_what(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError) as caught:
        read_campaign(path)
    assert str(caught.value).startswith(str(path))
    assert message in str(caught.value)


def test_all_errors_come_at_once_and_once_each(tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(
        'hul = 3\n[model]\nmass_kg = "70"\ninertia_kgm2 = -3\n[columns]\ntim = "t"\n'
        + RIG
        + RUN.replace("0.5", "2.5").replace("0.02", "0.2")
        + RUN.replace("frequency_hz", "frequncy_hz"),
        encoding="utf-8",
    )
    with pytest.raises(ConfigurationError) as caught:
        read_campaign(path)
    lines = str(caught.value).splitlines()
    assert lines[0].endswith("8 errors")
    assert len(lines) == 9
    assert len(set(lines)) == 9


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"[model\n", "not a readable TOML file.*line 1"),
        (b"\xff\xfe", "not a readable TOML file"),
        (None, "no such file"),
    ],
)
def test_an_unreadable_file(content: bytes | None, message: str, tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ConfigurationError, match=message):
        read_campaign(path)


def test_a_number_that_is_none_is_one_error(tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(RIG + "[model]\nmass_kg = 70\ninertia_kg_m2 = 3\ncg_x_m = nan\n")
    with pytest.raises(ConfigurationError) as caught:
        read_campaign(path)
    assert str(caught.value).lower().count("cg_x_m") == 1
