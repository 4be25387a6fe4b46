"""Files that a job writes: ``model.toml``, which campaigns include, and a tensor for others.

The tensor is for other programs: URDF's ``inertial``, or a table (CSV).
"""

from pathlib import Path

from analysis.inertia.parts import NAMES, BodyPart
from analysis.inertia.result import model_toml
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Severity
from hardware.description.oscillator import Plane
from pmm.document.labels import plain
from pmm.inertia.outcome import Outcome

ENDINGS = (".urdf", ".csv")


def model_section(outcome: Outcome) -> str:
    """Return the text of ``[model]`` and ``[model_uncertainty]``.

    Raises
    ------
    ConfigurationError
        If something is missing for it, or both planes could be meant.
    DataError
        If a flag says that the numbers are not to be used.
    """
    void = [flag for flag in outcome.flags if flag.severity is Severity.VOID]
    if void:
        raise DataError(f"{outcome.name}: no model is written: {void[0].message}")
    if outcome.body is None:
        missing = ", ".join(outcome.missing) or "the model's mass properties"
        raise ConfigurationError(f"{outcome.name}: --output needs {missing}; add to the file")
    plane = outcome.plane or _only_plane(outcome)
    return model_toml(outcome.body, plane)


def _only_plane(outcome: Outcome) -> Plane:
    axes = set(outcome.body.gyradii) if outcome.body else set()
    if ("pitch" in axes) == ("yaw" in axes):
        raise ConfigurationError(
            f'{outcome.name}: for which plane? Say plane = "vertical" (pitch) or "horizontal" '
            f"(yaw) in the file (gyradii: {', '.join(sorted(axes)) or 'none'})"
        )
    return Plane.VERTICAL if "pitch" in axes else Plane.HORIZONTAL


def check_ending(path: Path) -> None:
    """Refuse a file that is neither, before any work is done.

    Raises
    ------
    ConfigurationError
        If its name ends in something else.
    """
    if path.suffix.lower() not in ENDINGS:
        raise ConfigurationError(f"{path}: --properties writes {' or '.join(ENDINGS)}")


def mass_properties(outcome: Outcome, path: Path) -> str:
    """Return the file's text, by the ending of its name.

    Raises
    ------
    ConfigurationError
        If the job has no whole tensor.
    """
    if outcome.tensor is None:
        raise ConfigurationError(f"{outcome.name}: --properties needs a body with all its inertias")
    written = _urdf if path.suffix.lower() == ".urdf" else _csv
    return written(outcome.name, outcome.tensor)


def _csv(name: str, body: BodyPart) -> str:
    """Return a row for each property, with its uncertainty and its row of the covariance."""
    properties = body.uncertain
    head = (
        f"# {plain(name)}: x forward, y to starboard, z down from the datum; inertias about the "
        "centre of gravity; products are sums, ixy = sum m x y\n"
    )
    rows = zip(
        NAMES,
        properties.values,
        properties.standard_uncertainty,
        properties.covariance(),
        strict=True,
    )
    lines = [
        ",".join((key, f"{value!r}", f"{u!r}", *(f"{covariance!r}" for covariance in row)))
        for key, value, u, row in (
            (key, float(value), float(u), row.tolist()) for key, value, u, row in rows
        )
    ]
    columns = ",".join(("name", "value", "u", *(f"covariance with {key}" for key in NAMES)))
    return head + columns + "\n" + "\n".join(lines) + "\n"


def _urdf(name: str, body: BodyPart) -> str:
    """Return a link with x forward, y to port and z up; products with the tensor's sign.

    Turned about x by half a turn, ``ixy = -sum m x y`` becomes ``sum m x y`` of our axes, ``ixz``
    alike, and ``iyz`` is ``-sum m y z``.
    """
    from xml.sax.saxutils import quoteattr

    mass, x, y, z, xx, yy, zz, xy, xz, yz = body.parameters.tolist()
    return (
        '<?xml version="1.0"?>\n'
        f"<robot name={quoteattr(name)}>\n  <link name={quoteattr(name)}>\n    <inertial>\n"
        f'      <origin xyz="{x!r} {-y + 0.0!r} {-z + 0.0!r}" rpy="0 0 0"/>\n'
        f'      <mass value="{mass!r}"/>\n'
        f'      <inertia ixx="{xx!r}" ixy="{xy!r}" ixz="{xz!r}" iyy="{yy!r}" '
        f'iyz="{-yz + 0.0!r}" izz="{zz!r}"/>\n'
        "    </inertial>\n  </link>\n</robot>\n"
    )
