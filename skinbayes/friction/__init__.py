"""From the area of real contact to friction: shear stress, loss of the tissue, and what time on the skin does to them."""

from skinbayes.friction.coefficient import friction_coefficient
from skinbayes.friction.relaxation import contact_after_dwell, occluded_modulus, run_in_factor
from skinbayes.friction.terms import ball_hysteresis, shear_stress_under_pressure

__all__ = [
    "ball_hysteresis",
    "contact_after_dwell",
    "friction_coefficient",
    "occluded_modulus",
    "run_in_factor",
    "shear_stress_under_pressure",
]
