"""What TOML allows and no rig has is refused in words wherever it stands, and writes no file."""

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from analysis.readers.columns_toml import read_column_map
from hardware.description.errors import ConfigurationError
from pmm.campaign.calibration import read_calibration
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import no_file_name
from pmm.cli import cli
from pmm.configuration import read_toml
from pmm.plan.plan import read_plan
from pmm.plan.rig_file import read_rig_file
from sim.devices.bench_file import read_bench

HEAD = """name = "x"
oscillator = { preset = "vertical-1963" }
model = { mass_kg = 70.0, inertia_kg_m2 = 27.5 }
"""
RUN = '\n[[runs]]\nname = "a"\nfrequency_hz = 0.5\neccentricity_mm = 20\n'
RIG = """[oscillator]
preset = "vertical-1963"
[bus]
interface = "virtual"
channel = "nowhere"
[[forces]]
driver = "cia404-amplifier"
node = 4
channels = [{ name = "force_aft", object = "9130:1", scale = 1e-3, full_scale = 500.0 }]
"""
READERS: tuple[Callable[[Path], object], ...] = (
    read_campaign,
    read_plan,
    read_rig_file,
    read_bench,
    read_calibration,
    read_column_map,
)
EVERYWHERE = (
    "a = " + "[" * 5000 + "]" * 5000,
    ".".join(["a"] * 5000) + " = 1",
    "a = " + "9" * 5000,
    "a = 99999999999999999999999999999999",
    "a = 1979-05-27T07:32:00Z\nb = 07:32:00",
    "\x00",
    "[a]\n[a]",
    "a = inf\nb = nan",
)


