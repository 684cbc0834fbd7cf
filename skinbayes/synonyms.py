"""What people call the quantities and labels of the vocabulary: for suggestions, never to be read in silence."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection
from difflib import get_close_matches

_SYNONYMS = {
    "friction_coefficient": "mu cof friction friction_coeff friction_factor coefficient_of_friction coeff_of_friction "
    "friction_coefficient_mu dynamic_friction kinetic_friction mean_friction cof_mean mu_mean static_friction",
    "normal_force": "load force normal_load applied_load applied_force contact_force fn f_n f_normal force_normal weight",
    "friction_force": "tangential_force lateral_force shear_force frictional_force force_tangential f_f f_t ft",
    "number_of_measurements": "number_of_readings number_of_repeats number_of_replicates n_measurements sample_size",
    "sphere_radius": "radius ball_radius probe_radius tip_radius indenter_radius sphere_r radius_of_curvature",
    "sliding_speed": "velocity speed sliding_velocity sliding_rate stroke_speed v_slide",
    "indentation_depth": "depth indentation displacement penetration penetration_depth indentation_displacement",
    "indentation_force": "reaction_force indenter_force indentation_load",
    "viscosity": "eta visc dynamic_viscosity shear_viscosity",
    "shear_rate": "gamma_dot gammadot strain_rate rate_of_shear",
    "speed_viscosity_product": "eta_v etav viscosity_speed_product viscosity_times_speed",
    "temperature": "temp skin_temperature t_skin",
    "air_temperature": "room_temperature ambient_temperature t_air",
    "relative_humidity": "rh humidity hum rel_humidity air_humidity ambient_humidity",
    "time": "t elapsed elapsed_time time_after_wetting duration",
    "nominal_pressure": "pressure contact_pressure mean_pressure p_0",
    "nominal_contact_area": "contact_area area apparent_area apparent_contact_area nominal_area",
    "relative_contact_area": "contact_area real_contact_area area_ratio area_fraction",
    "frictional_shear_stress": "shear_stress tau shear_strength interfacial_shear_strength interfacial_shear_stress sigma_f",
    "young_modulus_layer": "young_modulus youngs_modulus young_s_modulus modulus elastic_modulus layer_modulus modulus_layer "
    "stratum_corneum_modulus youngs_modulus_layer e_0 e_layer e_sc",
    "young_modulus_bulk": "young_modulus youngs_modulus young_s_modulus modulus elastic_modulus bulk_modulus_of_elasticity "
    "tissue_modulus dermis_modulus modulus_bulk youngs_modulus_bulk e_1 e_bulk e_tissue",
    "poisson_ratio_layer": "poisson poisson_ratio nu poissons_ratio",
    "poisson_ratio_bulk": "poisson poisson_ratio nu poissons_ratio",
    "yield_stress": "hardness yield_strength indentation_hardness penetration_hardness sigma_y",
    "layer_thickness": "thickness stratum_corneum_thickness sc_thickness",
    "rms_height": "roughness rq sq rms rms_roughness roughness_rms h_rms",
    "hurst_exponent": "hurst roughness_exponent",
    "wavevector": "wavenumber wave_number wave_vector",
    "surface_tension": "surface_energy gamma_w",
    "contact_angle_skin": "contact_angle angle theta water_contact_angle",
    "contact_angle_counterface": "contact_angle theta angle_glass contact_angle_glass",
    "film_thickness": "film water_film water_film_thickness water_thickness d_film",
    "droplet_volume": "volume drop_volume water_volume",
    "evaporation_rate": "evaporation drying_rate",
    "skin_hydration": "hydration moisture corneometer corneometry skin_moisture",
    "noise_scale": "noise sigma sd std scatter noise_sigma",
    "degrees_of_freedom": "dof df",
    "person": "subject participant volunteer individual patient donor proband panelist panellist subject_id participant_id "
    "person_id subject_no subject_number",
    "body_site": "site location body_location body_part skin_site anatomical_site body_region region measurement_site",
    "liquid": "lubricant fluid oil solution",
    "counterface": "material counter_surface countersurface counterbody counter_body probe_material substrate slider",
    "state": "condition skin_state skin_condition wetness hydration_state",
    "source": "reference ref study paper",
    "plastic_fraction": "plastic_share",
    "asperity_load_fraction": "asperity_load_share load_share",
}  # fmt: skip
"""Name to what people write for it, in small letters with underscores."""

_OTHERWISE = {
    "sphere_radius": (
        "half of the diameter: halve the values",
        "diameter sphere_diameter ball_diameter probe_diameter tip_diameter indenter_diameter",
    ),
    "viscosity": ("the kinematic viscosity times the density", "kinematic_viscosity"),
    "hurst_exponent": ("3 minus the fractal dimension", "fractal_dimension"),
    "rms_height": ("the root-mean-square height, which is larger than the mean height Ra", "ra sa mean_roughness roughness_ra"),
    "speed_viscosity_product": (
        "not divided by a load: multiply by it",
        "hersey hersey_number stribeck_number sommerfeld_number",
    ),
    "wavevector": ("2π over the wavelength", "wavelength spatial_frequency"),
    "sliding_speed": ("2π times the radius times the rotations per time", "rpm rotation_speed rotational_speed"),
}  # fmt: skip
"""Name to what it is instead of something else that people write, and what that is called."""

_SPREAD = re.compile(
    r"(?:(?P<before>sd|std|stdev|sigma|err|error|uncertainty)_(?:of_)?)?(?P<base>.+?)"
    r"(?:_(?P<after>sd|s_d|std|stdev|stddev|std_dev|st_dev|sigma|se|sem|std_err|stderr|standard_error|err|error|unc|uncertainty|"
    r"spread|standard_dev|deviation))?"
)
_ERRORS = ("se", "sem", "std_err", "stderr", "standard_error")
_CUTOFF = 0.75


def plain_name(name: str) -> str:
    """A name in small letters with underscores, compatibility forms of letters resolved.

    Examples
    --------
    >>> plain_name(" Friction Coefficient"), plain_name("Young's modulus")
    ('friction_coefficient', 'youngs_modulus')
    """
    text = unicodedata.normalize("NFKC", name).replace("'", "").replace("’", "")
    return re.sub(r"[\s_.,:/-]+", "_", text).strip("_").lower()


def likely_meant(
    name: str, known: Collection[str], symbols: dict[str, str], spreads: tuple[str, str], near: bool = True
) -> list[tuple[str, str]]:
    """Which of the known names is meant by one that is not among them, the likeliest first, each with a remark or ``""``.

    Parameters
    ----------
    name : as it was written
    known : names that would be understood
    symbols : symbols in equations to names
    spreads : endings of names of standard deviations and of standard errors
    near : whether names that are only written alike count

    Examples
    --------
    >>> likely_meant("COF", ["friction_coefficient"], {}, ("_sd", "_se"))
    [('friction_coefficient', '')]
    >>> likely_meant("ball diameter", ["sphere_radius"], {}, ("_sd", "_se"))
    [('sphere_radius', 'half of the diameter: halve the values')]
    """
    plain = plain_name(name[:80])
    plain_names = {plain_name(one): one for one in known}
    bare = {re.sub("[^a-z0-9]", "", one): written for one, written in plain_names.items()}

    def called(name: str, plain: str) -> list[tuple[str, str]]:
        """The known names that this is: written otherwise, as a symbol, or by a synonym."""
        if plain in plain_names:
            return [(plain_names[plain], "")]
        if len(plain) > 3 and (joined := re.sub("[^a-z0-9]", "", plain)) in bare:
            return [(bare[joined], "")]
        symbol = unicodedata.normalize("NFKC", name)
        for written, quantity in symbols.items():
            if symbol in (written, written.replace("_", "")) and quantity in known:
                return [(quantity, "")]
        meanings = [(one, "", words) for one, words in _SYNONYMS.items()]
        meanings += [(one, why, words) for one, (why, words) in _OTHERWISE.items()]
        return [(one, why) for one, why, words in meanings if one in known and plain in words.split()][:2]

    found = called(name.strip(), plain)
    split = _SPREAD.fullmatch(plain)
    if not found and split is not None and (split["before"] or split["after"]):
        spread = spreads[split["after"] in _ERRORS]
        of_base = called(split["base"], split["base"])
        found = [(one + spread, "") for one, why in of_base if not why and not one.endswith(spreads)]
    if not found and near and len(plain) > 2:
        close = get_close_matches(plain, list(plain_names), n=2, cutoff=_CUTOFF)
        words = set(plain.split("_"))
        parts = [one for one in plain_names if len(plain) > 3 and words <= set(one.split("_"))]
        found = [(plain_names[one], "") for one in (close or (parts if len(parts) <= 2 else []))]
    return found
