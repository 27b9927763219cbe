# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a picture shows, and posts that share one."""

import pickle

import numpy as np

from pkm_post.report import plots


def painted(path):
    """Share of the pixels that have another colour than the background, the most frequent one."""
    from matplotlib.image import imread

    pixels = (imread(path)[..., :3] * 255).astype(np.uint32)
    colours = pixels[..., 0] << 16 | pixels[..., 1] << 8 | pixels[..., 2]
    _, counts = np.unique(colours, return_counts=True)
    return 1.0 - counts.max() / counts.sum()


def draw_equal_pictures_once(monkeypatch):
    """Let posts of equal data share the picture of the first; drawing it takes two thirds of a small post.

    A post whose picture would be made of other data draws its own. So files that are compared differ where they
    differed before.
    """
    draw, drawn = plots.draw, {}

    def draw_or_copy(path, *data):
        known = pickle.dumps(data)
        if known not in drawn:
            missing = draw(path, *data)
            drawn[known] = missing, None if missing else path.read_bytes()
        missing, picture = drawn[known]
        if picture is not None:
            path.write_bytes(picture)
        return missing

    monkeypatch.setattr(plots, "draw", draw_or_copy)
    return drawn
