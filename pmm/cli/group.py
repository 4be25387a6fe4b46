"""A group of commands, each imported when it is asked for, that names the one meant by a slip."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any, Final

import click

_LONGEST: Final = 200  # characters of a command's line in the help, which is then not cut


class CommandGroup(click.Group):
    """A group whose commands are listed in a stated order.

    A command is the object of its own name in the module of its own name, or is declared where the
    group is. The module imports what is heavy in the functions that need it, so that help answers
    at once.

    Parameters
    ----------
    package
        Where the modules of the commands lie.
    names
        The commands that lie there, in the order in which the help lists them, each with its line
        there, so that the help imports none; those that are declared where the group is come after
        them.
    kind
        What one of them is called in messages: ``"command"``, ``"job"``, ``"action"``.
    """

    def __init__(
        self,
        *arguments: Any,
        package: str = "",
        names: Mapping[str, str] | None = None,
        kind: str = "command",
        **attributes: Any,
    ) -> None:
        super().__init__(*arguments, **attributes)
        self.package, self.names, self.kind = package, names or {}, kind

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the commands' names."""
        return [*self.names, *self.commands]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, ``None`` if there is none of that name."""
        if cmd_name not in self.names:
            return super().get_command(ctx, cmd_name)
        word = cmd_name.replace("-", "_")
        command: click.Command = getattr(import_module(f"{self.package}.{word}"), word)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands, each with its line."""
        help_lines = {
            name: command.get_short_help_str(_LONGEST) for name, command in self.commands.items()
        }
        with formatter.section("Commands"):
            formatter.write_dl([*self.names.items(), *help_lines.items()])

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command that is meant, or say which one may be."""
        names = self.list_commands(ctx)
        if args[0] not in names and not args[0].startswith("-"):
            ctx.fail(self.unknown(args[0], names))
        return super().resolve_command(ctx, args)

    def unknown(self, word: str, names: Sequence[str]) -> str:
        """Return what is said of a word that is no command."""
        from difflib import get_close_matches

        near = get_close_matches(word, names, n=1, cutoff=0.4)
        choices = f"{self.kind}s: {', '.join(names)}"
        return f"no {self.kind} {word!r}; {f'did you mean {near[0]!r}?' if near else choices}"
