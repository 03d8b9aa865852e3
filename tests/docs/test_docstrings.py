"""Every public formula of the engine says its parameters with units, what it returns, and its source."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
ENGINE = REPOSITORY / "server" / "looplab" / "engine"
SECTION = re.compile(r"^(Parameters|Returns|Yields|Raises|Notes|References|Attributes|Examples)\n-{4,}$", re.MULTILINE)
# Formulas of the engine whose docstring must show the formula; a rename shows here.
FORMULAS = {
    "margins",
    "nyquist_count",
    "closed_loop_step",
    "step_metrics",
    "root_locus",
    "ultimate_point",
    "ziegler_nichols_ultimate",
    "ziegler_nichols_reaction",
    "cohen_coon",
    "chien_hrones_reswick",
    "tyreus_luyben",
    "astrom_hagglund_relay",
    "imc",
    "lambda_tuning",
    "simc",
    "amigo",
    "minimum_error",
    "shinskey",
    "optimal_tuning",
    "pole_placement",
    "smith_loop",
    "FOPDT",
    "SOPDT",
    "PID",
}


def public() -> Iterator[tuple[str, ast.FunctionDef | ast.ClassDef]]:
    """Public functions and classes at the top of public modules, and public methods of those classes."""
    for path in sorted(ENGINE.rglob("*.py")):
        where = path.relative_to(ENGINE).as_posix()
        if path.name.startswith("_") and path.name != "__init__.py":
            continue
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                yield f"{where}::{node.name}", node
                for method in node.body if isinstance(node, ast.ClassDef) else []:
                    if isinstance(method, ast.FunctionDef) and not method.name.startswith("_"):
                        yield f"{where}::{node.name}.{method.name}", method


PUBLIC = dict(public())


def sections(docstring: str) -> dict[str, str]:
    parts = SECTION.split(docstring)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def own_parameters(node: ast.FunctionDef) -> set[str]:
    arguments = node.args
    every = arguments.posonlyargs + arguments.args + arguments.kwonlyargs
    return {argument.arg for argument in every} - {"self", "cls"}


@pytest.mark.parametrize("name", PUBLIC)
def test_it_has_a_docstring(name):
    node = PUBLIC[name]
    # An override or a property named by its symbol may be one line; nothing public may be none.
    assert ast.get_docstring(node), f"{name} says nothing"


@pytest.mark.parametrize(
    "name", [name for name, node in PUBLIC.items() if ".. math::" in (ast.get_docstring(node) or "")]
)
def test_a_formula_gives_its_parts_and_its_source(name):
    node = PUBLIC[name]
    found = sections(ast.get_docstring(node) or "")
    if isinstance(node, ast.FunctionDef):
        # A class's formula is its definition; what a function computes has a source.
        assert "References" in found, "a formula has a source"
        assert {"Returns", "Yields"} & set(found), "a formula returns something"
        if own_parameters(node):
            assert "Parameters" in found
    else:
        assert {"Parameters", "Attributes"} & set(found)


@pytest.mark.parametrize(
    "name",
    [
        n
        for n, node in PUBLIC.items()
        if isinstance(node, ast.FunctionDef) and "Parameters" in sections(ast.get_docstring(node) or "")
    ],
)
def test_the_parameters_described_are_those_it_has(name):
    node = PUBLIC[name]
    assert isinstance(node, ast.FunctionDef)
    described = re.findall(
        r"^(\*{0,2}\w+(?:, \*{0,2}\w+)*) :",
        sections(ast.get_docstring(node) or "")["Parameters"],
        re.MULTILINE,
    )
    names = {part.strip().lstrip("*") for line in described for part in line.split(",")}
    assert names == own_parameters(node)


def test_the_formulas_of_the_subject_show_themselves():
    by_name = {name.split("::")[1]: ast.get_docstring(node) or "" for name, node in PUBLIC.items()}
    assert {name for name in FORMULAS if name not in by_name} == set()
    assert {name for name in FORMULAS if not re.search(r"\.\. math::|:math:`", by_name[name])} == set()
