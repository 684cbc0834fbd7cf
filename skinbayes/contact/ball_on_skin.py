"""The modulus that a ball meets on skin of any number of layers."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.layered_contact import layered_sphere_contact
from skinbayes.contact.solid import ElasticSolid
from skinbayes.contact.stacked_skin import StackedSkin


def modulus_under_ball(
    normal_force: ArrayLike, sphere_radius: ArrayLike, *, skin: ElasticSolid
) -> FloatArray:
    """Plane-strain modulus of the half-space on which a ball has the contact radius that it has on the skin.

    The uppermost layer, stratum corneum, is taken to be far thinner than the contact is wide and left out: it bends with what
    lies below. So it is `contact_modulus` of one layer, and of `StackedSkin` that of `layered_sphere_contact` with the others,
    which may be as thick as the contact is wide. With it in Hertz's formulas contact radius and mean pressure are right; the
    pressure profile is that of a half-space.

    Parameters
    ----------
    normal_force : F_N, N, > 0, any batch shape
    sphere_radius : R, m, > 0, broadcasts
    skin : moduli in Pa, lengths in m, broadcasts

    Returns
    -------
    modulus_under_ball : E*, Pa; of the batch shape of ``skin`` for one layer, of the broadcast shape for more; nan where an
        argument is impossible

    Notes
    -----
    About 0.1 s for each distinct skin of several layers. Friction of a lubricated ball with this modulus is within 3 to 5 % of
    that with the films on the layers themselves where the base is stiffer, 10 to 17 % where it is ten times softer. Under the
    skin and the ball of the paper the stratum corneum narrows the contact by 2.2 % and changes friction by 0.4 % at most.

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 5.8, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> skin = StackedSkin(young_moduli=[7e6, 80e3, 15e3], thicknesses=[20e-6, 1.2e-3])
    >>> print(modulus_under_ball([0.02, 2.0], 8e-3, skin=skin).round(-2))
    [70300. 25600.]
    """
    if not isinstance(skin, StackedSkin):
        return skin.contact_modulus
    parts = [part[1:] for part in skin.layer_by_layer()]
    if len(parts[0]) == 1:
        return skin.contact_modulus
    force, radius = (np.asarray(x, dtype=np.float64) for x in (normal_force, sphere_radius))
    columns = np.broadcast_arrays(force, radius, *(values for part in parts for values in part))
    rows = np.stack([np.ravel(column) for column in columns], axis=-1)
    found = np.full(len(rows), np.nan)
    possible = np.isfinite(rows).all(axis=1) & (rows[:, :2] > 0).all(axis=1)
    distinct, place = np.unique(rows[possible], axis=0, return_inverse=True)
    layers = len(parts[0])
    moduli = [
        float(
            layered_sphere_contact(
                one[0],
                float(one[1]),
                moduli=one[2 : 2 + layers].tolist(),
                poisson_ratios=one[2 + layers : 2 + 2 * layers].tolist(),
                thicknesses=one[2 + 2 * layers :].tolist(),
            ).equivalent_modulus[0]
        )
        for one in distinct
    ]
    found[possible] = np.array(moduli)[place.reshape(-1)]
    return found.reshape(columns[0].shape)[()]
