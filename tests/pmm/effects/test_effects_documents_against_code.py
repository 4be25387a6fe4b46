"""``docs/effects.md`` and ``docs/adding-an-effect.md`` against the catalogue and the loader."""

import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from docs.effects import POINTS, SET_POINTS, page
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from pmm.cli import cli
from sim.effects.agreement import mismatch
from sim.effects.catalogue import build, catalogue, load_file, user_effects
from sim.effects.switching import switch_on
from sim.rig import vertical_rig
from sim.run import steady_run
from tests.sim.effects.against_theory import at_small_angles

PAGE = Path(__file__).parents[3] / "docs" / "effects.md"
ADDING = (PAGE.parent / "adding-an-effect.md").read_text(encoding="utf-8")
(EXAMPLE,) = re.findall(r"^```python\n(.*?)^```", ADDING, flags=re.MULTILINE | re.DOTALL)
RIG = vertical_rig().ideal()


@pytest.fixture
def boot_file(tmp_path: Path) -> Path:
    path = tmp_path / "rubber_boot.py"
    path.write_text(EXAMPLE, encoding="utf-8")
    return path


@pytest.mark.slow
def test_the_page_is_in_step() -> None:
    assert PAGE.read_text(encoding="utf-8") == page()


def test_the_page_has_every_effect_once() -> None:
    names = re.findall(r"^\| \w+ \| `([\w-]+)` \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert names == list(catalogue())
    assert len(names) > 40


@pytest.mark.parametrize(
    ("text", "set_points"),
    [
        ("speed-droop:droop_rad_s_n_m=2e-4", SET_POINTS),
        ("load-ripple:inertia_kg_m2=200", SET_POINTS),
    ],
)
def test_reasons_for_a_large_mismatch_are_the_reasons(
    text: str, set_points: list[SetPoint]
) -> None:
    effect = build(text)
    assert mismatch(type(effect)(), RIG, SET_POINTS, points=POINTS) > 1e-3
    assert at_small_angles(effect, RIG, set_points, points=POINTS) < 1e-3


def test_foreshortening_is_the_leading_power() -> None:
    effect = build("foreshortening")
    set_points = [SetPoint(1.0, 0.01, np.pi, 1.0), SetPoint(0.5, 0.01, 2.0)]
    assert mismatch(effect, RIG, SET_POINTS, points=POINTS) > 1e-3
    assert mismatch(effect, RIG, set_points, points=POINTS) < 1e-3


def test_theories_of_small_angles_hold_at_small_angles() -> None:
    text = PAGE.read_text(encoding="utf-8")
    names = re.findall(r"^\| \w+ \| `([\w-]+)` \|.*small angles \|$", text, re.MULTILINE)
    assert len(names) > 10
    for name in names:
        if name not in {"speed-droop", "load-ripple"}:  # and first order: above
            assert at_small_angles(build(name), RIG, SET_POINTS, points=POINTS) < 1e-3


def test_the_example_agrees_with_its_theory(boot_file: Path) -> None:
    boot = load_file(boot_file)["rubber-boot"]()
    in_air = SetPoint(1.1, 0.03, 1.0, 0.0, Medium.AIR)
    assert mismatch(boot, RIG, [*SET_POINTS, in_air]) < 1e-3
    doubled = build("rubber-boot:stiffening_n_m2=10000", {"rubber-boot": type(boot)})
    twice, _ = switch_on((boot, boot), RIG, in_air)
    once, _ = switch_on((doubled,), RIG, in_air)
    for name in ("force_aft", "force_fore"):
        one, other = (steady_run(rig, in_air).spectra[name] for rig in (twice, once))
        np.testing.assert_allclose(one, other, atol=1e-12 * np.abs(one).max())


@pytest.mark.slow
def test_the_commands_of_the_page_work(boot_file: Path, tmp_path: Path) -> None:
    figures = tmp_path / "figures"
    options = ["--effects-file", str(boot_file), "--plot", str(figures)]
    shown = CliRunner().invoke(cli, ["effects", "rubber-boot", *options], catch_exceptions=False)
    assert shown.exit_code == 0
    assert "Rubber boot around the fore strut" in shown.stdout
    campaign = PAGE.parents[1] / "examples" / "vertical" / "campaign.toml"
    command = ["simulate", str(campaign), "--run", "heave-1.20", "--output", str(tmp_path / "out")]
    effect = ["--effect", "rubber-boot:stiffening_n_m2=8000"]
    done = CliRunner().invoke(cli, [*command, *effect, *options], catch_exceptions=False)
    assert done.exit_code == 0
    assert {one.name for one in figures.iterdir()} == {
        *(f"rubber-boot-signature.{suffix}" for suffix in ("svg", "png")),
        *(f"heave-1.20-chain.{suffix}" for suffix in ("svg", "png")),
    }


def test_own_files_that_are_no_use(tmp_path: Path, boot_file: Path) -> None:
    with pytest.raises(ConfigurationError, match=r"nowhere\.py: no Python file of effects"):
        load_file(tmp_path / "nowhere.py")
    broken = tmp_path / "broken.py"
    broken.write_text("def (:\n")
    with pytest.raises(ConfigurationError, match=r"broken\.py: cannot be imported: SyntaxError"):
        load_file(broken)
    empty = tmp_path / "empty.py"
    empty.write_text("A = 1\n")
    with pytest.raises(ConfigurationError, match=r"empty\.py: defines no effect"):
        load_file(empty)
    taken = tmp_path / "taken.py"
    taken.write_text(EXAMPLE.replace('"rubber-boot"', '"cable"'))
    with pytest.raises(ConfigurationError, match=r"taken\.py: cable: .* rename yours"):
        user_effects(taken)
