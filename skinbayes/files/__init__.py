"""Files: data sets with their provenance, reference tables, tabulated spectra, model files."""

from skinbayes.files.dataset import Dataset, load_dataset
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.files.provenance import Provenance

__all__ = ["Dataset", "Provenance", "load_dataset", "shipped_folder", "shipped_names"]
