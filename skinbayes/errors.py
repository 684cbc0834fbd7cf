"""Errors that are meant to be read by the person who typed the input."""

from __future__ import annotations


class InputError(ValueError):
    """Something the user gave cannot be used.

    The message is one or two plain sentences: where (file, line, row, column or parameter), what was found,
    and what was expected, in its unit. The command line prints it as it is and exits with status 2.
    """


class FingerprintMismatch(InputError):
    """A stored run belongs to another model, data set, prior or sampler setting than the one given."""