@pytest.mark.sample(19)
@pytest.mark.parametrize("read", READERS)
@pytest.mark.parametrize("text", EVERYWHERE, ids=range(len(EVERYWHERE)))
def test_every_reader_refuses_in_words(
    read: Callable[[Path], object], text: str, tmp_path: Path
) -> None:
    path = tmp_path / "file.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError) as caught:
        read(path)
    assert str(path) in str(caught.value)
    assert len(str(caught.value)) < 2000


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD.replace('"vertical-1963"', "[]") + RUN, "oscillator.preset = [] should be"),
        (HEAD.replace('"vertical-1963"', "{ a = 1 }") + RUN, "oscillator.preset ="),
        (HEAD + "[simulation]\nsample_rate_hz = 1e9" + RUN, "should be at most 1e+06"),
        (HEAD + RUN + "periods = 1_000_000_000", "periods = 1e+09 should be at most 100000"),
        (HEAD.replace('"x"', '"../../evil"') + RUN, "cannot be the name of a file or folder"),
        (HEAD + RUN.replace('"a"', '"nul"'), "a device's on Windows"),
        (HEAD + RUN.replace('"a"', '"a\\n"'), "it has '\\n'"),
        (HEAD + RUN.replace('"a"', f'"{"a" * 101}"'), "the limit is 100"),
    ],
)
def test_a_campaign_is_refused_in_words(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "in" / "campaign.toml"
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")
    made = CliRunner().invoke(cli, ["simulate", str(path)])
    assert made.exit_code == 2
    assert said in " ".join(made.stderr.split())
    assert list(tmp_path.iterdir()) == [path.parent]


@pytest.mark.parametrize("value", ["nan", "-nan", "inf", "-inf"])
@pytest.mark.parametrize(
    "key",
    [
        "hull.damping = [[{}, 0.0], [0.0, 1.0]]",
        "drive.speed_error = {}",
        "dynamometers.aft.gain = {}",
        "acquisition.force_aft.drift_per_s = {}",
        "model_uncertainty.mass_kg = {}",
        "cross_flow.cubic = [[0.0, 0.0, 0.0, {}], [0.0, 0.0, 0.0, 0.0]]",
    ],
)
def test_no_number_of_a_campaign_is_none(key: str, value: str, tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(HEAD + key.format(value) + "\n" + RUN, encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"finite|should be 0 or more"):
        read_campaign(path)


def test_degrees_of_freedom_may_be_infinite(tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    text = HEAD + "model_uncertainty = { mass_kg = 0.1, inertia_degrees_of_freedom = inf }\n" + RUN
    path.write_text(text, encoding="utf-8")
    assert read_campaign(path).model_uncertainty is not None


@pytest.mark.parametrize("value", ["1979-05-27", "nan", "inf"])
def test_a_device_takes_no_date_and_no_infinity(value: str, tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text(RIG.replace("1e-3", value), encoding="utf-8")
    with pytest.raises(ConfigurationError, match="channels") as caught:
        read_rig_file(path)
    assert "scale" in str(caught.value)


def test_a_node_is_no_date(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text(RIG.replace("node = 4", "node = 1979-05-27"), encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"forces\[0\]\.node = '1979-05-27'"):
        read_rig_file(path)


@pytest.mark.parametrize(
    ("option", "said"),
    [
        (("--frequency", "1e9"), "samples a period carry no harmonic"),
        (("--harmonics", "1000000000"), "cannot carry harmonic 1e+09"),
        (("--gate", "1000000000"), "a gate of 1000000000 periods does not fit"),
        (("--opens-at", "0.1", "--periods", "1000000000"), "but 1000000000 are asked for"),
    ],
)
def test_a_number_that_no_recording_holds_takes_no_memory(
    option: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    """Eight bytes for each harmonic, period or sample asked for would be 8 GB."""
    path = tmp_path / "campaign.toml"
    path.write_text(HEAD + RUN, encoding="utf-8")
    made = CliRunner().invoke(cli, ["simulate", str(path), "--output", str(tmp_path / "out")])
    assert made.exit_code == 0, made.stderr
    tracemalloc.start()
    done = CliRunner().invoke(cli, ["analyse", str(tmp_path / "out" / "a.nc"), *option])
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert done.exit_code in (1, 2)
    assert said in " ".join(done.stderr.split())
    assert most < 200e6


def test_a_simulation_that_no_memory_holds_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    run = RUN.replace("0.5", "0.1") + "periods = 100_000"
    path.write_text(HEAD + "[simulation]\nsample_rate_hz = 1e6" + run, encoding="utf-8")
    made = CliRunner().invoke(cli, ["simulate", str(path), "--output", str(tmp_path / "out")])
    assert made.exit_code == 2
    assert "more than 1e+07 samples at 1e+06 Hz; lower periods" in " ".join(made.stderr.split())


def test_a_plan_of_millions_of_runs_is_refused_before_they_are_made(tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(RIG, encoding="utf-8")
    numbers = ", ".join(f"{0.5 + n / 1000:g}" for n in range(200))
    path = tmp_path / "plan.toml"
    path.write_text(
        f'[[runs]]\nmotion = "heave"\nfrequencies_hz = [{numbers}]\namplitudes_mm = 20\n'
        "repeats = 1000\n",
        encoding="utf-8",
    )
    with pytest.raises(ConfigurationError, match="asks for 200000 runs; the limit is 10000"):
        read_plan(path)


@pytest.mark.parametrize("name", ["heave-f0.5-a20", "Tauchen 1", "Längs", "a.b", "com10", "é"])
def test_names_that_people_give_are_taken(name: str, tmp_path: Path) -> None:
    assert no_file_name(name) is None
    (tmp_path / name).mkdir()


@pytest.mark.parametrize("hz", ["1e9", "101"])
def test_a_frequency_beyond_half_the_sampling_is_refused(hz: str, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    rows = "\n".join(f"{k / 200:.3f},{k % 7}" for k in range(1000))
    path.write_text(f"t [s],F [N]\n{rows}\n", encoding="utf-8")
    done = CliRunner().invoke(cli, ["analyse", str(path), "--frequency", hz])
    assert done.exit_code == 1
    assert "a period needs at least 2: sample faster" in " ".join(done.stderr.split())


def test_a_recording_in_place_of_its_file_is_told_what_to_give(tmp_path: Path) -> None:
    path = tmp_path / "roll.csv"
    for content in ("Zeit;Müller\n0;1\n".encode("latin-1"), b"time,roll\n0,1\n"):
        path.write_bytes(content)
        with pytest.raises(ConfigurationError, match="give a TOML file that names it"):
            read_toml(path)
