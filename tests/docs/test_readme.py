"""The README is run, not believed: its commands, its examples and their output, its links and its maps."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from serving import environment, read

REPOSITORY = Path(__file__).resolve().parents[2]
README = (REPOSITORY / "README.md").read_text(encoding="utf-8")
ADDRESS = "http://127.0.0.1:8000"
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
SHELL = [text.strip() for language, text in BLOCKS if language == "sh"]
# An example and the output that the README prints under it.
EXAMPLES = re.findall(r"^```python\n(.*?)^```\n\nprints\n\n```text\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
ENV = environment(PYTHONPATH=str(REPOSITORY / "server"))


def rows(heading: str) -> list[list[str]]:
    """Cells of the first table under a heading, without its head."""
    section = README.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def test_the_two_commands_of_the_set_up_are_make_run_and_make_test():
    set_up = README.split("\n## Set up\n")[1].split("\n## ")[0]
    assert re.findall(r"^```sh\n(.*?)\n```$", set_up, re.MULTILINE | re.DOTALL) == ["make run", "make test"]


@pytest.mark.parametrize("target", sorted(set(re.findall(r"^(?:.*`)?make ([a-z-]+)", README, re.MULTILINE))))
def test_make_targets_exist(target):
    makefile = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
    assert re.search(rf"^{target}:", makefile, re.MULTILINE)


@pytest.mark.parametrize("command", [line for line in SHELL if line.startswith("looplab ")])
def test_looplab_commands_exist(command):
    run = subprocess.run(
        [sys.executable, "-m", *shlex.split(command), "--help"], env=ENV, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr


def test_the_shell_blocks_are_all_looked_at():
    assert all(block.startswith(("make ", "looplab ", "curl ")) for block in SHELL), SHELL


@pytest.mark.parametrize("command", [block for block in SHELL if block.startswith("curl ")])
def test_curl_examples_answer(command, server_url):
    if shutil.which("curl") is None:
        pytest.fail("the README's example needs curl: apt-get install curl", pytrace=False)
    assert ADDRESS in command
    # --fail: an answer of 4xx is a failure, with its text shown
    arguments = shlex.split(command.replace(ADDRESS, server_url))
    run = subprocess.run([*arguments, "--fail-with-body"], capture_output=True, text=True, timeout=30)
    assert run.returncode == 0, run.stdout
    assert '"closed_loop_stable":true' in run.stdout.replace(" ", "")


def test_every_python_block_is_an_example_with_its_output():
    assert len(EXAMPLES) == sum(language == "python" for language, _ in BLOCKS) > 0


@pytest.mark.parametrize(("code", "output"), EXAMPLES, ids=range(len(EXAMPLES)))
def test_python_examples_print_what_the_readme_says(code, output, server_url, tmp_path):
    run = subprocess.run(
        [sys.executable, "-c", code.replace(ADDRESS, server_url)],
        cwd=tmp_path,
        env=ENV,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert run.stdout == output, run.stderr


def test_links_lead_somewhere():
    links = re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", README)
    assert links
    assert [link for link in links if not (REPOSITORY / link).exists()] == []


def test_pages_of_the_table_answer(server_url):
    addresses = [row[0].strip("`") for row in rows("Pages")]
    assert "/workbench" in addresses
    for address in addresses:
        assert read(server_url + address)


def test_the_map_names_every_room_and_no_other():
    named = {path.strip("/") for row in rows("What is where") for path in re.findall(r"`([^`]+)`", row[0])}
    assert [path for path in named if not (REPOSITORY / path).is_dir()] == []
    rooms = {
        f"{folder}/{room.name}"
        for folder in ("server/looplab", "web")
        for room in (REPOSITORY / folder).iterdir()
        if room.is_dir() and any(room.rglob("*.py" if "server" in folder else "*.js"))
    }
    assert rooms - named == set()


def test_every_folder_of_tests_is_named():
    row = next(row for row in rows("What is where") if row[0] == "`tests/`")
    folders = {path.name for path in (REPOSITORY / "tests").iterdir() if any(path.glob("test_*.py"))}
    assert [name for name in sorted(folders) if name not in row[1]] == []


def test_the_licence_is_the_one_that_is_declared():
    assert "MIT License" in (REPOSITORY / "LICENSE").read_text(encoding="utf-8")


def test_the_changelog_has_unreleased_changes_on_top():
    changelog = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(r"^## (.*)$", changelog, re.MULTILINE)[1] == "Unreleased"
