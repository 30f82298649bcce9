# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of a run: how each is taken from its results, and how tables show it."""

import collections
import dataclasses
import json
import shlex

from support import Stopped, call, one_line, value_at


Column = collections.namedtuple("Column", ("heading", "key"))  # the key is that in the figures of a run


@dataclasses.dataclass(frozen=True)
class Figure:
    """A figure that tables can show. Some have two columns, which differ between the modes."""
    title: str
    columns: dict  # mode -> columns; the first one ranks the rows, the last one is the paper's
    factor: float  # from the unit of the run (metres, 0 to 1) to the unit of the heading
    digits: int  # after the decimal point
    lower_is_better: bool = None  # None: neither


def same(heading, key):
    return {mode: (Column(heading, key),) for mode in ("rgbd", "mono")}


FIGURES = {
    "ate": Figure("ATE, mm", {
        "rgbd": (Column("ATE SE3, mm", "ate_se3"), Column("ATE Sim3, mm", "ate_sim3")),
        "mono": (Column("ATE all frames, mm", "ate_sim3"),
                 Column("ATE keyframes, mm", "keyframes_ate_sim3"))}, 1e3, 2, True),
    "lost": Figure("frames without a pose, %", same("no pose, %", "lost"), 1.0, 1, True),
    "siou": Figure("SIoU", same("SIoU", "siou"), 1.0, 3, False),
    "siou_mask": Figure("SIoU with the mask", same("SIoU mask", "siou_mask"), 1.0, 3, False),
    "mtd": Figure("MTD, 1e-3 m2", same("MTD, 1e-3 m2", "mtd"), 1e3, 3, True),
    "objects": Figure("mapped objects", same("objects", "objects"), 1.0, 1),
    "found": Figure("visible true objects that are mapped, %", same("found, %", "found"), 1e2, 1, False),
    "doubles": Figure("true objects that are mapped more than once", same("doubles", "doubles"), 1.0, 1,
                      True),
    "centre": Figure("error of the centres, % of the size", same("centre, %", "centre"), 1e2, 1, True),
    "ap25": Figure("average precision at a 3D IoU of 0.25", same("AP25", "ap25"), 1.0, 3, False),
    "ar25": Figure("recall at a 3D IoU of 0.25", same("AR25", "ar25"), 1.0, 3, False),
    "centre_mm": Figure("median error of the centres, mm", same("centre, mm", "centre_mm"), 1e3, 1, True),
    "axes": Figure("median error of the half axes, %", same("axes, %", "axes"), 1e2, 1, True),
}

OF_BODIES = {"ap25": ("boxes", "25", "ap"), "ar25": ("boxes", "25", "ar"),
             "centre_mm": ("errors", "center_m"), "axes": ("errors", "axes_median")}


def of_true_objects(report):
    """The figures of the comparison with true objects, from the report of `evaluate objects`."""
    once, more, visible = (value_at(report, "groundtruth", key) for key in ("once", "more", "visible"))
    shares = [value_at(match, "center_share")
              for item in (report.get("groundtruth") or {}).get("each", [])
              for match in item.get("mapped", [])]
    shares = [share for share in shares if share is not None]
    return {"found": (once + more) / visible if visible and None not in (once, more) else None,
            "doubles": more, "centre": sum(shares) / len(shares) if shares else None}


def ask(*command):
    """The JSON report of an evaluation; {} if it refuses its input, for example no poses."""
    result = call(*command)
    try:
        return json.loads(result.stdout) if result.returncode == 0 else {}
    except ValueError as error:
        raise Stopped(f"{shlex.join(map(str, command))}: has printed no JSON: {one_line(error)}") from error


def evaluate(program, run, folder, summary):
    """The figures of a finished run in `folder`. `program` is hullslam."""
    out, truth, scale = folder / "out", folder / "groundtruth.txt", 1.0
    frames, tracked = (value_at(summary, "trajectory", key) for key in ("frames", "tracked"))
    figures = {"lost": 100.0 * (1.0 - tracked / frames) if frames and tracked is not None else None,
               "frames": frames,
               "keyframes": value_at(summary, "map", "keyframes"), "loops": value_at(summary, "map", "loops")}
    for file, prefix in (("trajectory.txt", ""), ("keyframes.txt", "keyframes_")):
        for alignment in ("se3", "sim3")[run["mode"] == "mono":] if truth.exists() else ():
            report = ask(program, "evaluate", "trajectory", truth, out / file, "--align", alignment, "--json")
            figures[f"{prefix}ate_{alignment}"] = value_at(report, "ate_m", "rmse")
            if run["mode"] == "mono" and not prefix:
                scale = value_at(report, "scale")
    if summary.get("objects") is None:
        return figures
    # The scale is the metres per unit of length of the run.
    mtd = value_at(summary, "objects", "mtd_mean_m2")
    figures |= {"objects": value_at(summary, "objects", "count"),
                "siou": value_at(summary, "objects", "siou_mean"),
                "siou_mask": value_at(summary, "objects", "siou_mask_mean"),
                "mtd": None if mtd is None or scale is None else mtd * scale**2}
    if run["objects"] is not None:
        figures |= of_true_objects(ask(program, "evaluate", "objects", out, "--groundtruth",
                                       run["objects"], "--json"))
        report = ask(program, "evaluate", "objects", out, "--truth", run["objects"], "--json")
        figures |= {name: value_at(report, "truth", *keys) for name, keys in OF_BODIES.items()}
    return figures
