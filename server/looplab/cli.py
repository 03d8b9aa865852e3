"""The command line: `looplab serve | labs | models | bench`."""

import os
import socket
from enum import StrEnum
from pathlib import Path
from typing import Annotated

# Before anything imports numpy: the matrices here are small, and threads of BLAS only get in each other's way.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
    os.environ.setdefault(_variable, "1")

import typer

from looplab import __version__
from looplab.labs.commands import app as labs_app
from looplab.schemas.commands import app as models_app


class LogLevel(StrEnum):
    """What the server writes down."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"
    DEBUG = "debug"


app = typer.Typer(
    name="looplab",
    add_completion=False,
    help="An interactive web control lab: feedback loops with exact dead time, tuning, graded labs.",
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_show_locals=False,
)
app.add_typer(labs_app)
app.add_typer(models_app)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"looplab {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Say the version and stop.")
    ] = False,
) -> None:
    """Run `looplab serve`, then open the address it prints."""


@app.command()
def serve(
    host: Annotated[
        str, typer.Option(help="Address to listen on; 0.0.0.0 lets other machines in.", envvar="LOOPLAB_HOST")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port to listen on; 0 takes a free one.", envvar="LOOPLAB_PORT")
    ] = 8000,
    labs: Annotated[
        Path | None,
        typer.Option(
            exists=True, file_okay=False, help="Folder of your own labs, in place of those that come with looplab."
        ),
    ] = None,
    log_level: Annotated[LogLevel, typer.Option(help="How much to log.")] = LogLevel.WARNING,
) -> None:
    """Start the server and say where to point the browser. Ctrl+C stops it."""
    import uvicorn

    if labs is not None:
        os.environ["LOOPLAB_LABS"] = str(labs.resolve())

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets=sockets)
            if not self.should_exit:  # only now would a browser get an answer
                typer.echo(f"looplab {__version__} is running. Open {_address(listener)} (Ctrl+C stops it).")

    listener = _listen(host, port)
    config = uvicorn.Config("looplab.api.app:create_app", factory=True, log_level=log_level.value, server_header=False)
    with listener:
        Server(config).run(sockets=[listener])


@app.command(
    add_help_option=False,  # the benchmark explains its own options
    context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
)
def bench(context: typer.Context) -> None:
    """Measure the engine and the server against python-control, side by side; options: looplab bench --help."""
    from looplab.bench import main as run

    raise typer.Exit(run(context.args))


def _listen(host: str, port: int) -> socket.socket:
    listener = None
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        listener = socket.socket(family, kind, protocol)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
    except OSError as error:
        if listener is not None:
            listener.close()
        reason = error.strerror or error
        typer.echo(f"Cannot listen on {host}, port {port}: {reason}. Another port: --port {port + 1}", err=True)
        raise typer.Exit(1) from error
    return listener


def _address(listener: socket.socket) -> str:
    host, port = listener.getsockname()[:2]
    if host in ("0.0.0.0", "::"):
        host = "127.0.0.1"
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"
