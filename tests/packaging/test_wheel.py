"""The wheel, in an environment of its own and from another folder, serves what a checkout serves."""

import json
import os
import re
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

from serving import environment, read, serving

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = ["/", "/workbench", "/labs"]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("dist")
    # The build tool of the environment: no download, and the same result as an isolated build.
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "--target", "wheel", "--directory", str(folder)],
        cwd=REPOSITORY,
        check=True,
        capture_output=True,
    )
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory) -> Path:
    """Folder of programs of an environment that has looplab from the wheel and its dependencies from ours.

    A path file lends it the dependencies, which spares their download; a path file inside the lent folder
    (an editable looplab is one) is not followed, so looplab itself can only come from the wheel.
    """
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder, with_pip=False, symlinks=os.name != "nt")
    paths = {"base": str(folder), "platbase": str(folder)}
    programs = Path(sysconfig.get_path("scripts", "venv", vars=paths))
    packages = Path(sysconfig.get_path("purelib", "venv", vars=paths))
    (packages / "lent.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", str(programs / "python")]
    subprocess.run(
        [*pip, "install", "--quiet", "--no-deps", "--no-index", "--ignore-installed", str(wheel)],
        check=True,
        stdin=subprocess.DEVNULL,
    )
    return programs


@pytest.fixture(scope="module")
def served(installed, tmp_path_factory):
    folder = tmp_path_factory.mktemp("elsewhere")
    found = subprocess.run(
        [str(installed / "python"), "-c", "import looplab; print(looplab.__file__)"],
        cwd=folder,
        env=environment(),
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    assert str(installed.parent) in found, f"looplab came from {found}"
    with serving([str(installed / "looplab")], folder, environment()) as url:
        yield url


def tracked(folder: str) -> list[str]:
    listing = subprocess.run(
        ["git", "ls-files", "-z", folder], cwd=REPOSITORY, check=True, capture_output=True, text=True
    ).stdout
    return [name for name in listing.split("\0") if name and (REPOSITORY / name).is_file()]


def test_the_wheel_carries_pages_labs_and_plants(wheel):
    inside = set(zipfile.ZipFile(wheel).namelist())
    assert {f"looplab/_data/{name}" for name in tracked("web") + tracked("labs")} <= inside
    plants = "server/looplab/plants"
    assert {name.removeprefix("server/") for name in tracked(plants) if name.endswith(".json")} <= inside
    assert {"looplab/py.typed", "looplab/plants/models/cstr.json"} <= inside


def test_the_wheel_carries_nothing_else(wheel):
    foreign = [
        name
        for name in zipfile.ZipFile(wheel).namelist()
        if not name.startswith("looplab/") and ".dist-info/" not in name
    ]
    assert foreign == []


def test_the_wheel_names_its_licence_and_its_script(wheel):
    archive = zipfile.ZipFile(wheel)
    info = next(name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
    assert "License-Expression: MIT" in archive.read(info).decode()
    points = archive.read(info.replace("METADATA", "entry_points.txt")).decode()
    assert "looplab = looplab.cli:app" in points


def test_pages_are_the_same_as_from_the_checkout(served, server_url):
    for path in PAGES:
        from_wheel, from_checkout = read(served + path), read(server_url + path)
        assert b"<main" in from_wheel
        # npm's bundle, which only a checkout has, is named by another hash.
        assert without_vendor(from_wheel) == without_vendor(from_checkout), path


def without_vendor(page: bytes) -> list[bytes]:
    return [line for line in page.splitlines() if b"/vendor/" not in line]


def test_static_files_are_the_checkouts(served):
    for name in tracked("web"):
        if name.endswith((".js", ".css")):
            assert read(f"{served}/static/{name.removeprefix('web/')}") == (REPOSITORY / name).read_bytes()


def test_what_a_page_links_is_served(served):
    page = read(served + "/workbench").decode()
    vendor = re.findall(r'"(/vendor/[^"]+)"', page)
    assert len(vendor) >= 2
    for address in vendor:
        assert read(served + address)


def test_labs_are_found(served):
    assert json.loads(read(served + "/api/v1/labs"))["labs"]
