"""Stribeck curves and tables of the cylinder of Eq. 9, which is the paper's and quick to solve."""

from functools import partial

from skinbayes import lubrication

stribeck_curve = partial(lubrication.stribeck_curve, contact="line")
stribeck_curve_of_liquid = partial(lubrication.stribeck_curve_of_liquid, contact="line")
FilmTablePlan = partial(lubrication.FilmTablePlan, contact="line")
