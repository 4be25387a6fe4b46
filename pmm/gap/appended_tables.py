"""Tables that are put into the file of a campaign or of a pendulum: effects, runs."""

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from hardware.description.errors import ConfigurationError
from pmm.recorder.campaign_owner import own_campaign
from pmm.recorder.files import free_name
from sim.effects.effect import Effect


@dataclass(frozen=True)
class Added:
    """An effect by its name, with its parameters."""

    name: str
    parameters: Mapping[str, float | str]

    @property
    def text(self) -> str:
        """Name and parameters for people."""
        parts = [
            f"{key} = {value if isinstance(value, str) else format(value, '.6g')}"
            for key, value in self.parameters.items()
        ]
        return f"{self.name}: {', '.join(parts)}"

    @property
    def table(self) -> str:
        """The effect as it stands in a file."""
        values = ", ".join(
            f"{key} = {json.dumps(value) if isinstance(value, str) else repr(float(value))}"
            for key, value in self.parameters.items()
        )
        parameters = f"parameters = {{ {values} }}\n" if values else ""
        return f'\n[[effects]]\nname = "{self.name}"\n{parameters}'


def stated_parameters(effect: Effect) -> dict[str, float]:
    """Return an effect's parameters, without those of forms that it does not have."""
    forms = {
        parameter.name: parameter.typical for parameter in effect.parameters() if parameter.forms
    }
    return {key: value for key, value in asdict(effect).items() if forms.get(key) != value}


def append_tables(path: Path, tables: Sequence[str], read: Callable[[Path], object]) -> Path:
    """Append tables to a file, and return where the old file is kept.

    Tables at the end of a TOML file leave everything before them as it is, comments too. The new
    file takes the old one's place only once it is whole and has been read.

    Parameters
    ----------
    tables
        As they stand in the file, each with its heading.
    read
        Reads such a file.

    Raises
    ------
    ConfigurationError
        If the new file cannot be read; the old one stays then.
    OwnedElsewhereError
        If another process is writing into its folder.
    """
    old = path.read_text(encoding="utf-8")
    text = old.rstrip("\n") + "\n" + "".join(tables)
    written = path.with_name(f"{path.name}.part")
    with own_campaign(path.resolve().parent):
        written.write_text(text, encoding="utf-8")
        try:
            read(written)
        except ConfigurationError:
            written.unlink()
            raise
        old_path = free_name(path, "")
        old_path.write_text(old, encoding="utf-8")
        written.replace(path)
    return old_path


def refuse_twice(path: Path, present_names: Collection[str], names: Collection[str]) -> None:
    """Refuse effects that a file has already.

    Raises
    ------
    ConfigurationError
        Naming them.
    """
    twice = sorted(set(present_names) & set(names))
    if twice:
        raise ConfigurationError(
            f"{path}: {', '.join(twice)} is in [[effects]] already; take it out first, so that its "
            "parameters are fitted whole"
        )
