"""`looplab models`: what an author of models needs at the command line."""

from pathlib import Path
from typing import Annotated

import orjson
import typer

from looplab.schemas.models import json_schema

app = typer.Typer(name="models", help="Nonlinear models as JSON.", no_args_is_help=True, rich_markup_mode="rich")


@app.callback()
def main() -> None:
    """Nonlinear models as JSON."""


@app.command()
def schema(
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Write to this file instead of the terminal.")
    ] = None,
) -> None:
    """Print the JSON schema of a model, for editors that complete and check while one types."""
    text = schema_text()
    if output is None:
        typer.echo(text, nl=False)
    else:
        output.write_text(text, encoding="utf-8")


def schema_text() -> str:
    """What plants/model.schema.json must hold."""
    return orjson.dumps(json_schema(), option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE).decode()
