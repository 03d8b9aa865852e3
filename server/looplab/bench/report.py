"""The benchmark's figures as tables."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.table import Table

from looplab.bench.column import NOTE
from looplab.bench.moves import WAYS
from looplab.bench.nonlinear_loops import RTOL


def _table(title: str, left: tuple[str, ...], right: tuple[str, ...], caption: str) -> Table:
    table = Table(title=title, title_justify="left", caption=caption, caption_justify="left")
    for name in left:
        table.add_column(name, no_wrap=True)
    for name in right:
        table.add_column(name, justify="right", no_wrap=True)
    return table


def _moves(rows: list[dict[str, Any]], title: str, peer: str, note: str = "") -> Table:
    said = dict.fromkeys(f"{r['what'].capitalize()}: {r['note']}." for r in rows if r["note"])
    notes = " ".join(said)
    caption = f"Processor time: medians in ms, their ratio, quartiles of the ratio call by call. {notes}{note}"
    columns = ("looplab", peer, "ratio", "quartiles", "goal")
    table = _table(title, ("",), columns, caption)
    loop = None
    for r in rows:
        if r["loop"] != loop:
            loop = r["loop"]
            table.add_section()
            table.add_row(f"[bold]{loop}")
        spread = f"{r['ratio_q1']:.1f}–{r['ratio_q3']:.1f}"
        medians = (f"{r[side]['median_ms']:.2f}" for side in ("ours", "peer"))
        what = r["what"] + (f", Padé {r['pade_order']}" if r["pade_order"] else "")
        table.add_row(what, *medians, f"{r['ratio']:.1f}", spread, f"{r['goal']:g}" if r["goal"] else "")
    return table


def _accuracy(rows: list[dict[str, Any]]) -> Table:
    caption = "Unit steps of setpoint and load, the larger; reference: method of steps at 60 digits."
    table = _table("Largest error with dead time", ("",), ("y", "u"), caption)
    for r in rows:
        table.add_section()
        table.add_row(f"[bold]{r['loop']}")
        for method, errors in r["errors"].items():
            worst = (max(v for k, v in errors.items() if k.endswith(signal)) for signal in ("y", "u"))
            table.add_row(method, *(f"{v:.1e}" for v in worst))
    return table


def _control(rows: list[dict[str, Any]]) -> Table:
    caption = (
        "Processor time: medians in ms and their ratio; apart: the largest difference of y. Sampled loops against "
        "scipy by a hand-written right-hand side and solve_ivp for each sample; the others by input_output_response. "
        f"On nonlinear plants all solve to a relative tolerance of {RTOL:g}."
    )
    table = _table("Loops that saturate", ("", "against"), ("looplab", "peer", "ratio", "goal", "apart"), caption)
    plant = None
    for r in rows:
        if r["plant"] != plant:
            plant = r["plant"]
            table.add_section()
            table.add_row(f"[bold]{plant}")
        medians = (f"{r[side]['median_ms']:.2f}" for side in ("ours", "peer"))
        goal = f"{r['goal']:g}" if r["goal"] else ""
        table.add_row(
            r["what"], r["peer_name"].split(",")[0], *medians, f"{r['ratio']:.1f}", goal, f"{r['difference']:.0e}"
        )
    return table


def _server(rows: list[dict[str, Any]]) -> Table:
    caption = "Bare: as many bytes in and out, nothing computed. Goal: 8 times at most, worker 110 MB at most."
    columns = ("ms", "bare ms", "ratio", "answer", "worker")
    table = _table("Processor time of the server for one gain move", ("",), columns, caption)
    for r in rows:
        if "reason" in r:
            table.add_row(r["plant"], r["reason"])
            continue
        cpu = r["cpu_ms"]
        size = (f"{r['answer_bytes'] / 1e3:.0f} kB", f"{r['worker_MB']:.0f} MB")
        table.add_section()
        table.add_row(f"[bold]{r['plant']}", f"{cpu['looplab']:.2f}", "", "", *size)
        for name, title in (("bare_fastapi", "a bare FastAPI route"), ("bare_asgi", "a bare ASGI application")):
            table.add_row(f"against {title}", "", f"{cpu[name]:.2f}", f"{r[f'ratio_to_{name}']:.1f}")
    return table


def show(console: Console, results: dict[str, Any]) -> None:
    """Print the tables."""
    machine = results["machine"]
    packages = ", ".join(f"{name} {number}" for name, number in machine["packages"].items())
    threads = ", ".join(sorted(set(machine["blas_threads"].values())))
    console.print(f"Python {machine['python']}, {machine['system']}, {machine['cores']} cores, BLAS threads {threads}")
    console.print(f"{packages}\n")
    ways = dict.fromkeys(r["way"] for r in results["moves"])
    work = [
        _moves(
            [r for r in results["moves"] if r["way"] == way],
            f"The same work by looplab and by python-control, burst by burst{f': {WAYS[way]}' if way else ''}",
            "control",
        )
        for way in ways
    ]
    column_title = "A distillation column of 44 states, 500 points"
    simulated = _moves(results["column"], column_title, "other", f"{NOTE.capitalize()}.")
    for table in (*work, simulated, _control(results["control"]), _accuracy(results["accuracy"])):
        console.print(table, "")
    if results["server"]:
        console.print(_server(results["server"]), "")
    if results["quick"]:
        console.print(f"Only {results['rounds']} repetitions (--quick): a look, not a measurement.")
