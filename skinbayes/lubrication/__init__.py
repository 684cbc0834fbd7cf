"""Lubricated skin: the mixed-lubrication film under a ball, its rheology and flow factors, and the Stribeck curve."""

from skinbayes.lubrication.asperities import (
    AsperityLaw,
    AsperityTable,
    asperity_law,
    asperity_table,
    law_of_table,
)
from skinbayes.lubrication.film import NODES, LubricatedFilms, lubricated_films
from skinbayes.lubrication.flow_factors import (
    FlowFactors,
    FrictionFactors,
    PatirCheng,
    TrivialFlowFactors,
)
from skinbayes.lubrication.gap_flow import (
    GapFactors,
    TabulatedFlowFactors,
    gap_flow_factors,
    tabulated_flow_factors,
)
from skinbayes.lubrication.rheology import FlowCurve, Rheology, ShearThinning, thinned_viscosity
from skinbayes.lubrication.stribeck import (
    LARGE_STRAIN,
    LARGEST_STRAIN,
    NOTABLE_STRAIN,
    THICKEST_FILM,
    StribeckCurve,
    stribeck_curve,
)

__all__ = [
    "LARGEST_STRAIN",
    "LARGE_STRAIN",
    "NODES",
    "NOTABLE_STRAIN",
    "THICKEST_FILM",
    "AsperityLaw",
    "AsperityTable",
    "FlowCurve",
    "FlowFactors",
    "FrictionFactors",
    "GapFactors",
    "LubricatedFilms",
    "PatirCheng",
    "Rheology",
    "ShearThinning",
    "StribeckCurve",
    "TabulatedFlowFactors",
    "TrivialFlowFactors",
    "asperity_law",
    "asperity_table",
    "gap_flow_factors",
    "law_of_table",
    "lubricated_films",
    "stribeck_curve",
    "tabulated_flow_factors",
    "thinned_viscosity",
]
