"""A ``provenance.toml`` to be completed: what an import knows is filled in, what only the reader knows is left empty."""

from __future__ import annotations

from skinbayes.files.digitised import DigitisedFile
from skinbayes.files.digitised_axes import AxisMeaning
from skinbayes.files.digitised_columns import DigitisedTable


def provenance_template(
    export: DigitisedFile,
    chosen: list[str],
    meanings: tuple[AxisMeaning, AxisMeaning],
    table: DigitisedTable,
    constants: dict[str, str],
    sha256: str,
) -> str:
    """Text of a provenance file for a digitised data set.

    Title, authors, DOI, figure, person and licence are empty; the file is refused until they are filled in.

    Parameters
    ----------
    export : what was read
    chosen : names of the data sets in it that were used
    meanings : of abscissa and ordinate
    table : what was written
    constants : columns that the user added
    sha256 : of the CSV
    """
    from tomlkit import string

    which = ", ".join(f"'{name}'" for name in chosen)
    how = f"Digitised: {export.kind}, {export.path.name} (sha256 {export.sha256}), data set {which}"
    steps = []
    for axis, meaning in zip(("abscissa", "ordinate"), meanings, strict=True):
        power = ", 10 to the power of the values read" if meaning.logarithmic else ""
        unit = meaning.quantity.unit
        converted = "" if meaning.unit == unit else f", {meaning.unit} to {unit}"
        steps.append(f"{axis} is {meaning.quantity.name}{power}{converted}")
    steps += [f"{name} = {text} in all rows, stated by the user" for name, text in constants.items()]
    spread = (
        "Reading errors, one standard deviation. "
        + " ".join(table.errors)
        + " Neither the scatter of the measurement nor the "
        "error of the calibration, which all points share, is in them."
    )

    def text(said: str) -> str:
        return string(said).as_string()

    return "\n".join(
        (
            "# Complete the empty entries: the data set cannot be loaded with this file before.",
            'title = ""                    # of the work with the figure',
            "authors = []                  # of that work",
            "doi = []                      # of that work, without resolver address; [] if it has none",
            'where = ""                    # the figure, such as "Fig. 2, open circles"',
            'licence = ""                  # of the figure, or what is known about it',
            'digitised_by = ""             # who read the figure, and when',
            'kind = "measurements"',
            f"how_read = {text(how)}",
            f"transformation = {text('; '.join(steps))}",
            f"spread = {text(spread)}",
            "caveats = []                  # what a user has to know before trusting a fit",
            f'sha256 = "{sha256}"',
            "",
        )
    )
