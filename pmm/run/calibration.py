"""Check weights up and down: the matrix from loads to readings, with cross-talk and hysteresis."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date, timedelta
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from hardware.description.errors import ConfigurationError, DataError
from pmm.plan.toml_text import toml_table, toml_value
from pmm.run.results import RunResult

FloatArray = NDArray[np.float64]
CALIBRATION_FILE: Final = "calibration.toml"
_LEAST_STEPS: Final = 3


@dataclass(frozen=True, eq=False)
class Calibration:
    """How the gauges answer to known loads.

    Attributes
    ----------
    channels
        The gauges that were loaded, in the order of rows and columns.
    matrix
        Reading of channel i for a newton on gauge j, shape ``(channels, channels)``: the identity
        for a perfect dynamometer; off the diagonal is the cross-talk.
    standard_uncertainty
        Of the matrix, from the scatter about the lines.
    hysteresis
        Largest difference between the ways up and down at one load, over the range, each gauge.
    nonlinearity
        Largest distance of a step from its line, over the range, each gauge.
    made, expires
        Dates.
    """

    channels: tuple[str, ...]
    matrix: FloatArray
    standard_uncertainty: FloatArray
    hysteresis: FloatArray
    nonlinearity: FloatArray
    made: date
    expires: date

    def loads(self, readings: FloatArray) -> FloatArray:
        """Return the loads behind readings, shape ``(channels, n)`` both."""
        return np.asarray(np.linalg.solve(self.matrix, readings))

    def is_expired(self, today: date) -> bool:
        """Whether it may no longer be relied on."""
        return today > self.expires


def calibrate(runs: Sequence[RunResult], made: date, valid_days: int) -> Calibration:
    """Return the calibration that check-weight runs give.

    Raises
    ------
    DataError
        If a gauge has fewer than three steps, or all of them at one load.
    """
    steps = [(one.plan["load"], one.means()) for one in runs]
    channels = tuple(dict.fromkeys(str(load["channel"]) for load, _ in steps))
    size = len(channels)
    matrix, spread = np.zeros((size, size)), np.zeros((size, size))
    hysteresis, nonlinearity = np.zeros(size), np.zeros(size)
    for j, loaded in enumerate(channels):
        mine = [(load, means) for load, means in steps if load["channel"] == loaded]
        forces = np.array([float(load["force_n"]) for load, _ in mine])
        readings = np.array([[means[name] for name in channels] for _, means in mine])
        _check_steps(loaded, forces)
        matrix[:, j], spread[:, j], residual = _lines(forces, readings)
        span = float(np.ptp(forces))
        nonlinearity[j] = np.abs(residual[:, j]).max() / span
        ways = [str(load["direction"]) for load, _ in mine]
        hysteresis[j] = _hysteresis(forces, readings[:, j], ways) / span
    expires = made + timedelta(days=valid_days)
    return Calibration(channels, matrix, spread, hysteresis, nonlinearity, made, expires)


def write_calibration(one: Calibration, path: Path) -> Path:
    """Write a calibration for people and programs; an older one of another date is kept beside."""
    if path.exists():
        before = read_calibration(path)
        if before.made != one.made:
            path.rename(path.with_name(f"{path.stem}-{before.made.isoformat()}{path.suffix}"))
    table: dict[str, object] = {
        "made": one.made.isoformat(),
        "expires": one.expires.isoformat(),
        "channels": list(one.channels),
        "matrix": one.matrix.tolist(),
        "standard_uncertainty": one.standard_uncertainty.tolist(),
        "hysteresis": one.hysteresis.tolist(),
        "nonlinearity": one.nonlinearity.tolist(),
    }
    head = "# Reading of a channel (row) for a newton on a gauge (column): docs/run-control.md\n"
    lines = "".join(f"{key} = {toml_value(value)}\n" for key, value in table.items())
    path.write_text(head + lines, encoding="utf-8")
    return path


def read_calibration(path: Path) -> Calibration:
    """Read a calibration file.

    Raises
    ------
    ConfigurationError
        If it cannot be read, or a key is missing or of the wrong shape.
    """
    import tomllib

    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        channels = tuple(table["channels"])
        arrays = [np.array(table[key], dtype=np.float64) for key in _ARRAYS]
        made, expires = (date.fromisoformat(table[key]) for key in ("made", "expires"))
    except (OSError, tomllib.TOMLDecodeError, KeyError, TypeError, ValueError) as error:
        raise ConfigurationError(f"{path}: no calibration: {error!r}") from error
    size = len(channels)
    if [one.shape for one in arrays] != [(size, size), (size, size), (size,), (size,)]:
        raise ConfigurationError(f"{path}: the matrix does not fit the {size} channels")
    matrix, spread, hysteresis, nonlinearity = arrays
    return Calibration(channels, matrix, spread, hysteresis, nonlinearity, made, expires)


_ARRAYS: Final = ("matrix", "standard_uncertainty", "hysteresis", "nonlinearity")


def modes_text(modes: Sequence[Mapping[str, object]]) -> str:
    """Return structural modes as the file that ``modes_file`` of a rig names."""
    return "\n".join(toml_table("modes", one, array=True) for one in modes)


def _check_steps(channel: str, forces: FloatArray) -> None:
    if forces.size < _LEAST_STEPS or not np.ptp(forces) > 0.0:
        raise DataError(
            f"{channel}: {forces.size} check weights between {forces.min():g} and "
            f"{forces.max():g} N; at least {_LEAST_STEPS} steps at different loads are needed"
        )


def _lines(forces: FloatArray, readings: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Fit a line through each column: slopes, their standard uncertainty, residuals."""
    basis = np.stack((np.ones_like(forces), forces), axis=1)
    found, *_ = np.linalg.lstsq(basis, readings, rcond=None)
    residual = readings - basis @ found
    freedom = max(forces.size - 2, 1)
    variance = (residual**2).sum(axis=0) / freedom
    inverse = np.linalg.inv(basis.T @ basis)
    return found[1], np.sqrt(inverse[1, 1] * variance), residual


def _hysteresis(forces: FloatArray, readings: FloatArray, ways: Sequence[str]) -> float:
    """Return the largest difference between the ways up and down at one load."""
    worst = 0.0
    for force in np.unique(forces):
        here = [(r, way) for f, r, way in zip(forces, readings, ways, strict=True) if f == force]
        up = [reading for reading, way in here if way == "up"]
        down = [reading for reading, way in here if way == "down"]
        if up and down:
            worst = max(worst, abs(float(np.mean(up) - np.mean(down))))
    return worst
