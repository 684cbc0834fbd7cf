"""The command line."""

from skinbayes.cli.main import main

__all__ = ["main"]
