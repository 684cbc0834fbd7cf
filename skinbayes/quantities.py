"""The quantities of the field: one name, symbol, unit and physical range for each."""

from __future__ import annotations

from math import inf, pi

from skinbayes.quantity import Quantity


def _closed(name: str, symbol: str, unit: str, meaning: str, upper: float = inf) -> Quantity:
    return Quantity(name, symbol, unit, meaning, upper=upper, lower_open=False)


ALL = (
    # skin
    Quantity("frictional_shear_stress", "σ_f", "Pa", "shear stress in the area of real contact"),
    Quantity("young_modulus_layer", "E0", "Pa", "Young's modulus of the stratum corneum"),
    Quantity("young_modulus_bulk", "E1", "Pa", "Young's modulus of the tissue below"),
    Quantity("young_modulus", "E", "Pa", "Young's modulus of a homogeneous solid"),
    Quantity("poisson_ratio", "ν", "1", "Poisson ratio of a homogeneous solid", -1.0, 0.5),
    Quantity("poisson_ratio_layer", "ν0", "1", "Poisson ratio of the stratum corneum", -1.0, 0.5),
    Quantity("poisson_ratio_bulk", "ν1", "1", "Poisson ratio of the tissue below", -1.0, 0.5),
    Quantity("layer_thickness", "d", "m", "thickness of the stratum corneum"),
    Quantity("young_modulus_dermis", "E_d", "Pa", "Young's modulus of viable epidermis and dermis"),
    Quantity("dermis_thickness", "d_d", "m", "thickness of viable epidermis and dermis"),
    Quantity("young_modulus_fat", "E_f", "Pa", "Young's modulus of the fat below the dermis"),
    Quantity("fat_thickness", "d_f", "m", "thickness of the fat below the dermis"),
    Quantity(
        "yield_stress", "σ_Y", "Pa", "penetration hardness; inf is purely elastic", infinite_allowed=True
    ),
    _closed(
        "relaxation_strength_bulk", "Δ1", "1", "instantaneous over relaxed modulus of the tissue, less 1"
    ),
    _closed(
        "relaxation_strength_layer", "Δ0", "1", "instantaneous over relaxed modulus of the layer, less 1"
    ),
    Quantity("relaxation_time_bulk", "τ1", "s", "relaxation time of the tissue at constant strain"),
    Quantity("relaxation_time_layer", "τ0", "s", "relaxation time of the layer at constant strain"),
    Quantity(
        "loss_tangent_bulk",
        "tan δ1",
        "1",
        "tan δ of the tissue, the same at all frequencies",
        0.0,
        1.0,
        lower_open=False,
        upper_open=True,
    ),
    Quantity(
        "loss_tangent_layer",
        "tan δ0",
        "1",
        "tan δ of the layer, the same at all frequencies",
        0.0,
        1.0,
        lower_open=False,
        upper_open=True,
    ),
    Quantity(
        "loss_tangent",
        "tan δ",
        "1",
        "tan δ of a homogeneous solid",
        0.0,
        1.0,
        lower_open=False,
        upper_open=True,
    ),
    Quantity("reference_angular_frequency", "ω_r", "1/s", "at which moduli of constant tan δ are given"),
    # beside a constant shear stress
    _closed(
        "shear_pressure_coefficient",
        "α",
        "1",
        "rise of the shear stress with the pressure in the real contact",
    ),
    _closed("work_of_adhesion", "w", "J/m^2", "work that separates the nominal contact, for its area"),
    # time on the skin
    _closed("dwell_time", "t_d", "s", "time from touching to sliding"),
    Quantity("contact_growth_time", "τ_c", "s", "time in which the real contact grows at rest"),
    _closed("initial_contact_fraction", "f_0", "1", "real contact at once over that after a long dwell", 1.0),
    Quantity(
        "occlusion_time", "τ_o", "s", "time in which the layer softens under a counterface that seals it"
    ),
    Quantity(
        "occluded_modulus_ratio", "r_o", "1", "modulus of the layer after long occlusion over that at once"
    ),
    Quantity(
        "cycle", "n", "1", "number of the stroke on the same place, the first is 1", 1.0, lower_open=False
    ),
    Quantity("run_in_cycles", "N_r", "1", "strokes in which friction runs in"),
    Quantity("run_in_ratio", "r_r", "1", "shear stress of the first stroke over that after many"),
    # roughness
    Quantity("rms_height", "h_rms", "m", "root-mean-square roughness"),
    Quantity(
        "hurst_exponent", "H", "1", "Hurst exponent; fractal dimension 3 − H", 0.0, 1.0, upper_open=True
    ),
    Quantity("wavevector_min", "q0", "1/m", "smallest roughness wavevector"),
    Quantity("wavevector_rolloff", "q_r", "1/m", "end of the plateau of the power spectrum"),
    Quantity("wavevector_max", "q1", "1/m", "largest roughness wavevector"),
    _closed("rms_slope", "s", "1", "root-mean-square slope"),
    Quantity(
        "surface_deviate",
        "z",
        "1",
        "normal score of a roughness parameter among the draws of a surface",
        lower=-inf,
    ),
    Quantity("total_area_ratio", "A_tot/A0", "1", "true area over nominal area", 1.0, lower_open=False),
    Quantity(
        "power_spectral_density", "C", "m^4", "two-dimensional power spectrum of heights, ⟨h²⟩ = 2π∫qC dq"
    ),
    Quantity("spectrum_knot_first", "q_k1", "1/m", "first knot of a free-form spectrum"),
    Quantity("spectrum_knot_last", "q_k6", "1/m", "last knot of a free-form spectrum"),
    *(
        Quantity(
            f"spectrum_factor_{i}",
            f"c{i}",
            "1",
            f"factor on the spectrum at knot {i}, relative to the others",
        )
        for i in range(1, 7)
    ),
    # another rough surface
    Quantity("counterface_rms_height", "h_c", "m", "root-mean-square roughness of the counterface"),
    Quantity(
        "counterface_hurst_exponent",
        "H_c",
        "1",
        "Hurst exponent of the counterface",
        0.0,
        1.0,
        upper_open=True,
    ),
    Quantity("counterface_wavevector_min", "q0_c", "1/m", "smallest roughness wavevector of the counterface"),
    Quantity(
        "counterface_wavevector_rolloff", "q_r,c", "1/m", "end of the plateau of the counterface's spectrum"
    ),
    Quantity("counterface_wavevector_max", "q1_c", "1/m", "largest roughness wavevector of the counterface"),
    Quantity("young_modulus_counterface", "E_c", "Pa", "Young's modulus of the counterface"),
    Quantity("poisson_ratio_counterface", "ν_c", "1", "Poisson ratio of the counterface", -1.0, 0.5),
    # ridges of finger pads
    Quantity("ridge_spacing", "λ_r", "m", "distance from ridge to ridge of a finger pad"),
    Quantity("ridge_width", "w_r", "m", "width of the tops of the ridges"),
    Quantity("ridge_height", "h_r", "m", "height of the ridges above the valleys"),
    # contact
    Quantity("wavevector", "q", "1/m", "roughness wavevector; in a contact the largest one included"),
    Quantity("magnification", "ζ", "1", "q/q0", lower=1.0, upper=inf, lower_open=False),
    Quantity("nominal_pressure", "p0", "Pa", "load over nominal contact area"),
    Quantity("nominal_contact_area", "A0", "m^2", "nominal (projected) contact area"),
    Quantity("nominal_area_ratio", "c_A", "1", "nominal contact area of a pad under 1 N over the area given"),
    Quantity(
        "nominal_area_load_exponent",
        "m_A",
        "1",
        "power of the load with which a pad's contact grows",
        0.0,
        2.0,
        lower_open=False,
    ),
    Quantity(
        "inlet_length", "ℓ", "m", "distance from the edge of the contact up to which liquid fills the gap"
    ),
    _closed("relative_contact_area", "A/A0", "1", "area of real contact over nominal area", 1.0),
    _closed("relative_contact_area_elastic", "A_el/A0", "1", "elastic part of the contact area", 1.0),
    _closed("relative_contact_area_plastic", "A_pl/A0", "1", "plastic part of the contact area", 1.0),
    _closed("plastic_fraction", "A_pl/A", "1", "fraction of the contact area that has yielded", 1.0),
    Quantity("surface_response", "S", "1", "layered response factor: S(0) = E0*/E1*, S(∞) = 1"),
    Quantity("effective_modulus", "E_eff", "Pa", "plane-strain modulus felt by one wavevector, E0*/S"),
    Quantity(
        "area_correction",
        "γ",
        "1",
        "Yang–Persson correction; none (= 1) is plain Persson",
        0.0,
        1.0,
        none_means=1.0,
    ),
    _closed("mean_separation", "ū", "m", "mean interfacial separation"),
    # friction experiment
    _closed("friction_coefficient", "μ", "1", "friction force over normal force"),
    Quantity("normal_force", "F_N", "N", "normal load"),
    _closed("friction_force", "F_f", "N", "force against sliding, or against its beginning"),
    Quantity(
        "number_of_measurements", "n", "1", "measurements whose mean a row holds", lower=1, lower_open=False
    ),
    _closed("sliding_speed", "v", "m/s", "sliding speed"),
    Quantity("sphere_radius", "R", "m", "radius of the sphere"),
    _closed("indentation_depth", "δ", "m", "depth to which a ball is pressed into the skin"),
    _closed("indentation_force", "F_δ", "N", "force that presses a ball to the indentation depth"),
    Quantity("indentation_rate", "dδ/dt", "m/s", "speed at which a ball is pressed in, and drawn back"),
    _closed(
        "indentation_loss_fraction",
        "W_loss/W",
        "1",
        "work lost in pressing in and drawing back over that of pressing in",
        1.0,
    ),
    Quantity("viscosity", "η", "Pa s", "dynamic viscosity"),
    _closed("shear_rate", "γ̇", "1/s", "shear rate"),
    _closed("speed_viscosity_product", "ηv", "N/m", "viscosity times sliding speed"),
    Quantity("velocity_shift_factor", "a", "1", "theory is evaluated at a·ηv"),
    Quantity(
        "inlet_film_limit",
        "3πηv/f_N",
        "1",
        "largest 3π ηv over load per length at which friction is predicted",
    ),
    Quantity(
        "strain_limit",
        "b/Rc",
        "1",
        "largest half width of the contact over radius at which friction is predicted",
    ),
    _closed(
        "additive_friction", "μ_add", "1", "friction that adds to that of the theory, whatever the speed"
    ),
    _closed(
        "friction_coefficient_boundary", "μ_b", "1", "part of the friction made in the area of real contact"
    ),
    _closed(
        "friction_coefficient_couette", "μ_c", "1", "part of the friction made by shear flow of the lubricant"
    ),
    Quantity(
        "friction_coefficient_pressure_flow", "μ_p", "1", "part of the friction made by pressure flow", -inf
    ),
    _closed(
        "friction_coefficient_hysteresis", "μ_h", "1", "part of the friction made by the loss of the tissue"
    ),
    _closed(
        "friction_coefficient_pressure",
        "μ_α",
        "1",
        "part of the friction made by shear stress that rises with the pressure",
    ),
    _closed("asperity_load_fraction", "φ_a", "1", "fraction of the load that asperities carry", 1.0),
    _closed("minimum_film_thickness", "u_min", "m", "smallest mean separation of lubricated surfaces"),
    _closed("central_film_thickness", "u_c", "m", "mean separation under the middle of the ball"),
    # descriptions of friction without a theory
    Quantity("typical_friction_coefficient", "μ_typ", "1", "friction coefficient that depends on nothing"),
    Quantity(
        "plateau_friction_coefficient", "μ_0", "1", "friction coefficient at small speed times viscosity"
    ),
    Quantity(
        "transition_speed_viscosity_product",
        "S_t",
        "N/m",
        "speed times viscosity at which friction leaves its plateau, at a load of 1 N",
    ),
    Quantity("transition_exponent", "a_t", "1", "how abruptly friction leaves its plateau"),
    Quantity(
        "transition_load_exponent", "m_t", "1", "power of the load with which the transition moves", -inf
    ),
    Quantity("rising_friction_coefficient", "μ_r", "1", "friction of the rising branch at the transition"),
    Quantity("rising_exponent", "b_r", "1", "power of speed times viscosity with which friction rises"),
    # water
    Quantity("surface_tension", "γ_w", "N/m", "surface tension of the liquid"),
    _closed("contact_angle_skin", "θ1", "rad", "contact angle of the liquid on skin", pi),
    _closed("contact_angle_counterface", "θ2", "rad", "contact angle of the liquid on the counterface", pi),
    _closed("film_thickness", "d_film", "m", "average thickness of the water film"),
    _closed("evaporation_rate", "ḋ", "m/s", "thickness evaporated per time"),
    _closed("relative_humidity", "RH", "1", "relative humidity", 1.0),
    Quantity("temperature", "T", "K", "temperature of air and skin, where both have the same"),
    _closed("time", "t", "s", "time"),
    Quantity(
        "kelvin_radius",
        "r_K",
        "m",
        "radius of curvature of water in equilibrium with humid air; inf is saturated air",
        infinite_allowed=True,
    ),
    Quantity("kelvin_gap", "d_K", "m", "largest gap that a capillary bridge spans"),
    _closed("capillary_pressure", "p_a", "Pa", "force of the capillary bridges over nominal contact area"),
    _closed("wet_area", "A_wet/A0", "1", "area between the surfaces that is wet over nominal area", 1.0),
    _closed("mean_separation_wet", "ū_wet", "m", "mean interfacial separation in the wet area"),
    _closed("droplet_volume", "ΔV", "m^3", "volume of the droplet that wets the track"),
    Quantity("stroke_length", "L", "m", "length of the sliding track"),
    Quantity("contact_width", "D", "m", "width of the sliding track"),
    Quantity("surface_temperature", "T_s", "K", "temperature of the skin, or of the water on it"),
    Quantity("air_temperature", "T_a", "K", "temperature of the air in which the humidity was measured"),
    Quantity("latent_heat", "Y", "J/kg", "latent heat of evaporation of water"),
    _closed("air_speed", "v_air", "m/s", "speed of the air over the water"),
    # drying
    _closed("wetting_time", "t_wet", "s", "time at which the skin is wetted"),
    _closed("initial_film", "d_0", "m", "average thickness of the water film right after wetting"),
    _closed("film_spread", "σ_film", "m", "standard deviation of the film thickness over the track"),
    Quantity("film_floor", "d_floor", "m", "film thickness below which skin counts as dry"),
    Quantity("young_modulus_layer_dry", "E_dry", "Pa", "Young's modulus of the dry stratum corneum"),
    Quantity("hardening_film", "d_h", "m", "film thickness at which ln E0 is half way between wet and dry"),
    Quantity("hardening_sharpness", "k_h", "1", "how abruptly the stratum corneum hardens"),
    _closed("peak_time", "t_peak", "s", "time of the largest friction while the film evaporates"),
    _closed("peak_friction", "μ_peak", "1", "largest friction coefficient while the film evaporates"),
    _closed("peak_width", "Δt_peak", "s", "time between the half heights of the friction peak"),
    _closed("wet_plateau", "μ_wet", "1", "friction coefficient of flooded skin"),
    _closed("dry_friction", "μ_dry", "1", "friction coefficient of dry skin"),
    _closed("dry_time", "t_dry", "s", "time at which the film is gone"),
    # humid air
    Quantity(
        "young_modulus_layer_wet", "E_wet", "Pa", "Young's modulus of the stratum corneum in saturated air"
    ),
    Quantity(
        "transition_humidity",
        "RH_t",
        "1",
        "relative humidity at which ln E0 is half way between dry and wet",
        0.0,
        1.0,
        upper_open=True,
    ),
    Quantity("transition_sharpness", "k_t", "1", "how abruptly the stratum corneum softens with humidity"),
    # people
    _closed("skin_hydration", "hydration", "1", "corneometer reading, arbitrary units"),
    # groups of data
    _closed(
        "group_scale",
        "σ_g",
        "1",
        "standard deviation of effects that groups of data share, of ln if the noise is logarithmic",
    ),
    # populations of people
    _closed(
        "population_scale",
        "σ_p",
        "1",
        "standard deviation of a parameter between people, of its ln if it is positive",
    ),
    Quantity("population_deviate", "z_p", "1", "normal score of one person in the population", lower=-inf),
    Quantity(
        "contrast", "δ", "1", "what a treatment adds to a parameter, to its ln if it is positive", lower=-inf
    ),
    _closed("contrast_scale", "σ_δ", "1", "standard deviation of what a treatment adds, between people"),
    Quantity("covariate_exponent", "k", "1", "power with which a column of the data acts", lower=-inf),
    # what rows along a column share
    _closed(
        "discrepancy_size",
        "s_δ",
        "1",
        "standard deviation of the smooth curve that the theory misses, of ln if the noise is logarithmic",
    ),
    Quantity(
        "discrepancy_length", "l_δ", "1", "length of that curve as a fraction of the range of the column"
    ),
    Quantity(
        "correlation_length", "l_c", "1", "distance over which the correlation of the noise falls to 1/e"
    ),
    Quantity(
        "independent_fraction",
        "f_i",
        "1",
        "fraction of the variance of correlated noise that is independent from row to row",
        upper=1.0,
        upper_open=True,
    ),
    _closed(
        "drift_scale",
        "s_d",
        "1",
        "standard deviation of a linear drift over the longest series, of ln if the noise is logarithmic",
    ),
    # noise and discrepancy
    _closed("noise_scale", "σ_noise", "1", "scale of the scatter about the forward model"),
    Quantity("degrees_of_freedom", "ν_t", "1", "degrees of freedom of Student's t"),
    Quantity(
        "discrepancy_factor",
        "δ",
        "1",
        "factor by which truth exceeds the forward model, the same in all rows",
    ),
    Quantity(
        "discrepancy_scale", "σ_δ", "1", "scatter of the truth about the forward model, relative, row by row"
    ),
)
"""Every quantity of the field that is known from the beginning."""
