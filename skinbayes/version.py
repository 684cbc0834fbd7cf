"""The version of this software, as a release names it."""

__version__ = "0.1.0"
