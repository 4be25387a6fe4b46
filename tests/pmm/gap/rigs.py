"""Small campaigns of a simulated rig with friction, for the gap commands to look at."""

import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

import xarray as xr
from click.testing import CliRunner, Result

from pmm.cli import cli

EXAMPLE = Path(__file__).parents[3] / "examples" / "gap" / "campaign.toml"
FRICTION_N = 0.3
FEW = ("--effects", "coulomb-friction", "--effects", "gain-error")
# Two frequencies, amplitudes and media: what the tests below take pieces away from.
RUNS = ("heave-0.50-20", "heave-0.80-20", "heave-1.10-20", "heave-0.80-10", "air-0.80-20")

_MADE: dict[tuple[str, ...], Path] = {}  # pytest keeps its folders until it ends


def run(*arguments: str | Path, given: str | None = None) -> Result:
    """Run ``pmm`` in this process; ``given`` is what is typed."""
    return CliRunner().invoke(cli, [str(one) for one in arguments], input=given)


def short(names: Sequence[str] = RUNS) -> str:
    """Return the example's campaign with a few of its runs, of a few periods each."""
    head, *runs = EXAMPLE.read_text().split("[[runs]]")
    kept = [one for one in runs if any(f'"{name}"' in one for name in names)]
    return "[[runs]]".join([head, *kept]).replace("periods = 10", "periods = 6")


def made(folder: Path, *options: str | Path, names: Sequence[str] = RUNS) -> Path:
    """Simulate it into a folder; what was simulated for another test is copied."""
    key = (*map(str, options), *names)
    if key not in _MADE:
        (folder / "short.toml").write_text(short(names))
        done = run("simulate", folder / "short.toml", "--output", folder / "made", *options)
        assert done.exit_code == 0, done.output
        _MADE[key] = folder / "made"
    return shutil.copytree(_MADE[key], folder / "rig")


def with_friction(folder: Path, names: Sequence[str] = RUNS) -> Path:
    """Simulate it with friction below the dynamometers."""
    return made(folder, "--effect", f"coulomb-friction:friction_n={FRICTION_N}", names=names)


def changed(rig: Path, folder: Path, name: str, change: Callable[[xr.Dataset], xr.Dataset]) -> Path:
    """Copy a campaign with one recording changed, which then is as of another program."""
    copy = shutil.copytree(rig, folder / "copy")
    path = copy / f"{name}.nc"
    with xr.open_dataset(path) as one:
        record = change(one.load())
    record.attrs.pop("checksums")
    record.to_netcdf(path)
    return copy


def rewritten(rig: Path, folder: Path, old: str, new: str) -> Path:
    """Copy a campaign with a piece of its file replaced."""
    copy = shutil.copytree(rig, folder / "copy")
    path = copy / "campaign.toml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    return copy
