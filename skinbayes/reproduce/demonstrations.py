"""Misprints and gaps of the paper, each shown by computing both ways."""

from __future__ import annotations

from collections.abc import Callable

from skinbayes.reproduce import gap_of_surface, gaps_of_contact, gaps_of_sliding, gaps_of_water
from skinbayes.reproduce.demonstration import Demonstration
from skinbayes.reproduce.paper import Paper

ALL: tuple[Callable[[Paper], Demonstration], ...] = (
    gaps_of_contact.surface,
    gaps_of_contact.wet_area,
    gap_of_surface.what_was_used,
    gaps_of_contact.dry_friction,
    gaps_of_water.droplet,
    gaps_of_water.capillary,
    gaps_of_water.heat,
    gaps_of_water.time,
    gaps_of_contact.square,
    gaps_of_sliding.shift,
    gaps_of_sliding.flow,
)


def demonstrations(paper: Paper | None = None) -> list[Demonstration]:
    """Misprints and gaps of the paper with the numbers that show them.

    Parameters
    ----------
    paper : the cases of the paper; None for those of its numbers

    Returns
    -------
    list of Demonstration
        In the order of the paper
    """
    cases = paper or Paper()
    return [show(cases) for show in ALL]
