"""`looplab models` at the command line."""

import json

from typer.testing import CliRunner

from looplab.cli import app


def test_the_schema_is_printed_or_written(tmp_path):
    printed = CliRunner().invoke(app, ["models", "schema"])
    assert printed.exit_code == 0
    schema = json.loads(printed.stdout)
    assert {"id", "title", "states"} == set(schema["required"])
    target = tmp_path / "model.schema.json"
    assert CliRunner().invoke(app, ["models", "schema", "-o", str(target)]).exit_code == 0
    assert json.loads(target.read_text(encoding="utf-8")) == schema
