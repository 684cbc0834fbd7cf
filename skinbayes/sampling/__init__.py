"""Ensemble sampling of any target density: starts, moves, stopping rule and store. Knows nothing of skin."""
