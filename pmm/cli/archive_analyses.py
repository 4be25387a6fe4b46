"""What ``pmm archive add`` computes: as ``pmm analyse``, ``pmm coefficients`` and ``pmm gap``."""

from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import TypeVar

from analysis.coefficients.recommendation import table
from hardware.description.errors import PmmError
from pmm.archive.results import LEVEL, Analysed, CoefficientValue, GapVerdict, HarmonicValue
from pmm.interface.coefficients import CoefficientsResult
from pmm.interface.harmonics import HarmonicsResult
from pmm.interface.opening import open as opened

T = TypeVar("T")


def analysed_folder(folder: Path) -> Analysed:
    """Return harmonics and recommended coefficients; what data refuse is said in the result."""
    records = opened(folder)
    refused: list[str] = []

    def harmonics() -> tuple[HarmonicValue, ...]:
        found = records.harmonics(level=LEVEL)
        refused.extend(one.said for one in found.failed)
        return tuple(_harmonics(found))

    def coefficients() -> tuple[CoefficientValue, ...]:
        found = records.coefficients(level=LEVEL)
        refused.extend(one.message for one in found.outcome.failed)
        return tuple(_coefficients(found))

    parts = _attempt(harmonics, refused), _attempt(coefficients, refused)
    return Analysed(*parts, tuple(dict.fromkeys(refused)))


def _attempt(find: Callable[[], tuple[T, ...]], refused: list[str]) -> tuple[T, ...]:
    try:
        return find()
    except PmmError as error:
        refused.append(str(error))
        return ()


def _harmonics(found: HarmonicsResult) -> Iterator[HarmonicValue]:
    for run in found.runs:
        for number, gate in enumerate(run.gates, 1):
            for channel in gate.channels:
                about = (run.run, number, channel.name)
                mean = channel.mean
                yield HarmonicValue(
                    *about, 0, channel.unit, mean.value, None, mean.half_width, None
                )
                for one in channel.harmonics:
                    sine, cosine = one.in_phase, one.quadrature
                    yield HarmonicValue(
                        *about, one.order, channel.unit, sine.value, cosine.value,
                        sine.half_width, cosine.half_width,
                    )  # fmt: skip


def _coefficients(found: CoefficientsResult) -> Iterator[CoefficientValue]:
    for row in table(found.outcome.result):
        if row["recommended"]:
            yield CoefficientValue(**{one.name: row[one.name] for one in fields(CoefficientValue)})


def diagnosed_folder(folder: Path) -> GapVerdict:
    """Return what the gap diagnosis answers."""
    found = opened(folder).gap()
    first = next(iter(found.report.ranking), None)
    if first is None:
        return GapVerdict(found.verdict, None, None)
    return GapVerdict(found.verdict, first.answer, first.probability)
