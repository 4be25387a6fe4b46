"""What is said of single runs that are used, and of channels that are not as loud as stated."""

from collections.abc import Iterator
from typing import Final

from analysis.gap.judge.withheld import gap_of
from analysis.gap.observe.sensors import heard_rms
from analysis.uncertainty.estimate import Estimate
from pmm.gap.examination import Examined

NOTED: Final = 2.0  # times: a specification's noise is often meant as a largest one


def run_notes(examined: Examined) -> Iterator[str]:
    """Yield notes about single runs, but the odd one."""
    yield from _not_foretold(examined)
    alike: dict[str, list[str]] = {}
    for name, said in examined.ready.cut_short.items():
        alike.setdefault(said, []).append(name)
    for said, names in alike.items():
        yield f"run{'s' * (len(names) > 1)} {', '.join(names)}: {said}"


def noise_notes(examined: Examined) -> Iterator[str]:
    """Yield the channels whose noise is not as it is stated: what was heard is what counts."""
    for line in examined.campaign.acquisition.lines:
        stated_rms = line.digitiser.noise_rms
        measured_rms = heard_rms(examined.ready.fitted, line.channel.name)
        if stated_rms and measured_rms and not 1.0 / NOTED < measured_rms / stated_rms < NOTED:
            unit = line.channel.unit
            yield (
                f"{line.channel.name}: white noise of {measured_rms:.2g} {unit} is heard, "
                f"{stated_rms:.2g} {unit} are stated as noise_rms; what is heard is used"
            )


def command_notes(examined: Examined) -> Iterator[str]:
    """Yield what commands and measured positions told of the settings."""
    for setting in examined.ready.commanded:
        added = "" if setting.added_m is None else f" and {_text(setting.added_m)}"
        yield (
            f"{setting.name}: {_text(setting.deviation)}{added} off, by command and measured "
            f"position of {setting.runs} runs; the simulation has it so, within {setting.key} = "
            f"{setting.tolerance:.2g}"
        )


def _text(estimate: Estimate) -> str:
    unit = "" if estimate.unit == "1" else f" {estimate.unit}"
    return f"{estimate.value:+.3g} ± {estimate.half_width():.2g}{unit}"


def odd_one(examined: Examined) -> str:
    """Return the run that is more probably odd than not; empty where there is none."""
    odd = examined.diagnosis.answers.odd_runs
    return next((name for name, share in odd.items() if share > 0.5), "")


def odd_note(name: str, probability: float) -> str:
    """Return what is said of an odd run."""
    return (
        f"run {name} alone has a gain or a zero of its own (probability {probability:.2f}); a bad "
        f"run? withhold it with --hold-out {name}"
    )


def _not_foretold(examined: Examined) -> Iterator[str]:
    """Yield what the user withheld and the cause that is named leaves much of."""
    judged, cause = examined.judged, examined.cause
    if cause is None or not judged.chosen or not judged.cured:
        return
    for plain, cured in zip(judged.plain, judged.cured, strict=True):
        before, after = gap_of(plain.remainder), gap_of(cured.remainder)
        if after > max(1.0, 0.5 * before):
            yield (
                f"{cured.regime} is not foretold: {' and '.join(cause.names)} leaves {after:.3g} u "
                "of it; it may itself be off, or the cause be another one"
            )
