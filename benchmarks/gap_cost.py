"""Cost of a diagnosis: 4 to 40 runs, all effects and their pairs, from recordings to an answer."""

import tempfile
import time
from collections.abc import Mapping
from concurrent.futures import Executor
from contextlib import redirect_stdout
from io import StringIO
from itertools import product
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
_TIMED = (24, 40)  # on two cores
_WORKERS = 2


def _simulated(folder: Path, count: int) -> Path:
    """Simulate a campaign of so many runs with two effects; return its folder."""
    head = _HEAD.read_text(encoding="utf-8").split("[[runs]]")[0]
    frequencies = (0.5, 0.7, 0.9, 1.1) if count <= 24 else (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1)
    water = product(("water",), frequencies, (20, 10), (0, 180))
    air = product(("air",), frequencies, (20,), (0, 180))
    set_points = sorted((*water, *air), key=lambda one: (one[2] != 20, one[0], one[1]))
    # Spread over all kinds of them, whatever their number.
    chosen = [set_points[at] for at in np.linspace(0, len(set_points) - 1, count).astype(int)]
    runs = [
        f'[[runs]]\nname = "{medium}-{hz:g}-{mm}-{deg}"\nmedium = "{medium}"\n'
        f"frequency_hz = {hz}\neccentricity_mm = {mm}\nstrut_phase_deg = {deg}\n"
        f"carriage_speed_m_s = {1.2 if medium == 'water' else 0.0}\nperiods = 10\n"
        for medium, hz, mm, deg in chosen
    ]
    (folder / "campaign.toml").write_text(head + "\n".join(runs), encoding="utf-8")
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


def _alone(scratch: Path, count: int, known: Mapping[str, type[Effect]]) -> Row:
    """Diagnose in this process, and say what it took of the processor."""
    folder = _simulated(_made(scratch / f"alone-{count}"), count)
    busy = time.process_time()
    found = _diagnosed(folder, known)
    return {
        "runs": count,
        "processor, s": time.process_time() - busy,
        "largest memory so far, MB": peak_bytes() / 1e6,
        **_told(found),
    }


def _on_two_cores(
    scratch: Path, count: int, known: Mapping[str, type[Effect]], executor: Executor
) -> Row:
    folder = _simulated(_made(scratch / f"two-{count}"), count)
    started = time.perf_counter()
    found = _diagnosed(folder, known, executor)
    return {"runs": count, "on two cores, s": time.perf_counter() - started, **_told(found)}


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
        for count in (8,) if quick else _COUNTS:
            report(f"{count} runs")
            rows.append(_alone(scratch, count, known))
        if not quick:
            with open_executor(_WORKERS) as executor:
                _on_two_cores(scratch, 6, known, executor)
                for count in _TIMED:
                    report(f"{count} runs on two cores")
                    timed.append(_on_two_cores(scratch, count, known, executor))
    notes = (
        f"{len(known)} effects and pairs of them, put in: "
        + " and ".join(one.split(":")[0] for one in _THERE)
        + "; from the recordings to the answer, proposed runs included; compiled code is there.",
        "What needs a sealed board is measured there: scoreboard.md.",
    )
    tables = {"In one process": rows} | ({"In two processes": timed} if timed else {})
    return Outcome(tables, {} if quick else _measured(rows, timed), notes)


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
