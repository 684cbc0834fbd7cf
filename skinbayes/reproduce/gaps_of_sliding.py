"""Gaps of Sect. 6 and Appendix C: the shift and the flow factors."""

from __future__ import annotations

from skinbayes.phrases import number
from skinbayes.reproduce.demonstration import Demonstration
from skinbayes.reproduce.liquid import flow_factor_curves
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.stribeck import features, plain_curve, shifts, softer_features


def shift(paper: Paper) -> Demonstration:
    """The shift of the Stribeck curve."""
    elastic = features(paper.products, plain_curve(paper).friction_coefficient)
    softer, (half, minimum) = softer_features(paper), shifts(paper)
    return Demonstration(
        id="shift",
        title="The loss of the tissue does not shift the Stribeck curve to lower speeds",
        where="Sect. 6.2; abstract; Appendix C",
        text="Theory and measurement are said to be a factor of about 20 apart in the text and one decade in the "
        "abstract, and the loss of the tissue is to explain it. Computed, a tissue that loses the quoted 25 % moves the curve "
        "the other way; softer skin would move it down. The measured curve is not available: the distance is not checked.",
        headers=("skin", "half of the plateau at", "minimum at"),
        rows=(
            ("elastic", f"ηv = {number(elastic.half)} N/m", f"{number(elastic.minimum)} N/m"),
            (f"tan δ = {number(paper.loss_tangent)}", f"{number(half)} times", f"{number(minimum)} times"),
            ("six times softer", f"{number(softer.half / elastic.half, 2)} times",
             f"{number(softer.minimum / elastic.minimum, 2)} times"),
            ("asked for (text, abstract)", "1/20, 1/10", "1/20, 1/10"),
        ),
    )  # fmt: skip


def flow(paper: Paper) -> Demonstration:
    """The flow factors."""
    trivial, full = flow_factor_curves(paper)
    plain, rough = (features(paper.products, friction) for friction in (trivial, full))
    rising = float((full / trivial)[-1])
    return Demonstration(
        id="flow-factors",
        title="Flow factors matter off the rising branch",
        where="Appendix C; Fig. 20",
        text="On the rising branch they do not, as the paper has it. On the falling flank they take almost half of the speed; on "
        "axes of many decades, as in Fig. 20, that is a small distance, in a fit it is not.",
        headers=("factors", "half of the plateau at", "smallest friction", "at 0.3 N/m"),
        rows=(
            ("trivial", f"{number(plain.half)} N/m", number(plain.least), number(float(trivial[-1]))),
            ("of the gaps", f"{number(rough.half)} N/m", number(rough.least), f"{number(rising)} times that"),
        ),
    )
