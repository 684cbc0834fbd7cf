"""Errors that are meant to be read by the person who typed the input."""

from __future__ import annotations


class InputError(ValueError):
    """Something the user gave cannot be used.

    The message is one or two plain sentences: where (file, line, row, column or parameter), what was found,
    and what was expected, in its unit. The command line prints it as it is and exits with status 2.
    """


class FingerprintMismatch(InputError):
    """A stored run belongs to another model, data set, prior or sampler setting than the one given."""


class RepairWarning(UserWarning):
    """Something in a stored run was damaged or missing, and what was done about it.

    The run goes on; the command line prints the message as it is on standard error.
    """
