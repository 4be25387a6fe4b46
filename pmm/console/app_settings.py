"""How a console is set up."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pmm.console.live.live_settings import OutletSettings
from pmm.console.security import Door


@dataclass(frozen=True)
class ConsoleSettings:
    """How a console is set up.

    Attributes
    ----------
    rig_path, plans, output
        The rig's file; where its plans lie; where campaigns are recorded (``None``: as the rig's
        file says).
    rig_hashes
        Of the files of the rig that is open.
    log_folder
        Where commands are logged while there is no campaign.
    earlier
        Folders of campaigns that finished runs are compared with.
    reference
        A table of coefficients over the frequency, as CSV.
    live
        Where live values go besides.
    """

    rig_path: Path
    rig_hashes: Mapping[str, str]
    plans: Path
    output: Path | None
    log_folder: Path
    door: Door
    earlier: tuple[Path, ...] = ()
    reference: Path | None = None
    live: OutletSettings = field(default_factory=OutletSettings)
