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

    The folder gets the campaign file and a NetCDF recording per run; "pmm analyse FOLDER" then
    analyses them. No recording is overwritten unless you say so.
    """
    from pmm.campaign import simulation
    from pmm.campaign.campaign_file import read_campaign
    from pmm.campaign.file_names import CAMPAIGN_FILE
    from pmm.cli.files import check_folder
    from pmm.cli.screen import pasted, say, show, show_progress
    from pmm.recorder.campaign_owner import own_new_campaign
    from pmm.report.simulation_document import simulation_document
    from sim.effects.catalogue import build, user_effects

    path = Path(campaign)
    path = path / CAMPAIGN_FILE if path.is_dir() else path
    read = read_campaign(path)
    folder = Path(read.name if output is None else output)
    chosen = [read.run(name) for name in runs] or list(read.runs)
    seed = read.simulation.seed if seed is None else seed
    more = user_effects(effects_file)
    on = (*read.effects_on(more), *(build(text, more) for text in effects))
    zeros = () if runs else simulation.zero_runs(read)
    check_folder(folder, "--output")
    simulation.check_target(path, read, (*chosen, *zeros), folder, overwrite=overwrite)
    if plot is not None:
        check_folder(Path(plot), "--plot")
    with own_new_campaign(folder):
        done = [
            *simulation.simulate_runs(
                read,
                show_progress(chosen, "simulating"),
                folder,
                seed,
                overwrite=overwrite,
                effects=on,
            )
        ]
        at_rest = [
            *simulation.simulate_zeros(read, zeros, folder, seed, overwrite=overwrite, effects=on)
        ]
        simulation.copy_campaign(path, read, folder)
    figures: list[Path] = []
    if plot is not None:
        from pmm.report.chain_figures import save_chain_figure

        for one in show_progress(done, "plotting"):
            figures += save_chain_figure(read, one.run, on, one.seed, Path(plot))
    show(simulation_document(read.name, folder, done, at_rest, on), as_json=as_json)
    if not as_json:
        say(pasted("analyse", folder), *figures)
