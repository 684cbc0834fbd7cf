"""The grammar of a recipe, by which recordings become friction; data types that refuse what they do not know."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from skinbayes.files.provenance import Doi, Text

Zero = Literal["as recorded", "both directions", "rest"]
Number = float | int
Line = Annotated[int, Field(ge=1, le=10_000)]


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class FileBlock(_Strict):
    """``[file]``: how the numbers stand in a file; what is not said is seen in the file."""

    separator: Literal["tab", "semicolon", "comma", "blanks"] | None = None
    decimal: Literal["point", "comma"] | None = None
    header_lines: Annotated[int, Field(ge=0, le=10_000)] | None = None
    names_line: Line | None = None
    units_line: Line | None = None
    footer_lines: Annotated[int, Field(ge=0, le=1000)] = 0
    sampling_rate: str | None = None


class ColumnBlock(_Strict):
    """An entry of ``[columns]``: a column of the file by name or number, or one value for all samples."""

    name: str | None = None
    number: Annotated[int, Field(ge=1, le=1000)] | None = None
    value: str | Number | None = None
    unit: str | None = None
    offset: Number = 0.0
    factor: Number = 1.0
    sign: Literal[1, -1] = 1
    range: Annotated[list[str], Field(min_length=2, max_length=2)] | None = None

    @model_validator(mode="after")
    def _one_source(self) -> ColumnBlock:
        if sum(part is not None for part in (self.name, self.number, self.value)) != 1:
            raise ValueError("give either 'name' or 'number' of a column, or a 'value' for all samples")
        if self.value is not None and (
            self.unit or self.offset or self.factor != 1.0 or self.sign != 1 or self.range
        ):
            raise ValueError("a 'value' is text with its unit and takes nothing else")
        return self


class LabelColumn(_Strict):
    """A label that stands in a column of the file."""

    name: str | None = None
    number: Annotated[int, Field(ge=1, le=1000)] | None = None

    @model_validator(mode="after")
    def _one_source(self) -> LabelColumn:
        if (self.name is None) == (self.number is None):
            raise ValueError("give either 'name' or 'number' of a column")
        return self


class StrokesBlock(_Strict):
    """``[strokes]``: how strokes are found, and which are taken."""

    origin: Literal["position", "sliding_speed", "tangential_force", "whole"] | None = Field(
        default=None, alias="from"
    )
    minimum_length: str | None = None
    minimum_duration: str | None = None
    directions: Literal["both", "forward", "backward"] = "both"
    skip_first: Annotated[int, Field(ge=0)] = 0


class SteadyBlock(_Strict):
    """``[steady]``: which part of a stroke counts."""

    rule: Literal["central share", "change points"] = "central share"
    share: Annotated[Number, Field(gt=0, le=1)] = 0.6


class ZeroBlock(_Strict):
    """``[zero]``: the zeros of the forces."""

    tangential_force: Zero = "as recorded"
    normal_force: Literal["as recorded", "rest"] = "as recorded"
    rest: Annotated[list[str], Field(min_length=2, max_length=2)] | None = None

    @model_validator(mode="after")
    def _rest_stated(self) -> ZeroBlock:
        if (self.rest is None) != ("rest" not in (self.tangential_force, self.normal_force)):
            raise ValueError(
                "'rest' = [from, to] goes with a force whose zero is \"rest\": a part of the recording in which nothing touches"
            )
        return self


class FrictionBlock(_Strict):
    """``[friction]``: how the coefficient is computed."""

    coefficient: Literal["ratio of means", "mean of ratios"] = "ratio of means"
    minimum_normal_force: str | None = None


class RampBlock(_Strict):
    """``[ramp]``: loads between which strokes are cut into bins."""

    edges: Annotated[list[str], Field(min_length=2, max_length=200)]


class RowsBlock(_Strict):
    """``[rows]``: what a row of the table is, and where time begins."""

    each: Annotated[list[str], BeforeValidator(_as_list), Field(min_length=1)] = ["stroke"]
    time_zero: str | None = None


class RecipeBlock(_Strict):
    """A whole recipe."""

    format: Literal[1] = 1
    title: Text
    authors: Annotated[list[Text], BeforeValidator(_as_list), Field(min_length=1)]
    doi: Annotated[list[Doi], BeforeValidator(_as_list)] = []
    licence: Text = "not stated"
    caveats: list[Text] = []
    file: FileBlock = FileBlock()
    columns: dict[str, ColumnBlock]
    labels: dict[str, str | LabelColumn] = Field(default_factory=dict)
    strokes: StrokesBlock = StrokesBlock()
    steady: SteadyBlock = SteadyBlock()
    zero: ZeroBlock = ZeroBlock()
    friction: FrictionBlock = FrictionBlock()
    ramp: RampBlock | None = None
    rows: RowsBlock = RowsBlock()
