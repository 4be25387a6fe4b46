"""From three records of a hull on two lines to its yaw gyradius with a budget."""

from pathlib import Path

from analysis.inertia.bifilar import yaw_from_period, yaw_from_ratio
from analysis.inertia.record import analyse_record, from_runs
from analysis.inertia.repeats import combine_runs
from analysis.inertia.series import series_from_recording
from analysis.readers import read_recording
from analysis.uncertainty.estimate import Estimate, exactly
from analysis.uncertainty.monte_carlo import Assessment

FOLDER = Path(__file__).parent
HALF_SPACING = Estimate.of(0.900, 5e-4, "m")
LINE = Estimate.of(3.477, 2e-3, "m")


def analyse(folder: Path = FOLDER) -> tuple[Assessment, Assessment]:
    """Return the gyradius by the period and by the ratio of the periods."""
    runs = []
    for path in sorted(folder.glob("stern-*.csv.gz")):
        recording = read_recording(path)
        series = series_from_recording(recording, recording.channel_names[0])
        runs.append(analyse_record(series, modes=2))
    yaw = from_runs(runs, 0, subject="yaw period").estimate
    by_period = yaw_from_period(yaw, HALF_SPACING, LINE, exactly(9.81, "m/s2"))
    ratios = []
    for run in runs:
        slow, fast = run.fit.modes
        spread = run.fit.period_uncertainty_s(0) / fast.period_s
        ratios.append(Estimate.of(slow.period_s / fast.period_s, spread))
    ratio = combine_runs(ratios, subject="ratio").estimate
    by_ratio = yaw_from_ratio(ratio, exactly(1.0), HALF_SPACING)
    return by_period, by_ratio
