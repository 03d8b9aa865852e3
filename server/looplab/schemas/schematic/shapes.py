"""The shapes of a drawing, one class a kind. `x, y` is the top left corner of what has width and height, the centre
of what is round, the pivot or foot of what turns or stands. Lengths are in units of the view; y points down."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from looplab.schemas.base import Model
from looplab.schemas.schematic.values import (
    Caption,
    Colour,
    Extent,
    Pair,
    Point,
    Repeat,
    Signal,
    Value,
)

Points = Annotated[list[Point], Field(min_length=2, max_length=100)]
Align = Literal["start", "middle", "end"]


class Shape(Model):
    """What every shape may have."""

    id: Annotated[str, StringConstraints(max_length=48, pattern=r"^[A-Za-z][\w{}+-]*$")] | None = None
    label: Caption | None = None
    label_at: Literal["top", "bottom", "left", "right", "centre"] = "bottom"
    opacity: Value = 1.0
    repeat: Repeat | None = None


class Placed(Shape):
    """A shape with a place of its own; it may move and turn."""

    x: Value
    y: Value
    rotate: Value = Field(default=0.0, description="Degrees, clockwise, about x, y.")


class Sized(Placed):
    width: Extent
    height: Extent


class Tank(Sized):
    """A vessel seen from the side, with its liquid and, if wanted, a jacket."""

    kind: Literal["tank"]
    level: Value = Field(default=0.6, description="Filled part of the height, 0 to 1.")
    fill: Colour = "water"
    top: Literal["open", "closed", "dished"] = "open"
    bottom: Literal["flat", "dished"] = "flat"
    jacket: Colour = "none"


class Tray(Sized):
    """A tray of a column with the liquid on it."""

    kind: Literal["tray"]
    level: Value = 0.5
    fill: Colour = "water"
    downcomer: Literal["left", "right", "alternate", "none"] = "alternate"


class Pipe(Shape):
    """A pipe along points, its elbows rounded; the dashes run with the flow."""

    kind: Literal["pipe"]
    points: Points
    size: Extent = 10.0
    flow: Value = Field(default=0.5, description="0 to 1; below 0 it runs backwards.")
    fill: Colour = "water"
    arrow: bool = True


class Stream(Placed):
    """Liquid falling from a mouth."""

    kind: Literal["stream"]
    length: Value
    size: Extent = 8.0
    flow: Value = 1.0
    fill: Colour = "water"


class Line(Shape):
    """A polyline: a wire, a signal, an outline."""

    kind: Literal["line"]
    points: Points
    stroke: Colour = "ink"
    dash: Literal["none", "dashed", "dotted"] = "none"
    arrow: Literal["none", "start", "end", "both"] = "none"
    closed: bool = False
    fill: Colour = "none"
    width: Annotated[float, Field(gt=0, le=20)] = 1.75


class Arrow(Placed):
    """A force, a heat flow or a flow, as long as it is strong; it points along x, and back where it is negative."""

    kind: Literal["arrow"]
    length: Value
    fill: Colour = "force"
    size: Extent = 8.0


class Valve(Placed):
    """A valve in a line along x; its stem and plug move."""

    kind: Literal["valve"]
    size: Extent = 32.0
    opening: Value = 0.5
    actuator: Literal["none", "diaphragm", "hand"] = "diaphragm"


class Pump(Placed):
    """A centrifugal pump: eye in the middle, outlet at the top."""

    kind: Literal["pump"]
    r: Extent
    speed: Value = Field(default=1.0, description="Turns per second of the picture.")
    outlet: Literal["left", "right"] = "right"


class Orifice(Placed):
    """An orifice plate between flanges, with its pressure taps."""

    kind: Literal["orifice"]
    size: Extent = 28.0


class Regulator(Placed):
    """A pressure regulator in section: spring, diaphragm, plug."""

    kind: Literal["regulator"]
    size: Extent = 64.0
    opening: Value = 0.5


class DPCell(Sized):
    """A differential pressure cell: two chambers and the diaphragm between them."""

    kind: Literal["dp_cell"]
    deflection: Value = Field(default=0.0, description="-1 to 1, towards the low side positive.")


class Heater(Sized):
    """An electric element that glows with its power."""

    kind: Literal["heater"]
    power: Value = 0.5


class Stirrer(Placed):
    """A shaft down from x, y with blades."""

    kind: Literal["stirrer"]
    length: Extent
    width: Extent = 40.0
    speed: Value = 0.7


class Thermometer(Placed):
    """A glass bulb thermometer; x, y is the top of the stem."""

    kind: Literal["thermometer"]
    height: Extent
    level: Value = 0.5
    fill: Colour = "heat"
    range: Pair | None = Field(default=None, description="Numbers at the foot and the head of the scale.")
    step: Extent | None = Field(default=None, description="From one number of the scale to the next.")


class Exchanger(Placed):
    """A condenser, a reboiler: a circle with a zigzag."""

    kind: Literal["exchanger"]
    r: Extent
    fill: Colour = "none"


class Room(Sized):
    """A house in section."""

    kind: Literal["room"]
    fill: Colour = "none"


class Person(Placed):
    """A human body, its core and its shell."""

    kind: Literal["person"]
    height: Extent
    fill: Colour = "none"
    skin: Colour = "none"


class Cart(Sized):
    """A cart on wheels that turn with x; x, y is where it stands, in the middle."""

    kind: Literal["cart"]


class Rod(Placed):
    """A rod up from its pivot; `rotate` is its angle from upright."""

    kind: Literal["rod"]
    length: Extent
    bob: Annotated[float, Field(ge=0, le=1000)] = 0.0
    fill: Colour = "accent"


class Car(Placed):
    """A car; x, y is where it stands, in the middle."""

    kind: Literal["car"]
    size: Extent = 120.0
    speed: Value = Field(default=1.0, description="Turns per second of the wheels in the picture.")


class Ground(Placed):
    """A line with hatching below, from x, y to the right."""

    kind: Literal["ground"]
    length: Extent
    speed: Value | None = Field(default=None, description="A lane below runs back at this speed; 1 is fast.")


class Ruler(Placed):
    """A scale with ticks and numbers, from x, y to the right."""

    kind: Literal["ruler"]
    length: Extent
    range: Pair
    step: Extent

    @model_validator(mode="after")
    def _not_too_fine(self) -> Self:
        if not self.range[0] < self.range[1]:
            raise ValueError("range must increase")
        if (self.range[1] - self.range[0]) / self.step > 50:
            raise ValueError("step is too fine: at most 50 ticks")
        return self


class Instrument(Placed):
    """An instrument's circle with its letters: LT, LC, TT."""

    kind: Literal["instrument"]
    letters: Annotated[str, StringConstraints(pattern=r"^[A-Z]{1,4}$")]
    r: Extent = 18.0
    mount: Literal["field", "panel"] = "field"


