"""The figures of an analysis.

``gate_figure`` shows which part of the record was used and how the fit lies on it,
``phasor_figure`` the harmonics with their uncertainty, ``spectrum_figure`` what else is in the
record and how much of it the resolver lets through.
"""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Final

from analysis.resolver.analysis import Analysis
from pmm.document.content import Figure
from pmm.report.gate import gate_figure
from pmm.report.phasors import phasor_figure
from pmm.report.response_figure import response_figure
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
_RESPONSE: Final = (
    "Gain, phase and coherence of the loads at the lines of the motion, and their harmonics: those "
    "excited, and between them what odd and even distortions leave beside the noise (dashes)."
)


def figures(
    analysis: Analysis, response_to: str | None = None, lines: Sequence[int] = ()
) -> Iterator[Figure]:
    """Yield the figures of an analysis's first reading; with the response to a channel if asked."""
    for kind, draw in FIGURES.items():
        yield Figure(kind, _CAPTIONS[kind], partial(draw, analysis))
    if response_to in analysis.recording.channel_names:
        draw_response = partial(response_figure, analysis.readings[0], response_to, lines)
        yield Figure("response", _RESPONSE, draw_response)
