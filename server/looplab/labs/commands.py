"""`looplab labs`: what an author of labs needs at the command line."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape

from looplab.labs.loader import default_folder, lab_files, read_lab
from looplab.labs.problems import LabError
from looplab.labs.schema import json_schema
from looplab.labs.selftest import run_tests
from looplab.schemas.schema_file import Output, write_schema

app = typer.Typer(
    name="labs",
    help="Check labs and write out their schema.",
    no_args_is_help=True,
    rich_markup_mode="rich",
)


@app.command()
def check(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(help="Lab files, or folders of them. Left out: the labs that come with looplab."),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Say only what is wrong.")] = False,
) -> None:
    """Read labs, render every text and formula, and run the labs' own tests.

    Exits with 1 where anything is wrong; each line then names the file and the place in it.
    """
    out = Console(highlight=False, soft_wrap=True)
    files = _files(paths or [default_folder()])
    if not files:
        out.print("There is no lab here: a lab is a .json file whose name is its id.")
        raise typer.Exit(1)
    failures = sum(_check_file(path, out, quiet) for path in files)
    if failures:
        out.print(f"[red]{failures} of {len(files)} {_plural('lab', len(files))} must be repaired.[/]")
        raise typer.Exit(1)
    if not quiet:
        out.print(f"[green]{len(files)} {_plural('lab', len(files))} in order.[/]")


@app.command()
def schema(output: Output = None) -> None:
    """Print the JSON schema of a lab, for editors that complete and check while one types."""
    write_schema(json_schema(), output)


def _files(paths: list[Path]) -> list[Path]:
    return [file for path in paths for file in (lab_files(path).values() if path.is_dir() else [path])]


def _check_file(path: Path, out: Console, quiet: bool) -> bool:
    """Report on one file; True where something is wrong."""
    try:
        lab = read_lab(path)
    except LabError as error:
        for problem in error.problems:
            out.print(f"[red]✗[/] {escape(str(path))}: {escape(str(problem))}")
        return True
    outcomes = run_tests(lab)
    failed = [outcome for outcome in outcomes if not outcome.passed]
    for outcome in failed:
        out.print(f"[red]✗[/] {escape(f'{path}: {outcome.exercise} ({outcome.case}): {outcome.message}')}")
    if not failed and not quiet:
        out.print(f"[green]✓[/] {escape(str(path))}: {len(outcomes)} tests passed")
    return bool(failed)


def _plural(word: str, count: int) -> str:
    return word if count == 1 else f"{word}s"
