"""Check weights up and down: the matrix from loads to readings, with cross-talk and hysteresis."""

from collections.abc import Mapping, Sequence
from datetime import date, timedelta
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from pmm.campaign.calibration import Calibration
from pmm.evaluation.run_results import RunResult
from pmm.toml_text import toml_table

_LEAST_STEPS: Final = 3


def calibrate(runs: Sequence[RunResult], made: date, valid_days: int) -> Calibration:
    """Return the calibration that check-weight runs give.

    Raises
    ------
    DataError
        If a gauge has fewer than three steps, or all of them at one load.
    """
    steps = [(run.plan["load"], run.means()) for run in runs]
    channels = tuple(dict.fromkeys(str(load["channel"]) for load, _ in steps))
    size = len(channels)
    matrix, spread = np.zeros((size, size)), np.zeros((size, size))
    hysteresis, nonlinearity = np.zeros(size), np.zeros(size)
    for j, gauge in enumerate(channels):
        gauge_steps = [(load, means) for load, means in steps if load["channel"] == gauge]
        forces = np.array([float(load["force_n"]) for load, _ in gauge_steps])
        readings = np.array([[means[name] for name in channels] for _, means in gauge_steps])
        _check_steps(gauge, forces)
        matrix[:, j], spread[:, j], residual = _lines(forces, readings)
        span = float(np.ptp(forces))
        nonlinearity[j] = np.abs(residual[:, j]).max() / span
        ways = [str(load["direction"]) for load, _ in gauge_steps]
        hysteresis[j] = _hysteresis(forces, readings[:, j], ways) / span
    expires = made + timedelta(days=valid_days)
    return Calibration(channels, matrix, spread, hysteresis, nonlinearity, made, expires)


def modes_text(modes: Sequence[Mapping[str, object]]) -> str:
    """Return structural modes as the file that ``modes_file`` of a rig names."""
    return "\n".join(toml_table("modes", mode, array=True) for mode in modes)


def _check_steps(channel: str, forces: FloatArray) -> None:
    if forces.size < _LEAST_STEPS or not np.ptp(forces) > 0.0:
        raise DataError(
            f"{channel}: {forces.size} check weights between {forces.min():g} and "
            f"{forces.max():g} N; at least {_LEAST_STEPS} steps at different loads are needed"
        )


def _lines(forces: FloatArray, readings: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Fit a line through each column: slopes, their standard uncertainty, residuals."""
    basis = np.stack((np.ones_like(forces), forces), axis=1)
    lines, *_ = np.linalg.lstsq(basis, readings, rcond=None)
    residual = readings - basis @ lines
    freedom = max(forces.size - 2, 1)
    variance = (residual**2).sum(axis=0) / freedom
    inverse = np.linalg.inv(basis.T @ basis)
    return lines[1], np.sqrt(inverse[1, 1] * variance), residual


def _hysteresis(forces: FloatArray, readings: FloatArray, ways: Sequence[str]) -> float:
    """Return the largest difference between the ways up and down at one load."""
    worst = 0.0
    for force in np.unique(forces):
        pairs = [(r, way) for f, r, way in zip(forces, readings, ways, strict=True) if f == force]
        up = [reading for reading, way in pairs if way == "up"]
        down = [reading for reading, way in pairs if way == "down"]
        if up and down:
            worst = max(worst, abs(float(np.mean(up) - np.mean(down))))
    return worst
