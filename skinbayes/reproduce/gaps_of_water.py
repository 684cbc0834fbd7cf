"""Misprints and gaps of Sect. 5: droplet, evaporation, bridges."""

from __future__ import annotations

import numpy as np

from skinbayes.phrases import number
from skinbayes.reproduce.bridges import flooded_separation, pull
from skinbayes.reproduce.demonstration import Demonstration
from skinbayes.reproduce.drying import hertz_diameter
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.shown import printed_text
from skinbayes.reproduce.statements import printed_value, statements
from skinbayes.wetting import film_of_droplet, latent_heat_of_evaporation


def droplet(paper: Paper) -> Demonstration:
    """The film of the droplet."""
    diameter, printed = hertz_diameter(paper, "ball-load"), printed_value("droplet-film")
    stated = printed_value("contact-width")

    def film(width: float) -> float:
        return float(film_of_droplet(paper["droplet-volume"], paper["stroke-length"], contact_width=width))

    asked = paper["droplet-volume"] / (paper["stroke-length"] * printed)
    widths = {"stated width": stated, "diameter of the Hertz contact": diameter, "what 90 µm ask for": asked}
    return Demonstration(
        id="droplet",
        title="The droplet does not make a film of 90 µm on the stated track",
        where="Sect. 5",
        text="50 µl on 8 cm times 0.8 cm are 78 µm, on a track as wide as the contact 65 µm. The times in "
        "the last column are those of the evaporation rate; the paper has 500 s.",
        headers=("track", "width", "film", "evaporates in"),
        rows=tuple(
            (name, f"{number(1e3 * width)} mm", f"{number(1e6 * film(width))} µm",
             f"{number(film(width) / paper.evaporation)} s")
            for name, width in widths.items()
        ),
    )  # fmt: skip


def time(paper: Paper) -> Demonstration:
    """The time of 76 s."""
    films = {
        "14 µm, as stated": printed_value("flooding-film-abstract"),
        "13 µm, mean separation in the text": printed_value("separation-without"),
        "ū(p0) computed": flooded_separation(paper),
    }
    rounded = printed_value("evaporation-rate")
    return Demonstration(
        id="seventy-six-seconds",
        title="14 µm of water do not evaporate in 76 s",
        where="Sect. 5, below Eq. 8; abstract",
        text="76 s are what 13 µm take at the rounded rate. The abstract rounds the same time to 100 s.",
        headers=("film", "at the rate of Eq. 8", "at the rounded 1.7 × 10⁻⁷ m/s"),
        rows=tuple(
            (name, f"{number(film / paper.evaporation)} s", f"{number(film / rounded)} s")
            for name, film in films.items()
        ),
    )


def heat(paper: Paper) -> Demonstration:
    """The latent heat."""
    own = float(latent_heat_of_evaporation(paper["skin-temperature"]))
    heats = {"printed": paper["latent-heat-used"], "water at the temperature of skin": own}
    return Demonstration(
        id="latent-heat",
        title="The latent heat is that of water near its boiling point",
        where="Sect. 5, Eq. 8",
        text="Water has the printed one at 94 °C. It makes the evaporation 6 % too fast.",
        headers=("latent heat", "kJ/kg", "rate"),
        rows=tuple(
            (
                name,
                number(heat / 1e3, 4),
                f"{number(paper.evaporation * paper['latent-heat-used'] / heat)} m/s",
            )
            for name, heat in heats.items()
        ),
    )


_PRINTED = ("capillary-pressure", "film-at-strongest", "separation-with")


def capillary(paper: Paper) -> Demonstration:
    """The strength of the bridges."""
    rows = []
    for closure, name in (("gaussian", "Gaussian"), ("sharp", "sharp")):
        for angle in ("angle-glass", "angle-glass-red"):
            state = paper.strongest(angle=angle, closure=closure)
            rows.append(
                (
                    f"{name} gaps, {number(np.degrees(paper[angle]))}° on glass",
                    number(pull(state, paper)),
                    f"{number(1e6 * float(state.film_thickness))} µm",
                    f"{number(1e6 * float(state.mean_separation))} µm",
                )
            )
    return Demonstration(
        id="gaps",
        title="How the gaps are distributed is not said, and decides the capillary pressure",
        where="Sect. 5; Figs. 8 to 10",
        text="Taking one sharp separation at each magnification gives a stronger pull, which agrees with the printed 0.7 at 20°; "
        "spreading the gaps as boundary elements do gives a weaker one. Neither brings the separation down to 10 µm.",
        headers=("closure", "p_a/p0", "film", "ū"),
        rows=[*rows, ("printed", *(printed_text(statements()[name].words) for name in _PRINTED))],
    )
