"""``pmm gap check``: answers against the keys of a board of sealed cases."""

import click


@click.command()
@click.argument("folder", metavar="FOLDER")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not tables.")
@click.option("--page", metavar="FILE.html", help="Write the board as a page there.")
def check(folder: str, as_json: bool, page: str | None) -> None:
    """Score the answers in FOLDER (docs/sealed.md) against its keys.

    The answers in FOLDER/answers are the first row, those in FOLDER/answers-NAME further ones.
    docs/sealed-scoring.md says what each figure counts. Exit status: 0 scored, 1 the board is not
    whole (a key lies open, an answer is missing, of no case or wrong).
    """
    from pmm.cli.gap_checking import run

    run(folder, page, as_json=as_json)
