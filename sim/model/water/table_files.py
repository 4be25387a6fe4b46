"""Files of added mass and damping: two CSV layouts and Capytaine's NetCDF.

Axes. Panel methods such as Capytaine have x forward, y to port and z up; ours are x forward, y to
starboard and z down: half a turn about x. Sway, heave, pitch and yaw all change their sign and so
does each force, so every 2 x 2 matrix of a plane is the same number in both. A file whose pitch is
bow up with heave up (or whose x points aft) needs ``rotation_sign=-1``, which changes the coupling.

Phase. Capytaine's time factor is exp(-i w t), WAMIT's exp(+i w t); added mass and damping are real
and defined by the force -(A x'' + B x') in either.

Rows and columns. A file's radiating degree of freedom moves (our column), its influenced degree of
freedom feels the force (our row).
"""

import csv
import io
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane
from sim.model.water.tables import RadiationTable

if TYPE_CHECKING:
    import xarray as xr

DEGREES_OF_FREEDOM: Final = {
    Plane.VERTICAL: ("Heave", "Pitch"),
    Plane.HORIZONTAL: ("Sway", "Yaw"),
}
_HULL_COLUMNS = (
    "body",
    "omega_rad_s",
    "radiating_dof",
    "influenced_dof",
    "added_mass_SI",
    "damping_SI",
)


def read_heave_csv(
    path: Path, added_mass: str = "a33_analytic_kg", damping: str = "b33_analytic_kg_s"
) -> RadiationTable:
    """Read a table of heave alone: one row a frequency, lines with ``#`` are comments.

    It is of the vertical plane; what concerns pitch is zero.

    Parameters
    ----------
    added_mass, damping
        The columns (kg, kg/s) beside ``omega_rad_s``.

    Raises
    ------
    DataError
        If a column is missing or a value is not a number.
    """
    rows = _rows(path, ("omega_rad_s", added_mass, damping))
    omega, a, b = (
        np.array([_number(path, line, row, name) for line, row in rows])
        for name in ("omega_rad_s", added_mass, damping)
    )
    unit = np.array([[1.0, 0.0], [0.0, 0.0]])
    a, b = a[:, None, None] * unit, b[:, None, None] * unit
    return RadiationTable(Plane.VERTICAL, omega, a, b, name=path.name)


def read_hull_csv(
    path: Path, plane: Plane, body: str | None = None, rotation_sign: int = 1
) -> RadiationTable:
    """Read one plane of one body: one row for each frequency and pair of degrees of freedom.

    Parameters
    ----------
    body
        Which body of the file; may be left out if there is one only.
    rotation_sign
        -1 where the file's rotation has the other sign relative to its translation.

    Raises
    ------
    DataError
        If the body, a column, or a pair at one of the frequencies is missing or there twice.
    """
    rows = _rows(path, _HULL_COLUMNS)
    bodies = list(dict.fromkeys(row["body"] for _, row in rows))
    if body is None and len(bodies) == 1:
        body = bodies[0]
    if body not in bodies:
        raise DataError(f"{path}: body {body!r} is not one of {', '.join(bodies)}; name one")
    pairs: dict[tuple[float, str, str], tuple[float, float]] = {}
    dofs = DEGREES_OF_FREEDOM[plane]
    for line, row in rows:
        motion, force = row["radiating_dof"], row["influenced_dof"]
        if row["body"] != body or motion not in dofs or force not in dofs:
            continue
        key = (_number(path, line, row, "omega_rad_s"), force, motion)
        if key in pairs:
            raise DataError(
                f"{path}, line {line}: {motion}, {force} at {key[0]:g} rad/s is there twice"
            )
        a, b = (_number(path, line, row, name) for name in _HULL_COLUMNS[-2:])
        pairs[key] = (a, b)
    omega = sorted({key[0] for key in pairs})
    values = np.array([[[_pair(path, pairs, w, f, m) for m in dofs] for f in dofs] for w in omega])
    values = values.reshape(len(omega), 2, 2, 2) * coupling_signs(rotation_sign)[..., None]
    name = f"{path.name} ({body})"
    return RadiationTable(plane, np.array(omega), values[..., 0], values[..., 1], name=name)


def hull_csv(table: RadiationTable, body: str, comment: str) -> str:
    """Return a table as :func:`read_hull_csv` reads it, every digit kept."""
    written = io.StringIO()
    written.write(f"# {comment}\n")
    lines = csv.writer(written, lineterminator="\n")
    lines.writerow(_HULL_COLUMNS)
    dofs = DEGREES_OF_FREEDOM[table.plane]
    for k, omega in enumerate(table.omega_rad_s.tolist()):
        for row, force in enumerate(dofs):
            for column, motion in enumerate(dofs):
                values = (table.added_mass[k, row, column], table.damping[k, row, column])
                lines.writerow((body, repr(omega), motion, force, *map(repr, map(float, values))))
    return written.getvalue()


