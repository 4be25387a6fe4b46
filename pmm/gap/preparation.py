"""From a campaign's folder to what is diagnosed: the same for one campaign and for a board."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Final

from analysis.gap.forward.commanded import KnownSetting, commanded
from analysis.gap.judge.diagnosis import Settings
from analysis.gap.observe.components import GapRun
from analysis.gap.observe.observation import COMPARED
from analysis.gap.quality.recentring import Recentred
from analysis.gap.quality.recordings import doubts, judge_recordings
from analysis.water import Water
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag
from pmm.campaign.campaign import Campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.coefficients.settings import CoefficientSettings, settings_of
from pmm.coefficients.systems import check_dimensions
from pmm.gap.case import Case, read_case, stated_tolerances
from pmm.gap.hold_out import held_out_runs
from pmm.gap.load import LoadedCampaign, campaign_of, load_campaign
from sim.effects.effect import Effect

PHOTOCELL: Final = "photocell"
SENSORS: Final = (PHOTOCELL, *COMPARED)  # what the diagnosis looks at
_FEWEST: Final = 3  # runs

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class PreparedCampaign:
    """A campaign, read, observed and judged.

    Attributes
    ----------
    left_out
        Runs that are not used, by name, with the reason.
    recentred
        The rig to begin with: moved to the coefficients that fit where the stated ones are far off.
    fitted, withheld
        The runs to fit, records at rest among them, and those that nobody looks at until the end.
    cut_short
        Runs of which many periods are not used, or some for want of samples, by name, with the
        reason.
    reporting
        How the user has coefficients reported: ``coefficients.toml`` beside the campaign file.
    damaged
        What is not what was written, by run.
    commanded
        The settings that recorded commands told; the tolerances of ``case`` are about these.
    """

    campaign: Campaign
    case: Case
    left_out: Mapping[str, str]
    recentred: Recentred
    fitted: tuple[GapRun, ...]
    withheld: tuple[GapRun, ...]
    settings: Settings
    cut_short: Mapping[str, str] = field(default_factory=dict)
    reporting: CoefficientSettings = field(default_factory=CoefficientSettings)
    damaged: Mapping[str, tuple[Flag, ...]] = field(default_factory=dict)
    commanded: tuple[KnownSetting, ...] = ()


def prepare(
    folder: Path,
    kinds: Mapping[str, type[Effect]],
    more: Mapping[str, type[Effect]] | None = None,
    sensors: Sequence[str] = (),
    hold_out: Sequence[str] = (),
    progress: Progress = lambda _: None,
) -> PreparedCampaign:
    """Read a campaign and say what of it can be used, and where the diagnosis begins.

    Parameters
    ----------
    kinds
        Effects to consider, by name.
    more
        Effects of the user's own, which the campaign may have switched on.

    Raises
    ------
    ConfigurationError
        If the campaign, the case, ``coefficients.toml`` or a name is wrong.
    DataError
        If fewer than three runs can be used, or a channel is in other units in all of them.
    """
    file = campaign_file(folder)
    _check_sensors(sensors)
    campaign, case = campaign_of(file), read_case(file)
    reporting = _reporting(file.parent, campaign.water)
    held_out = held_out_runs(campaign, hold_out)
    on = campaign.effects_on(more or {})
    progress("reading")
    loaded = load_campaign(file, (), lambda name: progress(f"reading {name}"), sensors)
    progress("looking for recordings that cannot be right")
    known_of = [run for run in loaded.runs if run.name not in held_out]
    commands = commanded(
        loaded.rig, known_of, case.tolerances, on, campaign.reference.channel,
        stated_tolerances(file).keys(),
    )  # fmt: skip
    loaded = replace(loaded, rig=commands.rig)
    case = replace(case, tolerances=commands.tolerances)
    recentred, fitted, withheld, left_out = _sorted(loaded, case, on, held_out, file)
    _check_enough(file, fitted, left_out)
    settings = Settings(
        kinds,
        case.tolerances,
        active_effects=tuple(on),
        choices=case.choices(campaign),
        reference_channel=loaded.reference_channel,
        moved=recentred.units,
        free=recentred.free,
    )
    for record in loaded.at_rest:
        (withheld if record.name in held_out else fitted).append(record)
    cut = {name: said for name, said in loaded.cut_short.items() if name not in left_out}
    used = tuple(fitted), tuple(withheld)
    return PreparedCampaign(
        campaign, case, left_out, recentred, *used, settings, cut, reporting, loaded.damaged,
        commands.known_settings,
    )  # fmt: skip


def _check_enough(file: Path, fitted: Sequence[GapRun], left_out: Mapping[str, str]) -> None:
    if len(fitted) < _FEWEST:
        why = "".join(f"; {name}: {reason}" for name, reason in left_out.items())
        raise DataError(
            f"{file}: {len(fitted)} runs to fit, a diagnosis needs {_FEWEST}: record "
            f"more set-points, or withhold fewer{why}"
        )


def _reporting(folder: Path, water: Water | None) -> CoefficientSettings:
    settings, _ = settings_of(folder, None)
    settings = replace(settings, ship=settings.ship.within(water))
    check_dimensions(settings.system, settings.ship)
    return settings


def campaign_file(folder: Path) -> Path:
    """Return the campaign file of a folder, or the file itself.

    Raises
    ------
    ConfigurationError
        If there is nothing of that name.
    """
    if not folder.exists():
        raise ConfigurationError(f"{folder}: no such folder or campaign file")
    return folder / CAMPAIGN_FILE if folder.is_dir() else folder


def _check_sensors(sensors: Sequence[str]) -> None:
    for name in sensors:
        if name not in SENSORS:
            near = get_close_matches(name, SENSORS, n=1, cutoff=0.4)
            hint = f"did you mean {near[0]!r}?" if near else f"channels: {', '.join(SENSORS)}"
            raise ConfigurationError(f"--sensors: no channel {name!r}; {hint}")


def _without_hull(campaign: Campaign) -> str:
    """Return what to add to a refusal where the simulation believes in no water at all."""
    hull = campaign.hull
    if any(any(row) for table in (hull.added_mass, hull.damping, hull.restoring) for row in table):
        return ""
    return (
        "; the campaign has no [hull], so that it is simulated without water: state restoring, "
        "added_mass and damping as far as they are known, and try again"
    )


def _sorted(
    loaded: LoadedCampaign, case: Case, on: Sequence[Effect], held_out: Sequence[str], file: Path
) -> tuple[Recentred, list[GapRun], list[GapRun], dict[str, str]]:
    """Return the rig to begin with, the runs to fit and those withheld, and what is left out."""
    fitted = [run for run in loaded.runs if run.name not in held_out]
    withheld = [run for run in loaded.runs if run.name in held_out]
    reference = loaded.reference_channel
    recentred, findings = judge_recordings(loaded.rig, fitted, case.tolerances, on, reference)
    if withheld:
        names = {run.name for run in withheld}
        all_doubts = doubts(recentred.rig, loaded.runs, on, reference)
        findings = (*findings, *(doubt for doubt in all_doubts if doubt.run in names))
    for doubt in findings:
        if not doubt.run:
            raise DataError(
                f"{file}: {doubt.channel}: {doubt.reason}{_without_hull(loaded.campaign)}"
            )
    bad: dict[str, str] = {}
    for doubt in findings:
        said = f"{doubt.channel}: {doubt.reason}".removeprefix(": ")
        bad[doubt.run] = f"{bad[doubt.run]}; {said}" if doubt.run in bad else said
    return (
        recentred,
        [run for run in fitted if run.name not in bad],
        [run for run in withheld if run.name not in bad],
        {**loaded.left_out, **bad},
    )
