"""Files: data sets with their provenance, reference tables, tabulated spectra, model files."""

from skinbayes.files.dataset import Dataset, as_dataset, load_dataset
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.files.provenance import Provenance
from skinbayes.files.reference import ReferenceTable, load_reference

__all__ = [
    "Dataset",
    "Provenance",
    "ReferenceTable",
    "as_dataset",
    "load_dataset",
    "load_reference",
    "shipped_folder",
    "shipped_names",
]
