"""``pmm completion``: what a shell needs to complete commands and options."""

import click


@click.command()
@click.argument("shell", type=click.Choice(("bash", "zsh", "fish")))
def completion(shell: str) -> None:
    """Print the lines that let a shell complete commands and options with Tab.

    \b
    bash   pmm completion bash >> ~/.bashrc
    zsh    pmm completion zsh >> ~/.zshrc
    fish   pmm completion fish > ~/.config/fish/completions/pmm.fish
    """  # noqa: D301
    from click.shell_completion import get_completion_class

    root = click.get_current_context().find_root().command
    kind = get_completion_class(shell)
    assert kind is not None  # noqa: S101  (click brings all three)
    click.echo(kind(root, {}, "pmm", "_PMM_COMPLETE").source())
