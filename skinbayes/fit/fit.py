"""The result of a fit, with its figures and its files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.arrays import ArrayLike
from skinbayes.atomic import write_atomically
from skinbayes.fit.drawn_fit import DrawnFit
from skinbayes.fit.netcdf import result_image

if TYPE_CHECKING:
    from skinbayes.files.dataset import Data
    from skinbayes.fit.design import Design
    from skinbayes.fit.prediction import Prediction
    from skinbayes.problem import Problem


@dataclass(frozen=True, repr=False)
class Fit(DrawnFit):
    """Posterior draws of a problem and everything computed from them.

    Its attributes, and what is computed from them, are those of :class:`~skinbayes.fit.result.FitResult`.

    Attributes
    ----------
    groups, provenance, problem : see :class:`~skinbayes.fit.result.FitResult`

    Examples
    --------
    Examples of methods go on from this one. Its draws are those of the prior, which are quick to make.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 100))
    >>> fit.names[0]
    'typical_friction_coefficient'
    """

    def __repr__(self) -> str:
        return f"Fit of '{self.name}': {self.provenance['sampling']['verdict']}"

    @classmethod
    def from_draws(
        cls, problem: Problem, samples: Any, log_weights: ArrayLike | None = None, seed: int = 1
    ) -> Fit:
        """The whole result from draws of any sampler.

        Parameters
        ----------
        problem : a problem with data
        samples : draws of the free parameters in SI: an array ``(draws, D)`` or ``(chains, draws, D)`` in the order of
            ``problem.names``; or by name, each ``(draws,)`` or ``(chains, draws)``: a mapping, a data frame, an
            ``xarray.Dataset``, or what has one as ``posterior`` (``InferenceData``, ``DataTree``). Levels of a parameter are
            ``name[level]``, or a dimension of ``name`` with labels. Other variables are left aside
        log_weights : ln of the weights up to a constant, shape ``(draws,)`` or ``(chains, draws)``; None if all weigh the same
        seed : non-negative integer, for predictive draws and the resampling of weighted ones

        Returns
        -------
        Fit
            ``converged`` if the effective sample size is at least 400 in every parameter and R-hat at most 1.01

        Raises
        ------
        InputError
            Draws of a parameter are missing, lie outside its prior, or shapes do not fit.

        Examples
        --------
        >>> import skinbayes as sb
        >>> problem = sb.load_problem("forearm-glass")
        >>> import numpy as np
        >>> before = problem.draw_prior(np.random.default_rng(1), 2000)
        >>> fit = sb.Fit.from_draws(problem, before, log_weights=problem.log_likelihood(before))
        >>> fit.converged
        False
        """
        from skinbayes.fit.given_draws import fit_parts

        return cls(*fit_parts(problem, samples, log_weights, seed), problem)

    def predict(
        self,
        conditions: Data,
        seed: int = 1,
        progress: Callable[[int, int], None] | None = None,
        cores: int = 1,
    ) -> Prediction:
        """Posterior predictions at rows that were not measured.

        Effects of people, liquids and other groups that the fit has seen are those that it found; of others they are drawn
        anew. A known spread of the data (``spread = "use"``) is taken to be that of the typical datum.

        Parameters
        ----------
        conditions : rows, as a CSV, data set, data frame or mapping of columns, with the columns that the data of the fit have
            (what was observed apart)
        seed : non-negative integer, for scatter and effects of new people
        progress : called with the number done and their total if a table has to be made for the rows
        cores : processes that make it

        Returns
        -------
        Prediction
            Draws of the model and of one measurement more for each row, with ``quantiles``, ``probability``, ``holds`` and
            ``to_frame``.

        Raises
        ------
        InputError
            A column is missing, cannot be used, or lies where the model cannot say anything; model or data of the fit are gone.

        Examples
        --------
        >>> rows = {"person": ["ID01", "new"], "liquid": ["water", "water"], "normal_force": [1.0, 1.0]}
        >>> fit.predict(rows).quantiles("friction_coefficient", 0.5).shape
        (2,)
        """
        from skinbayes.fit.prediction import predicted

        return predicted(self, conditions, seed, progress, cores)

    def design(
        self,
        candidates: Data,
        parameters: Sequence[str] = (),
        against: Fit | None = None,
        rows: int = 1,
        cost: str | None = None,
        seed: int = 1,
        progress: Callable[[int, int], None] | None = None,
    ) -> Design:
        """Which further rows would tell most, before they are measured and without new fits.

        The expected information of a measurement: by how much, in nats, it narrows what the fit knows, averaged over what the fit
        says it could give. See ``skinbayes.statistics.expected_information``.

        Parameters
        ----------
        candidates : rows as :meth:`predict` takes them
        parameters : one to three free parameters that are asked about; all together if empty, those of the noise included
        against : a fit of another model of the same quantities: then it is asked which of the two, at even odds, is right
        rows : how many rows to choose: each the one that adds most to those chosen before
        cost : column of the candidates with the cost of a row; what counts is then information over cost
        seed : non-negative integer
        progress : as :meth:`predict` takes it

        Returns
        -------
        Design
            Information of each candidate with its standard error, and the rows chosen; ``sentence`` and ``to_frame``.

        Raises
        ------
        InputError
            As :meth:`predict`; no such parameter or column.

        Examples
        --------
        >>> candidates = {"person": ["ID01", "new"], "liquid": ["water", "water"], "normal_force": [1.0, 1.0]}
        >>> fit.design(candidates).information.shape
        (2,)
        """
        from skinbayes.fit.design import design

        return design(self, candidates, parameters, against, rows, cost, seed, progress)

    def save(self, path: str | Path) -> Path:
        """Write the result as one netCDF file in the ArviZ schema; the file appears whole or not at all, and shows any damage.

        Parameters
        ----------
        path : the file

        Returns
        -------
        Path
            The file.

        Raises
        ------
        OSError
            It cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     again = sb.load_fit(fit.save(pathlib.Path(folder) / "fit.nc"))
        >>> again.names == fit.names
        True
        """
        write_atomically(Path(path), result_image(self.groups, self.provenance))
        return Path(path)
