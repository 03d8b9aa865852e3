"""Labs: one JSON file each, with its text, its bench, its exercises and their tests."""

from looplab.labs.grading import Result, grade
from looplab.labs.loader import Library, parse_lab, read_lab, validate_lab
from looplab.labs.problems import LabError, Problem
from looplab.labs.render import list_entry, render_lab
from looplab.labs.schema import Lab
from looplab.labs.selftest import Outcome, run_tests
from looplab.labs.text import render_math, render_text

__all__ = [
    "Lab",
    "LabError",
    "Library",
    "Outcome",
    "Problem",
    "Result",
    "grade",
    "list_entry",
    "parse_lab",
    "read_lab",
    "render_lab",
    "render_math",
    "render_text",
    "run_tests",
    "validate_lab",
]
