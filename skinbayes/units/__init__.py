"""Text with a unit to an SI number and back: what units there are, conversion, numbers for people."""

from skinbayes.units.conversion import (
    convert_array,
    converts,
    describe_unit,
    parse_quantity,
    product_unit,
    split_header,
    unit_example,
)
from skinbayes.units.format import format_quantity
from skinbayes.units.numbers import NUMBER, comma_advice
from skinbayes.units.unit_words import is_unit

__all__ = [
    "NUMBER",
    "comma_advice",
    "convert_array",
    "converts",
    "describe_unit",
    "format_quantity",
    "is_unit",
    "parse_quantity",
    "product_unit",
    "split_header",
    "unit_example",
]
