"""The water's memory of a campaign: a table of added mass and damping, fitted."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from sim.model.water.tables import UNCERTAINTY

if TYPE_CHECKING:
    from sim.model.water.fitted_memory import FittedMemory
    from sim.model.water.tables import RadiationTable


@dataclass(frozen=True)
class RadiationFile:
    """Where the table lies, and how it is fitted.

    Attributes
    ----------
    file
        Beside the campaign file: NetCDF of Capytaine, or CSV with one row for each frequency and
        pair of degrees of freedom, or of heave alone.
    states
        Of the memory for each degree of freedom; ``None``: as many as the uncertainty asks for. See
        :func:`sim.model.water.memory.fit_memory`.
    uncertainty
        Standard uncertainty of the table's values, relative.
    body
        Which body of a CSV with several.
    rotation_sign
        -1 where the file's rotation has the other sign relative to its translation.
    """

    file: str
    states: int | None = None
    uncertainty: float = UNCERTAINTY
    body: str | None = None
    rotation_sign: int = 1

    def fitted(self, plane: Plane) -> "FittedMemory":
        """Return the memory; the same file is fitted once.

        Raises
        ------
        ConfigurationError
            If there is no such file.
        DataError
            If it does not hold what is needed.
        """
        path = Path(self.file)
        if not path.is_file():
            raise ConfigurationError(f"[radiation] file = {self.file!r}: no such file")
        return _fitted(self, plane, path.stat().st_mtime_ns)


@lru_cache(maxsize=8)
def _fitted(source: RadiationFile, plane: Plane, changed_ns: int) -> "FittedMemory":  # noqa: ARG001
    from sim.model.water.memory import fit_memory

    return fit_memory(_read(source, plane), source.states, uncertainty=source.uncertainty)


def _read(source: RadiationFile, plane: Plane) -> "RadiationTable":
    from sim.model.water.table_files import read_capytaine, read_heave_csv, read_hull_csv

    path = Path(source.file)
    if path.suffix.lower() == ".nc":
        return read_capytaine(path, plane, source.rotation_sign)
    if "radiating_dof" in path.read_text(encoding="utf-8"):
        return read_hull_csv(path, plane, source.body, source.rotation_sign)
    if plane is not Plane.VERTICAL:
        raise DataError(f"{path}: a table of heave alone is of no use to the horizontal oscillator")
    return read_heave_csv(path)
