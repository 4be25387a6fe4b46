"""Figure of a frequency response, its coherence, and what stands between its lines."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.response.distortion import Degree, distortions
from analysis.response.frequency_response import frequency_response, phasors_of
from hardware.description.channels import Channel, Quantity
from pmm.document.labels import shown_name
from pmm.document.style import PALETTE, TRACE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from analysis.resolver.harmonics import Harmonics

_SURE: Final = 1.96
_MARKS: Final = {Degree.ODD: (PALETTE[1], "^"), Degree.EVEN: (PALETTE[2], "v")}


def response_figure(
    reading: "Harmonics", motion: str, orders: Sequence[int] | None = None
) -> "Figure":
    """Draw gain, phase and coherence of each load, and its harmonics beside noise.

    Parameters
    ----------
    motion
        The input.
    orders
        The lines that were excited; found where they are not given.
    """
    outputs = [
        name
        for name, unit in zip(reading.channel_names, reading.units, strict=True)
        if name != motion and Channel("", unit).quantity in (Quantity.FORCE, Quantity.MOMENT)
    ] or [name for name in reading.channel_names if name != motion]
    with new_figure(4.5 * len(outputs), 9.0) as figure:
        panels = figure.subplots(4, len(outputs), squeeze=False, sharex=True)
        for column, output in enumerate(outputs):
            _column(panels[:, column].tolist(), reading, motion, output, orders)
    return figure


def _column(
    panels: Sequence["Axes"],
    reading: "Harmonics",
    motion: str,
    output: str,
    orders: Sequence[int] | None,
) -> None:
    gain, phase, coherence, lines = panels
    response = frequency_response(reading, motion, output, orders)
    size, half = np.abs(response.values), _SURE * np.sqrt(response.variance / 2.0)
    frequencies_hz = response.frequencies_hz
    gain.errorbar(frequencies_hz, size, half, fmt="o-", ms=3, color=PALETTE[0])
    gain.set_title(f"{shown_name(output)} on {shown_name(motion)}")
    gain.set_ylabel(f"gain ({response.unit})")
    phase_deg = np.degrees(np.unwrap(np.angle(response.values)))
    phase_half_deg = np.degrees(np.minimum(half / np.maximum(size, 1e-300), np.pi))
    phase.errorbar(frequencies_hz, phase_deg, phase_half_deg, fmt="o-", ms=3, color=PALETTE[0])
    phase.set_ylabel("phase (deg)")
    coherence.plot(frequencies_hz, response.coherence, "o-", ms=3, color=PALETTE[0])
    coherence.set_ylim(min(0.9, 0.9 * float(response.coherence.min())), 1.01)
    coherence.set_ylabel("coherence")
    amplitudes = np.abs(phasors_of(reading, output)[np.array(response.orders) - 1])
    lines.semilogy(frequencies_hz, amplitudes, "o", ms=4, color=PALETTE[0], label="excited")
    for distortion in distortions(reading, response):
        distortion_hz = np.array(distortion.orders) * reading.frequency_hz
        color, mark = _MARKS[distortion.degree]
        lines.semilogy(
            distortion_hz,
            distortion.amplitudes,
            mark,
            ms=4,
            color=color,
            label=str(distortion.degree),
        )
        lines.semilogy(distortion_hz, distortion.noise, "_", color=TRACE)
    lines.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    lines.set_ylabel(f"amplitude ({response.unit.rpartition('/')[0]})")
    lines.set_xlabel("frequency (Hz)")
    lines.legend(ncols=3)
