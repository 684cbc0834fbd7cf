"""The draws of a fit and what is computed from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.files.population_block import DEVIATE, POPULATION_PARAMETERS
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    import pandas
    import xarray

    from skinbayes.problem import JointProblem, Problem


@dataclass(frozen=True)
class PosteriorResult:
    """Posterior draws and everything computed from them.

    Attributes
    ----------
    groups : the groups of the ArviZ schema by name, each an ``xarray.Dataset``: ``posterior`` (free parameters, and derived
        quantities marked ``kind = derived``), ``sample_stats``, ``prior``, ``prior_predictive``,
        ``posterior_predictive``, ``log_likelihood``, ``observed_data``, ``constant_data``. All draws weigh the same; what an
        engine with weights made is kept in ``weighted_posterior``. Of ``emcee`` a chain is an ensemble; its draws
        are thinned to near independence and ordered in time. All values in SI.
    provenance : versions, model text, data source, and under ``sampling`` engine, seed and its diagnostics by name

    Examples
    --------
    Examples of methods go on from this one. Its draws are those of the prior, which are quick to make.

    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-water")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 500))
    >>> fit.name, fit.names[0]
    ('finger-water', 'frictional_shear_stress')
    """

    groups: Mapping[str, xarray.Dataset]
    provenance: Mapping[str, Any]

    @property
    def name(self) -> str:
        """Name of the model."""
        return str(self.provenance["model"])

    @property
    def converged(self) -> bool:
        """Whether the stopping rule was met."""
        return bool(self.provenance["sampling"]["converged"])

    @property
    def names(self) -> tuple[str, ...]:
        """Labels of the free parameters: ``name`` or ``name[level]``."""
        return tuple(self.provenance["names"])

    @property
    def shown_names(self) -> tuple[str, ...]:
        """Labels of the free parameters without the normal scores of single people, whose values :meth:`people_labels` names."""
        return tuple(label for label in self.names if label.partition("[")[0] != DEVIATE)

    def people_labels(self) -> tuple[str, ...]:
        """What is known of each person of a population, and of what treatments do.

        Returns
        -------
        tuple of str
            Such as ``person_young_modulus_layer[ID01]`` and ``young_modulus_layer_ratio[after/before]``; empty if no parameter
            has a population.

        Examples
        --------
        >>> fit.people_labels()
        ()
        """
        return tuple(
            f"{name}[{level}]"
            for name, variable in self.groups["posterior"].data_vars.items()
            if variable.attrs.get("kind") == "person"
            for level in variable[variable.dims[-1]].values
        )

    def draws(self, label: str, group: str = "posterior") -> FloatArray:
        """All draws of one parameter or derived quantity.

        Parameters
        ----------
        label : ``name``, or ``name[level]`` where it differs by level or row
        group : of :attr:`groups`, such as ``"prior"``

        Returns
        -------
        ndarray
            Shape ``(draws,)``, chain after chain, SI.

        Raises
        ------
        KeyError
            No such group or quantity.

        Examples
        --------
        >>> fit.draws("young_modulus_layer").shape
        (500,)
        """
        name, _, level = label.partition("[")
        variable = self.groups[group][name]
        if level:
            extra = next(str(dimension) for dimension in variable.dims if dimension not in ("chain", "draw"))
            variable = variable.sel({extra: level.removesuffix("]")})
        return np.asarray(variable.values, dtype=float).reshape(-1)

    def quantiles(
        self, label: str, probabilities: ArrayLike = (0.05, 0.5, 0.95), group: str = "posterior"
    ) -> FloatArray:
        """Quantiles of one parameter or derived quantity; those of parameters with the weights, where draws have any.

        Parameters
        ----------
        label : ``name`` or ``name[level]``
        probabilities : between 0 and 1, any shape
        group : of :attr:`groups`, such as ``"prior"``

        Returns
        -------
        ndarray
            Shape of ``probabilities``, SI.

        Examples
        --------
        >>> low, median, high = fit.quantiles("young_modulus_layer")
        >>> bool(low < median < high)
        True
        """
        weighted = self.groups.get("weighted_posterior") if group == "posterior" else None
        if weighted is None or label not in self.names:
            return np.asarray(np.quantile(self.draws(label, group), np.asarray(probabilities, dtype=float)))
        from skinbayes.sampling.draws import weighted_quantiles

        values = weighted["theta"].values[..., self.names.index(label)].ravel()
        log_weights = weighted["log_weight"].values.ravel()
        return weighted_quantiles(values, np.exp(log_weights - log_weights.max()), probabilities)

    def theta(self, group: str = "posterior") -> FloatArray:
        """Draws of all free parameters as vectors.

        Parameters
        ----------
        group : of :attr:`groups`, such as ``"prior"``

        Returns
        -------
        ndarray
            Shape ``(draws, D)``, in the order of :attr:`names`, SI.

        Examples
        --------
        >>> fit.theta().shape
        (500, 5)
        """
        return np.stack([self.draws(label, group) for label in self.names], axis=-1)

    def derived_labels(self) -> tuple[str, ...]:
        """Derived quantities that the data leave uncertain.

        Returns
        -------
        tuple of str
            Their labels: ``name``, or ``name[row]`` for each row where they differ by row.

        Examples
        --------
        >>> fit.derived_labels()[:2]
        ('rms_slope', 'relative_contact_area[ID01]')
        """
        labels: list[str] = []
        for name, variable in self.groups["posterior"].data_vars.items():
            if variable.attrs.get("kind") != "derived":
                continue
            extra = [dimension for dimension in variable.dims if dimension not in ("chain", "draw")]
            levels = [f"[{level}]" for level in variable[extra[0]].values] if extra else [""]
            labels += [
                label for label in (f"{name}{level}" for level in levels) if np.ptp(self.draws(label)) > 0
            ]
        return tuple(labels)

    def summary(self, derived: bool = False) -> pandas.DataFrame:
        """Table of posterior quantiles and convergence.

        Parameters
        ----------
        derived : also list derived quantities, and what is known of each person (without an effective sample size of their own)

        Returns
        -------
        pandas.DataFrame
            Index: label. Columns: ``unit``, ``median``, ``q05``, ``q95`` (SI), of ``ess_bulk``, ``ess_tail`` and
            ``r_hat`` those that the engine has, and the prior's ``prior_median``, ``prior_q05``, ``prior_q95``. An
            effective sample size is nan where the run was too short to know it.

        Examples
        --------
        >>> fit.summary().loc["layer_thickness", "unit"]
        'm'
        """
        import pandas

        rows: dict[str, dict[str, Any]] = {}
        sampling = self.provenance["sampling"]
        also = (*self.people_labels(), *self.derived_labels()) if derived else ()
        for label in (*self.shown_names, *also):
            q05, median, q95 = self.quantiles(label)
            prior05, prior50, prior95 = self.quantiles(label, group="prior")
            place = self.names.index(label) if label in self.names else None
            rows[label] = {
                "unit": self.unit(label),
                "median": median,
                "q05": q05,
                "q95": q95,
                # an effective size of 0 is said where the autocorrelation has not died out: then it is not known
                **{
                    name: np.nan if place is None else sampling[name][place] or np.nan
                    for name in ("ess_bulk", "ess_tail", "r_hat")
                    if name in sampling
                },
                "prior_median": prior50,
                "prior_q05": prior05,
                "prior_q95": prior95,
            }
        return pandas.DataFrame.from_dict(rows, orient="index")

    def unit(self, label: str) -> str:
        """SI unit of a parameter or derived quantity.

        Parameters
        ----------
        label : ``name`` or ``name[level]``

        Returns
        -------
        str
            ``"1"`` for a number without dimension.

        Examples
        --------
        >>> fit.unit("young_modulus_layer")
        'Pa'
        """
        return str(self.groups["posterior"][label.partition("[")[0]].attrs.get("units", "1"))

    def symbol(self, label: str) -> str:
        """Symbol of a parameter or derived quantity, with its level.

        Parameters
        ----------
        label : ``name`` or ``name[level]``

        Returns
        -------
        str
            Plain text, such as ``"E0 (wet)"``.

        Examples
        --------
        >>> fit.symbol("young_modulus_layer")
        'E0'
        """
        name, _, level = label.partition("[")
        block = self.provenance.get("derived_symbols", {}).get(name, "")
        symbol = block or str(self.groups["posterior"][name].attrs.get("symbol", name))
        level = level.removesuffix("]")
        if name in POPULATION_PARAMETERS:  # of which parameter comes first
            of, comma, rest = level.partition(", ")
            level = f"{self.symbol(of) if of in self.names else QUANTITIES[of].symbol}{comma}{rest}"
        return f"{symbol} ({level})" if level else symbol

    def to_arviz(self) -> Any:
        """The result as ArviZ knows it.

        Returns
        -------
        arviz.InferenceData or xarray.DataTree
            The first for ArviZ below 1, the second from 1 on.

        Examples
        --------
        >>> fit.to_arviz().posterior["young_modulus_layer"].shape
        (1, 500)
        """
        from skinbayes.fit.arviz_adapter import to_arviz

        return to_arviz({name: group for name, group in self.groups.items() if "." not in name})

    def cite(self, style: Literal["text", "bibtex"] = "text") -> list[str]:
        """What to cite: the theory that the model used, the data, the methods and this software.

        Parameters
        ----------
        style : ``"text"``, one line each, or ``"bibtex"``, one entry each

        Returns
        -------
        list of str
            One text for each work.

        Raises
        ------
        InputError
            Another style.

        Examples
        --------
        >>> print(fit.cite("bibtex")[-1])
        @software{skinbayes,
          author = {{The skinbayes developers}},
          title = {{skinbayes: Bayesian inference of skin mechanics from friction data}},
          version = {0.1.0},
          note = {this software},
        }
        """
        from skinbayes.fit.bibliography import Reference

        if style not in ("text", "bibtex"):
            raise InputError(f"style: found {style!r}; expected 'text' or 'bibtex'")
        known = [Reference(**entry) for entry in self.provenance["references"]]
        return [reference.text() if style == "text" else reference.bibtex() for reference in known]


@dataclass(frozen=True)
class FitResult(PosteriorResult):
    """Posterior draws of a problem and everything computed from them.

    Attributes
    ----------
    groups, provenance : see :class:`PosteriorResult`
    problem : the problem, or None if the result was read from a file whose model or data are gone
    """

    problem: Problem | None = None


@dataclass(frozen=True)
class JointResult(PosteriorResult):
    """Posterior draws of several experiments and everything computed from them.

    Attributes
    ----------
    groups, provenance : see :class:`PosteriorResult`
    problem : the problem, or None if the result was read from a file whose model or data are gone
    """

    problem: JointProblem | None = None
