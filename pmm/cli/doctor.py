"""``pmm doctor``: whether this machine can do what is wanted of it."""

import click


@click.command()
@click.argument("rig", metavar="[RIG.toml]", required=False)
@click.option("--output", metavar="FOLDER", default=".", show_default=True,
              help="Where runs would be recorded.")  # fmt: skip
@click.option("--listen", "listen_s", metavar="S", type=click.FloatRange(min=0.0), default=1.1,
              show_default=True, help="How long to listen to the rig's devices.")  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def doctor(rig: str | None, output: str, listen_s: float, as_json: bool) -> None:
    """Check installation, buses, ports, devices, permissions, clock and disk.

    Each fault is named with its cure. With a rig's file, its devices are asked too; nothing moves
    and nothing is changed. Exit status: 0 no fault, 1 faults, 2 the rig's file is wrong.
    """
    from pmm.cli.doctor_work import run

    run(rig, output, listen_s, as_json=as_json)
