"""Writing ``model.toml``: the section that campaigns include."""

from pathlib import Path

from analysis.inertia.result import model_toml
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Severity
from hardware.description.oscillator import Plane
from pmm.inertia.outcome import Outcome


def check_output(path: Path, *, overwrite: bool) -> None:
    """Refuse a file that is there already, before any work is done.

    Raises
    ------
    DataError
        If it is there and may not be overwritten, or is a folder.
    """
    if path.is_dir():
        raise DataError(f"{path}: a folder; name a file, such as {path / 'model.toml'}")
    if path.exists() and not overwrite:
        raise DataError(f"{path}: there already; choose another --output, or --overwrite")


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
        what = ", ".join(outcome.missing) or "the model's mass properties"
        raise ConfigurationError(f"{outcome.name}: --output needs {what}; add to the file")
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
