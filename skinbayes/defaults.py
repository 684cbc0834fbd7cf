"""What commands and functions take unless told otherwise, where both have to say it: the help of a command imports no sampler."""

SEED = 1
"""The same command gives the same draws."""

EFFECTIVE_SAMPLE_SIZE = 2000
"""Wanted in every parameter."""

MAX_STEPS = 10_000
"""Of each ensemble of walkers, converged or not."""

MOST_DRAWS = 1000
"""Posterior draws that are kept of each of many fits."""
