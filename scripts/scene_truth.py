#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares scene.json of runs with the true relations of their synthetic sequences.

For each pair RUN_DIR SEQUENCE it prints precision and recall of the relations on, in and beside
between the mapped objects, and at the end those of all pairs together. With --questions N it also
asks hullslam query N questions per scene whose answer is known, and prints how often the right
object comes first. docs/scene.md explains how the figures are counted.

Exit codes: 0 done, 2 bad usage or input.
"""

import collections
import json
import math
import pathlib
import sys

from support import call, exit_code, InputError, parser_of, programs_folder, read_json

RELATIONS = ("on", "in", "beside")
NEAREST = 0.5  # of the true size: the largest distance between the centres of matched objects


def read_object(path, *keys):
    """The JSON object in a file, which must have these keys."""
    content = read_json(path)
    for key in keys:
        if key not in content:
            raise InputError(f"{path}: has no {key}")
    return content


def match(scene, truths):
    """The id of the true object of each mapped object. As in `evaluate objects`, it is the one
    whose centre is nearest in relation to its size. Of several mapped objects of one true object,
    the nearest counts."""
    best = {}
    for mapped in scene["objects"]:
        shares = [(math.dist(mapped["centre"], truth["world_from_object"][:3])
                   / (2.0 * sum(truth["half_extents"]) / 3.0), truth["id"]) for truth in truths]
        share, truth = min(shares, default=(1.0, -1))
        if share <= NEAREST and (truth not in best or share < best[truth][0]):
            best[truth] = (share, mapped["id"])
    return {mapped: truth for truth, (_, mapped) in best.items()}


def true_relations(truth, known):
    """The true relations between known objects, as a set of (relation, subject, object), and the support
    of each object. A support is the text "support 2"."""
    heights = [support["height"] for support in truth["supports"]]
    # The floors of all rooms are one floor, which is the first support.
    names = [f"support {heights.index(height) if height == 0.0 else i}" for i, height in enumerate(heights)]
    relations, supports = set(), {}
    for entry in truth["relations"]:
        if "support" in entry:
            supports[entry["subject"]] = names[entry["support"]]
        other = entry["object"] if "object" in entry else names[entry["support"]]
        if entry["subject"] in known and ("support" in entry or other in known):
            relations.add((entry["relation"], entry["subject"], other))
    return relations, supports


def compare(scene, truth, matched):
    """The found and the true relations between matched objects, as sets of (relation, subject, object)."""
    true, supports = true_relations(truth, set(matched.values()))
    found = set()
    for entry in scene["relations"]:
        subject, other = matched.get(entry["subject"]), matched.get(entry["object"])
        if entry["relation"] in RELATIONS and subject is not None and other is not None:
            found.add((entry["relation"], subject, other))
    for surface in scene["surfaces"]:  # its true support is the one of most of its objects
        objects = [matched[mapped] for mapped in surface["objects"] if mapped in matched]
        votes = [supports[i] for i in objects if i in supports]
        support = max(sorted(set(votes)), key=votes.count, default=None)
        found |= {("on", i, support) for i in objects}
    return found, true


def figure(part, whole):
    return f"{part / whole:.3f}" if whole else "-"


def print_counts(name, counts):
    cells = [f"{counts['mapped']} of {counts['objects']}"]
    for relation in RELATIONS:
        right, found, true = (counts[relation, kind] for kind in ("right", "found", "true"))
        cells.append(f"{figure(right, found)} {figure(right, true)} ({found} found, {true} true)")
    print(f"| {name} | " + " | ".join(cells) + " |")


def names_of(truth):
    return {entry["id"]: entry["class"] for entry in truth["objects"]}


def list_errors(found, true, names):
    def name(thing):
        return f"{names[thing]} {thing}" if thing in names else str(thing)

    for kind, wrong in (("wrong", found - true), ("missing", true - found)):
        for relation, subject, other in sorted(wrong, key=str):
            print(f"  {kind}: {name(subject)} {relation} {name(other)}")


def make_questions(scene, truth, matched, count):
    """Questions with one right answer among the mapped objects: (text, mapped id). Each names the
    class of an object and, if there are several of this class, a true relation that only this one
    has."""
    names = names_of(truth)
    mapped_of = {value: key for key, value in matched.items()}
    labels = {entry["id"]: entry["class"] for entry in scene["objects"]}
    usual = [i for i in sorted(mapped_of) if labels[mapped_of[i]] == names[i]]
    relations = {(e["relation"], e["subject"], e["object"]) for e in truth["relations"]
                 if "object" in e and e["subject"] in usual and e["object"] in usual}
    words = {"on": "on the", "in": "in the", "beside": "next to the"}
    related = {}
    for relation, subject, other in sorted(relations):
        key = (names[subject], relation, names[other])
        related.setdefault(key, set()).add(subject)
    questions = [(f"the {subject} {words[relation]} {other}", mapped_of[min(ids)])
                 for (subject, relation, other), ids in sorted(related.items()) if len(ids) == 1]
    single = [(f"the {names[i]}", mapped_of[i]) for i in usual
              if sum(names[k] == names[i] for k in usual) == 1]
    mixed = []
    while questions or single:
        mixed += questions[:2] + single[:1]
        questions, single = questions[2:], single[1:]
    return mixed[:count]


def ask(program, run, text):
    done = call(program, "query", run, text, "--json")
    if done.returncode == 1:
        return None
    if done.returncode != 0:
        raise InputError(f"{program} {run} '{text}': {done.stderr.strip()}")
    return json.loads(done.stdout)["answers"][0]["object"]


def measure(run, sequence, arguments):
    """Prints the figures of a run. Returns its counts."""
    scene = read_object(run / "scene.json", "objects", "relations", "surfaces")
    truth = read_object(sequence / "groundtruth_objects.json", "objects", "relations", "supports")
    matched = match(scene, truth["objects"])
    found, true = compare(scene, truth, matched)
    counts = collections.Counter({"mapped": len(matched), "objects": len(truth["objects"])})
    for kind, relations in ("right", found & true), ("found", found), ("true", true):
        counts.update((relation, kind) for relation, _, _ in relations)
    print_counts(run.name, counts)
    if arguments.list:
        list_errors(found, true, names_of(truth))
    for text, expected in make_questions(scene, truth, matched, arguments.questions):
        answer = ask(arguments.program, run, text)
        counts.update({"asked": 1, "answered": answer == expected})
        if arguments.list and answer != expected:
            print(f"  {text}: {answer}, expected {expected}")
    if arguments.questions:
        print(f"  questions: the right object comes first in {counts['answered']} of {counts['asked']}")
    return counts


def measure_all(arguments):
    print("| run | mapped | " + " | ".join(f"{r}: precision recall" for r in RELATIONS) + " |")
    print("|---|---|---|---|---|")
    totals = collections.Counter()
    for run, sequence in zip(arguments.pairs[::2], arguments.pairs[1::2]):
        totals.update(measure(run, sequence, arguments))
    print_counts("all", totals)
    if arguments.questions:
        print(f"all questions: {totals['answered']} of {totals['asked']} "
              f"({figure(totals['answered'], totals['asked'])})")


def main():
    parser = parser_of(__doc__)
    parser.add_argument("pairs", nargs="+", metavar="RUN_DIR SEQUENCE", type=pathlib.Path,
                        help="the output folder of a run, and its synthetic sequence. The run must "
                        "have the world of the ground truth, as those of map-objects")
    parser.add_argument("--questions", type=int, default=0, metavar="N", help="ask N questions per scene")
    parser.add_argument("--program", default=programs_folder() / "hullslam",
                        help="path of hullslam (default: that of this installation or of "
                             "build/release/bin)")
    parser.add_argument("--list", action="store_true", help="also list all errors")
    arguments = parser.parse_args()
    if len(arguments.pairs) % 2:
        parser.error("expected pairs RUN_DIR SEQUENCE")
    return exit_code(measure_all, arguments, failure=2)


if __name__ == "__main__":
    sys.exit(main())
