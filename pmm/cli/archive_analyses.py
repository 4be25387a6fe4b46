"""What ``pmm archive add`` computes: as ``pmm analyse``, ``pmm coefficients`` and ``pmm gap``."""

from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import TypeVar

from analysis.coefficients.recommendation import table
from hardware.description.errors import PmmError
from pmm.archive.results import LEVEL, AnalysedCampaign, CoefficientValue, GapVerdict, HarmonicValue
from pmm.interface.coefficients import CoefficientsResult
from pmm.interface.harmonics import HarmonicsResult
from pmm.interface.opening import open as opened

T = TypeVar("T")


def analysed_folder(folder: Path) -> AnalysedCampaign:
    """Return harmonics and recommended coefficients; what data refuse is said in the result."""
    records = opened(folder)
    refusals: list[str] = []

    def harmonics() -> tuple[HarmonicValue, ...]:
        result = records.harmonics(level=LEVEL)
        refusals.extend(failure.full_message for failure in result.failed)
        return tuple(_harmonics(result))

    def coefficients() -> tuple[CoefficientValue, ...]:
        result = records.coefficients(level=LEVEL)
        refusals.extend(failure.message for failure in result.outcome.failed)
        return tuple(_coefficients(result))

    parts = _attempt(harmonics, refusals), _attempt(coefficients, refusals)
    return AnalysedCampaign(*parts, tuple(dict.fromkeys(refusals)))


def _attempt(find: Callable[[], tuple[T, ...]], refusals: list[str]) -> tuple[T, ...]:
    try:
        return find()
    except PmmError as error:
        refusals.append(str(error))
        return ()


def _harmonics(result: HarmonicsResult) -> Iterator[HarmonicValue]:
    for run in result.runs:
        for number, gate in enumerate(run.gates, 1):
            for channel in gate.channels:
                keys = (run.run, number, channel.name)
                mean = channel.mean
                yield HarmonicValue(*keys, 0, channel.unit, mean.value, None, mean.half_width, None)
                for harmonic in channel.harmonics:
                    sine, cosine = harmonic.in_phase, harmonic.quadrature
                    yield HarmonicValue(
                        *keys, harmonic.order, channel.unit, sine.value, cosine.value,
                        sine.half_width, cosine.half_width,
                    )  # fmt: skip


def _coefficients(result: CoefficientsResult) -> Iterator[CoefficientValue]:
    for row in table(result.outcome.result):
        if row["recommended"]:
            yield CoefficientValue(
                **{field.name: row[field.name] for field in fields(CoefficientValue)}
            )


def diagnosed_folder(folder: Path) -> GapVerdict:
    """Return what the gap diagnosis answers."""
    gap = opened(folder).gap()
    first = next(iter(gap.report.ranking), None)
    if first is None:
        return GapVerdict(gap.verdict, None, None)
    return GapVerdict(gap.verdict, first.answer, first.probability)
