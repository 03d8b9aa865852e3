"""JSON schemas as files, and the option of the commands that write them."""

from pathlib import Path
from typing import Annotated, Any

import orjson
import typer

Output = Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file instead of the terminal.")]


def schema_text(schema: dict[str, Any]) -> str:
    """What the file of a schema must hold."""
    return orjson.dumps(schema, option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE).decode()


def write_schema(schema: dict[str, Any], output: Path | None) -> None:
    """To a file, or to the terminal."""
    if output is None:
        typer.echo(schema_text(schema), nl=False)
    else:
        output.write_text(schema_text(schema), encoding="utf-8")
