"""Mutated campaign folders through the door and the quality checks, or through whole commands."""

import warnings
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Final

import numpy as np
from click.testing import CliRunner

from benchmarks.boards.folder import base
from benchmarks.boards.judged import scratch
from benchmarks.boards.mutations import MUTATIONS
from benchmarks.boards.where import arose
from hardware.description.errors import PmmError
from pmm.cli import cli
from sim.effects.catalogue import catalogue

TEXT: Final = 0.7  # share of folders that are another system's text, the others NetCDF
MOST: Final = 3  # mutations of a folder; one of them as often as more
# An effect of each kind: what a whole diagnosis looks for in so many folders.
EFFECTS: Final = ("coulomb-friction", "gain-error", "quadratic-damping")
# The product's own parts of a refusal; without one of them it is no sentence.
_BEGINS: Final = ("error: ", "Usage: ")


def spoiled(seed: int, folder: Path) -> tuple[str, ...]:
    """Write the mutated campaign of a seed; return the names of what was done to it."""
    rng = np.random.default_rng([22, seed])
    made = base(foreign=bool(rng.random() < TEXT))
    count = 1 if rng.random() < 0.5 else int(rng.integers(2, MOST + 1))
    names = tuple(str(one) for one in rng.choice(list(MUTATIONS), size=count, replace=False))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # values of 1e300 overflow while they are spoiled
        for name in names:
            MUTATIONS[name](made, rng)
    made.write(folder)
    return names


def through_the_door(seed: int) -> dict[str, Any]:
    """Read a mutated campaign as each of the three commands does, up to the quality checks."""
    with scratch() as folder:
        names = spoiled(seed, folder)
        found = {name: _tried(way, folder) for name, way in _WAYS.items()}
    return _row(seed, names, found)


def through_commands(seed: int) -> dict[str, Any]:
    """Type each command on a mutated campaign."""
    with scratch() as folder:
        names = spoiled(seed, folder)
        found = {words[0]: _typed(folder, words) for words in _COMMANDS}
    return _row(seed, names, found)


def _row(seed: int, names: tuple[str, ...], found: dict[str, tuple[str, str]]) -> dict[str, Any]:
    said = {way: text for way, (outcome, text) in found.items() if outcome == "traceback"}
    return {
        "seed": seed,
        "mutations": list(names),
        "outcomes": {way: outcome for way, (outcome, _) in found.items()},
        "tracebacks": said,
    }


def _analyse(folder: Path) -> None:
    """Read each run's recording and resolve it."""
    from analysis.resolver.analysis import analyse
    from pmm.campaign.campaign import Campaign
    from pmm.harmonics.sources import find_sources, read_source

    refused: PmmError | None = None
    for source in find_sources([str(folder)]).sources:
        told = source.campaign or Campaign()
        try:
            analyse(read_source(source), told.reference, told.analysis)
        except PmmError as error:
            refused = error
    if refused is not None:
        raise refused


def _coefficients(folder: Path) -> None:
    from pmm.coefficients.settings import settings_of
    from pmm.coefficients.workflow import coefficients_of

    settings, _ = settings_of(folder, None)
    with ThreadPoolExecutor(1) as executor:
        coefficients_of([folder], settings, executor, lambda *_: None)


def _gap(folder: Path) -> None:
    from pmm.gap.preparation import prepare

    prepare(folder, catalogue())


_WAYS: Final[dict[str, Callable[[Path], None]]] = {
    "analyse": _analyse,
    "coefficients": _coefficients,
    "gap": _gap,
}
_COMMANDS: Final = (
    ("analyse",),
    ("coefficients",),
    ("report", "--overwrite"),
    ("gap", "--jobs", "1", *(word for name in EFFECTS for word in ("--effects", name))),
)


def _tried(way: Callable[[Path], None], folder: Path) -> tuple[str, str]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            way(folder)
        except (PmmError, OSError) as error:
            return (
                ("refused", str(error)) if str(error) else ("traceback", "a refusal without a word")
            )
        except Exception as error:  # what is looked for
            return "traceback", arose(error)
    return "done", ""


def _typed(folder: Path, words: tuple[str, ...]) -> tuple[str, str]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        done = CliRunner().invoke(cli, [words[0], str(folder), *words[1:]])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        return "traceback", arose(done.exception)
    if done.exit_code == 0:
        return "done", ""
    is_sentence = any(line.startswith(_BEGINS) for line in done.stderr.splitlines())
    if done.exit_code in (1, 2) and is_sentence:
        return "refused", done.stderr
    return "traceback", f"exit status {done.exit_code}: {done.stderr[-200:]}"


def counted(board: str, first: int, stop: int) -> dict[str, Any]:
    """Spoil the campaigns of some seeds; return how often what came out, and every traceback."""
    through = through_the_door if board == "mutations" else through_commands
    outcomes: Counter[str] = Counter()
    done: Counter[str] = Counter()
    tracebacks = []
    for seed in range(first, stop):
        row = through(seed)
        outcomes.update(f"{way}: {one}" for way, one in row["outcomes"].items())
        done.update(row["mutations"])
        if row["tracebacks"]:
            tracebacks.append({key: row[key] for key in ("seed", "mutations", "tracebacks")})
    return {
        "seed": first,
        "stop": stop,
        "outcomes": dict(sorted(outcomes.items())),
        "mutations": dict(sorted(done.items())),
        "tracebacks": tracebacks,
    }
