"""Gap distributions of one skin at all pressures of a range, interpolated between a few.

Along a curve of films only the pressure changes. The components of the gap distribution are smooth functions of ln p, so
that they are computed at a few pressures and interpolated by Chebyshev polynomials.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray, IndexArray
from skinbayes.emulation.chebyshev import coefficients, lobatto, polynomials, slopes
from skinbayes.wetting._gaps import GapSource
from skinbayes.wetting._mixture import Filled, Mixture, cover, fill, folded_mean

_GRID = np.geomspace(1e-4, 3.0, 16)  # gaps in units of the mean separation


class GapFamily(NamedTuple):
    """Gap distributions of B skins at pressures from ``exp(start)`` to ``exp(start + span)``.

    Attributes
    ----------
    start, span : of ln p, p in Pa, dimensionless, shape ``(B,)``
    parts : Chebyshev coefficients of fraction (dimensionless), share times centre and width (m) of the n components, one
        after the other, and of ln ū (m), shape ``(B, K, 3 n + 1)``
    limit : largest centre at the nodes, m, shape ``(B,)``
    narrow : half the smallest width of each component at the nodes, m, shape ``(B, n)``
    middle : distribution in the middle of the range, components of shape ``(B, n)``
    reach : largest gap of each component at any node, to 1e-12 of its fraction, m, shape ``(B, n)``
    rest : coefficients of fraction and share times mean gap (m) of a component and all after it, shape ``(B, K, 2, n)``
    """

    start: FloatArray
    span: FloatArray
    parts: FloatArray
    limit: FloatArray
    narrow: FloatArray
    middle: Mixture
    reach: FloatArray
    rest: FloatArray

    def _basis(self, log_pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        t = 2 * (log_pressure - self.start[:, None]) / self.span[:, None] - 1
        basis = polynomials(t, self.parts.shape[1])
        return basis, basis[..., :-1] @ slopes(self.parts.shape[1]) * (2 / self.span)[:, None, None]

    def at(self, log_pressure: FloatArray) -> tuple[Mixture, Mixture]:
        """Distributions, and their derivatives along ln p, at ln p of shape ``(B, F)``; shapes are ``(B F, n)``."""
        basis, rise = self._basis(log_pressure)
        width, columns = self.parts.shape[-1] - 1, log_pressure.shape[1]
        value, change = ((x @ self.parts[..., :-1]).reshape(-1, width) for x in (basis, rise))
        limit, narrow = (np.repeat(x, columns, axis=0) for x in (self.limit[:, None], self.narrow))
        return _centres(value, change, width // 3, limit, narrow)

    def fill(self, log_pressure: FloatArray, gap: FloatArray) -> Filled:
        """What lies below ``gap`` (m) at ln p, both of shape ``(B, F)``."""
        mixture, _ = self.at(log_pressure)
        return Filled(*(x.reshape(gap.shape) for x in fill(mixture, gap.reshape(-1))))

    def cover(self, log_pressure: FloatArray, gap: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Area below ``gap`` (m) and its derivative along ln p, all of shape ``(B, F)``."""
        mixture, slope = self.at(log_pressure)
        area, rise = cover(mixture, gap.reshape(-1), slope)
        return area.reshape(gap.shape), rise.reshape(gap.shape)

    def block(self, rows: IndexArray) -> GapFamily:
        """Some of the skins."""
        return GapFamily(
            self.start[rows],
            self.span[rows],
            self.parts[rows],
            self.limit[rows],
            self.narrow[rows],
            Mixture(*(x[rows] for x in self.middle)),
            self.reach[rows],
            self.rest[rows],
        )

    def components_above(self, gap: FloatArray) -> IndexArray:
        """How many of the first components reach above ``gap`` (m, shape ``(B,)``), in steps of 8."""
        n = self.reach.shape[1]
        above = self.reach >= gap[:, None]
        last = np.where(above.any(axis=1), n - above[:, ::-1].argmax(axis=1), 0)
        return np.minimum(-(-last // 8) * 8, n)

    def lumped(self, keep: int) -> GapFamily:
        """The family with all components from ``keep`` on in one, exact for gaps that these do not reach."""
        n = self.reach.shape[1]
        if keep >= n - 1:
            return self
        fraction, moment, width = (self.parts[..., i * n : i * n + keep] for i in range(3))
        lump = self.rest[..., keep]
        narrow = np.zeros_like(lump[..., :1])
        narrow[:, 0, 0] = 0.01 * lump[:, 0, 1] / lump[:, 0, 0]
        columns = [fraction, lump[..., :1], moment, lump[..., 1:], width, narrow, self.parts[..., -1:]]
        widths = np.concatenate([self.narrow[:, :keep], narrow[:, 0] / 2], axis=1)
        return self._replace(
            parts=np.concatenate(columns, axis=-1), narrow=widths, reach=self.reach[:, : keep + 1]
        )

    def gap_of_film(self, film: FloatArray) -> FloatArray:
        """Gap (m) below which the film (m, shape ``(B,)``) lies at a pressure in the middle of the range, roughly."""
        mean = self.mean_separation(self.start[:, None])
        gap = mean * _GRID
        mixture = Mixture(*(np.repeat(x, _GRID.size, axis=0) for x in self.middle))
        films = np.log(fill(mixture, gap.reshape(-1)).film).reshape(gap.shape)
        target = np.log(film)[:, None]
        cell = np.clip((films < target).sum(axis=1)[:, None], 1, _GRID.size - 1)
        (low, high), logs = (np.take_along_axis(films, c, axis=1) for c in (cell - 1, cell)), np.log(_GRID)
        # a film that the gap cannot hold at that pressure gets the widest gap of the grid
        rise = np.fmin((target - low) / (high - low), 1.0)
        return np.asarray((mean * np.exp(logs[cell - 1] + (logs[cell] - logs[cell - 1]) * rise))[:, 0])

    def mean_separation(self, log_pressure: FloatArray) -> FloatArray:
        """ū, m, at ln p of shape ``(B, F)``."""
        basis, _ = self._basis(log_pressure)
        return np.asarray(np.exp((basis * self.parts[:, None, :, -1]).sum(axis=-1)))


def gap_family(start: FloatArray, span: FloatArray, source: GapSource, count: int) -> GapFamily:
    """The family between ``exp(start)`` and ``exp(start + span)`` Pa from ``count`` pressures, ends included."""
    pressure = np.exp(start[:, None] + span[:, None] * lobatto(count))
    (fraction, centre, spread), mean = source.at(pressure)
    values = np.concatenate([fraction, fraction * centre, spread, np.log(mean)[..., None]], axis=-1)
    middle = Mixture(*(x[:, count // 2] for x in (fraction, centre, spread)))
    mean_gap = folded_mean(centre, spread)
    after = [np.cumsum(x[..., ::-1], axis=-1)[..., ::-1] for x in (fraction, fraction * mean_gap)]
    rest = coefficients(np.concatenate(after, axis=-1))
    return GapFamily(
        start,
        span,
        coefficients(values),
        centre.max(axis=(1, 2)),
        spread.min(axis=1) / 2,
        middle,
        (centre + 7 * spread).max(axis=1),
        rest.reshape(*rest.shape[:-1], 2, -1),
    )


def _centres(
    value: FloatArray, change: FloatArray, n: int, limit: FloatArray, narrow: FloatArray
) -> tuple[Mixture, Mixture]:
    """Components and their slopes from shares, first moments and widths side by side.

    A component that interpolation leaves with hardly any fraction has a centre and a width of rounding errors; ``limit``
    and ``narrow``, m, shapes ``(M, 1)`` and ``(M, n)``, keep them where they do no harm.
    """
    fraction, fraction_rise = value[:, :n], change[:, :n]
    raw = value[:, n : 2 * n] / fraction
    centre = np.fmin(np.fmax(raw, 0.0), limit)
    rise = np.where(centre == raw, (change[:, n : 2 * n] - raw * fraction_rise) / fraction, 0.0)
    width = np.fmax(value[:, 2 * n :], narrow)
    return Mixture(fraction, centre, width), Mixture(fraction_rise, rise, change[:, 2 * n :])