class Readout(Placed):
    """Name, value and unit of a signal."""

    kind: Literal["readout"]
    signal: Signal
    name: Caption | None = Field(default=None, description="In place of the signal's; T_amb is set with a subscript.")
    unit: Caption | None = Field(default=None, description="In place of the model's unit.")
    digits: Annotated[int, Field(ge=1, le=6)] = 3
    decimals: Annotated[int, Field(ge=0, le=6)] | None = None
    times: float = Field(default=1.0, description="Factor to the unit shown.")
    bare: bool = Field(default=False, description="Value and unit only; the name is still read aloud.")
    align: Align = "start"


class Text(Placed):
    kind: Literal["text"]
    text: Caption
    size: Literal["s", "m", "l"] = "m"
    align: Align = "start"
    fill: Colour = "ink"


class Box(Sized):
    kind: Literal["box"]
    radius: Annotated[float, Field(ge=0, le=1000)] = 0.0
    fill: Colour = "none"
    stroke: Colour = "ink"


class Disc(Placed):
    kind: Literal["disc"]
    r: Value
    fill: Colour = "none"
    stroke: Colour = "ink"


class Group(Placed):
    """Shapes that move and turn together; their places count from x, y."""

    kind: Literal["group"]
    shapes: Annotated[list[AnyShape], Field(min_length=1, max_length=200)]


AnyShape = Annotated[
    Tank
    | Tray
    | Pipe
    | Stream
    | Line
    | Arrow
    | Valve
    | Pump
    | Orifice
    | Regulator
    | DPCell
    | Heater
    | Stirrer
    | Thermometer
    | Exchanger
    | Room
    | Person
    | Cart
    | Rod
    | Car
    | Ground
    | Ruler
    | Instrument
    | Readout
    | Text
    | Box
    | Disc
    | Group,
    Field(discriminator="kind"),
]

Group.model_rebuild()

__all__ = ["AnyShape", "Group"]
