"""The guide for authors is right: its lab passes the check, and it names every measure and knob there is."""

import re
from pathlib import Path
from typing import get_args

import pytest

from looplab.labs import parse_lab, run_tests
from looplab.labs.schema import LoopMeasure
from looplab.labs.schema.bench import Knob


@pytest.fixture(scope="module")
def guide() -> str:
    return (Path(__file__).resolve().parents[2] / "labs" / "README.md").read_text(encoding="utf-8")


def test_the_lab_of_the_guide_is_in_order(guide: str) -> None:
    found = re.search(r"```json\n(.*?)```", guide, re.DOTALL)
    assert found
    lab = parse_lab(found[1], "README.md")
    assert [outcome.message for outcome in run_tests(lab) if not outcome.passed] == []
    assert f"labs/{lab.id}.json" in guide


def test_the_guide_names_what_can_be_measured_and_turned(guide: str) -> None:
    named = set(re.findall(r"`(\w+)`", guide))
    own = {name for name in get_args(LoopMeasure) if not name.startswith(("load_", "omega_M"))}
    assert own <= named
    assert set(get_args(Knob)) <= named
