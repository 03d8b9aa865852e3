"""Where the pages and the labs are: in the repository of a checkout, in `_data` of an installed wheel."""

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def _data_dir(name: str) -> Path:
    # A checkout (or an editable install, which runs from it) is recognised by its pyproject.toml:
    # a folder called "web" two levels above site-packages is not ours.
    repository = _PACKAGE.parents[1]
    if (repository / "pyproject.toml").is_file() and (repository / "server" / "looplab").is_dir():
        return repository / name
    installed = _PACKAGE / "_data" / name
    if installed.is_dir():
        return installed
    raise FileNotFoundError(
        f"looplab's folder {name!r} is not in the installed package ({installed}); reinstall looplab"
    )


def web_dir() -> Path:
    """The folder of pages, scripts and styles that the server hands out."""
    return _data_dir("web")


def labs_dir() -> Path:
    """The folder of labs that come with looplab."""
    return _data_dir("labs")


def node_modules_dir() -> Path | None:
    """The checkout's `node_modules`, or None in an installed wheel or where npm has not run."""
    folder = _PACKAGE.parents[1] / "node_modules"
    return folder if folder.is_dir() and (folder.parent / "pyproject.toml").is_file() else None
