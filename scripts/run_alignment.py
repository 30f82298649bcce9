# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs stamps, such as those of the poses of a run and the true ones, and aligns trajectories."""

import numpy as np

MAX_DIFFERENCE = 0.02  # s, between stamps of a pair: estimated and true pose, or image and depth
LEAST_POSES = 3  # for an alignment
STARTS = 50  # of align_most(). If half of the points are right, so is one of 8 triples, and no triple of
#              50 is right with a probability of (7/8)^50 = 0.1 %


def pair(stamps, truth_stamps):
    """Pairs of indices (k x 2) of stamps that differ by less than MAX_DIFFERENCE.

    Each stamp is in one pair at most; the pair with the smallest difference is taken first, as in TUM's
    associate.py.
    """
    order = np.argsort(truth_stamps, kind="stable")
    begin = np.searchsorted(truth_stamps, stamps - MAX_DIFFERENCE, sorter=order)
    end = np.searchsorted(truth_stamps, stamps + MAX_DIFFERENCE, side="right", sorter=order)
    candidates = sorted((abs(stamp - truth_stamps[j]), i, j) for i, stamp in enumerate(stamps)
                        for j in order[begin[i]:end[i]])
    used_i, used_j, pairs = set(), set(), []
    for difference, i, j in candidates:
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


def move(alignment, points):
    """Points moved by a result of align()."""
    scale, rotation, shift = alignment
    return scale * points @ rotation.T + shift


def align_most(source, target, with_scale=False):
    """align() for the half of the points that agrees best, so that up to half may be wrong.

    Least trimmed squares (Rousseeuw and Van Driessen 2006): from triples of points, the half with
    the smallest errors is aligned anew until it stays the same, and of all results the one with the
    smallest sum of squares in its half counts. The triples are always the same.
    """
    count = len(source)
    half, rng = count // 2 + 1, np.random.default_rng(1)
    best, least = align(source, target, with_scale), np.inf
    for _ in range(STARTS):
        chosen, last = rng.choice(count, min(3, count), replace=False), np.inf
        while True:
            found = align(source[chosen], target[chosen], with_scale)
            squares = np.sum((move(found, source) - target) ** 2, axis=1)
            chosen = np.argpartition(squares, half - 1)[:half]
            total = squares[chosen].sum()
            if total >= last * (1.0 - 1e-6):
                break
            last = total
        if last < least:
            best, least = found, last
    return best
