# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a picture shows."""

import numpy as np


def painted(path):
    """Share of the pixels that have another colour than the background, the most frequent one."""
    from matplotlib.image import imread

    pixels = (imread(path)[..., :3] * 255).astype(np.uint32)
    colours = pixels[..., 0] << 16 | pixels[..., 1] << 8 | pixels[..., 2]
    _, counts = np.unique(colours, return_counts=True)
    return 1.0 - counts.max() / counts.sum()
