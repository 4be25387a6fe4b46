"""How well the pitch gyradius comes out over the lines' length, by both readings."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from pmm.document.labels import plain
from pmm.document.style import PALETTE, drawing
from pmm.inertia.outcome import Outcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WORDS = {"fixed": "depth known (fig 17)", "joint": "depth measured along"}


def line_figure(outcome: Outcome, errors: Mapping[str, Sequence[tuple[float, float]]]) -> "Figure":
    """Draw the error of the gyradius per error of the periods; the best line is where it is least.

    Parameters
    ----------
    errors
        By reading: line length in m, and metres per second.
    """
    from matplotlib.figure import Figure

    found = {one.name: one.estimate.value for one in outcome.findings}
    with drawing():
        figure = Figure(figsize=(10.5, 4.6), layout="constrained")
        figure.suptitle(f"{plain(outcome.name)}: lines for the pitch gyradius")
        axes = figure.add_subplot()
        for number, (reading, rows) in enumerate(errors.items()):
            line, error = np.array(rows).T
            best = found[f"bifilar_best_line_{reading}_m"]
            color = PALETTE[number]
            label = f"{_WORDS[reading]}: best {best:.2f} m"
            axes.loglog(line, 1e3 * error, color=color, label=label)
            axes.plot(best, 1e3 * float(np.interp(best, line, error)), "o", color=color)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(lambda value, _: f"{value:g}")
            axis.set_minor_formatter(lambda _value, _place: "")
        axes.set_xlabel("line length (m)")
        axes.set_ylabel("error of the gyradius per\nerror of both periods (mm/s)")
        axes.grid(visible=True, which="minor", lw=0.3)
        axes.legend(loc="upper right")
    return figure
