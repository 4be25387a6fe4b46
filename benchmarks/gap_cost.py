"""Cost of a diagnosis, from recordings to an answer, with all effects and their pairs.

Measured on sealed cases of 8 to 12 runs, half of them nulls, and on a campaign of 4 to 40 runs with
two effects.
"""

import tempfile
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import Executor
from contextlib import redirect_stdout
from io import StringIO
from itertools import count, islice, product
from pathlib import Path

import numpy as np

from analysis.gap.judge.diagnosis import Diagnosis, diagnose
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.peak import peak_bytes
from pmm.cli import cli
from pmm.gap.preparation import prepare
from pmm.parallel import open_executor
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect

_HEAD = Path(__file__).parents[1] / "examples" / "gap" / "campaign.toml"
_THERE = ("connecting-rod:rod_length_m=1.5", "coulomb-friction:friction_n=0.3")
_COUNTS = (4, 8, 12, 16, 40)
_SEED = 61  # of development: no board is scored by it
_EACH, _USUAL = 10, range(8, 13)  # cases of each world, and how many runs they have
_TIMED = (24, 40)  # on two cores
_WORKERS = 2


def _simulated(folder: Path, runs: int) -> Path:
    """Simulate a campaign of so many runs with two effects; return its folder."""
    head = _HEAD.read_text(encoding="utf-8").split("[[runs]]")[0]
    frequencies = (0.5, 0.7, 0.9, 1.1) if runs <= 24 else (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1)
    water = product(("water",), frequencies, (20, 10), (0, 180))
    air = product(("air",), frequencies, (20,), (0, 180))
    set_points = sorted((*water, *air), key=lambda one: (one[2] != 20, one[0], one[1]))
    # Spread over all kinds of them, whatever their number.
    chosen = [set_points[at] for at in np.linspace(0, len(set_points) - 1, runs).astype(int)]
    texts = [
        f'[[runs]]\nname = "{medium}-{hz:g}-{mm}-{deg}"\nmedium = "{medium}"\n'
        f"frequency_hz = {hz}\neccentricity_mm = {mm}\nstrut_phase_deg = {deg}\n"
        f"carriage_speed_m_s = {1.2 if medium == 'water' else 0.0}\nperiods = 10\n"
        for medium, hz, mm, deg in chosen
    ]
    (folder / "campaign.toml").write_text(head + "\n".join(texts), encoding="utf-8")
    effects = [word for one in _THERE for word in ("--effect", one)]
    told = ["simulate", str(folder / "campaign.toml"), "--output", str(folder / "rig")]
    with redirect_stdout(StringIO()):
        cli.main([*told, *effects], standalone_mode=False)
    return folder / "rig"


def _diagnosed(
    folder: Path, known: Mapping[str, type[Effect]], executor: Executor | None = None
) -> Diagnosis:
    prepared = prepare(folder, dict(known))
    return diagnose(prepared.recentred.rig, prepared.fitted, prepared.settings, executor)


def _known(quick: bool) -> Mapping[str, type[Effect]]:
    there = [one.split(":")[0] for one in _THERE]
    return {name: kind for name, kind in catalogue().items() if not quick or name in there}


def _alone(scratch: Path, runs: int, known: Mapping[str, type[Effect]]) -> Row:
    """Diagnose in this process, and say what it took of the processor."""
    found, busy_s = _timed(_simulated(_made(scratch / f"alone-{runs}"), runs), known)
    return {
        "runs": runs,
        "processor, s": busy_s,
        "largest memory so far, MB": peak_bytes() / 1e6,
        **_told(found),
    }


def _on_two_cores(
    scratch: Path, runs: int, known: Mapping[str, type[Effect]], executor: Executor
) -> Row:
    folder = _simulated(_made(scratch / f"two-{runs}"), runs)
    started = time.perf_counter()
    found = _diagnosed(folder, known, executor)
    return {"runs": runs, "on two cores, s": time.perf_counter() - started, **_told(found)}


