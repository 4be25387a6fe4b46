"""The command that takes what a campaign's folder holds, for whoever asks what comes next."""

from pathlib import Path


def next_command(folder: Path, files: Path) -> str:
    """Return the command for the recordings of a folder, as a shell takes it.

    Runs with a propeller that turns are for ``pmm steering``, oscillations for ``pmm analyse``,
    tows alone for ``pmm coefficients``, and other records at rest for ``pmm evaluate``.

    Parameters
    ----------
    folder
        Has the campaign's file and its recordings.
    files
        Where settings may lie that the folder does not have.
    """
    from pmm.campaign.campaign_file import read_campaign
    from pmm.campaign.file_names import CAMPAIGN_FILE
    from pmm.cli.screen import pasted
    from pmm.steering.settings import SETTINGS_FILE

    campaign = read_campaign(folder / CAMPAIGN_FILE)
    runs = [run for run in campaign.runs if run.recording_path(folder).is_file()]
    at_rest = [record for record in campaign.at_rest if record.recording_path(folder).is_file()]
    if any(run.revolutions_hz for run in runs) or any(one.revolutions_hz for one in at_rest):
        settings = files / SETTINGS_FILE
        is_elsewhere = settings.is_file() and not (folder / SETTINGS_FILE).is_file()
        named = ("--settings", settings) if is_elsewhere else ()
        return pasted("steering", folder, *named)
    if runs:
        return pasted("analyse", folder)
    has_tows = any(record.kind.towed for record in at_rest)
    return pasted("coefficients" if has_tows else "evaluate", folder)
