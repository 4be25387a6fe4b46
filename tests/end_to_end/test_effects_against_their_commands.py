"""``pmm effects`` and ``pmm simulate --effect`` from the command line to the recording."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from analysis.readers import read_recording
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from pmm.cli import cli
from sim.effects.catalogue import catalogue

CAMPAIGN = """
[oscillator]
preset = "vertical-1963"

[model]
mass_kg = 70.0
inertia_kg_m2 = 27.5

[hull]
damping = [[190.0, 0.0], [0.0, 55.0]]

[simulation]
waiting_s = 100.0
"""
RUN = """
[[runs]]
name = "{0}"
frequency_hz = 0.8
eccentricity_mm = 20.0
periods = 4
"""


def run(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in arguments])


def campaign(folder: Path, *, extra: str = "", runs: tuple[str, ...] = ("heave",)) -> Path:
    path = folder / "campaign.toml"
    path.write_text(CAMPAIGN + extra + "".join(RUN.format(name) for name in runs))
    return path


def simulated(folder: Path, path: Path, *options: str, name: str = "heave") -> Recording:
    done = run("simulate", path, "--output", folder, *options)
    assert done.exit_code == 0, done.output
    return read_recording(folder / f"{name}.nc")


def force(recording: Recording) -> FloatArray:
    row = recording.index("force_aft")
    return np.asarray(recording.samples[row : row + 1, :])


def test_the_list_is_the_catalogue() -> None:
    shown = json.loads(run("effects", "--json").stdout)
    assert shown["schema"] == "pmm-effects-1"
    assert [one["name"] for one in shown["effects"]] == list(catalogue())
    first = shown["effects"][0]
    assert {"code", "stage", "title", "description", "parameters"} <= set(first)
    assert {"unit", "typical", "low", "high", "meaning"} <= set(first["parameters"][0])
    table = run("effects").stdout
    assert all(name in table for name in catalogue())


def test_one_effect_has_its_signature_beside_the_simulated_one() -> None:
    shown = run("effects", "coulomb-friction:friction_n=2", "--phase", 60, "--json")
    (effect,) = json.loads(shown.stdout)["effects"]
    assert effect["values"]["friction_n"] == 2.0
    assert effect["set_point"]["strut_phase_rad"] == pytest.approx(np.pi / 3.0)
    theory, found = (
        {(one["channel"], one["order"]): one["quadrature"] for one in effect[key]}
        for key in ("theory", "simulated")
    )
    assert theory["force_aft", 1] == pytest.approx(8.0 / np.pi)
    assert found["force_aft", 1] == pytest.approx(8.0 / np.pi, rel=1e-3)


@pytest.mark.sample(24)
@pytest.mark.parametrize("name", list(catalogue()))
def test_every_effect_can_be_shown(name: str) -> None:
    shown = run("effects", name, "--speed", 1.0, "--phase", 90)
    assert shown.exit_code == 0, shown.output
    assert catalogue()[name].title in shown.stdout


def test_lines_beside_the_harmonics_are_shown() -> None:
    assert "recorded_force_aft 0.2 at 50 Hz" in run("effects", "hum").stdout


@pytest.mark.parametrize("command", ["effects", "simulate"])
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("coulom-friction", "no effect 'coulom-friction'; did you mean coulomb-friction"),
        ("coulomb-friction:fricton=2", "no parameter 'fricton'; did you mean 'friction_n'?"),
        ("coulomb-friction:friction_n=60", "friction_n = 60 N is outside the plausible range 0 to"),
        ("coulomb-friction:friction_n=nan", "friction_n = nan N is outside the plausible range"),
        ("coulomb-friction:friction_n=two", "friction_n = 'two' is no number"),
    ],
)
def test_wrong_effects_are_refused(command: str, text: str, message: str, tmp_path: Path) -> None:
    path = campaign(tmp_path)
    arguments = [text] if command == "effects" else [path, "--output", tmp_path, "--effect", text]
    refused = run(command, *arguments)
    assert refused.exit_code == 2
    assert message in " ".join(refused.stderr.split())
    assert not (tmp_path / "heave.nc").exists()


def test_effects_are_recorded_and_the_set_point_is_what_was_told(tmp_path: Path) -> None:
    path = campaign(tmp_path)
    effects = ("--effect", "frequency-error:relative=0.01", "--effect", "zero-offset")
    recording = simulated(tmp_path / "out", path, *effects)
    on = json.loads(recording.provenance["effects"])
    assert [one["name"] for one in on] == ["frequency-error", "zero-offset"]
    assert on[0]["parameters"]["relative"] == 0.01
    assert recording.set_point is not None
    assert recording.set_point.frequency_hz == 0.8
    edges = recording.photocell_edges_s
    assert edges is not None
    assert np.diff(edges) == pytest.approx(1.0 / (0.8 * 1.01), rel=1e-6)
    assert "effects" not in simulated(tmp_path / "plain", path).provenance


def test_several_effects_add_up(tmp_path: Path) -> None:
    path = campaign(tmp_path)
    plain = force(simulated(tmp_path / "0", path))
    both, *single = (
        force(simulated(tmp_path / str(number), path, *options)) - plain
        for number, options in enumerate(
            (
                ("--effect", "coulomb-friction:friction_n=2", "--effect", "cable"),
                ("--effect", "coulomb-friction:friction_n=2"),
                ("--effect", "cable"),
            ),
            1,
        )
    )
    assert np.abs(single[0]).max() > 1.0
    assert both == pytest.approx(single[0] + single[1], abs=1e-9)


def test_effects_of_the_file_are_those_of_the_command_line(tmp_path: Path) -> None:
    on = '[[effects]]\nname = "quadratic-damping"\nparameters = { translation_n_s2_m2 = 500.0 }\n'
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    in_file = simulated(tmp_path / "1", campaign(tmp_path / "a", extra=on))
    option = ("--effect", "quadratic-damping:translation_n_s2_m2=500")
    on_line = simulated(tmp_path / "2", campaign(tmp_path / "b"), *option)
    np.testing.assert_array_equal(force(in_file), force(on_line))
    assert in_file.provenance["effects"] == on_line.provenance["effects"]


def test_wrong_effects_of_a_file_are_all_said(tmp_path: Path) -> None:
    wrong = '[[effects]]\nname = "cabel"\n[[effects]]\nname = "cable"\nparameters = {x = 1.0}\n'
    refused = run("simulate", campaign(tmp_path, extra=wrong), "--output", tmp_path / "out")
    assert refused.exit_code == 2
    message = " ".join(refused.stderr.split())
    assert "effects[1]: no effect 'cabel'; did you mean cable" in message
    assert "effects[2]: effect cable has no parameter 'x'" in message


@pytest.mark.slow
def test_an_effect_on_a_campaign_knows_the_run_before(tmp_path: Path) -> None:
    path = campaign(tmp_path, runs=("first", "second"))
    option = ("--effect", "residual-waves")
    plain = tmp_path / "plain"
    simulated(plain, path, name="first")
    simulated(tmp_path / "waves", path, *option, name="first")
    gaps = {}
    for name in ("first", "second"):
        one, other = (read_recording(tmp_path / kind / f"{name}.nc") for kind in ("plain", "waves"))
        gaps[name] = np.abs(force(one) - force(other)).max()
    assert gaps["first"] == 0.0
    assert gaps["second"] > 1e-3
    # The second run alone is disturbed as much as it is after the first.
    alone = simulated(tmp_path / "alone", path, "--run", "second", *option, name="second")
    same = read_recording(tmp_path / "waves" / "second.nc")
    np.testing.assert_array_equal(force(alone), force(same))


@pytest.mark.slow
def test_plots_of_runs_with_and_without_effects(tmp_path: Path) -> None:
    path = campaign(tmp_path)
    for name, effects in (("nominal", ()), ("lag", ("--effect", "amplifier-lag"))):
        figures = tmp_path / f"{name}-figures"
        simulated(tmp_path / name, path, "--plot", str(figures), *effects)
        text = (figures / "heave-chain.svg").read_text()
        assert "model and water" in text
        assert ("no difference" in text) is (name == "lag")
        assert (figures / "heave-chain.png").stat().st_size > 10_000


def test_no_figure_where_there_is_no_signature(tmp_path: Path) -> None:
    shown = run("effects", "hum", "--plot", tmp_path / "figures")
    assert shown.exit_code == 0
    assert "does not repeat with the shaft" in " ".join(shown.stderr.split())
    assert not (tmp_path / "figures").exists()
    assert run("effects", "--plot", tmp_path).exit_code == 2
