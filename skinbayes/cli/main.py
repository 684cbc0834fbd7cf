"""The ``skinbayes`` command: subcommands, and what happens when something goes wrong."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import click

from skinbayes import __version__
from skinbayes.cli.catalogue import datasets, models, show
from skinbayes.cli.check import check
from skinbayes.cli.compare import compare
from skinbayes.cli.digitised import digitised
from skinbayes.cli.fit import fit
from skinbayes.cli.output import EXIT_BAD_INPUT, EXIT_INTERRUPTED
from skinbayes.cli.predict import predict
from skinbayes.cli.prior import prior
from skinbayes.cli.report import report
from skinbayes.cli.template import template
from skinbayes.errors import InputError

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")
"""Set to 1 unless the user set them: the matrices are small, and threads of linear algebra stand in the way of the worker
processes (a fit on two cores took a quarter longer with them). NumPy reads them when it is imported, which is later."""


class _InOrder(click.Group):
    """Lists the subcommands in the order in which one uses them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)


@click.group(cls=_InOrder, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="skinbayes")
def cli() -> None:
    """What friction data say about skin, and how sure that is.

    MODEL is the name of a shipped model (see 'skinbayes models') or the path of a model file (TOML).
    RUN is a directory that 'skinbayes fit' wrote.

    Every command takes --json: one JSON document on standard output, SI values.
    Exit status: 0 done, 2 bad input, 3 finished without converging, 130 interrupted.
    """


for _command in (models, datasets, show, template, digitised, check, prior, predict, fit, compare, report):
    cli.add_command(_command)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; exits with the documented status."""
    for name in ONE_THREAD:
        os.environ.setdefault(name, "1")
    try:
        _prepare_output()
        status = cli.main(
            args=None if arguments is None else list(arguments), prog_name="skinbayes", standalone_mode=False
        )
        if sys.stdout is not None:
            sys.stdout.flush()
    except InputError as error:
        _complain(_printable(str(error)))
        status = EXIT_BAD_INPUT
    except click.ClickException as error:  # a wrong option, for example
        with suppress(OSError):
            error.show()
        status = EXIT_BAD_INPUT
    except (KeyboardInterrupt, click.Abort):
        _complain("interrupted")
        status = EXIT_INTERRUPTED
    except BrokenPipeError:
        # the reader of a pipe went away ('skinbayes show ... | head')
        sys.stderr.close()
        status = 0
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        if not place and error.errno in (errno.ENOSPC, errno.EBADF, errno.EIO):
            place = "output cannot be written: "
        _complain(f"{_printable(place)}{error.strerror or error}")
        status = EXIT_BAD_INPUT
    sys.exit(status if isinstance(status, int) else 0)


def _complain(text: str) -> None:
    """One message on standard error, if that can be written."""
    with suppress(OSError):
        click.echo(f"skinbayes: {text}", err=True)


def _prepare_output() -> None:
    """Have characters that standard output cannot take replaced (σ in many code pages), and refuse to work for nobody."""
    if sys.stdout is None:
        raise InputError("standard output is closed; expected one to write to, such as a file or /dev/null")
    streams: tuple[Any, ...] = (sys.stdout, sys.stderr)
    for stream in streams:
        if getattr(stream, "errors", None) in ("strict", "surrogateescape"):
            stream.reconfigure(errors="replace")


def _printable(text: str) -> str:
    """One line without control characters, which a file or an argument could send to the terminal."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)
