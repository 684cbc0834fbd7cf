"""Total pressure of bridged skin against the film, from curves solved now or interpolated in a table."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray, IndexArray
from skinbayes.contact import mean_separation
from skinbayes.emulation.chebyshev import lobatto
from skinbayes.wetting._curve import Curve, solve_curve
from skinbayes.wetting._gaps import GapSource
from skinbayes.wetting._solids import Solid
from skinbayes.wetting.bridge_table import BridgeTable, skin_groups


class Bridged(NamedTuple):
    """A flat batch of B skins that bridges may hold.

    Attributes
    ----------
    load, wetting_tension : p0, Pa, and γ_w Σcos θ ≥ 0, N/m, shape ``(B,)``
    source : what their gap distributions are made of, each part of no batch shape or of shape ``(B,)``
    height : rms height, m, shape ``(B,)``
    table : curves solved beforehand, or None
    """

    load: FloatArray
    wetting_tension: FloatArray
    source: GapSource
    height: FloatArray
    table: BridgeTable | None

    def with_layer(self, modulus: FloatArray) -> Bridged:
        """The same with other moduli of the layer, Pa, shape ``(B,)``."""
        skin: Any = self.source.skin  # a layered one: others have no layer
        skin = replace(skin, young_modulus_layer=modulus)
        source = GapSource(self.source.spectrum, skin, self.source.area_correction, self.source.closure)
        return self._replace(source=source)

    def select(self, rows: IndexArray) -> Bridged:
        """Some of the skins."""
        return Bridged(
            self.load[rows],
            self.wetting_tension[rows],
            self.source.select(rows),
            self.height[rows],
            self.table,
        )

    def flooded(self) -> tuple[FloatArray, BoolArray, Curve | None]:
        """Flooded film ū(p0), m, and which skins the table knows, shape ``(B,)``; and the curves of these."""
        known, curve = np.zeros(self.load.shape, dtype=bool), None
        separation = np.full(self.load.shape, np.nan)
        source = self.source
        if self.table is not None and isinstance(source.skin, Solid):
            groups = skin_groups(
                self.load,
                self.wetting_tension,
                height=self.height,
                spectrum=source.spectrum,
                skin=source.skin,
                area_correction=source.area_correction,
            )
            known = self.table.covers(groups) & (self.wetting_tension > 0)
            if known.any():
                chosen = {name: value[known] for name, value in groups.items()}
                curve = self.table.curve(chosen, self.load[known], height=self.height[known])
                separation[known] = curve.flooded()
        rest = np.flatnonzero(~known)
        if rest.size:
            source = self.source.select(rest)
            separation[rest] = mean_separation(
                self.load[rest, None],
                source.spectrum,
                skin=source.skin,
                area_correction=source.area_correction,
            )[:, 0]
        return separation, known, curve

    def curves(
        self, thinnest: FloatArray, separation: FloatArray, known: BoolArray, curve: Curve | None
    ) -> Iterator[tuple[IndexArray, Curve]]:
        """Curves of the skins with bridges that reach down to the film ``thinnest``, m, with what `flooded` found."""
        if curve is not None:
            # a curve of the table that ends too early is solved anew
            far = curve.nodes[:, -1] <= np.log(thinnest[known])
            rows = np.flatnonzero(known)[far]
            known = known.copy()
            known[np.flatnonzero(known)[~far]] = False
            if rows.size:
                yield rows, curve.select(far)
        solvable = (
            np.isfinite(self.load * self.wetting_tension * separation)
            & (self.wetting_tension > 0)
            & (separation > 0)
        )
        rows = np.flatnonzero(solvable & ~known)
        if rows.size:
            load, wetting_tension, film = self.load[rows], self.wetting_tension[rows], thinnest[rows]
            yield (
                rows,
                solve_curve(
                    self.source.select(rows), load, wetting_tension, separation[rows], film, whole=True
                ),
            )

    def log_pressure(self, films: FloatArray) -> FloatArray:
        """ln p, p in Pa, at films, m, of shape ``(B, F)``; nan where a parameter is impossible."""
        if not (self.wetting_tension > 0).any():
            return np.asarray(np.log(self.load + 0 * self.wetting_tension)[:, None] + np.zeros(films.shape))
        separation, known, curve = self.flooded()
        possible = np.isfinite(self.load * self.wetting_tension * separation)
        found = np.where(possible, np.log(self.load), np.nan)[:, None] + np.zeros(films.shape)
        # where there is nothing to solve, half of the flooded film stands in
        inside = np.where(films < separation[:, None], films, separation[:, None] / 2)
        for rows, each in self.curves(inside.min(axis=1), separation, known, curve):
            bridged = each.at(inside[rows])[1][0]
            found[rows] = np.where(films[rows] < separation[rows, None], bridged, found[rows])
        return found

    def path(self, count: int, floor: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Films, m, from the floor (at most half of the flooded film) to flooded, and ln p there, shapes ``(B, count)``."""
        separation, known, curve = self.flooded()
        start = np.minimum(floor, separation / 2)
        possible = np.isfinite(self.load * self.wetting_tension * separation)
        films = start[:, None] + (separation - start)[:, None] * lobatto(count)
        found = np.where(possible, np.log(self.load), np.nan)[:, None] + np.zeros(films.shape)
        for rows, each in self.curves(start, separation, known, curve):
            # equal steps of z are short where the film matters; backwards, as the film falls along z
            first = each.place(start[rows, None])
            log_film, found[rows] = each.along(first * (1 - lobatto(count)))
            films[rows] = np.exp(log_film)
            films[rows, 0], films[rows, -1] = start[rows], separation[rows]
        return films, found
