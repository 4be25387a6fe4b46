"""The campaigns that the project ships or makes, each made anew with a noise seed of its own."""

import gzip
import importlib.util
import re
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Final

from click.testing import CliRunner

from analysis.readers import read_recording
from benchmarks.boards import outside
from benchmarks.machine import ROOT
from pmm.cli import cli

EXAMPLES: Final = ROOT / "examples"
RIGS: Final = ROOT / "pmm" / "cli" / "demo_rigs"

Make = Callable[[Path, int, Sequence[str]], Path]
"""Makes a campaign: an empty folder, a seed, effects as ``pmm simulate --effect`` takes them."""


class NotMadeError(RuntimeError):
    """A command that makes a campaign refused, which is the board's fault."""


def typed(*words: str | Path) -> str:
    """Run ``pmm`` in this process and return what it prints.

    Raises
    ------
    NotMadeError
        If it does not end well.
    """
    done = CliRunner().invoke(cli, [str(one) for one in words])
    if done.exit_code:
        raise NotMadeError(f"pmm {' '.join(map(str, words))}: {done.output} {done.exception!r}")
    return done.stdout


def simulated(example: Path, folder: Path, seed: int, effects: Sequence[str]) -> Path:
    """Simulate a campaign file as the README says."""
    options = [word for one in effects for word in ("--effect", one)]
    typed("simulate", example, "--output", folder / "rig", "--seed", str(seed), *options)
    return folder / "rig"


def foreign(folder: Path, seed: int, effects: Sequence[str]) -> Path:
    """Make ``examples/foreign`` anew: what it was made of, with another seed."""
    made = simulated(EXAMPLES / "foreign" / "truth.toml", folder, seed, effects)
    theirs, recipe = folder / "theirs", _recipe()
    theirs.mkdir()
    for path in sorted(made.glob("*.nc")):
        one = read_recording(path)
        rows = recipe.table(one.time_s(), *(one.values(name) for name in one.channel_names[:5]))
        recipe.write(theirs / f"{path.stem}.csv.gz", rows, path.stem)
    shutil.copy(EXAMPLES / "foreign" / "campaign.toml", theirs)
    return theirs


def _recipe() -> ModuleType:
    path = EXAMPLES / "foreign" / "make.py"
    spec = importlib.util.spec_from_file_location("foreign_recipe", path)
    if spec is None or spec.loader is None:
        raise NotMadeError(f"{path} cannot be read")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def begun(folder: Path, seed: int, effects: Sequence[str]) -> Path:
    """Let ``pmm init campaign`` begin one from the same files, their headers with all units."""
    theirs = foreign(folder, seed, effects)
    for path in theirs.glob("*.csv.gz"):
        text = gzip.decompress(path.read_bytes()).decode()
        head, _, rows = text.partition("\n")
        for name, unit in (("Kraft A", "kN"), ("Kraft B", "kN"), ("Kurbel", "deg")):
            head = head.replace(name, f"{name} [{unit}]")
        path.write_bytes(gzip.compress(f"{head}\n{rows}".encode(), mtime=0))
    return initiated(sorted(theirs.glob("*.csv.gz")), folder)


def initiated(recordings: Sequence[Path], folder: Path) -> Path:
    """Begin a campaign from recordings as they are, of a model that is stated."""
    model = ("--mass-kg", "70", "--inertia-kg-m2", "27.5")
    typed("init", "campaign", "--yes", "--output", folder / "begun", *model, *recordings)
    return folder / "begun"


# What rig.toml has of a sensor, to be taken away.
_SENSORS: Final[Mapping[str, re.Pattern[str]]] = {
    "displacements": re.compile(
        r"\[\[forces\]\]\ndriver = \"cia404-amplifier\"\nnode = 5\n.*?\n\]\n\n", re.DOTALL
    ),
    "photocell": re.compile(r"\[photocell\]\n.*?\n\n", re.DOTALL),
    "aft force": re.compile(r"  \{ name = \"force_aft\".*?\n"),
}
LESS: Final = (
    (),
    ("displacements",),
    ("photocell",),
    ("displacements", "photocell"),
    ("displacements", "photocell", "aft force"),
)
# A plan of a few short runs, for what does not ask for more.
SHORT: Final = """name = "short"
rig = "rig.toml"
operator = "board"

[defaults]
periods = 5
settling_periods = 1
pause_s = 0.5
duration_s = 2.0

[zero]
duration_s = 2.0
every = 10

[[runs]]
motion = "heave"
frequencies_hz = [0.8, 1.2]
amplitudes_mm = [10.0, 20.0]
speeds_m_s = 1.2
"""


def carried_out(
    rig: str,
    without: Sequence[str],
    plan: str | None,
    folder: Path,
    seed: int,
    effects: Sequence[str],
) -> Path:
    """Let ``pmm run`` carry out a plan on the simulated rig of the demo, with fewer sensors."""
    if effects:
        raise NotMadeError("the devices of the simulated rig are without effects")
    own = folder / f"{rig}-rig"
    shutil.copytree(RIGS / rig, own)
    text = (own / "rig.toml").read_text(encoding="utf-8")
    for sensor in without:
        text, count = _SENSORS[sensor].subn("", text, count=1)
        if not count:
            raise NotMadeError(f"{rig}/rig.toml has no {sensor}")
    (own / "rig.toml").write_text(text, encoding="utf-8")
    devices = (own / "simulated.toml").read_text(encoding="utf-8")
    (own / "simulated.toml").write_text(re.sub(r"seed = \d+", f"seed = {seed}", devices))
    if plan is not None:
        (own / "plan.toml").write_text(plan, encoding="utf-8")
    typed("run", own / "plan.toml", "--output", folder / rig)
    return folder / rig


def less(without: Sequence[str]) -> str:
    """Return the name of the campaign of ``pmm run`` with fewer sensors."""
    return "pmm run" + (f", no {', no '.join(without)}" if without else ", all sensors")


@dataclass(frozen=True)
class Recipe:
    """A campaign of the boards.

    Attributes
    ----------
    seeds
        How many are asked for, from 0 up.
    coefficients_off
        Whether those that it states are off on purpose, so that "coefficients" is right.
    unstated
        Effects that its recordings do have and its file does not state: naming them is right too.
    """

    make: Make
    seeds: int
    coefficients_off: bool = False
    unstated: tuple[str, ...] = ()


MANY: Final = 100
FEW: Final = 20
NULLS: Final[Mapping[str, Recipe]] = {
    "examples/gap": Recipe(partial(simulated, EXAMPLES / "gap" / "campaign.toml"), MANY),
    "examples/vertical": Recipe(partial(simulated, EXAMPLES / "vertical" / "campaign.toml"), MANY),
    # truth.toml: the aft gauge drifts by 0.004 N/s.
    "examples/foreign": Recipe(foreign, MANY, unstated=("zero-drift",)),
    "sealed generator, CSV": Recipe(
        partial(outside.null, stated=False), MANY, coefficients_off=True
    ),
    "sealed generator, CSV, noise stated": Recipe(
        partial(outside.null, stated=True), FEW, coefficients_off=True
    ),
    "demo/vertical": Recipe(partial(carried_out, "vertical", (), None), FEW),
    "pmm init campaign": Recipe(begun, FEW, coefficients_off=True),
    **{less(one): Recipe(partial(carried_out, "vertical", one, SHORT), FEW) for one in LESS},
}
