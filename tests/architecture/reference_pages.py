"""The pages of the reference that are made from the code: docs/vocabulary.md and docs/shipped-models.md.

``python tests/architecture/reference_pages.py`` writes them.
"""

from __future__ import annotations

from collections.abc import Sequence

from source_tree import ROOT

from skinbayes.files.locate import shipped_names
from skinbayes.files.modelfile import ModelSpec, load_model
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.quantities import ALL
from skinbayes.vocabulary import LABELS


def table(headers: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [headers, ["---"] * len(headers), *rows]
    return "".join(f"| {' | '.join(cell.replace('|', '/') for cell in line)} |\n" for line in lines)


def vocabulary() -> str:
    """docs/vocabulary.md."""
    rows = [
        (f"`{one.name}`", one.symbol, one.unit, one.range_text().removesuffix(f" {one.unit}"), one.meaning)
        for one in ALL
    ]
    labels = ", ".join(f"`{label}`" for label in sorted(LABELS))
    return f"""# Vocabulary

<!-- made by tests/architecture/reference_pages.py -->

One name, symbol and unit for each quantity, the same in code, model files, CSV headers, results and these pages. In a header
the name stands with a unit of your own in brackets, `normal_force [mN]`
([data](data.md#your-own-measurements-a-csv-with-units-in-its-header)); in a model file values are text with a unit.
Ranges are in the unit of the table. A quantity of your own: [a column](extending.md#a-column).

{table(("name", "symbol", "unit", "range", "meaning"), rows)}
Usual labels, columns without a unit: {labels}; any other name will do.
"""


def parameter(one: ParameterSpec) -> tuple[str, str, str]:
    """A row of the table of a model."""
    return f"`{one.label}`", one.prior_text, one.source


def model(spec: ModelSpec) -> str:
    """The section of a model."""
    if spec.dataset:
        rows = "".join(f", rows with {column} = {', '.join(levels)}" for column, levels in spec.rows.items())
        data = f"Data: `{spec.dataset}`{rows}."
    else:
        data = "Data: yours, with `--data`." if spec.observables else "No data: it predicts."
    observed = (
        f" Observed: {', '.join(f'`{name}`' for name in spec.observables)}." if spec.observables else ""
    )
    noise = ", ".join(f"`{family}`" for family in dict.fromkeys(spec.noise.values()))
    scatter = f" Noise: {noise}." if noise else ""
    rows = [
        parameter(one)
        for one in (*spec.parameters, *spec.covariate_exponents, *spec.groups, *spec.noise_parameters)
    ]
    return f"""## {spec.name}

**{spec.title}.** {" ".join(spec.description.split())}

Forward model `{spec.forward}`. {data}{observed}{scatter}

{table(("parameter", "prior or value", "source"), rows)}"""


def shipped_models() -> str:
    """docs/shipped-models.md."""
    specs = [load_model(name) for name in shipped_names("models")]
    return f"""# Shipped models

<!-- made by tests/architecture/reference_pages.py -->

Each is a [model file](model-files.md) in `models/`: `skinbayes new NAME -o mine.toml` copies one, `skinbayes show NAME`
prints it with everything that it takes by default.

{chr(10).join(model(spec) for spec in specs)}"""


PAGES = {"vocabulary": vocabulary, "shipped-models": shipped_models}

if __name__ == "__main__":
    for name, make in PAGES.items():
        (ROOT / "docs" / f"{name}.md").write_text(make(), encoding="utf-8")
