"""What ``pmm gap add`` does: fit, append to the campaign file, and keep the old one."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.cli.gap_adding import add_and_say, check_appendable
from pmm.cli.gap_diagnose_work import engine, progress
from pmm.cli.gap_options import Looks
from pmm.cli.hints import pasted
from pmm.gap.appending import Added, refuse_twice
from pmm.gap.examine import Examined, examine
from pmm.gap.load import campaign_of
from pmm.gap.words import what_is_wrong
from sim.effects.effect import Effect

JSON_SCHEMA = "pmm-gap-add-1"


@dataclass(frozen=True)
class GapAddOptions(Looks):
    """The options of the command, by their names there."""

    campaign: str
    effect: str | None
    jobs: int | None
    as_json: bool


def run(request: GapAddOptions) -> None:
    """Add an effect to a campaign.

    Raises
    ------
    ConfigurationError
        If the campaign or an option is wrong, or the campaign has that effect already.
    DataError
        If no effect is found.
    """
    folder = Path(request.campaign)
    path = folder / CAMPAIGN_FILE if folder.is_dir() else folder
    if not path.exists():
        raise ConfigurationError(f"{path}: no such folder or campaign file")
    check_appendable(path)
    if request.effect is not None:
        _refuse_twice(path, (request.effect,))
    chosen = _effects(_examined(request, path), request)
    _refuse_twice(path, [one.name for one in chosen])
    added = [Added(one.name, asdict(one)) for one in chosen]
    files = [word for one in request.files for word in ("--effects", one)]
    again = pasted("gap", request.campaign, *files)
    schema = JSON_SCHEMA if request.as_json else None
    add_and_say(path, added, campaign_of, again=again, schema=schema)


def _examined(request: GapAddOptions, path: Path) -> Examined:
    options = request.options
    if request.effect is not None:
        options = replace(options, effects=(request.effect, *request.files))
    with progress() as told, engine(request, request.jobs) as executor:
        return examine(path, options, executor, told)


def _effects(examined: Examined, request: GapAddOptions) -> Sequence[Effect]:
    """Return what to add: the named effect as fitted, or the one that was found."""
    found = examined.diagnosis
    if request.effect is not None:
        fits = [one for one in found.weighed.singles if one.names == (request.effect,)]
        if not fits:
            reason = found.weighed.refused.get(request.effect, "these runs do not show it")
            raise DataError(f"{request.effect}: cannot be fitted: {reason}")
        return fits[0].effects
    if examined.cause is None:
        raise DataError(
            f"{examined.campaign.name}: {what_is_wrong(examined.conclusion)} So there "
            "is nothing to add; --effect NAME adds one all the same"
        )
    return examined.cause.effects


def _refuse_twice(path: Path, names: Sequence[str]) -> None:
    refuse_twice(path, [one.name for one in campaign_of(path).effects], names)
