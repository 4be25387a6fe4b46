"""The water's memory of a campaign: a table of added mass and damping, fitted."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from sim.model.water.tables import UNCERTAINTY
from sim.model.water.wamit_file import FirstColumn, read_wamit

if TYPE_CHECKING:
    from sim.model.water.fitted_memory import FittedMemory
    from sim.model.water.tables import RadiationTable


@dataclass(frozen=True)
class RadiationFile:
    """Where the table lies, and how it is fitted.

    Attributes
    ----------
    file
        Beside the campaign file: NetCDF of Capytaine, WAMIT's ``.1``, or CSV with one row for each
        frequency and pair of degrees of freedom, or of heave alone.
    states
        Of the memory for each degree of freedom; ``None``: as many as the uncertainty asks for. See
        :func:`sim.model.water.memory.fit_memory`.
    uncertainty
        Standard uncertainty of the table's values, relative.
    body
        Which body of a CSV with several; of WAMIT's its number, from 1.
    rotation_sign
        -1 where the file's rotation has the other sign relative to its translation.
    density_kg_m3, length_m, first_column
        Of WAMIT's files, whose values have no dimension: of the water, ``ULEN``, and whether rows
        begin with periods or with frequencies.
    """

    file: str
    states: int | None = None
    uncertainty: float = UNCERTAINTY
    body: str | None = None
    rotation_sign: int = 1
    density_kg_m3: float | None = None
    length_m: float = 1.0
    first_column: FirstColumn = FirstColumn.PERIOD

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

    def table(self, plane: Plane) -> "RadiationTable":
        """Return the table by the reader of its format.

        Raises
        ------
        DataError
            If it does not hold what is needed.
        """
        from sim.model.water.table_files import read_capytaine, read_heave_csv, read_hull_csv

        path = Path(self.file)
        if path.suffix.lower() == ".nc":
            return read_capytaine(path, plane, self.rotation_sign)
        if path.suffix == ".1":
            return self._of_wamit(path, plane)
        if "radiating_dof" in path.read_text(encoding="utf-8-sig"):
            return read_hull_csv(path, plane, self.body, self.rotation_sign)
        if plane is not Plane.VERTICAL:
            raise DataError(f"{path}: heave alone is of no use to the horizontal oscillator")
        return read_heave_csv(path)

    def _of_wamit(self, path: Path, plane: Plane) -> "RadiationTable":
        if self.density_kg_m3 is None:
            raise DataError(
                f"{path}: its values have no dimension; state density_kg_m3, of the water that it "
                "was computed for, and length_m where ULEN is not 1"
            )
        number = self.body or "1"
        if not number.isdecimal() or number == "0":
            raise DataError(f"{path}: body {number!r}; bodies of a WAMIT file are counted from 1")
        return read_wamit(
            path, plane, self.density_kg_m3, self.length_m, int(number), self.rotation_sign,
            self.first_column,
        )  # fmt: skip


@lru_cache(maxsize=8)
def _fitted(source: RadiationFile, plane: Plane, changed_ns: int) -> "FittedMemory":  # noqa: ARG001
    from sim.model.water.memory import fit_memory

    return fit_memory(source.table(plane), source.states, uncertainty=source.uncertainty)
