# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/accuracy.py measures of a run, and whether the runs of two builds differ by more than
chance.

Two runs of the same input by two builds are a pair. Their difference is never exactly zero: a
keyframe that begins one frame later changes the error of a single run by several percent. So a
difference counts only in one of these ways:

    spread    The median difference of the pairs of a case (with its mode and variant) is beyond
              4 s / sqrt(n), where s is the spread of the differences over its n seeds and first
              frames, and beyond the least difference that matters. With few pairs s is uncertain, so
              the usual spread of all cases of the mode counts as PRIOR_PAIRS more pairs.
    sign      Of the pairs of a mode and variant, over all cases or in one, significantly more are
              worse than better (sign test).
    disaster  A single run that has become much worse, and is worse than all runs of its case were.
"""

import dataclasses
import math
import statistics

import numpy as np

from paper_tables.definitions import ALL_MODES
from paper_tables.text import DASH, Best, Grid
from run_statistics import sign_probability
from support import InputError, read_trajectory, value_at
from tum_and_icl import LEAST_POSES, align, align_most, move, pair

WRONG = 0.05  # of the true path: a frame that is farther off is wrong
OTHER_PART = 10.0  # percent of the frames that only one of two runs knows: a run that loses more frames
#                    has the error of an easier part, and the loss itself is compared
DEVIATIONS = 4.0  # s / sqrt(n) of a case, until a difference counts. The deviation of a median is up to
#                   1.25 s / sqrt(n), so this is 3.2 of it: by chance once in 1500, and a comparison
#                   has some 300 differences of a case, of which most cannot get worse
PRIOR_PAIRS = 3
SIGNIFICANT = 0.01  # p of a sign test. There are some 20 of them, so 0.05 would always be somewhere
LEAST_PAIRS = 8  # of a sign test that can be significant: 2 / 2^8 < 0.01
ALL_CASES = "all"


@dataclasses.dataclass(frozen=True)
class Measure:
    """A figure that is compared."""
    title: str
    keys: dict  # mode -> key in the figures of a run
    is_lower_better: bool
    least: float  # difference that matters, for a case of few runs
    disaster: dict = dataclasses.field(default_factory=dict)  # mode -> difference of a single run; else none
    is_relative: bool = False  # differences are those of the logarithms
    factor: float = 1.0  # from the unit of a run to that of the tables
    digits: int = 1


def each(value):
    return dict.fromkeys(ALL_MODES, value)


# One keyframe more or less changes the error by some 5 %, loses a frame or two of 100, and shifts an
# object by a few percent of its size. Monocular errors vary more: between f922b75 and 87e868e, single
# runs of cases that are the same differ by at most 5 % with depth and 25 % without.
MEASURES = {
    "ate": Measure("ATE, mm", each("ate_se3") | {"mono": "ate_sim3"}, True, math.log(1.05),
                   each(math.log(1.5)) | {"mono": math.log(2.0)}, True, 1e3, 2),
    # Lost is better than wrong, so a frame that was wrong and is lost now is no frame worse.
    "unknown": Measure("no right pose, %", each("unknown"), True, 2.0, each(10.0)),
    "wrong": Measure("wrong pose, %", each("wrong"), True, 2.0, each(5.0)),
    "objects": Measure("objects", each("objects"), False, 1.0),
    "found": Measure("found, %", each("found"), False, 0.05, factor=1e2),
    "siou": Measure("SIoU", each("siou"), False, 0.02, digits=3),
    "scale": Measure("scale error, %", {"rgbd": "scale_error", "stereo": "scale_error"}, True, 0.001,
                     factor=1e2, digits=2),
}
KEPT = ("ate_se3", "ate_sim3", "keyframes_ate_sim3", "lost", "frames", "keyframes", "loops",
        "objects", "siou", "found", "doubles", "ap25", "ar25", "centre_mm", "axes")  # of a table run


# ---- one run


def read_poses(path):
    """Stamps and positions of a trajectory; none of both if it has no poses."""
    try:
        stamps, poses = read_trajectory(path)
    except InputError:
        return np.empty(0), np.empty((0, 3))
    return stamps, poses[:, :3]


def figures_of_poses(folder, mode, frames):
    """The share of the frames with a wrong pose, percent, and the error of the scale of the right
    ones. One bad part would spoil an alignment by least squares and make all frames wrong."""
    stamps, positions = read_poses(folder / "out" / "trajectory.txt")
    true_stamps, truth = read_poses(folder / "groundtruth.txt")
    pairs = pair(stamps, true_stamps) if len(stamps) and len(true_stamps) else np.empty((0, 2), int)
    if len(pairs) < LEAST_POSES or not frames:
        return {"wrong": 0.0 if frames else None, "scale_error": None}
    source, target = positions[pairs[:, 0]], truth[pairs[:, 1]]
    path = np.linalg.norm(np.diff(target, axis=0), axis=1).sum()
    errors = np.linalg.norm(move(align_most(source, target, mode == "mono"), source) - target, axis=1)
    is_right = errors <= WRONG * path
    scale = align(source[is_right], target[is_right], True)[0] if is_right.sum() > 2 else None
    return {"wrong": 100.0 * float((~is_right).sum()) / frames,
            "scale_error": abs(math.log(scale)) if mode != "mono" and scale else None}


def run_report(name, run, result, out, summary):
    """What the report of a gate keeps of a run."""
    figures = {key: result["figures"].get(key) for key in KEPT}
    figures |= figures_of_poses(out / "runs" / name, run["mode"], figures["frames"])
    if figures["frames"] is None:  # the run has made nothing
        figures["lost"] = 100.0
    figures["unknown"] = figures["lost"] + (figures["wrong"] or 0.0)
    if figures["found"] is not None:
        figures["objects"] = None  # more of them may be wrong ones, so those that are found count
    return {"case": run["case"], "sequence": run["sequence"], "mode": run["mode"],
            "variant": run["variant"], "seed": run["seed"], "degradation": run["degradation"],
            "level": run["level"], "input": run["input"], "failure": result["failure"],
            "figures": figures, "track_ms": value_at(summary, "timing", "track_ms", "median")}


# ---- comparison


def value_of(measure, run):
    return run["figures"].get(measure.keys.get(run["mode"]))


def worsening(measure, before, after):
    """How much worse `after` is; None if one of the two is not known or not positive, or if they are
    the errors of different parts of the sequence."""
    old, new = value_of(measure, before), value_of(measure, after)
    if old is None or new is None or (measure.is_relative and min(old, new) <= 0.0):
        return None
    if measure.is_relative and abs(after["figures"]["lost"] - before["figures"]["lost"]) > OTHER_PART:
        return None
    change = math.log(new / old) if measure.is_relative else new - old
    return change if measure.is_lower_better else -change


def grouped(names, key):
    found = {}
    for name in names:
        found.setdefault(key(name), []).append(name)
    return found


def limit(measure, values, prior):
    """The largest median of the differences `values` that may be chance."""
    prior = max(prior, measure.least / DEVIATIONS)
    mean = statistics.fmean(values)
    spread = math.sqrt((sum((value - mean)**2 for value in values) + PRIOR_PAIRS * prior**2)
                       / (len(values) - 1 + PRIOR_PAIRS))
    return max(measure.least, DEVIATIONS * spread / math.sqrt(len(values)))


def verdict(change, largest):
    return "worse" if change > largest else "better" if change < -largest else "same"


class Comparison:
    """Two reports of a gate, {name: run} each. Only runs of the same input are compared, as figures of
    other images or settings tell nothing about the program."""

    def __init__(self, before, after):
        self.before, self.after = before, after
        self.common = [name for name, run in after.items()
                       if name in before and before[name].get("input") == run["input"]]
        self.changes = {key: {name: change for name in self.common if (
            change := worsening(measure, before[name], after[name])) is not None}
            for key, measure in MEASURES.items()}
        self.cases, self.families = self.compare_cases(), self.compare_families()
        self.disasters = list(self.find_disasters())

    def case_of(self, name):
        run = self.after[name]
        return run["case"], run["mode"], run["variant"]

    def compare_cases(self):
        """{(case, mode, variant): {measure: (median change, limit, verdict)}}"""
        found = {group: {} for group in grouped(self.common, self.case_of)}
        for key, measure in MEASURES.items():
            groups = {group: [self.changes[key][name] for name in names]
                      for group, names in grouped(self.changes[key], self.case_of).items()}
            for group, values in groups.items():
                # The usual spread: the median over the cases of this mode that have two runs or more.
                prior = statistics.median([statistics.stdev(others) for (_, mode, _), others in groups.items()
                                           if mode == group[1] and len(others) > 1] or [0.0])
                largest, median = limit(measure, values, prior), statistics.median(values)
                found[group][key] = (median, largest, verdict(median, largest))
        return found

    def compare_families(self):
        """{(case or all, mode, variant): {measure: (median, p, verdict)}}: sign tests. Modes and
        variants are apart, because their runs of the same input are not independent."""
        keys = (lambda name: (ALL_CASES, *self.case_of(name)[1:]), self.case_of)
        found = {}
        for key, measure in MEASURES.items():
            changes = self.changes[key]
            for group_of in keys:
                for group, names in grouped(changes, group_of).items():
                    values = [changes[name] for name in names]
                    if len(values) >= LEAST_PAIRS:
                        p, median = sign_probability(values), statistics.median(values)
                        told = verdict(median, 0.0) if p <= SIGNIFICANT else "same"
                        found.setdefault(group, {})[key] = (median, p, told)
        return found

    def find_disasters(self):
        """(name, measure, before, after) of single runs that have become much worse, and worse than
        every run of their case was; (name, None, before, after) of runs that now crash."""
        groups = grouped(self.common, self.case_of)
        for name in self.common:
            old, new = self.before[name], self.after[name]
            for key, measure in MEASURES.items():
                if self.changes[key].get(name, -math.inf) >= measure.disaster.get(new["mode"], math.inf):
                    former = [value_of(measure, self.before[other]) for other in groups[self.case_of(name)]]
                    if value_of(measure, new) > max(value for value in former if value is not None):
                        yield name, key, value_of(measure, old), value_of(measure, new)
            if is_crash(new) and not is_crash(old):
                yield name, None, old["failure"] or "done", new["failure"]

    def is_worse(self):
        tables = [*self.cases.values(), *self.families.values()]
        return bool(self.disasters) or any(told == "worse" for table in tables
                                           for _, _, told in table.values())


def is_crash(run):
    return bool(run["failure"]) and run["failure"].startswith(("crashed", "not finished"))


# ---- what is printed


def number(measure, value):
    return DASH if value is None else f"{value * measure.factor:.{measure.digits}f}"


def change_text(measure, change):
    """The change in the unit of the tables, where more is more."""
    change = change if measure.is_lower_better else -change
    if measure.is_relative:
        return f"{100.0 * math.expm1(change):+.0f} %"
    return f"{change * measure.factor:+.{measure.digits}f}"


def case_cell(comparison, group, key, names):
    measure = MEASURES[key]
    values = ([value for name in names if (value := value_of(measure, runs[name])) is not None]
              for runs in (comparison.before, comparison.after))
    old, new = (statistics.median(of_runs) if of_runs else None for of_runs in values)
    entry = comparison.cases[group].get(key)
    if entry is None or old is None or new is None:
        return DASH if old is None and new is None else f"{number(measure, old)} -> {number(measure, new)}"
    text = number(measure, old)
    if number(measure, new) != text:
        text += f" -> {number(measure, new)}"
    if entry[2] != "same":
        text += f" ({change_text(measure, entry[0])}, {entry[2]})"
    return Best(text) if entry[2] == "worse" else text


def case_grid(comparison, only_changed=False):
    """A row for each case, mode and variant: medians before and after."""
    rows = []
    for group, names in grouped(comparison.common, comparison.case_of).items():
        told = [entry[2] for entry in comparison.cases[group].values()]
        if only_changed and not any(word != "same" for word in told):
            continue
        rows.append([*group, str(len(names)),
                     *(case_cell(comparison, group, key, names) for key in MEASURES)])
    return Grid("Cases", ["case", "mode", "variant", "runs",
                          *(measure.title for measure in MEASURES.values())], rows,
                ["Medians over the runs of a case, before -> after. In brackets is the median change "
                 "of pairs of runs, if it is beyond its spread."])


def family_lines(comparison):
    for (case, mode, variant), table in comparison.families.items():
        for key, (median, p, told) in table.items():
            if told != "same":
                yield (f"{told}: {MEASURES[key].title.split(',')[0]}, {case}, {mode}, {variant}: "
                       f"median change {change_text(MEASURES[key], median)}, sign test p {p:.2g}")


def disaster_lines(comparison):
    for name, key, *values in comparison.disasters:
        title, (old, new) = "", values
        if key is not None:
            title, (old, new) = f"{MEASURES[key].title} ", (number(MEASURES[key], value) for value in values)
        yield f"worse: {name}: {title}{old} -> {new}"


def new_lines(comparison):
    """The figures of the runs that are not compared."""
    for name in [name for name in comparison.after if name not in comparison.common]:
        measures = [MEASURES[key] for key in ("ate", "unknown", "wrong")]
        shown = [f"{measure.title} {number(measure, value)}" for measure in measures
                 if (value := value_of(measure, comparison.after[name])) is not None]
        why = "has another input than before" if name in comparison.before else "is new"
        yield f"not compared: {name} {why}: {', '.join(shown) or 'no figures'}"


def frame_line(title, runs):
    """How many frames of all runs have no pose, and how many a wrong one."""
    known = [run["figures"] for run in runs if run["figures"].get("frames")]
    total = sum(figures["frames"] for figures in known)
    lost, wrong = (round(sum(figures["frames"] * (figures[key] or 0.0) for figures in known) / 100.0)
                   for key in ("lost", "wrong"))
    times = [run["track_ms"] for run in runs if run.get("track_ms")]
    time = f"; tracking {statistics.median(times):.1f} ms a frame" if times else ""
    return (f"{title}: {total:.0f} frames in {len(runs)} runs, {lost} without a pose, {wrong} with a "
            f"wrong one{time}")
