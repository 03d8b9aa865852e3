"""What tuning rules start from: the ultimate point and the low-order models of a plant, or what an experiment gave."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Literal

from looplab.engine.errors import EngineError, RuleNotApplicable
from looplab.engine.identification import two_point
from looplab.engine.low_order import half_rule, integrating_half_rule, ramp_asymptote
from looplab.engine.stability.gain_ranges import GainRange, gain_ranges
from looplab.engine.systems.first_second_order import FOPDT, SOPDT
from looplab.engine.systems.integrating import DIPDT, IPDT
from looplab.engine.systems.transfer_function import TransferFunction
from looplab.engine.tuning.settings import DEFAULTS, Options, PlantData, Rule, Settings
from looplab.engine.tuning.ultimate_point import UltimatePoint, ultimate_point


def _window(window: GainRange) -> str:
    low, high = window.low.K, window.high.K
    if low is None or high is None:
        return f"Kc above {low:.4g}" if low is not None else f"Kc below {high:.4g}"
    return f"Kc between {low:.4g} and {high:.4g}"


def _require_open_loop_stable(plant: TransferFunction) -> None:
    """An ultimate-cycle rule takes a fraction of Ku, and trusts every gain below it to be stable."""
    if not plant.poles.size or plant.poles.real.max() <= 0:
        return
    windows = gain_ranges(plant, negative=True).ranges
    if windows:
        held = " or ".join(_window(w) for w in windows)
        raise RuleNotApplicable(
            f"the plant is unstable: proportional control holds it only with {held}, and rules that take a share of "
            "the ultimate gain were made for plants that need no control to be stable",
            field="plant",
            hint="search the gains by their robustness instead",
        )


class KnownPlant:
    """A plant, and what rules read off it; each reading is made once, when it is first asked for.

    Parameters
    ----------
    plant : TransferFunction or None
        Proper, dead time exact.
    model : FOPDT or None
        A model in place of the plant.
    ultimate : UltimatePoint or None
        An ultimate point in place of the plant's own, as an experiment gives it.
    """

    def __init__(
        self,
        plant: TransferFunction | None = None,
        model: FOPDT | None = None,
        ultimate: UltimatePoint | None = None,
    ) -> None:
        self.plant = plant if plant is not None or model is None else model.to_transfer_function()
        self.model, self.given_point = model, ultimate
        self._found: dict[str, PlantData | EngineError] = {}

    @classmethod
    def of(cls, plant: TransferFunction) -> KnownPlant:
        """The plant itself is known.

        Raises
        ------
        ImproperSystem
        """
        return cls(plant.require_proper("plant"))

    def _once(self, name: str, find: Callable[[TransferFunction], PlantData]) -> PlantData:
        if name not in self._found:
            if self.plant is None:
                error = RuleNotApplicable("this rule needs a model or the plant, not Ku and Pu", field="model")
                self._found[name] = error
            else:
                try:
                    self._found[name] = find(self.plant)
                except EngineError as error:
                    self._found[name] = error
        found = self._found[name]
        if isinstance(found, EngineError):
            raise found
        return found

    def ultimate(self) -> UltimatePoint:
        """Ku and Pu; raises RuleNotApplicable where there are none."""
        if self.given_point is not None:
            return self.given_point
        found = self._once("ultimate", ultimate_point)
        assert isinstance(found, UltimatePoint)
        return found

    def reaction_curve(self) -> FOPDT:
        """First-order model from the step response (or as given); raises RuleNotApplicable."""
        if self.model is not None:
            return self.model
        found = self._once("reaction_curve", two_point)
        assert isinstance(found, FOPDT)
        return found

    @cached_property
    def _integrators(self) -> int:
        return self.plant.origin_order if self.plant is not None and self.plant.gain else 0

    def _second_order(self) -> SOPDT | None:
        """The plant itself, where it is a stable second-order model without zeros."""
        P = self.plant
        if P is None or P.order != 2 or P.zeros.size or P.poles.real.max() >= 0:
            return None
        size = abs(P.poles[0]) ** 0.5 * abs(P.poles[1]) ** 0.5
        return SOPDT(P.dc_gain, 1.0 / size, float(-P.poles.real.sum()) / (2.0 * size), P.theta)

    def for_rule(self, rule: Rule, type: str) -> PlantData:
        """What a rule starts from for one type of controller.

        Raises
        ------
        RuleNotApplicable
            The plant has no such data.
        """
        if rule.needs == "ultimate":
            point = self.ultimate()
            if self.given_point is None and self.plant is not None:
                _require_open_loop_stable(self.plant)
            return point
        if self._integrators and self.plant is not None and self.model is None:
            lags: Literal[0, 1] = 1 if type == "PID" and rule.reduction == "half_rule" else 0
            if self._integrators == 1 and rule.reduction == "reaction_curve":
                return self._once("ramp", ramp_asymptote)
            if "IPDT" in rule.formulas:
                return self._once(f"integrating {lags}", lambda P: integrating_half_rule(P, lags))
        if "SOPDT" in rule.formulas and type in rule.formulas["SOPDT"] and self.model is None:
            if rule.reduction == "half_rule":
                return self._once("half_rule SOPDT", lambda P: half_rule(P, "SOPDT"))
            exact = self._second_order()
            if exact is not None:
                return exact
        if rule.reduction == "half_rule" and self.model is None:
            return self._once("half_rule FOPDT", lambda P: half_rule(P, "FOPDT"))
        return self.reaction_curve()

    def tune(self, rule: Rule, type: str, options: Options = DEFAULTS) -> Settings:
        """Settings by one rule.

        Raises
        ------
        RuleNotApplicable
            The rule has no such type, the plant has not what it needs, or is outside its range.
        """
        if type not in rule.types:
            raise RuleNotApplicable(
                f"{rule.name} has no settings for {type}", field="types", hint=", ".join(rule.types)
            )
        return rule.apply(self.for_rule(rule, type), type, options)

    def describe(self, data: PlantData, rule: Rule) -> str:
        """How the data of a rule were come by, in words."""
        if isinstance(data, UltimatePoint):
            return "as given" if self.given_point is not None else "from the plant's exact frequency response"
        if self.model is not None:
            return "as given"
        if isinstance(data, IPDT | DIPDT):
            if rule.reduction == "half_rule":
                return "half rule"
            return "the line that the plant's step response ends on"
        if rule.reduction == "half_rule":
            return "half rule"
        if isinstance(data, SOPDT):
            return "the plant itself"
        P = self.plant
        exact = P is not None and P.order == 1 and not P.zeros.size
        return "the plant itself" if exact else "through 28.3 % and 63.2 % of the plant's exact step response"
