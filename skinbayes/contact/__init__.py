"""Contact mechanics of skin and other solids: layered elasticity, Persson's contact area, yielding, gaps, and Hertz contacts."""

from skinbayes.contact.adhesion import AdhesiveSphere, dmt_contact, jkr_contact, tabor_parameter
from skinbayes.contact.area import persson_contact_area, relative_contact_area
from skinbayes.contact.ball_on_skin import modulus_under_ball
from skinbayes.contact.constant_loss import ConstantLossMaterial
from skinbayes.contact.correction import AREA_CORRECTION, corrected_twice_stress_variance
from skinbayes.contact.counterface import SolidPair
from skinbayes.contact.elastoplastic import ContactArea, elastoplastic_contact_area, total_contact_area
from skinbayes.contact.elliptic_contact import (
    EllipseFactors,
    HertzEllipse,
    cylinder_of_ellipse,
    ellipse_factors,
    elliptic_contact,
)
from skinbayes.contact.gaps import GapDistribution, gap_distribution
from skinbayes.contact.hertz import HertzSphere, sphere_contact, sphere_force, sphere_of_contact
from skinbayes.contact.homogeneous import HomogeneousSolid
from skinbayes.contact.layered import LayeredSkin
from skinbayes.contact.layered_contact import (
    LayeredLine,
    LayeredSphere,
    layered_line_contact,
    layered_sphere_contact,
)
from skinbayes.contact.layers import layered_modulus
from skinbayes.contact.line_contact import (
    EquivalentCylinder,
    HertzLine,
    cylinder_of_contact,
    cylinder_of_sphere,
    line_contact,
)
from skinbayes.contact.separation import mean_separation
from skinbayes.contact.separation_inverse import pressure_at_separation
from skinbayes.contact.solid import (
    ElasticSolid,
    effective_modulus,
    reduced_modulus,
    surface_response,
    validate_solid,
)
from skinbayes.contact.stacked_skin import StackedSkin
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.contact.viscoelastic import Creep, ViscoelasticMaterial
from skinbayes.contact.viscoelastic_indentation import (
    IndentationCycle,
    indentation_creep,
    indentation_cycle,
    indentation_relaxation,
)
from skinbayes.contact.viscoelastic_line_contact import ViscoelasticLine, viscoelastic_line_contact
from skinbayes.contact.viscoelastic_materials import (
    constant_loss_solid,
    material_of_dynamic_moduli,
    standard_linear_solid,
)
from skinbayes.contact.viscoelastic_skin import ViscoelasticSkin

__all__ = [
    "AREA_CORRECTION",
    "AdhesiveSphere",
    "ConstantLossMaterial",
    "ContactArea",
    "Creep",
    "ElasticSolid",
    "EllipseFactors",
    "EquivalentCylinder",
    "GapDistribution",
    "HertzEllipse",
    "HertzLine",
    "HertzSphere",
    "HomogeneousSolid",
    "IndentationCycle",
    "LayeredLine",
    "LayeredSkin",
    "LayeredSphere",
    "SolidPair",
    "StackedSkin",
    "ViscoelasticLine",
    "ViscoelasticMaterial",
    "ViscoelasticSkin",
    "constant_loss_solid",
    "corrected_twice_stress_variance",
    "cylinder_of_contact",
    "cylinder_of_ellipse",
    "cylinder_of_sphere",
    "dmt_contact",
    "effective_modulus",
    "elastoplastic_contact_area",
    "ellipse_factors",
    "elliptic_contact",
    "gap_distribution",
    "indentation_creep",
    "indentation_cycle",
    "indentation_relaxation",
    "jkr_contact",
    "layered_line_contact",
    "layered_modulus",
    "layered_sphere_contact",
    "line_contact",
    "material_of_dynamic_moduli",
    "mean_separation",
    "modulus_under_ball",
    "persson_contact_area",
    "pressure_at_separation",
    "reduced_modulus",
    "relative_contact_area",
    "sphere_contact",
    "sphere_force",
    "sphere_of_contact",
    "standard_linear_solid",
    "surface_response",
    "tabor_parameter",
    "total_contact_area",
    "twice_stress_variance",
    "validate_solid",
    "viscoelastic_line_contact",
]