def _timed(folder: Path, known: Mapping[str, type[Effect]]) -> tuple[Diagnosis, float]:
    """Diagnose in this process; return what was found and the seconds of its processor."""
    busy = time.process_time()
    found = _diagnosed(folder, known)
    return found, time.process_time() - busy


def _sealed(world: str, each: int, scratch: Path) -> Iterator[Path]:
    """Yield folders of a world's first cases of usual length, every other one a null."""
    from tests.sealed.generator.case import first_design, make
    from tests.sealed.generator.files import write_open

    fitting = (at for at in count(1) if len(first_design(_SEED, at, world).runs) in _USUAL)
    for number, index in enumerate(islice(fitting, each)):
        case = make(_SEED, index, null=number % 2 == 0, where=world)
        folder = _made(scratch / f"{world}-{index}")
        write_open(case, folder)
        yield folder / case.name


def _usual(
    scratch: Path, known: Mapping[str, type[Effect]], quick: bool
) -> tuple[list[Row], float]:
    """Return a row on each world's usual campaigns, and the median of all of them in seconds."""
    from benchmarks.boards.worlds import WORLDS

    rows, all_s = list[Row](), list[float]()
    for world in WORLDS[:1] if quick else WORLDS:
        each = 2 if quick else _EACH
        taken = [_timed(folder, known)[1] for folder in _sealed(world, each, scratch)]
        all_s += taken
        rows.append(
            {
                "world": world,
                "campaigns": len(taken),
                "median, s": float(np.median(taken)),
                "of nulls, s": float(np.median(taken[::2])),
                "of gaps, s": float(np.median(taken[1::2])),
                "slowest, s": max(taken),
            }
        )
    return rows, float(np.median(all_s))


def _told(found: Diagnosis) -> Row:
    answer, probability = max(found.answers.by_answer.items(), key=lambda one: one[1])
    return {"answer": answer, "probability": round(probability, 4)}


def _made(folder: Path) -> Path:
    folder.mkdir()
    return folder


def run(quick: bool, report: Report) -> Outcome:
    """Time diagnoses of campaigns of several lengths, in one process and in two."""
    known = _known(quick)
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        report("once, so that what is compiled is there")
        _alone(scratch, 6, known)
        rows, timed = [], []
        for runs in (8,) if quick else _COUNTS:
            report(f"{runs} runs")
            rows.append(_alone(scratch, runs, known))
        if not quick:
            with open_executor(_WORKERS) as executor:
                _on_two_cores(scratch, 6, known, executor)
                for runs in _TIMED:
                    report(f"{runs} runs on two cores")
                    timed.append(_on_two_cores(scratch, runs, known, executor))
        # Last: making cases takes memory that no diagnosis does.
        report(f"sealed cases of {_USUAL[0]} to {_USUAL[-1]} runs")
        usual, median_s = _usual(scratch, known, quick)
    notes = (
        f"{len(known)} effects and pairs of them, the two effects are "
        + " and ".join(one.split(":")[0] for one in _THERE)
        + "; from the recordings to the answer, proposed runs included; compiled code is there.",
        "A sealed case's time is that of the answer alone; other figures on such: scoreboard.md.",
    )
    tables = {f"Sealed cases of {_USUAL[0]} to {_USUAL[-1]} runs, in one process": usual}
    tables |= {"Two effects, in one process": rows}
    tables |= {"Two effects, in two processes": timed} if timed else {}
    measured = {} if quick else {"usual_s": median_s, **_measured(rows, timed)}
    return Outcome(tables, measured, notes)


def _measured(rows: list[Row], timed: list[Row]) -> dict[str, float]:
    taken = {int(row["runs"]): float(row["processor, s"]) for row in rows}
    counts = np.log(list(taken))
    return {
        "runs_12_s": 0.5 * (taken[8] + taken[12]),
        "runs_24_s": float(timed[0]["on two cores, s"]),
        "runs_40_s": float(timed[1]["on two cores, s"]),
        "memory_mb": float(rows[-1]["largest memory so far, MB"]),
        "power_of_runs": float(np.polyfit(counts, np.log(list(taken.values())), 1)[0]),
    }


BENCHMARK = Benchmark("gap_cost", "Cost of a gap diagnosis", run)
