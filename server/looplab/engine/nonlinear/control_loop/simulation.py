"""Simulation of a model under control: from sample to sample, from mode to mode, dead times included."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from looplab.engine.errors import NonFinite
from looplab.engine.nonlinear.control_loop.agenda import Deed, make_agenda, shortest_delay
from looplab.engine.nonlinear.control_loop.history import History, panel_times
from looplab.engine.nonlinear.control_loop.members import ContinuousMember, Member, SampledMember
from looplab.engine.nonlinear.control_loop.metrics import loop_metrics
from looplab.engine.nonlinear.control_loop.result import ControlledSimulation, LoopSignals
from looplab.engine.nonlinear.control_loop.settings import ControlLoop
from looplab.engine.nonlinear.control_loop.start import Start, prepare, within
from looplab.engine.nonlinear.language import Values
from looplab.engine.nonlinear.model import CompiledModel
from looplab.engine.nonlinear.simulation.arguments import Courses, call_budget, tolerances
from looplab.engine.nonlinear.simulation.grid import check_times
from looplab.engine.nonlinear.simulation.result import EventRecord
from looplab.engine.nonlinear.simulation.right_hand_side import Course, RunsAway
from looplab.engine.nonlinear.simulation.run import Run
from looplab.engine.nonlinear.simulation.solvers import Counter, Tolerances
from looplab.engine.systems.polynomial import FloatArray

# How often a panel of the past may be halved where the signal is not smooth.
_MOST_HALVINGS = 8


def simulate_control(
    model: CompiledModel,
    times: npt.ArrayLike,
    loops: Sequence[ControlLoop],
    inputs: Courses | None = None,
    parameters: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | Sequence[float] | None = None,
    *,
    method: str = "LSODA",
    rtol: float = 1e-8,
    atol: float | None = None,
    budget: int | None = None,
) -> ControlledSimulation:
    r"""Simulate a model whose inputs are moved by controllers.

    .. math:: \dot x = f(t, x, u, p), \quad y = g(t, x, u, p), \quad u = \mathrm{PID}(r, y)

    Continuous controllers, valves and sensors are states beside those of the model, with their exact Jacobian. Sampled
    controllers act between pieces of the integration, and their dead times are exact: the output is measured at the
    sample less the dead time, the valve moves at the sample plus its own. The dead time of a continuous controller
    looks up the past, kept as polynomials of degree 12 that are halved until their error is that of the solver; what
    remains, at corners, is told as ``history_error``. Before the start everything was as it is there.

    Parameters
    ----------
    model : CompiledModel
    times : array_like, shape (count,)
        Strictly increasing, from 2 to 5000; the first is the start [time].
    loops : sequence of ControlLoop
        One to three, each with an input of its own.
    inputs : mapping of str to float or InputCourse, or None
        Inputs that are not nominal; of one that a loop moves, a number: its bias.
    parameters, initial, method, rtol, atol, budget
        As in ``simulate_open_loop``.

    Returns
    -------
    ControlledSimulation
        Cut as an open-loop simulation is, and where a controller's output runs away.

    Raises
    ------
    InvalidInput
        An argument is out of range.
    IllPosedLoop
        A loop is algebraic.
    NonFinite
        The equations have no finite value at the start.

    References
    ----------
    .. [1] K. J. Astrom, T. Hagglund, Advanced PID Control, ISA 2006, ch. 3.
    .. [2] R. Bellman, K. L. Cooke, Differential-Difference Equations, Academic Press 1963, ch. 3 (method of steps).
    """
    t = check_times(times)
    start = prepare(model, t, loops, inputs or {}, parameters or {}, initial)
    allowed = call_budget(start.closed.model, method)
    counter = Counter(allowed if budget is None else budget)
    work = _Work(t, loops, start, method, tolerances(start.x, rtol, atol, counter))
    with warnings.catch_warnings():
        # The solvers' complaints come back as a reason.
        warnings.simplefilter("ignore")
        work.go()
    return work.result(model, loops)


class _Work:
    """A controlled simulation under way."""

    def __init__(
        self, t: FloatArray, loops: Sequence[ControlLoop], start: Start, method: str, tolerances: Tolerances
    ) -> None:
        self.model, self.p, self.rtol, self.counter = start.closed.model, start.p, tolerances.rtol, tolerances.counter
        self.given = dict(start.courses)
        courses: dict[str, Course] = dict(start.courses)
        self.members: list[Member] = []
        for index, (loop, at, names) in enumerate(zip(loops, start.loops, start.closed.names, strict=True)):
            kind = ContinuousMember if loop.sampling_time is None else SampledMember
            with within(f"loops[{index}]"):
                self.members.append(kind(loop, at, names, self.model, t))
            courses |= self.members[-1].courses
        self.agenda = make_agenda(
            t,
            loops,
            [c for c in courses.values() if hasattr(c, "breakpoints")],  # type: ignore[misc]
        )
        self.histories: list[tuple[History, int]] = [each for m in self.members for each in m.histories]
        self.run = Run(self.model, [courses[name] for name in self.model.input_names], self.p, method, tolerances)
        if self.histories:
            # A step that ends beyond the piece must not look beyond what is known.
            self.run.max_step = 0.5 * shortest_delay(loops)
        self.wanted = set(t.tolist())
        self.t, self.x = t, start.x
        self.records: list[tuple[float, FloatArray, Values, list[tuple[float, ...]]]] = []

    def go(self) -> None:
        """From the start to the end, or to where it is cut."""
        run, edges, stops = self.run, self.agenda.edges, self.agenda.stops
        run.start(edges[0], self.x)
        run.rhs.enter(edges[0])
        places = np.searchsorted(stops, edges, side="right").tolist()
        for (begin, finish), (first, last) in zip(pairwise(edges), pairwise(places), strict=True):
            with run.budgeted():
                self.enter(begin)
                if run.cut is None:
                    self.advance(stops[first:last].tolist(), finish, 0)
            if run.cut is not None:
                return
        with run.budgeted():
            self.enter(edges[-1])

    def enter(self, begin: float) -> None:
        """Do what is to be done at an edge, and take the inputs from there on."""
        run = self.run
        try:
            for deed, index in self.agenda.deeds.get(begin, ()):
                self.do(deed, self.members[index], begin)
            run.enter(begin)
            if begin in self.wanted and run.cut is None:
                self.record(begin, run.x)
        except (NonFinite, RunsAway) as error:
            if not self.records:
                raise
            run.cut = error.message

    def do(self, deed: Deed, member: Member, t: float) -> None:
        """One deed of one loop."""
        run = self.run
        if deed is Deed.CHANGE_MODE:
            x = member.change_mode(t, run.x, run.rhs, self.p)
            run.x = x
        elif deed is Deed.MEASURE:
            member.measure(self.outputs(t, run.x))
        elif deed is Deed.SAMPLE:
            member.sample()
        else:
            member.move_valve()

    def outputs(self, t: float, x: FloatArray) -> Values:
        """Outputs of the closed loop with the inputs of the piece that was entered."""
        return self.model.outputs(t, x.tolist(), self.run.rhs.u(t), self.p)

    def record(self, t: float, x: FloatArray) -> None:
        """Keep what was asked for."""
        out = self.outputs(t, x)
        self.records.append((t, x, out, [member.signals(t, out) for member in self.members]))

    def advance(self, stops: list[float], finish: float, halvings: int) -> None:
        """Go on to the end of a piece; halve it where the past would not be kept closely enough."""
        run = self.run
        begin, nodes = run.t, np.zeros(0)
        mark = run.mark()
        wanted = self.wanted
        if self.histories:
            nodes = panel_times(begin, finish)
            stops = sorted({*stops, *nodes[1:].tolist()})
            wanted = self.wanted | set(nodes.tolist())
        run.advance(stops, finish, wanted)
        samples = [(begin, mark.x), *run.samples[1:]]
        del run.samples[1:]
        try:
            if self.histories and run.cut is None:
                at = dict(samples)
                outs = [self.outputs(t, at[t]) for t in nodes.tolist()]
                values = [np.array([out[place] for out in outs]) for _, place in self.histories]
                coarse = any(
                    history.tail(v) > self.rtol * max(float(np.abs(v).max()), abs(history.before))
                    for (history, _), v in zip(self.histories, values, strict=True)
                )
                if coarse and halvings < _MOST_HALVINGS:
                    run.back(mark)
                    middle = 0.5 * (begin + finish)
                    self.advance([*(s for s in stops if s < middle), middle], middle, halvings + 1)
                    if run.cut is None:
                        self.advance([s for s in stops if s > middle], finish, halvings + 1)
                    return
                for (history, _), v in zip(self.histories, values, strict=True):
                    history.append(begin, finish, v)
            for t, x in samples[1:]:
                # At the end of the piece the inputs begin anew first.
                if t in self.wanted and t < finish:
                    self.record(t, x)
        except NonFinite as error:
            run.cut = error.message

    def result(self, plant: CompiledModel, loops: Sequence[ControlLoop]) -> ControlledSimulation:
        """All that was kept, as arrays."""
        run, n, q = self.run, len(plant.state_names), len(plant.output_names)
        if run.cut is not None and run.t > self.records[-1][0]:
            try:
                self.record(run.t, run.x)
            except NonFinite as error:
                run.cut = error.message
        t = np.array([record[0] for record in self.records])
        x = np.array([record[1][:n] for record in self.records])
        out = np.array([record[2] for record in self.records])
        places = {name: i for i, name in enumerate(self.model.output_names)}
        columns = {name: course.values(t) for name, course in self.given.items()}
        columns |= {m.loop.input: out[:, places[m.names("moved")]] for m in self.members}
        u = np.array([columns[name] for name in plant.input_names]).T
        return ControlledSimulation(
            t,
            x,
            out[:, :q],
            u,
            tuple(EventRecord(e.name, e.message, e.t, e.x[:n]) for e in run.events),
            run.t if run.cut is not None else None,
            run.cut,
            self.counter.calls,
            tuple(
                self.signals(i, t, out[:, plant.output_names.index(m.loop.output)]) for i, m in enumerate(self.members)
            ),
        )

    def signals(self, index: int, t: FloatArray, y: FloatArray) -> LoopSignals:
        """The signals of one loop."""
        member = self.members[index]
        loop, limits = member.loop, member.limits
        y_m, v, u, auto = np.array([record[3][index] for record in self.records]).T
        return LoopSignals(
            loop.output,
            loop.input,
            loop.setpoint.values(t),
            y_m,
            v,
            u,
            auto > 0.5,
            max((history.error for history, _ in member.histories), default=None),
            loop_metrics(t, y, u, (u <= limits.low) | (u >= limits.high), loop.setpoint, self.run.cut is not None),
        )
