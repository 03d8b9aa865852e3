"""The benchmark's command line and the order in which it measures."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="looplab bench",
        description="Times one gain move against python-control doing the same work, in turn by bursts, "
        "as a slider makes them, compares both with exact references, and weighs the server against a bare POST.",
    )
    parser.add_argument("--out", type=Path, metavar="FILE.json", help="write every figure to this file")
    parser.add_argument("--quick", action="store_true", help="few repetitions: a look, not a measurement")
    parser.add_argument("--no-server", action="store_true", help="leave out the part that starts servers")
    return parser


def main(arguments: Sequence[str] = ()) -> int:
    """Run the benchmark; 0 when it ran, whatever the ratios are."""
    options = _parser().parse_args(list(arguments))
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from looplab.bench import accuracy, column, loci, machine, moves, nonlinear_loops, report, saturated, server

    console = Console()
    rounds = 3 if options.quick else 40
    requests = 100 if options.quick else 600
    results: dict[str, object] = {"machine": machine.describe(), "quick": options.quick, "rounds": rounds}
    steps = (len(moves.COMPARISONS) + len(loci.LOCI) + len(column.ROWS)) * rounds + len(accuracy.CASES)
    steps += 0 if options.no_server else server.STEPS
    # The peer takes seconds for some of these.
    few = max(2, rounds // 8)
    steps += (saturated.STEPS + nonlinear_loops.STEPS) * few
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("starting", total=steps)

        def tick(what: str) -> None:
            progress.update(task, description=what, advance=1)

        results["accuracy"] = accuracy.measure(tick)
        results["moves"] = [*moves.measure(rounds, tick), *loci.measure(rounds, tick)]
        results["control"] = saturated.measure(few, tick) + nonlinear_loops.measure(few, tick)
        results["column"] = column.measure(rounds, lambda: tick("a distillation column"))
        results["server"] = None if options.no_server else server.measure(requests, tick)
    report.show(console, results)
    if options.out is not None:
        options.out.write_text(json.dumps(results, indent=1, allow_nan=False) + "\n")
        console.print(f"All figures: {options.out}")
    return 0
