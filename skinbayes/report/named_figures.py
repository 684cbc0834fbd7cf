"""Figures of a fit by name, of one experiment or of several."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from skinbayes.errors import InputError
from skinbayes.fit.joint_fit import JointFit
from skinbayes.plot.data import data_abscissas
from skinbayes.report.drawings import TRACE, Drawing, drawings, sampled
from skinbayes.vocabulary import suggestions

if TYPE_CHECKING:
    from skinbayes.fit import Fit


def named_figures(fit: Fit | JointFit) -> dict[str, tuple[Fit, Drawing]]:
    """Every figure of the page of a fit by its name; those of one of several experiments begin with its name and a dot."""
    if not isinstance(fit, JointFit):
        return {drawing.key: (fit, drawing) for drawing in drawings(fit)}
    whole = fit.together
    shared = [*sampled(), *([] if "weighted_posterior" in fit.groups else [TRACE])]
    found = {drawing.key: (whole, drawing) for drawing in shared}
    for name, one in fit.experiments.items():
        found |= {
            f"{name}.{drawing.key}": (one, drawing) for drawing in drawings(one) if drawing.key not in found
        }
    return found


def chosen_figures(
    fit: Fit | JointFit, names: tuple[str, ...], abscissa: str | None
) -> dict[str, tuple[Fit, Drawing, dict[str, Any]]]:
    """The figures asked for by name, ``all`` for every one, with the arguments that they are drawn with.

    Raises
    ------
    InputError
        There is no such figure, or no such condition to draw the data against.
    """
    known = named_figures(fit)
    for name in names:
        if name not in known and name != "all":
            if name.rpartition(".")[2] == "data":
                raise InputError(
                    f"{name[:80]}: no condition of these data differs between rows, or the model is gone; expected "
                    f"one of {', '.join(known)}"
                )
            raise InputError(
                f"no figure {name[:80]!r} of this run.{suggestions(name[:80], list(known))} It has: {', '.join(known)}"
            )
    wanted = list(known) if "all" in names else list(dict.fromkeys(names))
    against = [name for name in wanted if known[name][1].key == "data"]
    if abscissa is not None and not against:
        raise InputError(
            "--against: only the figure of the data is drawn against a condition; expected it with 'data'"
        )
    if abscissa is not None:
        for name in against:
            offered = data_abscissas(known[name][0])
            if abscissa not in offered:
                raise InputError(
                    f"--against: found {abscissa[:80]!r};{suggestions(abscissa[:80], list(offered))} these data can be drawn "
                    f"against {', '.join(offered)}"
                )
    return {
        name: (*known[name], {"abscissa": abscissa} if name in against and abscissa is not None else {})
        for name in wanted
    }
