"""The grammar of a model file, as data types that refuse what they do not know."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

Power = Annotated[float | int, Field(ge=-100, le=100)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


def _either(**fields: str) -> Any:
    """A validator that wants exactly one of the fields, each with what it is."""

    def check(block: Any) -> Any:
        if sum(getattr(block, name) is not None for name in fields) != 1:
            raise ValueError(f"give either {' or '.join(f'{name!r}{what}' for name, what in fields.items())}")
        return block

    return model_validator(mode="after")(check)


class DataBlock(_Strict):
    """``[data]``: which rows of which data set, and what of it the model explains; no data set if the user brings one."""

    dataset: str | None = None
    file: str | None = None
    observable: str | None = None
    observables: list[str] | None = Field(default=None, min_length=1)
    rows: dict[str, list[str]] = Field(default_factory=dict)
    spread: Literal["use", "ignore"] | None = None
    input_spread: Literal["use", "ignore"] | None = None
    missing: Literal["drop"] | None = None

    @model_validator(mode="after")
    def _one_source(self) -> DataBlock:
        if self.dataset is not None and self.file is not None:
            raise ValueError("give 'dataset' (a shipped data set) or 'file' (the path of a CSV), not both")
        return self

    _observed = _either(observable="", observables=" (a list of several)")

    @model_validator(mode="after")
    def _each_once(self) -> DataBlock:
        if len(set(self.names())) < len(self.names()):
            raise ValueError(f"'observables' names one twice: {', '.join(self.names())}")
        return self

    def names(self) -> list[str]:
        """All observables; a friction force is explained as the friction coefficient that it makes with the normal force."""
        names = self.observables or [str(self.observable)]
        return ["friction_coefficient" if name == "friction_force" else name for name in names]


class SurfaceBlock(_Strict):
    """``[surface]``: a named surface, the user's own tabulated power spectrum, or the posterior of a fit of one."""

    name: str | None = None
    file: str | None = None
    posterior: str | None = None
    convention: str | None = None
    rms_height_measured: Any = None
    rms_slope_measured: Any = None
    total_area_ratio_measured: Any = None

    _source = _either(
        name=" (a named surface)", file=" (the path of a spectrum CSV)", posterior=" (a run of a spectrum)"
    )


class RheologyBlock(_Strict):
    """``[rheology]``: measured flow curves of the liquids, which stand for ``viscosity``."""

    dataset: str | None = None
    file: str | None = None
    by: str

    _source = _either(dataset=" (a shipped data set)", file=" (the path of a CSV)")


class GroupBlock(_Strict):
    """``[groups.COLUMN]``: data of one level of a grouping column share an effect."""

    scale: Any


class DiscrepancyBlock(_Strict):
    """``[discrepancy]``: what the theory misses along columns, smooth curves that are fitted with it."""

    along: str | Annotated[list[str], Field(min_length=1)]
    within: str | None = None
    axis: Literal["linear", "logarithmic"] | None = None
    size: Any = None
    length: Any = None


class CorrelationBlock(_Strict):
    """``[noise.correlation]``: noise with a memory along a column."""

    along: str
    within: str | None = None
    length: Any = None
    independent: Any = None
    drift: Any = None


class NoiseTable(BaseModel):
    """``[noise]``: beside the correlation it holds what the noise families know, read elsewhere."""

    model_config = ConfigDict(extra="allow", strict=True, frozen=True)

    correlation: CorrelationBlock | None = None


class CovariateBlock(_Strict):
    """``[covariates.NAME]``: a column of the data that multiplies an input or the observable as a power."""

    column: str
    acts_on: str
    reference: str | float | int
    exponent: Any


class DerivedBlock(_Strict):
    """``[derived.NAME]``: a product of powers of parameters and intermediate quantities, for all or some rows."""

    product: dict[str, Power] = Field(min_length=1)
    rows: dict[str, list[str]] = Field(default_factory=dict)
    meaning: str = ""
    symbol: str = ""


class GridBlock(_Strict):
    """``[conditions]`` entry: a list of values, or a grid between two values."""

    values: list[str | float | int] | None = None
    logspace: list[str | float | int] | None = None
    linspace: list[str | float | int] | None = None
    points: int | None = Field(default=None, ge=2, le=10_000)

    @model_validator(mode="after")
    def _one_form(self) -> GridBlock:
        given = [form for form in (self.values, self.logspace, self.linspace) if form is not None]
        if len(given) != 1:
            raise ValueError("give exactly one of 'values', 'logspace' or 'linspace'")
        if self.values is None:
            if self.points is None:
                raise ValueError("a 'logspace' or 'linspace' needs 'points'")
            if len(given[0]) != 2:
                raise ValueError("a 'logspace' or 'linspace' needs two values: [first, last]")
        elif not self.values:
            raise ValueError("'values' is empty")
        return self


class ModelBlock(_Strict):
    """A whole model file."""

    format: Literal[1] = 1
    title: str
    description: str = ""
    forward: str
    options: dict[str, str] = Field(default_factory=dict)
    data: DataBlock | None = None
    surface: SurfaceBlock | None = None
    parameters: dict[str, Any]
    noise: NoiseTable | None = None
    groups: dict[str, GroupBlock] = Field(default_factory=dict)
    discrepancy: DiscrepancyBlock | None = None
    covariates: dict[str, CovariateBlock] = Field(default_factory=dict)
    rheology: RheologyBlock | None = None
    derived: dict[str, DerivedBlock] = Field(default_factory=dict)
    conditions: dict[str, GridBlock] = Field(default_factory=dict)
    baseline_models: list[str] = Field(default_factory=list)

    @model_validator(mode="after")
    def _data_need_noise(self) -> ModelBlock:
        if (self.data is None) != (self.noise is None):
            missing = "[noise]" if self.noise is None else "[data]"
            raise ValueError(
                f"{missing} is missing: a model of data needs both [data] and [noise], a model without data neither"
            )
        return self


class ExperimentBlock(_Strict):
    """``[experiments.NAME]``: what a model file of this experiment alone would say, but for surface and parameters."""

    forward: str
    options: dict[str, str] = Field(default_factory=dict)
    data: DataBlock
    noise: NoiseTable
    groups: dict[str, GroupBlock] = Field(default_factory=dict)
    discrepancy: DiscrepancyBlock | None = None
    covariates: dict[str, CovariateBlock] = Field(default_factory=dict)
    rheology: RheologyBlock | None = None
    derived: dict[str, DerivedBlock] = Field(default_factory=dict)


class JointBlock(_Strict):
    """A whole model file of several experiments on one skin."""

    format: Literal[1] = 1
    title: str
    description: str = ""
    experiments: dict[str, ExperimentBlock]
    surface: SurfaceBlock | None = None
    parameters: dict[str, Any]
