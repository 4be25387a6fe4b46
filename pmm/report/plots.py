"""The figures of an analysis.

``gate_figure`` shows which part of the record was used and how the fit lies on it,
``phasor_figure`` the harmonics with their uncertainty, ``spectrum_figure`` what else is in the
record and how much of it the resolver lets through.
"""

from collections.abc import Iterator
from functools import partial
from typing import Final

from analysis.resolver.analysis import Analysis
from pmm.document.content import Figure
from pmm.report.gate import gate_figure
from pmm.report.phasors import phasor_figure
from pmm.report.spectrum import spectrum_figure

__all__ = ["FIGURES", "figures", "gate_figure", "phasor_figure", "spectrum_figure"]

FIGURES: Final = {"gate": gate_figure, "phasors": phasor_figure, "spectrum": spectrum_figure}
_CAPTIONS: Final = {
    "gate": "The record, the window that was found or given and the gate, with the fit over the "
    "trace; beside it the end of the gate, and the residual of the fit.",
    "phasors": "Harmonics as phasors with their 95 % regions: in phase to the right, quadrature "
    "up. Below each, how the gate's single periods spread about it, magnified.",
    "spectrum": "Amplitude spectrum over the gate, and the part of a vibration that the resolver "
    "lets through into each harmonic.",
}


def figures(analysis: Analysis) -> Iterator[Figure]:
    """Yield the figures of an analysis's first reading."""
    for kind, draw in FIGURES.items():
        yield Figure(kind, _CAPTIONS[kind], partial(draw, analysis))
