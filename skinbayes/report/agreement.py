"""Whether experiments on one skin agree, in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from skinbayes.fit.left_out import LeftOutExperiment, shared_labels
from skinbayes.phrases import and_list
from skinbayes.plot.numbers import interval, quantity

if TYPE_CHECKING:
    from skinbayes.fit import JointFit


def agreement_sentences(fit: JointFit, found: Sequence[LeftOutExperiment]) -> list[str]:
    """What the experiments say about each other, in words."""
    labels = shared_labels(fit)
    if not labels:
        return ["The experiments share no free parameter, so that they cannot disagree about one."]
    said = [f"Informed by more than one experiment: {and_list([fit.symbol(label) for label in labels])}."]
    for one in found:
        if not one.reliable:
            said.append(
                f"{one.experiment}: it says so much that the draws cannot tell what the others would say without it "
                f"(Pareto k {one.pareto_k:.2f}). 'skinbayes report RUN --refit' samples without it."
            )
            continue
        values = [
            f"{fit.symbol(label)} = {quantity(middle, fit.unit(label))} "
            f"(90 %: {interval(low, high, fit.unit(label), typical=middle)}), with it "
            f"{quantity(one.all[label][1], fit.unit(label))} "
            f"({interval(one.all[label][0], one.all[label][2], fit.unit(label), typical=middle)})"
            for label, (low, middle, high) in one.without.items()
        ]
        said.append(
            f"{one.experiment}: without it the others say {'; '.join(values)}. ln of the probability that they give to its data "
            f"is {one.elpd:.2f} ± {one.error:.2f}."
        )
        if one.pulls:
            said.append(
                f"{one.experiment} DISAGREES with the others about {and_list([fit.symbol(label) for label in one.pulls])}: with "
                "it the median leaves the 90 % interval without it. Do not use the joint value before it is clear why."
            )
    return said
