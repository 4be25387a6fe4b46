"""A group of commands that knows its own names, and the one that a misspelt name may mean."""

from collections.abc import Collection
from typing import ClassVar

import click


class NamingGroup(click.Group):
    """A group whose commands are listed in a stated order.

    Attributes
    ----------
    names
        The commands, in the order in which the help lists them.
    kind
        What one of them is called in messages: ``"command"``, ``"job"``, ``"action"``.
    """

    names: ClassVar[Collection[str]] = ()
    kind: ClassVar[str] = "command"

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the commands' names."""
        return list(self.names)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command that is meant, or say which one may be."""
        if args[0] not in self.names and not args[0].startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(args[0], self.names, n=1, cutoff=0.4)
            known = f"{self.kind}s: {', '.join(self.names)}"
            ctx.fail(
                f"no {self.kind} {args[0]!r}; {f'did you mean {near[0]!r}?' if near else known}"
            )
        return super().resolve_command(ctx, args)
