"""Everything as one document of plain values, for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from skinbayes.reproduce.demonstration import Demonstration
from skinbayes.reproduce.rules import RULES
from skinbayes.reproduce.shown import count_sentence
from skinbayes.reproduce.statements import statements
from skinbayes.reproduce.table import Compared


def document(rows: Sequence[Compared], shown: Sequence[Demonstration]) -> dict[str, Any]:
    """Rows, counts, rules, demonstrations, inputs and what is stated but not computed."""
    stated = statements().values()
    return {
        "quantities": [row.to_dict() for row in rows],
        "agreeing": sum(row.agrees for row in rows),
        "total": len(rows),
        "summary": count_sentence(list(rows)),
        "rules": {name: rule.sentence for name, rule in RULES.items()},
        "demonstrations": [vars(one) for one in shown],
        "inputs": [
            {"id": s.id, "where": s.where, "description": s.description, "unit": s.unit, "printed": s.words,
             "value": s.printed and s.printed.value}
            for s in stated if s.role == "input"
        ],
        "not_computed": [
            {"id": s.id, "where": s.where, "description": s.description, "printed": s.words, "reason": s.remark}
            for s in stated if s.role == "not computed"
        ],
    }  # fmt: skip
