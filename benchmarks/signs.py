"""Effects of either sign, planted at 20 sigma with each: how many the diagnosis names."""

from collections.abc import Iterator
from typing import Final

from analysis.gap.judge.diagnosis import Diagnosis, Settings, diagnose
from benchmarks.outcome import Benchmark, Outcome, Report
from pmm.gap.load import unlimited
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect
from sim.rig import vertical_rig
from tests.analysis.gap.signed import planted, signed_kinds
from tests.analysis.gap.small import problem_of, record

_SIGMA: Final = 20.0
_SEEDS: Final = (61, 62, 63)
_QUICK: Final = ("channel-skew", "connecting-rod")  # one planted, both sought


def run(quick: bool, report: Report) -> Outcome:
    """Plant each effect with each sign, over some seeds, and diagnose with the whole catalogue."""
    every = catalogue()
    kinds = {name: every[name] for name in _QUICK} if quick else every
    names = [name for name in signed_kinds() if name in kinds][: 1 if quick else None]
    seeds = _SEEDS[:1] if quick else _SEEDS
    rows = [row for name in names for row in _rows(name, kinds, seeds, report)]
    tried = sum(int(row["tried"]) for row in rows)
    named = sum(int(row["in the class"]) for row in rows)
    return Outcome(
        {"Either sign": rows},
        {} if quick else {"named": named / max(tried, 1)},
        (
            "Six runs of the vertical rig. What does not reach 20 sigma within its range, for the "
            "free numbers take it, is not tried.",
        ),
    )


def _rows(
    name: str, kinds: dict[str, type[Effect]], seeds: tuple[int, ...], report: Report
) -> Iterator[dict[str, str | float]]:
    rig = unlimited(vertical_rig())
    problem = problem_of(rig, record(rig, (), seed=1))
    for sign in (1.0, -1.0):
        report(f"{name}, sign {sign:+g}")
        there = planted(problem, kinds[name], _SIGMA, sign)
        runs = [] if there is None else [record(rig, [there], seed) for seed in seeds]
        found = [diagnose(rig, one, Settings(kinds)) for one in runs]
        yield {
            "effect": name,
            "sign": f"{sign:+g}",
            "tried": len(found),
            "named": sum(one.answers.best == name for one in found),
            "in the class": sum(_in_class(one, name) for one in found),
            "else": ", ".join(one.answers.best for one in found if not _in_class(one, name)),
        }


def _in_class(found: Diagnosis, name: str) -> bool:
    """Tell whether the answer is the effect, or one that these runs cannot tell from it."""
    if found.cause is None:
        return False
    alike = {other for own in found.classes.values() for other, _ in own}
    return name in {*found.cause.names, *alike}


BENCHMARK = Benchmark("signs", "Effects of either sign", run)
