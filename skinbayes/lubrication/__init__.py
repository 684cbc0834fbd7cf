"""Lubricated skin: the mixed-lubrication film under a ball, its rheology and flow factors, and the Stribeck curve."""

from skinbayes.lubrication.asperities import (
    AsperityLaw,
    AsperityTable,
    asperity_law,
    asperity_table,
    law_of_table,
)
from skinbayes.lubrication.contact_films import CONTACTS, LINE, POINT
from skinbayes.lubrication.effective_viscosity import EffectiveViscosity, stribeck_curve_of_liquid
from skinbayes.lubrication.film import NODES, LubricatedFilms, lubricated_films
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, HOMOGENEOUS_PARAMETERS, FilmAxes, film_axes
from skinbayes.lubrication.film_plan import FilmTablePlan
from skinbayes.lubrication.film_table import FilmTable
from skinbayes.lubrication.film_table_build import build_film_table
from skinbayes.lubrication.film_table_evaluation import (
    LubricatedBalls,
    TabulatedFriction,
    tabulated_friction,
    tabulated_friction_of_liquids,
)
from skinbayes.lubrication.flow_curves import LiquidRows, liquid_rows
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
from skinbayes.lubrication.point_film import CELLS, LubricatedPointFilms, lubricated_point_films
from skinbayes.lubrication.rheology import FlowCurve, Rheology, ShearThinning, thinned_viscosity
from skinbayes.lubrication.stribeck import (
    LARGE_STRAIN,
    LARGEST_STRAIN,
    NOTABLE_STRAIN,
    REASONS_FOR_NO_PREDICTION,
    THICKEST_FILM,
    StribeckCurve,
    stribeck_curve,
)
from skinbayes.lubrication.viscoelastic_film import ViscoelasticFilms, viscoelastic_films
from skinbayes.lubrication.viscoelastic_point_film import ViscoelasticPointFilms, viscoelastic_point_films
from skinbayes.lubrication.viscoelastic_stribeck import (
    SPHERE_OVER_CYLINDER,
    ViscoelasticStribeckCurve,
    viscoelastic_stribeck_curve,
)

__all__ = [
    "CELLS",
    "CONTACTS",
    "FILM_PARAMETERS",
    "HOMOGENEOUS_PARAMETERS",
    "LARGEST_STRAIN",
    "LARGE_STRAIN",
    "LINE",
    "NODES",
    "NOTABLE_STRAIN",
    "POINT",
    "REASONS_FOR_NO_PREDICTION",
    "SPHERE_OVER_CYLINDER",
    "THICKEST_FILM",
    "AsperityLaw",
    "AsperityTable",
    "EffectiveViscosity",
    "FilmAxes",
    "FilmTable",
    "FilmTablePlan",
    "FlowCurve",
    "FlowFactors",
    "FrictionFactors",
    "GapFactors",
    "LiquidRows",
    "LubricatedBalls",
    "LubricatedFilms",
    "LubricatedPointFilms",
    "PatirCheng",
    "Rheology",
    "ShearThinning",
    "StribeckCurve",
    "TabulatedFlowFactors",
    "TabulatedFriction",
    "TrivialFlowFactors",
    "ViscoelasticFilms",
    "ViscoelasticPointFilms",
    "ViscoelasticStribeckCurve",
    "asperity_law",
    "asperity_table",
    "build_film_table",
    "film_axes",
    "gap_flow_factors",
    "law_of_table",
    "liquid_rows",
    "lubricated_films",
    "lubricated_point_films",
    "stribeck_curve",
    "stribeck_curve_of_liquid",
    "tabulated_flow_factors",
    "tabulated_friction",
    "tabulated_friction_of_liquids",
    "thinned_viscosity",
    "viscoelastic_films",
    "viscoelastic_point_films",
    "viscoelastic_stribeck_curve",
]
