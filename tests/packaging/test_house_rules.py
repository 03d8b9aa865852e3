"""Rules of the house that a linter does not know: what is tracked, how long it is, what the engine needs."""

import ast
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

REPOSITORY = Path(__file__).resolve().parents[2]
LONGEST = 400
CODE = {".py", ".js", ".css", ".html", ".md", ".toml", ".yml", ".sh", ""}
# What the engine may import beside itself and the standard library.
ENGINE_MAY_IMPORT = {"numpy", "scipy", "looplab"}
# A letter in brackets, so that this file does not offend its own rules.
MACHINE_PATHS = re.compile(r"(?<![\w.])/(?:[w]ork|[r]oot|[h]ome|opt/[w]heels)/")
REGISTRIES = re.compile(r"pypi[.]org|python[h]osted|npmj[s]\.|deb[.]debian|https?://\S+[.](?:whl|tgz|deb)\b")


def tracked() -> list[Path]:
    listing = subprocess.run(
        ["git", "ls-files", "-z"], cwd=REPOSITORY, check=True, capture_output=True, text=True
    ).stdout
    return [REPOSITORY / name for name in listing.split("\0") if name and (REPOSITORY / name).is_file()]


def text_of(path: Path) -> str | None:
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None


def modules(folder: str) -> list[Path]:
    return sorted((REPOSITORY / "server" / "looplab" / folder).rglob("*.py"))


def top_level_imports(path: Path, everywhere: bool) -> set[str]:
    """First names of absolute imports: of the whole file, or of what runs when it is imported."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    names: set[str] = set()
    nodes: list[ast.AST] = [tree]
    while nodes:
        node = nodes.pop()
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.split(".")[0])
        if everywhere or not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            nodes.extend(ast.iter_child_nodes(node))
    return names - set(sys.stdlib_module_names)


def test_no_file_is_two_files():
    too_long = {
        str(path.relative_to(REPOSITORY)): lines
        for path in tracked()
        if path.suffix in CODE and path.name != "requirements.lock"
        if (lines := len((text_of(path) or "").splitlines())) > LONGEST
    }
    assert too_long == {}


@pytest.mark.parametrize("pattern", [MACHINE_PATHS, REGISTRIES], ids=["machine path", "registry"])
def test_nothing_tracked_names_a_machine_or_a_registry(pattern):
    named = [
        f"{path.relative_to(REPOSITORY)}: {found[0]}"
        for path in tracked()
        if (text := text_of(path)) is not None
        for found in pattern.finditer(text)
    ]
    assert named == []


def test_nothing_tracked_is_third_party_or_made():
    names = {path.name for path in tracked()}
    assert not names & {"uv.lock", "package-lock.json", "plotly.min.js", "plotly-cartesian.min.js"}
    folders = {part for path in tracked() for part in path.relative_to(REPOSITORY).parts[:-1]}
    assert not folders & {"node_modules", ".venv", "dist", "build", "__pycache__"}
    fonts = [path.name for path in tracked() if path.suffix in {".ttf", ".otf", ".woff", ".woff2", ".whl"}]
    assert fonts == []


def test_the_engine_needs_numpy_and_scipy_only():
    assert modules("engine"), "no engine to look at"
    foreign = {
        f"{path.relative_to(REPOSITORY)}: {name}"
        for path in modules("engine")
        for name in top_level_imports(path, everywhere=False) - ENGINE_MAY_IMPORT
    }
    assert foreign == set()
    # Exchange with python-control is what it is there for, and imports it when it is called.
    inside = {name for path in modules("engine") for name in top_level_imports(path, everywhere=True)}
    assert inside - ENGINE_MAY_IMPORT <= {"control"}


def test_what_is_imported_is_declared():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    declared = {Requirement(line).name.replace("-", "_") for line in project["dependencies"]}
    # fastapi is starlette with schemas, markdown-it-py's module has another name
    known = declared | {"starlette", "markdown_it", "looplab"}
    foreign = {
        f"{path.relative_to(REPOSITORY)}: {name}"
        for path in modules("")
        for name in top_level_imports(path, everywhere=True) - known
    }
    assert foreign == set()


def test_slow_packages_are_imported_late():
    """`control`, matplotlib and scipy.signal cost 1.4 to 1.8 s, scipy.optimize 26 MB: none at the start."""
    late = {"control", "matplotlib", "plotly", "pandas", "scipy.signal", "scipy.optimize", "scipy.integrate", "ziamath"}
    code = "import sys, looplab.api, looplab.cli; print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-c", code],
        check=True,
        capture_output=True,
        text=True,
        env={"PYTHONPATH": str(REPOSITORY / "server")},
    )
    assert late & set(run.stdout.split()) == set()


def test_no_module_hides_what_its_package_exports():
    """A module `a.b` takes the place of a name `b` that `a` has from elsewhere, as soon as anyone imports it."""
    hidden = set()
    for path in modules(""):
        if path.name != "__init__.py":
            continue
        package = ".".join(path.relative_to(REPOSITORY / "server").parts[:-1])
        siblings = {child.stem for child in path.parent.iterdir() if child.suffix == ".py" or child.is_dir()}
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                names = {alias.asname or alias.name for alias in node.names} & siblings
                hidden |= {f"{package}.{name}" for name in names if node.module not in {package, f"{package}.{name}"}}
    assert hidden == set()


def test_the_lock_satisfies_what_is_declared():
    lines = (REPOSITORY / "requirements.lock").read_text(encoding="utf-8").splitlines()
    pins = [Requirement(line) for line in lines if not line.startswith("#")]
    versions = {pin.name: next(iter(pin.specifier)).version for pin in pins}
    assert all([spec.operator for spec in pin.specifier] == ["=="] for pin in pins)
    assert all(pin.url is None for pin in pins)
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for line in project["dependencies"] + project["optional-dependencies"]["dev"]:
        wanted = Requirement(line)
        assert wanted.specifier.contains(versions[wanted.name]), f"{wanted} is not what is locked"


def test_npm_packages_have_exact_versions():
    package = json.loads((REPOSITORY / "package.json").read_text(encoding="utf-8"))
    for name, version in {**package["dependencies"], **package["devDependencies"]}.items():
        assert re.fullmatch(r"\d+\.\d+\.\d+", version), f"{name} {version}"
