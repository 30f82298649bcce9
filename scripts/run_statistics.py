# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests whether two sets of runs differ by more than chance."""

import itertools
import math
import random
import statistics

EXACT_PAIRS = 14  # up to so many pairs, all 2^n sign flips are tried
DRAWS = 20000  # of random sign flips for more pairs


def flip_probability(differences):
    """The two-sided p of Fisher's sign-flip test that the mean of paired differences is 0."""
    observed = abs(sum(differences)) * (1 - 1e-12)  # rounding must not exclude the observed signs
    if len(differences) <= EXACT_PAIRS:
        flips = list(itertools.product((1, -1), repeat=len(differences)))
        drawn = 0
    else:
        draw = random.Random(1)
        flips = [[draw.choice((1, -1)) for _ in differences] for _ in range(DRAWS)]
        drawn = 1  # the observed signs are one of the draws
    extreme = sum(abs(sum(sign * value for sign, value in zip(signs, differences))) >= observed
                  for signs in flips)
    return (extreme + drawn) / (len(flips) + drawn)


def sign_probability(differences):
    """The two-sided p of the sign test that differences are as often above 0 as below. Zeros do not
    count."""
    above, below = (sum(1 for value in differences if sign * value > 0) for sign in (1, -1))
    count = above + below
    tail = sum(math.comb(count, k) for k in range(min(above, below) + 1)) / 2.0**count
    return min(1.0, 2.0 * tail)


def compare(base, other):
    """(change, p, pairs) of the positive figures `other` against `base`, both {key of a run:
    figure}; (None, None, 0) without a pair. The change is the ratio of the geometric means minus
    1."""
    pairs = [(base[key], other[key]) for key in sorted(base.keys() & other.keys())
             if base[key] > 0 and other[key] > 0]
    if not pairs:
        return None, None, 0
    logs = [math.log(after / before) for before, after in pairs]
    return math.exp(statistics.fmean(logs)) - 1.0, flip_probability(logs), len(logs)
