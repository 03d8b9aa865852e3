"""`looplab models`: what an author of models needs at the command line."""

import typer

from looplab.schemas.models import json_schema
from looplab.schemas.schema_file import Output, write_schema

app = typer.Typer(name="models", help="Nonlinear models as JSON.", no_args_is_help=True, rich_markup_mode="rich")


@app.callback()
def main() -> None:
    """Nonlinear models as JSON."""


@app.command()
def schema(output: Output = None) -> None:
    """Print the JSON schema of a model, for editors that complete and check while one types."""
    write_schema(json_schema(), output)
