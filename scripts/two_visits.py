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
import json
import pathlib
import re
import subprocess
import sys

from support import exit_code, parser_of, programs_folder, read_json, SCRIPTS, Stopped

# First and last frame of each session, for a recording of 800 frames. The second sessions follow the
# first one, overlap with it, come before it, and are short and long.
CUTS = ("0:300,301:500", "0:300,301:799", "0:200,201:799", "0:600,601:799", "400:799,0:399",
        "200:600,0:199")
SCENES = ("desk:0", "desk:1", "desk:2", "room:0", "room:1", "room:3", "house:0")
KINDS = ("seen_again", "moved", "gone", "not_seen", "new", "first_seen")


def run(command, log, codes=(0,)):
    """Runs a program and returns what it prints; its messages go to the file `log`."""
    with log.open("w", encoding="utf-8") as messages:
        result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                                stderr=messages, text=True, check=False)
    if result.returncode not in codes:
        raise Stopped(f"{' '.join(map(str, command))}: exit code {result.returncode}; see {log}")
    return result.stdout


def thinned(sequence, masks, out, recall, seed):
    """The folder of masks of which the share `recall` (%) is left."""
    if recall == 100:
        return masks
    copy = out / "thinned"
    if not copy.exists():
        run([SCRIPTS / "degrade_sequence.py", sequence, copy, "--masks", masks, "--mask-drop",
             1.0 - recall / 100.0, "--seed", seed], out / "thinned.log")
    return copy / "masks"


def two_sessions(arguments, out, first, second):
    """Runs both sessions and returns the numbers of changes. `first` and `second` are the arguments of
    rgbd_tum."""
    settings = [word for value in arguments.set for word in ("--set", value)]
    common = [arguments.programs / arguments.program, *settings, "--quiet", "--overwrite"]
    if not (out / "second" / "summary.json").exists():
        run([common[0], *first, *common[1:], "--save-map", out / "a.map", "--output", out / "first"],
            out / "first.log")
        run([common[0], *second, *common[1:], "--load-map", out / "a.map", "--output",
             out / "second"], out / "second.log")
    objects = read_json(out / "second" / "summary.json")["objects"]
    return {kind: int((objects["changes"] or {}).get(kind, 0)) for kind in KINDS}


def cut_job(arguments, cut, recall, seed):
    """One cut of the recording."""
    out = arguments.out / f"{cut.replace(':', '-').replace(',', '_')}-{recall}-{seed}"
    out.mkdir(parents=True, exist_ok=True)
    masks = thinned(arguments.sequence, arguments.masks, out, recall, seed)
    selections = []
    for part in cut.split(","):
        first, last = part.split(":")
        selections.append([arguments.sequence, "--masks", masks, "--first", first, "--last", last])
    return {"cut": cut, "recall": recall, "seed": seed, **two_sessions(arguments, out, *selections)}


def render(arguments, name, seed, rearranged):
    """The folder of a rendered scene."""
    folder = arguments.out / f"{name}{seed}{'-rearranged' if rearranged else ''}"
    if not (folder / "groundtruth_objects.json").exists():
        more = ["--rearranged", "1"] if rearranged else []
        run([arguments.programs / "make_synthetic", folder, "--scene", name, "--seed", seed, *more,
             "--quiet", "--force"], arguments.out / f"{folder.name}.log")
    return folder


def scene_job(arguments, scene, recall, seed):
    """One scene and its rearranged version."""
    name, number = scene.split(":")
    out = arguments.out / f"{name}{number}-{recall}-{seed}"
    out.mkdir(parents=True, exist_ok=True)
    selections = []
    for rearranged in (False, True):
        folder = render(arguments, name, number, rearranged)
        part = out / ("after" if rearranged else "before")
        part.mkdir(exist_ok=True)
        masks = thinned(folder, folder / "masks", part, recall, seed + rearranged)
        selections.append([folder, "--masks", masks])
    row = {"scene": scene, "recall": recall, "seed": seed, **two_sessions(arguments, out, *selections)}
    told = run([arguments.programs / "hullslam", "evaluate", "objects", out / "second",
                "--groundtruth", selections[1][0] / "groundtruth_objects.json", "--json"],
               out / "evaluate.log")
    changes = json.loads(told)["groundtruth"]["changes"]
    for kind in ("places_left", "places_taken"):
        row |= {f"{kind} {figure}": changes[kind][figure]
                for figure in ("in_truth", "reported", "right")}
    return row


def write_rows(path, rows):
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)


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
            print(f"  {row['scene']:10}", *(row[f"places_left {figure}"]
                                            for figure in ("in_truth", "reported", "right")))
        for kind in ("places_left", "places_taken"):
            truth, said, right = (sum(row[f"{kind} {figure}"] for row in of_recall)
                                  for figure in ("in_truth", "reported", "right"))
            print(f"  {kind}: {right} of {said} reported are right ({100 * right / max(said, 1):.0f} %),"
                  f" {right} of {truth} were found ({100 * right / max(truth, 1):.0f} %)")


def list_jobs(arguments):
    """One function without arguments for each run."""
    seeds = {recall: range(1) if recall == 100 else range(arguments.seeds)
             for recall in arguments.recall}
    pairs = [(recall, seed) for recall in arguments.recall for seed in seeds[recall]]
    if arguments.kind == "scenes":
        return [lambda a=(scene, *pair): scene_job(arguments, *a)
                for scene in arguments.scene for pair in pairs]
    return [lambda a=(cut, *pair): cut_job(arguments, *a) for cut in arguments.cut for pair in pairs]


def measure(arguments):
    arguments.out.mkdir(parents=True, exist_ok=True)
    if arguments.kind == "scenes":  # rendered before, since several runs need the same scene
        for scene in arguments.scene:
            for rearranged in (False, True):
                render(arguments, *scene.split(":"), rearranged)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        rows = list(pool.map(lambda job: job(), list_jobs(arguments)))
    write_rows(arguments.out / f"{arguments.kind}.csv", rows)
    (print_scenes if arguments.kind == "scenes" else print_still)(rows)


def main(words=None):
    parser = parser_of(__doc__)
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="still|scenes")
    still, scenes = kinds.add_parser("still"), kinds.add_parser("scenes")
    still.add_argument("sequence", type=pathlib.Path, metavar="SEQUENCE")
    for kind in (still, scenes):
        kind.add_argument("out", type=pathlib.Path, metavar="OUT")
        kind.add_argument("--recall", type=int, nargs="+", default=[100], metavar="PERCENT",
                          help="shares of the masks that are left, in % (default 100)".replace("%", "%%"))
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
    if not all(1 <= recall <= 100 for recall in arguments.recall):
        parser.error("--recall must be from 1 to 100")
    return exit_code(measure, arguments)


if __name__ == "__main__":
    sys.exit(main())