def read_capytaine(path: Path, plane: Plane, rotation_sign: int = 1) -> RadiationTable:
    """Read one plane of a dataset that Capytaine saved as NetCDF.

    Variables ``added_mass`` and ``radiation_damping`` over ``omega`` (rad/s), ``radiating_dof`` and
    ``influenced_dof``; further dimensions have to be of length 1. A frequency of infinity gives
    the table's ``added_mass_infinite``.

    Raises
    ------
    DataError
        If a variable, a dimension or a degree of freedom is missing, a further dimension has more
        than one value, or the speed is not zero.
    """
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        _check_capytaine(path, dataset)
        order = ("omega", "influenced_dof", "radiating_dof")
        matrices = [
            _matrices(path, dataset[name], plane, order) * coupling_signs(rotation_sign)
            for name in ("added_mass", "radiation_damping")
        ]
        omega = np.asarray(dataset["omega"].values, dtype=np.float64)
    rising = np.argsort(omega)
    omega, (a, b) = omega[rising], (values[rising] for values in matrices)
    finite = np.isfinite(omega)
    infinite = a[np.isposinf(omega)]
    return RadiationTable(
        plane,
        omega[finite],
        a[finite],
        b[finite],
        infinite[0] if infinite.size else None,
        name=path.name,
    )


def _check_capytaine(path: Path, dataset: "xr.Dataset") -> None:
    needed = ("added_mass", "radiation_damping", "omega", "radiating_dof", "influenced_dof")
    missing = [name for name in needed if name not in dataset.variables]
    if missing:
        raise DataError(
            f"{path}: {', '.join(missing)} missing from what Capytaine writes; "
            f"the file holds {', '.join(map(str, dataset.variables)) or 'nothing'}"
        )
    if "forward_speed" in dataset.variables and np.any(dataset["forward_speed"].values != 0.0):
        raise DataError(
            f"{path}: forward_speed is {dataset['forward_speed'].values} m/s; compute the table at "
            f"0, speed enters by the velocity through the water and the derivatives"
        )


def _matrices(
    path: Path, variable: "xr.DataArray", plane: Plane, order: tuple[str, str, str]
) -> FloatArray:
    dofs = DEGREES_OF_FREEDOM[plane]
    further = {str(d): n for d, n in variable.sizes.items() if d not in order and n != 1}
    if further or not set(order) <= set(variable.dims):
        raise DataError(
            f"{path}: {variable.name} has the dimensions {dict(variable.sizes)}; it needs "
            f"{', '.join(order)} and one value of anything else: select one before saving"
        )
    for axis in order[1:]:
        labels = [str(label) for label in variable[axis].values]
        for dof in dofs:
            if dof not in labels:
                raise DataError(f"{path}: {axis} {dof!r} is not one of {', '.join(labels)}")
    chosen = variable.squeeze([d for d in variable.dims if d not in order], drop=True)
    chosen = chosen.sel(influenced_dof=list(dofs), radiating_dof=list(dofs)).transpose(*order)
    return np.asarray(chosen.values, dtype=np.float64)


def coupling_signs(rotation_sign: int) -> FloatArray:
    """Return what a plane's matrices are multiplied by for the sense of a file's rotation.

    Raises
    ------
    DataError
        If it is not 1 or -1.
    """
    if rotation_sign not in (-1, 1):
        raise DataError(f"rotation_sign = {rotation_sign} must be 1 or -1")
    return np.array([[1.0, rotation_sign], [rotation_sign, 1.0]])


def _pair(
    path: Path,
    pairs: Mapping[tuple[float, str, str], tuple[float, float]],
    omega: float,
    force: str,
    motion: str,
) -> tuple[float, float]:
    try:
        return pairs[omega, force, motion]
    except KeyError:
        raise DataError(
            f"{path}: {motion} (radiating) and {force} (influenced) miss at {omega:g} rad/s; "
            f"write 0 where the coupling is known to vanish"
        ) from None


def _rows(path: Path, columns: Iterable[str]) -> list[tuple[int, dict[str, str]]]:
    """Return each row with its line number in the file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    numbered = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and line[0] != "#"]
    reader = csv.DictReader(line for _, line in numbered)
    missing = [name for name in columns if name not in (reader.fieldnames or ())]
    if missing:
        raise DataError(
            f"{path}: no column {', '.join(missing)}; "
            f"there are {', '.join(reader.fieldnames or ())}"
        )
    rows = list(zip((number for number, _ in numbered[1:]), reader, strict=True))
    if not rows:
        raise DataError(f"{path}: the table has a heading but no rows")
    return rows


def _number(path: Path, line: int, row: Mapping[str, str], column: str) -> float:
    try:
        value = float(row[column])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f"{path}, line {line}: {column} is {row[column]!r}, not a finite number")
    return value
