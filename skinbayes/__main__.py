"""`python -m skinbayes` is the command `skinbayes`."""

from skinbayes.cli import main

main()
