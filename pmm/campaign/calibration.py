"""The calibration of the gauges: what they read for known loads, its dates and its file.

:func:`pmm.evaluation.check_weights.calibrate` makes one of check weights;
:mod:`pmm.campaign.calibrated_recording` applies it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path
from typing import Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.toml import parse_toml
from pmm.toml_text import toml_value
from pmm.whole_file import write_whole

CALIBRATION_FILE: Final = "calibration.toml"
_WORST_CONDITION: Final = 1e6


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
    file, sha256
        Where it was read from; empty where it was not.
    """

    channels: tuple[str, ...]
    matrix: FloatArray
    standard_uncertainty: FloatArray
    hysteresis: FloatArray
    nonlinearity: FloatArray
    made: date
    expires: date
    file: str = ""
    sha256: str = ""

    @property
    def force_uncertainty(self) -> FloatArray:
        """Standard uncertainty of force i for a newton on gauge j, shape as the matrix.

        Forces are ``K^-1 readings``, so that an error dK of the matrix makes ``-K^-1 dK`` of the
        forces: a gauge's own gain on the diagonal, cross-talk beside it.
        """
        inverse = np.linalg.inv(self.matrix)
        return np.asarray(np.sqrt(inverse**2 @ self.standard_uncertainty**2))

    def is_expired(self, today: date) -> bool:
        """Whether it may no longer be relied on."""
        return today > self.expires


def write_calibration(calibration: Calibration, path: Path) -> Path:
    """Write a calibration for people and programs; an older one of another date is kept beside."""
    if path.exists():
        old_calibration = read_calibration(path)
        if old_calibration.made != calibration.made:
            path.rename(
                path.with_name(f"{path.stem}-{old_calibration.made.isoformat()}{path.suffix}")
            )
    head = "# Reading of a channel (row) for a newton on a gauge (column): docs/run-control.md\n"
    lines = "".join(
        f"{key} = {toml_value(value)}\n" for key, value in as_table(calibration).items()
    )
    write_whole(path, head + lines)
    return path


def read_calibration(path: Path) -> Calibration:
    """Read a calibration file.

    Raises
    ------
    ConfigurationError
        If it cannot be read, a key is missing or of the wrong shape, or two gauges tell the same.
    """
    import hashlib

    try:
        data = path.read_bytes()
        table = parse_toml(data.decode("utf-8"))
    except (OSError, UnicodeDecodeError, ConfigurationError) as error:
        raise ConfigurationError(f"{path}: no calibration: {error}") from error
    calibration = from_table(table, str(path))
    return replace(calibration, file=path.name, sha256=hashlib.sha256(data).hexdigest())


def as_table(calibration: Calibration) -> dict[str, Any]:
    """Return a calibration with the keys of its file."""
    return {
        "made": calibration.made.isoformat(),
        "expires": calibration.expires.isoformat(),
        "channels": list(calibration.channels),
        **{key: getattr(calibration, key).tolist() for key in _ARRAYS},
    }


def from_table(table: Mapping[str, Any], place: str) -> Calibration:
    """Return the calibration that a table holds; ``place`` names it in errors.

    It raises what :func:`read_calibration` raises.
    """
    missing = [key for key in _KEYS if key not in table]
    if missing:
        raise ConfigurationError(f"{place}: no calibration: {', '.join(missing)} missing")
    try:
        channels = tuple(str(name) for name in table["channels"])
        arrays = [np.array(table[key], dtype=np.float64) for key in _ARRAYS]
        made, expires = (date.fromisoformat(table[key]) for key in ("made", "expires"))
    except (TypeError, ValueError) as error:
        raise ConfigurationError(f"{place}: no calibration: {error}") from error
    size = len(channels)
    if [array.shape for array in arrays] != [(size, size), (size, size), (size,), (size,)]:
        raise ConfigurationError(f"{place}: the matrix does not fit the {size} channels")
    pairs = zip(_ARRAYS, arrays, strict=True)
    if bad_keys := [key for key, array in pairs if not np.isfinite(array).all()]:
        raise ConfigurationError(f"{place}: {' and '.join(bad_keys)} should be finite numbers")
    if not np.linalg.cond(arrays[0]) < _WORST_CONDITION:
        raise ConfigurationError(
            f"{place}: matrix = {arrays[0].tolist()} is singular: two gauges would tell the same"
        )
    matrix, spread, hysteresis, nonlinearity = arrays
    return Calibration(channels, matrix, spread, hysteresis, nonlinearity, made, expires)


_ARRAYS: Final = ("matrix", "standard_uncertainty", "hysteresis", "nonlinearity")
_KEYS: Final = ("made", "expires", "channels", *_ARRAYS)
