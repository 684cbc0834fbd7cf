"""The paper reproduced: every number, equation and comparison that it states, beside what skinbayes computes."""

from skinbayes.reproduce.demonstration import Demonstration
from skinbayes.reproduce.demonstrations import demonstrations
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import COMPUTED, Found
from skinbayes.reproduce.rules import RULES, Rule
from skinbayes.reproduce.statements import Statement, statements
from skinbayes.reproduce.table import Compared, compared, judged, reproduction

__all__ = [
    "COMPUTED",
    "RULES",
    "Compared",
    "Demonstration",
    "Found",
    "Paper",
    "Rule",
    "Statement",
    "compared",
    "demonstrations",
    "judged",
    "reproduction",
    "statements",
]
