"""The inertia tests: time and accuracy of the period fits, and whole tests on simulated records."""

import numpy as np

from analysis.inertia.damped_fit import fit_damped
from benchmarks.inertia_rivals import compare_rivals
from benchmarks.inertia_simulated import run_simulated
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.timing import Contender, interleave

_DURATION_S, _RATE_HZ = 160.0, 256.0


def run(quick: bool, report: Report) -> Outcome:
    """Fit long records with one mode and with two, and short ones from poor starts."""
    duration_s = 20.0 if quick else _DURATION_S
    times_s = np.arange(0.0, duration_s, 1.0 / _RATE_HZ)
    noise = 1e-4 * np.random.default_rng(0).standard_normal(times_s.size)
    first = 0.02 * np.exp(-0.0048 * times_s) * np.cos(2.0 * np.pi * times_s / 4.39)
    second = 0.01 * np.exp(-0.0081 * times_s) * np.cos(2.0 * np.pi * times_s / 3.83)
    contenders = [
        Contender("plain sum of the record", lambda: noise.sum()),
        Contender("one damped sine", lambda: fit_damped(times_s, first + noise)),
        Contender("two damped sines", lambda: fit_damped(times_s, first + second + noise, modes=2)),
    ]
    interleave(contenders, 3 if quick else 10, report)
    report("poor starts")
    rivals = compare_rivals(5 if quick else 1000, seed=0)
    simulated, measured = run_simulated(quick, report)
    return Outcome(
        {
            f"A record of {duration_s:g} s at {_RATE_HZ:g} Hz": [_timed(c) for c in contenders],
            "Poor starts, 0.1 to 10 times the truth": [
                {
                    "method": rival.name,
                    "starts": rival.starts,
                    "success": rival.success,
                    "RMS error of the period": rival.rms_error,
                    "median, ms": 1e3 * rival.median_s,
                }
                for rival in rivals
            ],
            **simulated,
        },
        {
            **measured,
            "fit_ms": 1e3 * contenders[1].best_s,
            "fit_two_ms": 1e3 * contenders[2].best_s,
            "success": rivals[0].success,
            "success_over_peer": rivals[0].success - max(one.success for one in rivals[1:]),
            "error_over_peer": rivals[0].rms_error / min(one.rms_error for one in rivals[1:]),
        },
        (
            "The record of the poor starts is 60 s at 32 Hz, a swing's, with white noise; "
            "BicycleParameters' fit is timed without the figure that it draws.",
            "A campaign is four releases that differ by 3e-4 of the period, on lines, levers and "
            "masses that tape and scale do not quite know; ideal is the GUM's uncertainty of the "
            "same formula were all inputs' known.",
            *(() if len(rivals) > 2 else ("BicycleParameters is not installed: no row.",)),
        ),
    )


def _timed(contender: Contender) -> Row:
    return {"what": contender.name, "best, ms": 1e3 * contender.best_s}


BENCHMARK = Benchmark("inertia", "Period fits of inertia tests, and whole tests simulated", run)
