#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes up a vocabulary in DBoW2's text format, for tests and benchmarks of large files.

The tree is full. Its descriptors and weights are random, so it cannot be used to recognise places.
The default has the shape of ORB-SLAM2's ORBvoc.txt: a million words, 145 MB. The same arguments give
the same bytes.

Exit codes: 0 done, 2 bad usage or a file that cannot be written.
"""

import argparse

import numpy as np


def write_vocabulary(stream, branching, levels, seed):
    """Writes the nodes level by level; all leaves are on the last level."""
    random = np.random.default_rng(seed)
    stream.write(f"{branching} {levels} 0 0\n")
    first_parent, parents = 0, 1
    for level in range(1, levels + 1):
        is_leaf = int(level == levels)
        count = parents * branching
        for begin in range(0, count, 10_000):  # keeps the memory small
            numbers = range(begin, min(begin + 10_000, count))
            descriptors = random.integers(0, 256, (len(numbers), 32)).tolist()
            weights = random.uniform(0.5, 8.0, len(numbers)).tolist()
            stream.writelines(
                f"{first_parent + number // branching} {is_leaf} {' '.join(map(str, descriptor))} "
                f"{weight if is_leaf else 0:.6g}\n"
                for number, descriptor, weight in zip(numbers, descriptors, weights))
        first_parent, parents = first_parent + parents, count


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", help="text file to write")
    parser.add_argument("--branching", type=int, default=10, help="children of a node (10)")
    parser.add_argument("--levels", type=int, default=6, help="levels of the tree (6)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the numbers (0)")
    arguments = parser.parse_args()
    if arguments.branching < 2 or arguments.levels < 1:
        parser.error("expected --branching of at least 2 and --levels of at least 1")
    try:
        with open(arguments.output, "w", encoding="ascii") as stream:
            write_vocabulary(stream, arguments.branching, arguments.levels, arguments.seed)
    except OSError as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
