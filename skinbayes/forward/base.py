"""The shape of a forward model."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.emulation import Progress
from skinbayes.errors import InputError
from skinbayes.lubrication import FlowCurve
from skinbayes.roughness import TabulatedSpectrum
from skinbayes.roughness.spectrum import SELF_AFFINE_PARAMETERS
from skinbayes.vocabulary import Quantity

ROUGHNESS_INPUTS = SELF_AFFINE_PARAMETERS
"""Inputs of a self-affine spectrum; a named surface supplies all of them."""

Inputs = Mapping[str, FloatArray]
"""Name to SI values; each array broadcasts to ``(B, N)``: B parameter vectors, N rows of conditions."""

Ranges = Mapping[str, tuple[float, float]]
"""Name of an input to its smallest and largest value over the rows and nearly all of the prior, SI."""

Multiples = Mapping[str, tuple[str, float]]
"""Name of an input to another one of which it is the same multiple at all rows, and the multiple."""


class TiedRanges(dict[str, tuple[float, float]]):
    """`Ranges` of inputs some of which vary together.

    Attributes
    ----------
    multiples : which, and how
    """

    def __init__(self, ends: Ranges, multiples: Multiples) -> None:
        super().__init__(ends)
        self.multiples = multiples


def multiples_of(ranges: Ranges) -> Multiples:
    """Inputs that are multiples of others; none where nothing is known of that."""
    return ranges.multiples if isinstance(ranges, TiedRanges) else {}


@dataclass(frozen=True)
class Tables:
    """Measured curves that enter beside the numbers.

    Attributes
    ----------
    spectrum : tabulated roughness spectrum, or None
    flow_curves : viscosity against shear rate of the liquid of each row, or None; rows of one liquid share an object
    """

    spectrum: TabulatedSpectrum | None = None
    flow_curves: tuple[FlowCurve, ...] | None = None

    def at_row(self, row: int) -> Tables:
        """The curves of one row."""
        if self.flow_curves is None:
            return self
        return Tables(self.spectrum, (self.flow_curves[row],))

    def digest(self) -> str | None:
        """What tells one spectrum from another in the key of a table that is kept; None without a spectrum."""
        if self.spectrum is None:
            return None
        parts = (self.spectrum.wavevector, self.spectrum.node_power, self.spectrum.scale)
        return hashlib.sha256(np.concatenate([np.ravel(x) for x in parts]).tobytes()).hexdigest()


@dataclass(frozen=True)
class Profile:
    """A curve that a forward model can draw beyond its observables, such as contact area against wavevector.

    Attributes
    ----------
    name, title : identifier and title for plots
    abscissa, ordinate : names of quantities in the vocabulary
    grid : abscissa values for given inputs, shape ``(K,)``, SI
    evaluate : ordinate for inputs that broadcast to ``(B,)`` at the grid, shape ``(B, K)``
    needs : inputs without which there is no such curve
    uniform : inputs that may not be a column of the rows: a curve at the value of one row would connect nothing
    """

    name: str
    title: str
    abscissa: str
    ordinate: str
    grid: Callable[[Inputs, Tables], FloatArray]
    evaluate: Callable[[Inputs, Tables, FloatArray], FloatArray]
    needs: tuple[str, ...] = ()
    uniform: tuple[str, ...] = ()


def profiles_against(
    abscissa: str,
    titles: Mapping[str, str],
    grid: Callable[[Inputs, Tables], FloatArray],
    evaluate: Callable[..., FloatArray],
    *,
    called: str,
    uniform: tuple[str, ...] = (),
) -> tuple[Profile, ...]:
    """Profiles of several ordinates against one abscissa, one below the other.

    Parameters
    ----------
    abscissa : a quantity
    titles : each ordinate to the title of its profile
    grid, uniform : as those of a `Profile`
    evaluate : as that of a `Profile`, with the ordinate as ``observable``
    called : end of the names of the profiles
    """
    return tuple(
        Profile(
            name=f"{ordinate}_against_{called}",
            title=title,
            abscissa=abscissa,
            ordinate=ordinate,
            grid=grid,
            evaluate=partial(evaluate, observable=ordinate),
            uniform=uniform,
        )
        for ordinate, title in titles.items()
    )


def partners(goes_with: Mapping[str, str | tuple[str, ...]], name: str) -> tuple[str, ...]:
    """Inputs without which one has no meaning, of the ``goes_with`` of a model."""
    found = goes_with.get(name, ())
    return (found,) if isinstance(found, str) else found


def nothing_derived(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    """No quantities between inputs and observables."""
    return {}


@dataclass(frozen=True)
class ForwardModel:
    """Physics with names.

    Attributes
    ----------
    name : the name used in model files
    summary : one line
    observables : names this model predicts
    required : inputs that must be given, as a parameter or as a column of conditions; a tuple inside is a set of
        alternatives, each alternative a tuple of names, the first complete one is used
    optional : inputs with default values, SI
    goes_with : optional or accepted input to the input, or a tuple of all inputs, without which it has no meaning: refused if
        one is not given, and no default then
    why_needed : required input to the reason why it is, a clause that is said where it is missing
    exclusive : further sets of alternatives of which at most one may be given, such as wavevector or magnification
    derived_names : names of the ``derived`` quantities
    blocks : those of them that may stand for the parameters behind them when combinations are named (``rms_slope``)
    accepted : further inputs that may be given and have no default
    evaluate : ``(inputs, tables) -> {observable: (B, N)}``
    parts : parts that add up to the first observable, same calling convention, or None; ``check`` says how each goes with load
    derived : quantities between inputs and observables (``rms_slope``, ``nominal_pressure``), same calling convention
    profiles : curves for plots
    abscissa : abscissa of the first profile for inputs that broadcast to ``(B, N)``, where it is none of the inputs but
        follows from them (viscosity times speed), or None; data are drawn against it
    validate : raises InputError saying in words which inputs cannot be (evaluation itself gives NaN), or None
    explain : sentences on why predictions are missing (NaN) or doubtful, or None
    flags : ``(inputs, tables) -> {flag: (B, N)}``, true where a prediction is at the edge of what the theory can say, or None
    flag_meanings : what each flag says, a clause
    prepare : ``(model, ranges, tables, progress, cores) ->`` the same model with a faster evaluation within ranges, or None
    accuracy : a sentence on the error of the evaluation, empty if it is that of the physics below
    expensive : True if an evaluation takes so long (a tenth of a millisecond) that fewer walkers are better
    uses_flow_curves : True if flow curves of liquids may stand for ``viscosity``
    uses_surface : True if a roughness spectrum enters: the five roughness inputs, or a tabulated spectrum
    quantities : quantities of its own, which become known with it
    options : name of a choice to its values, the first of which is taken if none is given: ``{"closure": ("gaussian", "sharp")}``
    variant : the model for given values of all options, called by keyword; needed where there are options
    chosen : the values that this model was made for

    Examples
    --------
    Examples of methods go on from this one.

    >>> def evaluate(inputs, tables):
    ...     return {"friction_coefficient": inputs["frictional_shear_stress"] / inputs["nominal_pressure"]}
    >>> needed = ("frictional_shear_stress", (("nominal_pressure",),))
    >>> model = ForwardModel(
    ...     "full-contact", "all of the area touches", ("friction_coefficient",), needed, evaluate,
    ...     optional={"temperature": 293.0}, uses_surface=False,
    ... )
    >>> given = {"frictional_shear_stress": np.array([[2e3]]), "nominal_pressure": np.array([[1e3, 4e3]])}
    >>> model.evaluate(given, Tables())["friction_coefficient"].tolist()
    [[2.0, 0.5]]
    """

    name: str
    summary: str
    observables: tuple[str, ...]
    required: tuple[str | tuple[tuple[str, ...], ...], ...]
    evaluate: Callable[[Inputs, Tables], dict[str, FloatArray]]
    optional: Mapping[str, float] = field(default_factory=dict)
    derived: Callable[[Inputs, Tables], dict[str, FloatArray]] = nothing_derived
    parts: Callable[[Inputs, Tables], dict[str, FloatArray]] | None = None
    goes_with: Mapping[str, str | tuple[str, ...]] = field(default_factory=dict)
    why_needed: Mapping[str, str] = field(default_factory=dict)
    exclusive: tuple[tuple[tuple[str, ...], ...], ...] = ()
    derived_names: tuple[str, ...] = ()
    blocks: tuple[str, ...] = ()
    accepted: tuple[str, ...] = ()
    profiles: tuple[Profile, ...] = field(default=())
    uses_surface: bool = True
    validate: Callable[[Inputs, Tables], None] | None = None
    explain: Callable[[Inputs, Tables], list[str]] | None = None
    flags: Callable[[Inputs, Tables], dict[str, BoolArray]] | None = None
    flag_meanings: Mapping[str, str] = field(default_factory=dict)
    prepare: Callable[[ForwardModel, Ranges, Tables, Progress | None, int], ForwardModel] | None = None
    accuracy: str = ""
    abscissa: Callable[[Inputs, Tables], FloatArray] | None = None
    expensive: bool = False
    uses_flow_curves: bool = False
    quantities: tuple[Quantity, ...] = ()
    options: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    variant: Callable[..., ForwardModel] | None = None
    chosen: Mapping[str, str] = field(default_factory=dict)

    def with_options(self, given: Mapping[str, str], where: str = "options") -> ForwardModel:
        """This model with some of its options set; the others have their first value.

        Parameters
        ----------
        given : option to value
        where : place of the options, for messages

        Returns
        -------
        ForwardModel
            The model for these values.

        Raises
        ------
        InputError
            An option or a value that it does not have.

        Examples
        --------
        >>> from skinbayes.forward import forward_model
        >>> forward_model("drying").with_options({"closure": "sharp"}).chosen
        {'closure': 'sharp'}
        """
        for name, value in given.items():
            if name not in self.options:
                takes = f"it takes {', '.join(self.options)}" if self.options else "it takes none"
                raise InputError(
                    f"{where}: the forward model '{self.name}' has no option '{name:.60}'; {takes}"
                )
            if value not in self.options[name]:
                raise InputError(
                    f"{where}.{name}: found {value!r:.60}; expected {' or '.join(map(repr, self.options[name]))}"
                )
        if self.variant is None:
            return self
        chosen = {name: values[0] for name, values in self.options.items()} | dict(given)
        return replace(self.variant(**chosen), options=self.options, variant=self.variant, chosen=chosen)

    def required_names(self) -> tuple[str, ...]:
        """All names that occur in ``required``, alternatives included.

        Returns
        -------
        tuple of str
            Each once.

        Examples
        --------
        >>> model.required_names()
        ('frictional_shear_stress', 'nominal_pressure')
        """
        flat: list[str] = []
        for entry in self.required:
            flat += [entry] if isinstance(entry, str) else [name for names in entry for name in names]
        return tuple(dict.fromkeys(flat))

    def defaults(self, given: Collection[str]) -> dict[str, float]:
        """Values of the optional inputs that are not given, but for those without a meaning beside what is given.

        Parameters
        ----------
        given : names of the inputs that are given

        Returns
        -------
        dict
            Name to value, SI.

        Examples
        --------
        >>> model.defaults(["nominal_pressure"])
        {'temperature': 293.0}
        """
        return {
            name: float(value)
            for name, value in self.optional.items()
            if name not in given and set(partners(self.goes_with, name)) <= set(given)
        }

    def input_names(self) -> tuple[str, ...]:
        """All inputs the model takes; roughness inputs included if it has a surface.

        Returns
        -------
        tuple of str
            Sorted.

        Examples
        --------
        >>> model.input_names()
        ('frictional_shear_stress', 'nominal_pressure', 'temperature')
        """
        return self._input_names

    @cached_property
    def _input_names(self) -> tuple[str, ...]:
        # asked for at every evaluation
        roughness = ROUGHNESS_INPUTS if self.uses_surface else ()
        return tuple(sorted({*self.required_names(), *self.optional, *self.accepted, *roughness}))

    def alternatives(self) -> tuple[tuple[tuple[str, ...], ...], ...]:
        """All sets of alternatives, required or not.

        Returns
        -------
        tuple
            For each set its alternatives, a tuple of names each.

        Examples
        --------
        >>> model.alternatives()
        ((('nominal_pressure',),),)
        """
        return (*(entry for entry in self.required if not isinstance(entry, str)), *self.exclusive)
