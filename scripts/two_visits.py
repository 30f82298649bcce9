#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts how often a second visit reports wrong departures, and how many departures it finds.

    two_visits.py still SEQUENCE OUT [--masks MASKS]   one recording in which nothing moves, cut in two
    two_visits.py scenes OUT [--scene desk:0 ...]      rendered scenes and their rearranged versions

`still` cuts SEQUENCE (TUM's format) into two sessions in six ways, or as --cut A:B,C:D says: the frames
A to B, then C to D. The second session goes on with the
map of the first one. As nothing leaves, every object that it reports as gone or moved is a false
departure. `scenes` renders each scene twice, the second time with objects moved, taken away and added,
and compares the reported departures with the true ones: NAME:SEED is the scene and the seed.

With --recall a share of the masks is removed at random, with another seed for each run, as a network
would miss them. OUT gets the runs, and OUT/still.csv or OUT/scenes.csv with one row per run. What is
there already is not made again.

Exit codes: 0 done, 1 a run failed, 2 bad usage or input.
"""

import concurrent.futures
import csv
import functools
import itertools
import pathlib
import re
import sys

from paper_tables.figures import ask
from support import exit_code, number, parser_of, programs_folder, read_json, run_program, SCRIPTS, Stopped

# First and last frame of each session, for a recording of 800 frames. The second sessions follow the
# first one, overlap with it, come before it, and are short and long.
CUTS = ("0:300,301:500", "0:300,301:799", "0:200,201:799", "0:600,601:799", "400:799,0:399", "200:600,0:199")
SCENES = ("desk:0", "desk:1", "desk:2", "room:0", "room:1", "room:3", "house:0")
KINDS = ("seen_again", "moved", "gone", "not_seen", "new", "first_seen")
PLACES, FIGURES = ("places_left", "places_taken"), ("in_truth", "reported", "right")


def run(command, log):
    """Runs a program, whose messages go to the file `log`."""
    if (code := run_program(command, log)) != 0:
        raise Stopped(f"{' '.join(map(str, command))}: exit code {code}; see {log}")


def thinned(sequence, masks, out, recall, seed):
    """The folder of masks of which the share `recall` (%) is left."""
    if recall == 100:
        return masks
    copy = out / "thinned"
    if not copy.exists():
        run([SCRIPTS / "degrade_sequence.py", sequence, copy, "--masks", masks, "--mask-drop",
             1.0 - recall / 100.0, "--seed", seed], out / "thinned.log")
    return copy / "masks"


def render(arguments, scene, is_rearranged):
    """The folder of a rendered scene."""
    name, seed = scene.split(":")
    folder = arguments.out / f"{name}{seed}{'-rearranged' if is_rearranged else ''}"
    if not (folder / "groundtruth_objects.json").exists():
        more = ["--rearranged", "1"] if is_rearranged else []
        run([arguments.programs / "make_synthetic", folder, "--scene", name, "--seed", seed, *more,
             "--quiet", "--force"], arguments.out / f"{folder.name}.log")
    return folder


def sessions_of(arguments, subject, recall, seed, out):
    """The arguments of rgbd_tum for the two sessions of a cut of the recording, or of a scene and its
    rearranged version."""
    if arguments.kind == "still":
        masks = thinned(arguments.sequence, arguments.masks, out, recall, seed)
        return [[arguments.sequence, "--masks", masks, "--first", first, "--last", last]
                for first, last in (part.split(":") for part in subject.split(","))]
    found = []
    for index, part in enumerate(("before", "after")):
        (out / part).mkdir(exist_ok=True)
        folder = render(arguments, subject, index)
        found.append([folder, "--masks", thinned(folder, folder / "masks", out / part, recall, seed + index)])
    return found


def measure_one(arguments, subject, recall, seed):
    """The row of a cut or a scene: the numbers of changes and, for a scene, those of the truth."""
    names = {":": "-" if arguments.kind == "still" else "", ",": "_"}
    out = arguments.out / f"{subject.translate(str.maketrans(names))}-{recall}-{seed}"
    out.mkdir(parents=True, exist_ok=True)
    sessions = sessions_of(arguments, subject, recall, seed, out)
    if not (out / "second" / "summary.json").exists():
        settings = [word for value in arguments.set for word in ("--set", value)]
        for name, session, option in zip(("first", "second"), sessions, ("--save-map", "--load-map")):
            run([arguments.programs / arguments.program, *session, *settings, "--quiet", "--overwrite",
                 option, out / "a.map", "--output", out / name], out / f"{name}.log")
    changes = read_json(out / "second" / "summary.json")["objects"]["changes"] or {}
    row = {"cut" if arguments.kind == "still" else "scene": subject, "recall": recall, "seed": seed,
           **{kind: int(changes.get(kind, 0)) for kind in KINDS}}
    if arguments.kind == "scenes":
        told = ask(arguments.programs / "hullslam", "evaluate", "objects", out / "second", "--groundtruth",
                   sessions[1][0] / "groundtruth_objects.json", "--json")
        if not told:
            raise Stopped(f"{out / 'second'}: cannot be compared with the true objects")
        row |= {f"{kind} {figure}": told["groundtruth"]["changes"][kind][figure]
                for kind in PLACES for figure in FIGURES}
    return row


def print_still(rows):
    """False departures of each cut and recall, summed over the seeds."""
    for recall in sorted({row["recall"] for row in rows}, reverse=True):
        print(f"masks {recall} %: seen again, moved, gone, not seen")
        for cut in dict.fromkeys(row["cut"] for row in rows):
            of_cut = [row for row in rows if row["cut"] == cut and row["recall"] == recall]
            print(f"  {cut:16}", *(sum(row[kind] for row in of_cut) for kind in KINDS[:4]))
        of_recall = [row for row in rows if row["recall"] == recall]
        false = sum(row["moved"] + row["gone"] for row in of_recall)
        print(f"  {false} false departures in {len(of_recall)} runs")


def print_scenes(rows):
    """Precision and recall of departures and of new places, over all scenes."""
    for recall in sorted({row["recall"] for row in rows}, reverse=True):
        of_recall = [row for row in rows if row["recall"] == recall]
        print(f"masks {recall} %: in truth, reported, right")
        for row in of_recall:
            print(f"  {row['scene']:10}", *(row[f"places_left {figure}"] for figure in FIGURES))
        for kind in PLACES:
            truth, said, right = (sum(row[f"{kind} {figure}"] for row in of_recall) for figure in FIGURES)
            print(f"  {kind}: {right} of {said} reported are right ({100 * right / max(said, 1):.0f} %),"
                  f" {right} of {truth} were found ({100 * right / max(truth, 1):.0f} %)")


def measure(arguments):
    arguments.out.mkdir(parents=True, exist_ok=True)
    subjects = arguments.cut if arguments.kind == "still" else arguments.scene
    # Rendered before, since several runs need the same scene.
    for scene in subjects if arguments.kind == "scenes" else ():
        for is_rearranged in (False, True):
            render(arguments, scene, is_rearranged)
    pairs = [(recall, seed) for recall in arguments.recall
             for seed in range(1 if recall == 100 else arguments.seeds)]
    jobs = [functools.partial(measure_one, arguments, subject, *pair)
            for subject, pair in itertools.product(subjects, pairs)]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        rows = list(pool.map(lambda job: job(), jobs))
    with (arguments.out / f"{arguments.kind}.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    (print_scenes if arguments.kind == "scenes" else print_still)(rows)


def main(words=None):
    parser = parser_of(__doc__)
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="still|scenes")
    still, scenes = kinds.add_parser("still"), kinds.add_parser("scenes")
    still.add_argument("sequence", type=pathlib.Path, metavar="SEQUENCE")
    for kind in (still, scenes):
        kind.add_argument("out", type=pathlib.Path, metavar="OUT")
        kind.add_argument("--recall", type=number(1, 100, int), nargs="+", default=[100], metavar="PERCENT",
                          help="shares of the masks that are left, in %% (default 100)")
        kind.add_argument("--seeds", type=int, default=1, metavar="N",
                          help="runs for each recall below 100 (default 1)")
        kind.add_argument("--jobs", type=int, default=1, metavar="N",
                          help="runs at the same time (default 1)")
        kind.add_argument("--program", default="rgbd_tum", help="rgbd_tum (default) or mono_tum")
        kind.add_argument("--programs", type=pathlib.Path, default=programs_folder(), metavar="DIR",
                          help="folder of the programs")
        kind.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                          help="a setting for all runs")
    still.add_argument("--masks", type=pathlib.Path, help="folder of masks, format yolo-seg (default: "
                       "SEQUENCE/masks)")
    still.add_argument("--cut", nargs="+", default=CUTS, metavar="A:B,C:D",
                       help=f"(default: {' '.join(CUTS)})")
    scenes.add_argument("--scene", nargs="+", default=SCENES, metavar="NAME:SEED",
                        help=f"(default: {' '.join(SCENES)})")
    arguments = parser.parse_args(words)
    if arguments.kind == "still":
        arguments.masks = arguments.masks or arguments.sequence / "masks"
        for cut in arguments.cut:
            if not re.fullmatch(r"\d+:\d+,\d+:\d+", cut):
                parser.error(f"--cut is '{cut}', expected four numbers of frames as in {CUTS[0]}")
    return exit_code(measure, arguments)


if __name__ == "__main__":
    sys.exit(main())
