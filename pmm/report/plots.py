"""The figures of an analysis, and writing them to files.

``gate_figure`` shows which part of the record was used and how the fit lies on it,
``phasor_figure`` the harmonics with their uncertainty, ``spectrum_figure`` what else is in the
record and how much of it the resolver lets through.
"""

from collections.abc import Sequence
from pathlib import Path

from analysis.resolver.analysis import Analysis
from hardware.description.errors import ConfigurationError
from pmm.document.style import write_figure
from pmm.report.gate import gate_figure
from pmm.report.phasors import phasor_figure
from pmm.report.spectrum import spectrum_figure

__all__ = ["FIGURES", "gate_figure", "phasor_figure", "save_figures", "spectrum_figure"]

FIGURES = {"gate": gate_figure, "phasors": phasor_figure, "spectrum": spectrum_figure}


def save_figures(
    analysis: Analysis, folder: Path, stem: str, formats: Sequence[str] = ("svg", "png")
) -> list[Path]:
    """Write the figures of an analysis's first reading.

    Parameters
    ----------
    folder
        Made if it is not there.
    stem
        Files are named ``<stem>-gate.svg``, ``<stem>-phasors.svg``, ``<stem>-spectrum.svg``.
    formats
        Any of ``svg``, ``png`` and ``pdf``.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ConfigurationError
        If a format is not known or the stem is no plain file name.
    """
    if not stem or Path(stem).name != stem:
        raise ConfigurationError(f"figures cannot be named {stem!r}; give a name without a folder")
    written = []
    for kind, draw in FIGURES.items():
        written += write_figure(draw(analysis), folder, f"{stem}-{kind}", formats)
    return written
