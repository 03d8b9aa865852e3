"""`looplab labs` at the command line."""

from pathlib import Path
from typing import Any

import orjson
import pytest
from typer.testing import CliRunner

from looplab import __version__
from looplab.cli import app
from looplab.labs import Library

runner = CliRunner()


@pytest.fixture
def lab_file(tmp_path: Path, data: dict[str, Any]) -> Path:
    path = tmp_path / "small.json"
    path.write_bytes(orjson.dumps(data))
    return path


def test_check_all() -> None:
    result = runner.invoke(app, ["labs", "check"])
    assert result.exit_code == 0
    assert "ziegler-nichols-third-order.json" in result.output
    assert "in order" in result.output


def test_check_one_file_and_one_folder(lab_file: Path) -> None:
    for path in (lab_file, lab_file.parent):
        result = runner.invoke(app, ["labs", "check", str(path)])
        assert result.exit_code == 0
        assert "tests passed" in result.output
    assert runner.invoke(app, ["labs", "check", "-q", str(lab_file)]).output == ""


def test_check_names_the_file_and_the_place(lab_file: Path, data: dict[str, Any]) -> None:
    data["parts"][0]["blocks"][1]["prompt"] = r"What is $\Ku$?"
    data["parts"][0]["blocks"][5]["hints"] = ["$\\frac{1}$"]
    lab_file.write_bytes(orjson.dumps(data))
    result = runner.invoke(app, ["labs", "check", str(lab_file)])
    assert result.exit_code == 1
    assert "small.json: parts[0].blocks[1].prompt: The formula" in result.output
    assert "small.json: parts[0].blocks[5].hints[0]: The formula" in result.output


def test_check_runs_the_tests(lab_file: Path, data: dict[str, Any]) -> None:
    data["parts"][0]["blocks"][5]["specifications"][0]["limit"] = 10
    lab_file.write_bytes(orjson.dumps(data))
    result = runner.invoke(app, ["labs", "check", str(lab_file)])
    assert result.exit_code == 1
    assert "design (author): the author's answer" in result.output
    assert "20.2 %, at most 10 %" in result.output


@pytest.mark.parametrize("name", ["missing.json", "empty"])
def test_check_of_nothing(tmp_path: Path, name: str) -> None:
    (tmp_path / "empty").mkdir()
    result = runner.invoke(app, ["labs", "check", str(tmp_path / name)])
    assert result.exit_code == 1
    assert result.output.strip()


def test_schema(tmp_path: Path) -> None:
    printed = orjson.loads(runner.invoke(app, ["labs", "schema"]).output)
    assert printed["title"] == "looplab lab"
    assert "$schema" in printed["properties"]
    runner.invoke(app, ["labs", "schema", "-o", str(tmp_path / "s.json")])
    assert orjson.loads((tmp_path / "s.json").read_bytes()) == printed


def test_version_and_help() -> None:
    assert runner.invoke(app, ["--version"]).output == f"looplab {__version__}\n"
    for arguments in (["--help"], ["serve", "--help"], ["labs", "--help"], ["labs", "check", "--help"]):
        result = runner.invoke(app, arguments)
        assert result.exit_code == 0
        assert "Usage" in result.output


def test_a_port_in_use_is_said_so() -> None:
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        result = runner.invoke(app, ["serve", "--port", str(port)])
    assert result.exit_code == 1
    assert f"port {port}" in result.output


def test_serve_with_labs_of_ones_own(lab_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOOPLAB_LABS", "")  # so that it is put back afterwards
    monkeypatch.setattr("uvicorn.Server.run", lambda *_, **__: None)
    result = runner.invoke(app, ["serve", "--port", "0", "--labs", str(lab_file.parent)])
    assert result.exit_code == 0, result.output
    assert [lab.id for lab in Library().all()] == ["small"]
    assert runner.invoke(app, ["serve", "--labs", str(lab_file.parent / "nowhere")]).exit_code == 2
