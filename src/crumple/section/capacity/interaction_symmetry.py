"""Turns and mirror images that leave the plastic interaction of a section as it is.

Those of a square act on (M_y, M_z) as matrices with entries 0, 1 and -1.  A section that is symmetric about
its z axis has the image (N, M_y, -M_z), one symmetric about y the image (N, -M_y, M_z), one that looks the
same after half a turn both signs, and a square section M_y and M_z exchanged.  The surface is even besides,
so half a turn also means that N may change its sign.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.capacity.interaction import PlasticInteraction

SAME = 1e-7
"""Difference of two dissipations, over the largest, that is rounding of the places of the walls."""
ROUND = 1e-4
"""The same of a ring, whose wall is drawn by many straight sides."""
_AWAY = np.array([1.0, 0.31, 0.077])
"""Direction that no image leaves as it is: of all images of a place, the one furthest along it is kept."""


def _square() -> Floats:
    """The eight turns and mirror images of a square, the identity first, shape (8, 3, 3)."""
    images = []
    for order, one, other in product(((1, 2), (2, 1)), (1.0, -1.0), (1.0, -1.0)):
        image = np.diag([1.0, 0.0, 0.0])
        image[1, order[0]], image[2, order[1]] = one, other
        images.append(image)
    return np.array(images)


_SQUARE = _square()


def symmetry(interaction: PlasticInteraction) -> Floats:
    """Images of (N, M_y, M_z) over their scales that the surface is equal to, itself first, shape (g, 3, 3).

    Found by the dissipation of the walls at rates without symmetry and at the images of these rates, so it
    does not matter how the walls are drawn.
    """
    rates = np.random.default_rng(0).normal(size=(24, 3)) * [0.5, 1.0, 1.0]
    images = rates @ _SQUARE.transpose(0, 2, 1)
    whole = np.concatenate([images, np.zeros((*images.shape[:2], 1))], axis=-1)
    dissipated = interaction.support(whole / interaction.scales)
    off = np.abs(dissipated - dissipated[0]).max(axis=1)
    same = off <= SAME * dissipated[0].max()
    return np.asarray(_SQUARE[same])


def axisymmetric(interaction: PlasticInteraction) -> bool:
    """Whether moments about all axes are alike, as in a round tube."""
    angle = np.linspace(0.0, math.pi / 2.0, 8)[:, None]
    stretch, zero = np.array([0.0, 0.3, 1.0, 3.0]), np.zeros((len(angle), 4))
    rates = np.stack([stretch + zero, np.cos(angle) + zero, np.sin(angle) + zero, zero], axis=-1)
    dissipated = interaction.support(rates / interaction.scales)
    return bool(np.all(np.abs(dissipated - dissipated[0]) <= ROUND * dissipated[0]))


def one_of_each(places: Floats, images: Floats) -> Floats:
    """Whether a place (N, M_y, M_z) is the one to keep of its images and their opposites, (n, 3) to (n,)."""
    best = np.abs(places @ (_AWAY @ images).T).max(axis=1)
    return np.asarray(places @ _AWAY >= best - 1e-9 * best)


def multiplicity(rows: Floats, images: Floats) -> tuple[Floats, Floats]:
    """How many linear forms the images of each row are, and the projection on what its own images keep.

    Parameters
    ----------
    rows, images
        Shapes (k, 3) and (g, 3, 3).

    Returns
    -------
    tuple
        Counts (k,): a row that is its own image, or minus it, counts once.  Matrices (k, 3, 3) under which
        a changed row has no more images than before.
    """
    turned = (rows @ images.transpose(0, 2, 1)).transpose(1, 0, 2)
    size = 1e-9 * np.abs(rows).max(axis=1)[:, None]
    kept = (np.abs(turned - rows[:, None]).max(axis=2) <= size).astype(float)
    turned_round = (np.abs(turned + rows[:, None]).max(axis=2) <= size).astype(float)
    number = (kept + turned_round).sum(axis=1)
    projection = np.tensordot(kept - turned_round, images, 1) / number[:, None, None]
    return len(images) / number, projection


def with_images(rows: Floats, images: Floats) -> Floats:
    """All different images of rows, minus a row being the same, shape (n, 3)."""
    found: list[Floats] = []
    for row in rows:
        own: list[Floats] = []
        for image in images @ row:
            if not any(np.array_equal(image, s * other) for other in own for s in (1.0, -1.0)):
                own.append(image)
        found += own
    return np.array(found)
