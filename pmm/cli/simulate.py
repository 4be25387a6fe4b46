"""``pmm simulate``: a campaign file in, a campaign folder with a recording per run out."""

from pathlib import Path

import click

from pmm.cli.options import JSON


@click.command()
@click.argument("campaign", metavar="CAMPAIGN.toml")
@click.option("--output", metavar="FOLDER", help="Where to write.  [default: the campaign's name]")
@click.option("--seed", type=click.IntRange(min=0), help="Of all noise, in place of the file's.")
@click.option(
    "--run", "runs", multiple=True, metavar="NAME", help="Simulate this run only; repeatable."
)
@click.option(
    "--effect",
    "effects",
    multiple=True,
    metavar="NAME[:PARAM=VALUE,...]",
    help='Switch an effect on, besides those of the file; repeatable; "pmm effects" lists them.',
)
@click.option("--effects-file", metavar="FILE.py", help="A Python file with effects of your own.")
@click.option("--plot", metavar="FOLDER", help="Draw each run's signals stage by stage there.")
@click.option("--overwrite", is_flag=True, help="Replace recordings that are there.")
@JSON
def simulate(
    campaign: str,
    output: str | None,
    seed: int | None,
    runs: tuple[str, ...],
    effects: tuple[str, ...],
    effects_file: str | None,
    plot: str | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Simulate the runs of a campaign and write its recordings.

    The folder gets the campaign file and a NetCDF recording per run; the command that takes them is
    printed below. No recording is overwritten unless you say so.
    """
    from pmm.campaign.simulated_campaign import planned_simulation
    from pmm.cli.files import check_folder
    from pmm.cli.next_step import next_command
    from pmm.cli.screen import say, show, show_progress
    from pmm.report.simulation_document import simulation_document

    simulation = planned_simulation(
        Path(campaign),
        None if output is None else Path(output),
        runs=runs,
        effects=effects,
        effects_file=effects_file,
        seed=seed,
        overwrite=overwrite,
    )
    check_folder(simulation.folder, "--output")
    check_folder(plot, "--plot")
    outcome = simulation.carry_out(lambda tasks: show_progress(tasks, "simulating"))
    figures: list[Path] = []
    if plot is not None:
        from pmm.report.chain_figures import save_chain_figure

        for simulated_run in show_progress(outcome.runs, "plotting"):
            figures += save_chain_figure(
                simulation.campaign,
                simulated_run.run,
                simulation.effects,
                simulated_run.seed,
                Path(plot),
            )
    show(simulation_document(simulation, outcome), as_json=as_json)
    if not as_json:
        say(next_command(simulation.folder, simulation.file.parent), *figures)
