"""The ``skinbayes`` command: subcommands, and what happens when something goes wrong."""

from __future__ import annotations

import errno
import io
import os
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

import click

from skinbayes.cli.calibrate import calibrate
from skinbayes.cli.catalogue import datasets, models, show
from skinbayes.cli.check import check
from skinbayes.cli.compare import compare
from skinbayes.cli.design import design
from skinbayes.cli.digitised import digitised
from skinbayes.cli.fit import fit
from skinbayes.cli.methods import methods
from skinbayes.cli.new import new
from skinbayes.cli.output import EXIT_BAD_INPUT, EXIT_INTERRUPTED, EXIT_MACHINE, message
from skinbayes.cli.plot import plot
from skinbayes.cli.predict import predict
from skinbayes.cli.prior import prior
from skinbayes.cli.reduce import reduce
from skinbayes.cli.report import report
from skinbayes.cli.reproduce import reproduce
from skinbayes.cli.sensitivity import sensitivity
from skinbayes.cli.spectrum import spectrum
from skinbayes.cli.table import table
from skinbayes.cli.template import template
from skinbayes.errors import NO_SPACE, InputError, MachineError, RepairWarning
from skinbayes.version import __version__

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
    Exit status: 0 done, 2 bad input, 3 finished without converging, 4 stopped by the machine (disk full, folder gone,
    process killed, no memory; what was stored is kept), 130 interrupted.
    """


for _command in (
    models,
    datasets,
    show,
    new,
    template,
    digitised,
    reduce,
    spectrum,
    check,
    prior,
    predict,
    fit,
    sensitivity,
    compare,
    design,
    calibrate,
    report,
    plot,
    table,
    methods,
    reproduce,
):
    cli.add_command(_command)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; exits with the documented status."""
    for name in ONE_THREAD:
        os.environ.setdefault(name, "1")
    try:
        _prepare_output()
        with _repairs_told():
            status = cli.main(
                args=None if arguments is None else list(arguments),
                prog_name="skinbayes",
                standalone_mode=False,
            )
        if sys.stdout is not None:
            sys.stdout.flush()
    except InputError as error:
        _complain(str(error))
        status = EXIT_BAD_INPUT
    except MachineError as error:
        _complain(str(error))
        status = EXIT_MACHINE
    except MemoryError:
        _complain("there is not enough memory")
        status = EXIT_MACHINE
    except click.ClickException as error:
        shown = io.StringIO()
        error.show(shown)  # a wrong option, for example
        with suppress(OSError):
            for line in shown.getvalue().splitlines():
                click.echo(message(line), err=True)
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
        if not place and error.errno in (*NO_SPACE, errno.EBADF, errno.EIO):
            place = "output cannot be written: "
        _complain(f"{place}{error.strerror or error}")
        status = EXIT_MACHINE if error.errno in NO_SPACE else EXIT_BAD_INPUT
    sys.exit(status if isinstance(status, int) else 0)


def _complain(text: str) -> None:
    """One message on standard error, if that can be written."""
    with suppress(OSError):
        click.echo(f"skinbayes: {message(text)}", err=True)


def _prepare_output() -> None:
    """Have characters that standard output cannot take replaced (σ in many code pages), and refuse to work for nobody."""
    if sys.stdout is None:
        raise InputError("standard output is closed; expected one to write to, such as a file or /dev/null")
    streams: tuple[Any, ...] = (sys.stdout, sys.stderr)
    for stream in streams:
        if getattr(stream, "errors", None) in ("strict", "surrogateescape"):
            stream.reconfigure(errors="replace")


@contextmanager
def _repairs_told() -> Iterator[None]:
    """Say on standard error, in one line, what was damaged and what was done about it."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", RepairWarning)
        shown = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
            if issubclass(category, RepairWarning):
                _complain(str(message))
            else:
                shown(message, category, *place, **more)

        warnings.showwarning = show
        yield
