"""The seam between problems and samplers: what an engine is given, what it returns, and engines by name."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from typing import Any, Protocol

from skinbayes.errors import InputError
from skinbayes.sampling.draws import Draws
from skinbayes.sampling.ensemble_engine import EnsembleEngine
from skinbayes.sampling.nested_engine import NestedEngine
from skinbayes.sampling.options import EngineOptions
from skinbayes.sampling.progress import RunProgress
from skinbayes.sampling.store import SampleStore
from skinbayes.sampling.target import Target


class Engine(Protocol):
    """Something that draws from a target.

    Any object with ``run`` is one. Two attributes are looked at if it has them: ``options``, the class of its options (a subclass
    of `EngineOptions`; itself if missing), and ``package``, the library whose version is kept with the result.

    Examples
    --------
    >>> import numpy as np
    >>> class FromPrior:
    ...     def run(self, target, options, store, progress):
    ...         unit = np.random.default_rng(options.seed).random((1000, len(target.names)))
    ...         position = target.prior_transform(unit)
    ...         return Draws(position, log_weights=target.log_likelihood(position))
    >>> find_engine(FromPrior())[0]
    'FromPrior'
    """

    def run(
        self,
        target: Target,
        options: Any,
        store: SampleStore | None,
        progress: Callable[[RunProgress], None] | None,
    ) -> Draws:
        """Draw from a target.

        Parameters
        ----------
        target : names, log-density, starts; prior transform and log-likelihood; all in unconstrained coordinates
        options : the seed, from which all randomness has to come, the effective sample size wanted, and more
        store : where steps may be kept so that the run can be resumed; None keeps nothing
        progress : to be called now and then with anything that has ``steps`` and ``sentence(width)``

        Returns
        -------
        Draws
            In the coordinates of the target, ``(chains, draws, D)`` or ``(draws, D)``, with weights where they have any.

        Examples
        --------
        >>> import skinbayes as sb
        >>> target = sb.load_problem("finger-null").target()
        >>> FromPrior().run(target, EngineOptions(seed=1), None, None).samples.shape
        (1, 1000, 4)
        """


ENGINES: dict[str, Engine] = {"emcee": EnsembleEngine(), "nested": NestedEngine()}
"""Engines by name."""


def register_engine(name: str, engine: Engine) -> None:
    """Make an engine of your own known under a name, for ``sample(problem, engine=name)``.

    Parameters
    ----------
    name : letters, digits, ``_`` and ``-``
    engine : an object with ``run``, see :class:`Engine`

    Raises
    ------
    InputError
        The name is taken or no name, or the engine has no ``run``.

    Examples
    --------
    >>> class Mine:
    ...     def run(self, target, options, store, progress):
    ...         return Draws(target.starts(np.random.default_rng(options.seed), 100))
    >>> register_engine("mine", Mine())
    >>> find_engine("mine")[0], ENGINES.pop("mine") is None
    ('mine', False)
    """
    if not name.replace("_", "").replace("-", "").isalnum():
        raise InputError(f"engine: name {name!r} found; expected letters, digits, '_' and '-'")
    if ENGINES.get(name, engine) is not engine:
        raise InputError(f"engine '{name}': there is one of this name already; give another name")
    ENGINES[name] = _usable(engine)


def find_engine(engine: str | Engine) -> tuple[str, Engine]:
    """Name and engine for what a user gave: a name, or an object with ``run``.

    Raises
    ------
    InputError
        No engine has this name, or the object has no ``run``.
    """
    if isinstance(engine, str):
        if engine not in ENGINES:
            close = get_close_matches(engine, ENGINES, 1)
            hint = f"did you mean '{close[0]}'? " if close else ""
            raise InputError(f"engine: {engine!r} found; {hint}expected one of {', '.join(ENGINES)}")
        return engine, ENGINES[engine]
    name = next((name for name, known in ENGINES.items() if known is engine), type(engine).__name__)
    return name, _usable(engine)


def options_for(name: str, engine: Engine, **given: Any) -> EngineOptions:
    """The options of an engine from what was given by keyword.

    Raises
    ------
    InputError
        It has no option of a name, or a value is out of range.
    """
    kind: type[EngineOptions] = getattr(engine, "options", EngineOptions)
    known = kind.__dataclass_fields__
    if unknown := [option for option in given if option not in known]:
        raise InputError(f"engine '{name}': no option {unknown[0]!r}; expected some of {', '.join(known)}")
    return kind(**given)


def _usable(engine: Engine) -> Engine:
    if not callable(getattr(engine, "run", None)) or isinstance(engine, type):
        raise InputError(
            f"engine: {engine!r:.80} found; expected a name or an object with run(target, options, store, progress)"
        )
    return engine
