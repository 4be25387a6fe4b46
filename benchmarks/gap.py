"""The gap's diagnosis: 24 runs, 40 effects and their pairs, from recordings to an answer."""

import tempfile
import time
from contextlib import redirect_stdout
from io import StringIO
from itertools import product
from pathlib import Path

from analysis.gap.judge.diagnosis import diagnose
from benchmarks.outcome import Benchmark, Outcome, Report
from pmm.cli import cli
from pmm.gap.preparation import prepare
from pmm.parallel import open_executor
from sim.effects.catalogue import catalogue

_HEAD = Path(__file__).parents[1] / "examples" / "gap" / "campaign.toml"
_THERE = ("connecting-rod:rod_length_m=1.5", "coulomb-friction:friction_n=0.3")
_EFFECTS = 40
_WORKERS = 2


def _campaign(folder: Path, quick: bool) -> int:
    """Write a campaign of 24 runs beside what the example says of its rig; return how many."""
    head = _HEAD.read_text(encoding="utf-8").split("[[runs]]")[0]
    frequencies = (0.8,) if quick else (0.5, 0.7, 0.9, 1.1)
    water = list(product(("water",), frequencies, (10, 20), (0, 180)))
    air = list(product(("air",), frequencies, (20,), (0, 180)))
    runs = [
        f'[[runs]]\nname = "{medium}-{hz:g}-{mm}-{deg}"\nmedium = "{medium}"\n'
        f"frequency_hz = {hz}\neccentricity_mm = {mm}\nstrut_phase_deg = {deg}\n"
        f"carriage_speed_m_s = {1.2 if medium == 'water' else 0.0}\nperiods = 10\n"
        for medium, hz, mm, deg in (*water, *air)
    ]
    (folder / "campaign.toml").write_text(head + "\n".join(runs), encoding="utf-8")
    return len(runs)


def _names(count: int) -> list[str]:
    """Return so many effects of the catalogue, those that are there among them."""
    there = [one.split(":")[0] for one in _THERE]
    others = [name for name in catalogue() if name not in there]
    return there + others[: count - len(there)]


def run(quick: bool, report: Report) -> Outcome:
    """Simulate the campaign with two effects, and time its diagnosis on two processes."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        report("simulating the campaign")
        count = _campaign(folder, quick)
        effects = [word for one in _THERE for word in ("--effect", one)]
        told = ["simulate", str(folder / "campaign.toml"), "--output", str(folder / "rig")]
        with redirect_stdout(StringIO()):
            cli.main([*told, *effects], standalone_mode=False)
        names = _names(2 if quick else _EFFECTS)
        known = {name: kind for name, kind in catalogue().items() if name in names}
        with open_executor(1 if quick else _WORKERS) as executor:
            if not quick:
                report("once, so that what is compiled is there")
                prepared = prepare(folder / "rig", known)
                diagnose(prepared.there.rig, prepared.fitted, prepared.settings, executor)
            report("diagnosing")
            started, busy = time.perf_counter(), time.process_time()
            prepared = prepare(folder / "rig", known)
            found = diagnose(prepared.there.rig, prepared.fitted, prepared.settings, executor)
            taken, own = time.perf_counter() - started, time.process_time() - busy
    answer, probability = max(found.answers.by_answer.items(), key=lambda one: one[1])
    return Outcome(
        {
            "A campaign": [
                {
                    "runs": count,
                    "effects": len(known),
                    "put in": " and ".join(one.split(":")[0] for one in _THERE),
                    "answer": answer,
                    "probability": round(probability, 4),
                    "s": taken,
                    "of it in the first process": own,
                }
            ]
        },
        {} if quick else {"campaign_s": taken},
        (
            "From the recordings to the answer, proposed runs included; compiled code is there.",
            "What needs a sealed board is measured there: scoreboard.md.",
        ),
    )


BENCHMARK = Benchmark("gap", "Gap diagnosis", run)
