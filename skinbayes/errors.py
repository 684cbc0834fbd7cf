"""Errors that are meant to be read by the person who typed the input."""

from __future__ import annotations

NEXT_PROBLEM = "\n  - "
"""Stands between the problems of one file in a message; the only line break in messages."""


class InputError(ValueError):
    """Something the user gave cannot be used.

    The message is one or two plain sentences, or a list of them for a file with several faults: where (file, line, row,
    column or parameter), what was found, and what was expected, in its unit. The command line prints it as it is and
    exits with status 2.
    """


class FingerprintMismatch(InputError):
    """A stored run belongs to another model, data set, prior or sampler setting than the one given."""
