"""The swing at rest: tilts under weights, the fit to all levers at once, and what it leaves."""

from typing import TYPE_CHECKING

import numpy as np

from pmm.document.labels import plain, shown_name
from pmm.document.style import PALETTE, TRACE, drawing
from pmm.inertia.outcome import StaticTest

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def static_figure(test: StaticTest) -> "Figure":
    """Draw the tilts' tangents over weight times lever, with the fit, and the residuals below.

    Residuals tell levers apart that the upper panel shows on one line.
    """
    from matplotlib.figure import Figure

    pooled = test.result.pooled
    slope, offset = 1.0 / pooled.moment.value, pooled.offset_rad.value
    with drawing():
        figure = Figure(figsize=(10.5, 6.0), layout="constrained")
        figure.suptitle(f"{plain(test.where)}: tilts under weights")
        grid = figure.add_gridspec(2, 1, height_ratios=(2.0, 1.0))
        axes = figure.add_subplot(grid[0])
        rest = figure.add_subplot(grid[1], sharex=axes)
        for number, one in enumerate(test.series):
            pull, tangent = one.weight_kg * one.lever_m, np.tan(one.tilt_rad)
            color, marker = PALETTE[number % len(PALETTE)], "osDv^P*"[number % 7]
            label = f"{shown_name(one.name)}, lever {one.lever_m:g} m"
            axes.plot(pull, tangent, marker, ms=5.0, color=color, label=label)
            left = 1e3 * (tangent - offset - slope * pull)
            rest.plot(pull, left, marker, ms=5.0, color=color)
        furthest = max(float((one.weight_kg * one.lever_m).max()) for one in test.series)
        axes.plot([0.0, furthest], [offset, offset + slope * furthest], color=TRACE, label="fit")
        axes.set_title(
            f"first moment {pooled.moment.value:.5g} kg m, u of the fit "
            f"{pooled.moment.uncertainty:.2g}; offset {1e3 * offset:.3g} mrad",
            loc="left",
        )
        axes.set_ylabel("tangent of the tilt")
        axes.tick_params(labelbottom=False)
        rest.axhline(0.0, color=TRACE, lw=0.9)
        rest.set_ylabel("residual\n(mrad)")
        rest.set_xlabel("weight times lever (kg m)")
        figure.legend(loc="outside lower left", ncols=4)
    return figure
