# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs the poses of a run with the true ones and aligns the two trajectories."""

import numpy as np

MAX_DIFFERENCE = 0.02  # s, between the stamps of an estimated pose and a true one


def pair(stamps, truth_stamps):
    """Pairs of indices (k x 2) of stamps that differ by less than MAX_DIFFERENCE.

    Each stamp is in one pair at most; the pair with the smallest difference is taken first.
    """
    candidates = []
    begin = np.searchsorted(truth_stamps, stamps - MAX_DIFFERENCE)
    end = np.searchsorted(truth_stamps, stamps + MAX_DIFFERENCE, side="right")
    for i, stamp in enumerate(stamps):
        for j in range(begin[i], end[i]):
            candidates.append((abs(stamp - truth_stamps[j]), i, j))
    used_i, used_j, pairs = set(), set(), []
    for difference, i, j in sorted(candidates):
        if difference < MAX_DIFFERENCE and i not in used_i and j not in used_j:
            used_i.add(i)
            used_j.add(j)
            pairs.append((i, j))
    return np.array(sorted(pairs), dtype=int).reshape(-1, 2)


def align(source, target, with_scale=False):
    """Returns s, R (3 x 3) and t (3) that minimise |s R source + t - target| (Umeyama 1991).

    `source` and `target` are n x 3, one point per row. s is 1 unless `with_scale`.
    """
    source_mean, target_mean = source.mean(axis=0), target.mean(axis=0)
    u, singular, vt = np.linalg.svd((target - target_mean).T @ (source - source_mean))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    rotation = u @ flip @ vt
    spread = np.sum((source - source_mean) ** 2)
    scale = float(singular @ np.diag(flip) / spread) if with_scale and spread > 0 else 1.0
    return scale, rotation, target_mean - scale * rotation @ source_mean
