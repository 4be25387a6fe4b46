"""What a path is: a recording, a campaign, a plan's design, or the file of a pendulum test."""

import builtins
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hardware.description.errors import ConfigurationError
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.interface.arguments import Count, FilePath, checked, text_of
from pmm.interface.records import RecordKind, Records
from pmm.remote import local_path

# The first table or key that a file has tells what it is; a pendulum test has none of them.
_TELLING: Final = {
    "grid": RecordKind.DESIGN,
    "bus": RecordKind.RIG,
    "rig": RecordKind.PLAN,
    "runs": RecordKind.CAMPAIGN,
    "oscillator": RecordKind.CAMPAIGN,
}


@checked
def open(path: FilePath) -> Records:  # noqa: A001
    """Open what is measured, or is to be; nothing is read but its kind.

    Parameters
    ----------
    path
        A recording (CSV, NetCDF, MATLAB or TDMS); a campaign's folder or file; or the TOML file of
        a pendulum test or of a plan's design. Or the URL of one of the first two, such as
        ``s3://bucket/campaign``.

    Raises
    ------
    ConfigurationError
        If nothing is there, or a folder has no campaign file.
    DataError
        If what lies elsewhere cannot be read.
    """
    path = local_path(path)
    if not path.exists():
        raise ConfigurationError(f"{path}: no such file or folder")
    if path.is_dir():
        if not (path / CAMPAIGN_FILE).exists():
            raise ConfigurationError(
                f"{path}: a folder without a {CAMPAIGN_FILE}; open one of its recordings"
            )
        return Records(path, RecordKind.CAMPAIGN)
    if path.suffix != ".toml":
        return Records(path, RecordKind.RECORDING)
    return Records(path, _kind(path))


def _kind(path: Path) -> RecordKind:
    """Return what a TOML file is of."""
    with builtins.open(path, "rb") as file:  # noqa: PTH123
        try:
            table = tomllib.load(file)
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise ConfigurationError(f"{path}: {error}") from None
    if "channels" in table:
        raise ConfigurationError(
            f"{path}: says how the columns of a recording are read, and is none; open the recording"
        )
    kinds = (kind for key, kind in _TELLING.items() if key in table)
    return next(kinds, RecordKind.PENDULUM)


@checked
def simulate(
    campaign: FilePath,
    output: FilePath | None = None,
    *,
    runs: Sequence[str] = (),
    effects: Sequence[str] = (),
    effects_file: FilePath | None = None,
    seed: Count | None = None,
    overwrite: bool = False,
) -> Records:
    """Simulate the runs of a campaign, as ``pmm simulate`` does, and open what was written.

    Parameters
    ----------
    campaign
        The campaign's file, or the folder that holds it.
    output
        Folder to write to; named after the campaign if not given.
    runs
        Names of those that are simulated; all if not given.
    effects
        Switched on besides those of the file, as ``"NAME:PARAM=VALUE,..."``.
    effects_file
        A Python file with effects of your own.
    seed
        Of all noise, in place of the file's.
    overwrite
        Whether recordings that are there are replaced.

    Raises
    ------
    ConfigurationError
        If the file is wrong, a run or an effect is not known, or something would be overwritten.
    """
    from pmm.campaign.simulated_campaign import planned_simulation

    simulation = planned_simulation(
        Path(campaign),
        None if output is None else Path(output),
        runs=runs,
        effects=effects,
        effects_file=text_of(effects_file),
        seed=seed,
        overwrite=overwrite,
    )
    try:
        simulation.carry_out()
    except OSError as error:
        raise ConfigurationError(f"{simulation.folder}: cannot be written to: {error}") from None
    return Records(simulation.folder, RecordKind.CAMPAIGN)
