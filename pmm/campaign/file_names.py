"""Names that become files and folders: of campaigns, entries of plans, runs."""

from collections.abc import Iterator, Mapping
from typing import Any, Final

from pmm.configuration import Fault

CAMPAIGN_FILE: Final = "campaign.toml"
LONGEST: Final = 100  # letters; a run's name gets a number and an ending, and systems end at 255
_NEVER: Final = set('/\\:*?"<>|')  # apart folders, or no name on Windows
_DEVICES: Final = {"con", "prn", "aux", "nul"} | {
    f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10)
}


def no_file_name(name: str) -> str | None:
    """Say why a name cannot be that of a file or folder on every system; ``None`` if it can.

    Nothing that passes leads out of the folder that it is put into.
    """
    if not name.strip():
        return "is empty"
    if len(name) > LONGEST:
        return f"has {len(name)} letters; the limit is {LONGEST}"
    bad_letters = sorted(
        {letter for letter in name if letter in _NEVER or not letter.isprintable()}
    )
    if bad_letters:
        return f"cannot be the name of a file or folder: it has {', '.join(map(repr, bad_letters))}"
    if name[0] in " ." or name[-1] in " .":
        return "cannot be the name of a file or folder: it begins or ends with a dot or a blank"
    if name.split(".")[0].casefold() in _DEVICES:
        return "cannot be the name of a file or folder: it is a device's on Windows"
    return None


def campaign_name_faults(table: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield what is wrong with the name of a campaign or plan: its folder is called so."""
    name = table.get("name")
    fault = no_file_name(name) if isinstance(name, str) else None
    if fault is not None:
        yield Fault(("name",), f"= {name!r} {fault}")
