"""What grading says: to the student in words, to a script in fields."""

from dataclasses import dataclass, field
from typing import Any, Literal

Status = Literal["correct", "partly", "wrong", "blank", "unreadable"]


@dataclass(frozen=True)
class Check:
    """One thing that was looked at: a field of the answer, or a specification.

    ``measured`` is the student's own value, ``limit`` the demand where there is one that the student may see.
    """

    name: str
    passed: bool
    text: str
    measured: float | None = None
    limit: float | None = None
    feedback_html: str = ""


@dataclass(frozen=True)
class Result:
    """The verdict on one answer; ``score`` is the part of the exercise's points that it earns, 0 to 1."""

    status: Status
    feedback_html: str
    score: float = 0.0
    checks: list[Check] = field(default_factory=list)

    @property
    def correct(self) -> bool:
        return self.status == "correct"

    def as_dict(self) -> dict[str, Any]:
        return {
            "correct": self.correct,
            "status": self.status,
            "score": self.score,
            "feedback_html": self.feedback_html,
            "checks": [
                {
                    "name": check.name,
                    "passed": check.passed,
                    "measured": check.measured,
                    "limit": check.limit,
                    "text": check.text,
                    "feedback_html": check.feedback_html,
                }
                for check in self.checks
            ],
        }
