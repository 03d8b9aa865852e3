"""The shelves of the library: which plants stand together, and in which order."""

from __future__ import annotations

OTHERS = "Others"
GROUPS: dict[str, tuple[str, ...]] = {
    "Heating and cooling": (
        *("heater", "heated-room", "thermometer", "thermometer-glass"),
        *("jacketed-cooler-thin-wall", "jacketed-cooler", "body-temperature"),
    ),
    "Tanks": (
        *("gravity-drained-tank", "two-tanks", "two-tanks-interacting", "tanks-in-series"),
        *("level-loop", "quadruple-tank", "quadruple-tank-crossed"),
    ),
    "Reactors": ("cstr", "cstr-variable-volume", "jacketed-cstr"),
    "Columns": (
        *("distillation", "ethanol-water", "ogunnaike-ray"),
        *("wood-berry", "vinante-luyben", "wardle-wood"),
    ),
    "Mechanical": ("cart-pendulum", "cruise-control"),
    "Instruments": ("orifice", "rtd", "dp-cell", "control-valve", "pump-valve", "pressure-regulator"),
}


def group_of(plant_id: str) -> str:
    """The shelf of a plant."""
    return next((group for group, members in GROUPS.items() if plant_id in members), OTHERS)


def shelved(plant_ids: list[str]) -> list[str]:
    """The ids in the order of the shelves; those on none come last."""
    order = [member for members in GROUPS.values() for member in members]
    return sorted(plant_ids, key=lambda name: (order.index(name) if name in order else len(order), name))
