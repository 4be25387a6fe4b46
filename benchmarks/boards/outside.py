"""Campaigns of a simulator that is not ``sim/``: the sealed generator's, as another system's CSV.

Names, units and signs are not those of the project; a ``[columns]`` map says what they are.
"""

import gzip
import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from tests.sealed.generator.background import Background
from tests.sealed.generator.case import Case, make
from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.design import design
from tests.sealed.generator.features import StalledError, recorded
from tests.sealed.generator.files import campaign_text
from tests.sealed.generator.kinds import Content, NothingFitsError
from tests.sealed.generator.priors import STATED, drawn, priors
from tests.sealed.generator.rig import CHANNELS, Record
from tests.sealed.generator.signatures import Projection, Situation
from tests.sealed.generator.sizing import Sized, nuisances, sized
from tests.sealed.generator.toml import table
from tests.sealed.generator.worlds import world

SEED: Final = 22  # of the generator; below 100, where seeds are for development
FRICTION: Final = "coulomb-friction"
LEAST_SNR: Final = 10.0
LARGEST_SNR: Final = 100.0
_TRIES: Final = 8
# Column, unit, and what makes it of SI; the fore gauge is mounted the other way round.
_THEIRS: Final = {
    "shaft_angle": ("Kurbel", "rev", 0.5 / np.pi),
    "displacement_aft": ("Hub hinten", "cm", 1e2),
    "displacement_fore": ("Hub vorn", "cm", 1e2),
    "force_aft": ("Waage 1", "kN", 1e-3),
    "force_fore": ("-Waage 2", "kN", -1e-3),
    "carriage_speed": ("Wagen", "km/h", 3.6),
}


def null(folder: Path, seed: int, effects: Sequence[str], *, stated: bool) -> Path:
    """Write a null: coefficients within their tolerances, nuisances below the noise.

    Parameters
    ----------
    stated
        Whether the campaign states noise and resolution of its channels.
    """
    if effects:
        raise ValueError("effects of sim/ are not the sealed generator's")
    return written(make(SEED, seed, null=True), folder / "theirs", stated=stated)


def with_friction(seed: int) -> tuple[Case, Sized]:
    """Return a case with friction below the dynamometers, and that friction.

    Its SNR, by the generator's own signature with all tolerances projected out, is 10 to 100.

    Raises
    ------
    NothingFitsError
        If no rig drawn shows so much.
    """
    for again in range(_TRIES):
        rng = np.random.default_rng([SEED, seed, 7, again])
        try:
            case, found = _drawn(seed, rng)
            case.signature, case.withheld  # noqa: B018 - what has to turn, turns
        except StalledError:
            continue
        if found.snr >= LEAST_SNR:
            return case, found
    raise NothingFitsError(f"seed {seed}: no friction of an SNR of {LEAST_SNR:g}")


def _drawn(seed: int, rng: np.random.Generator) -> tuple[Case, Sized]:
    campaign = design(rng, world("A"))
    known = priors(campaign.believed)
    true = drawn(campaign.believed, known, rng)
    situation = Situation(campaign.rig, campaign.runs, true)
    projection = Projection.of(situation, known)
    wanted = float(np.exp(rng.uniform(np.log(1.25 * LEAST_SNR), np.log(LARGEST_SNR))))
    found = sized(situation, projection, BY_NAME[FRICTION], wanted, rng)
    content = Content("single", "gap", (found,), ((FRICTION,),), (found.effect.stage,))
    background = Background(situation, projection)
    always, total = background.quieted(
        content.without_size(true), nuisances(situation, projection, rng)
    )
    p = true
    for one in (*always, found):
        p = one.put(p)
    case = Case(SEED, seed, False, campaign, situation, projection, content, always, total, p)
    return case, found


def written(case: Case, folder: Path, *, stated: bool) -> Path:
    """Write a case's recordings and what is believed of it."""
    folder.mkdir()
    rig = case.campaign.rig
    for number, run in enumerate(case.campaign.runs):
        made = case.recorded(run, number)
        _write(folder / f"{run.name}.csv.gz", made, rig.sensors)
        if "photocell" in rig.sensors:
            lines = "\n".join(f"{edge:.9f}" for edge in made.edges_s.tolist())
            (folder / f"{run.name}_flanken.csv").write_text(f"edge [s]\n{lines}\n")
    text = campaign_text(case, foreign=False)
    if not stated:
        text = re.sub(r"\[acquisition\]\n.*?\n\n", "", text, flags=re.DOTALL)
    text = re.sub(r'(\[\[runs\]\]\nname = "(.+?)"\n)', r'\1file = "\2.csv.gz"\n', text)
    (folder / "campaign.toml").write_text(f"{text}\n{_columns(rig.sensors)}", encoding="utf-8")
    (folder / "case.toml").write_text(table("[tolerances]", STATED), encoding="utf-8")
    return folder


def _columns(sensors: Sequence[str]) -> str:
    names = [CHANNELS[row] for row in recorded(tuple(sensors))]
    theirs = {name: ":".join(_THEIRS[name][:2]) for name in names}
    text = table("[columns]", {"time": "Uhr:ms", "separator": ";", "decimal": ","})
    text += table("\n[columns.channels]", theirs)
    if "photocell" in sensors:
        text += table("\n[columns.photocell]", {"edges_file": "{stem}_flanken.csv"})
    return text


def _write(path: Path, record: Record, sensors: Sequence[str]) -> None:
    """Write a recording: milliseconds, semicolons, decimal commas."""
    heads, columns = ["Uhr"], [1e3 * record.times_s]
    for row in recorded(tuple(sensors)):
        name, _, factor = _THEIRS[CHANNELS[row]]
        heads.append(name.removeprefix("-"))
        columns.append(record.channels[row] * factor)
    text = io.StringIO()
    np.savetxt(text, np.column_stack(columns), fmt="%.9g", delimiter=";",
               header=";".join(heads), comments="")  # fmt: skip
    path.write_bytes(gzip.compress(text.getvalue().replace(".", ",").encode(), mtime=0))
