"""A fit over a record of hundreds of swings is drawn up to its envelope everywhere."""

import numpy as np
import pytest

from analysis.inertia.record import analyse_record
from analysis.inertia.series import Series
from pmm.inertia.sources import PeriodRuns
from pmm.report.inertia_record import record_figure


@pytest.mark.slow
def test_the_fit_reaches_the_envelope() -> None:
    rate_hz, period_s = 20.0, 1.0
    time_s = np.arange(int(900 * rate_hz)) / rate_hz
    values = 0.1 * np.exp(-time_s / 600.0) * np.cos(2.0 * np.pi * time_s / period_s + 0.3)
    run = analyse_record(Series("long", "sway", "m", rate_hz, 0.0, values))
    runs = PeriodRuns("period", "1 record", (), records=(run,), whole_records=(run.part.series,))
    axes = record_figure(runs).axes[0]
    fit = next(line for line in axes.lines if line.get_label() == "fit")
    x, y = (np.asarray(one, dtype=float) for one in (fit.get_xdata(), fit.get_ydata()))
    scale = np.ptp(y) / np.ptp(values)  # the unit that is shown
    for start in (100.0, 400.0, 800.0):
        seen = np.ptp(y[(x >= start) & (x < start + 10.0)]) / scale
        assert seen == pytest.approx(0.2 * np.exp(-(start + 5.0) / 600.0), rel=0.03)
