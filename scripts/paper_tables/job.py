# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes one run of a plan, or one folder that runs need. Snakemake starts a process for each."""

import contextlib
import errno
import fcntl
import glob
import json
import os
import pathlib
import resource
import shlex
import shutil
import signal
import subprocess
import time

from paper_tables.figures import of_objects, of_true_objects, of_trajectory
from paper_tables.plan import RESULT_VERSION, folder_output, result_file
from run_errors import InputError, one_line
from run_statistics import try_read_json, value_at, write

LOG, ERROR = "log.txt", "error.txt"
STOPPED = {signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP}


class Stopped(Exception):
    """The job could not be made for a reason that is none of the run, such as a full disk."""


@contextlib.contextmanager
def locked(path):
    """Waits until no other process makes the same thing.

    When the scheduler is killed, its jobs go on, and a new scheduler starts them again.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def execute(command, log, seconds, environment=None):
    """The exit code of a program, whose messages go to the file `log`; None after a timeout."""
    with log.open("w", encoding="utf-8") as file:
        file.write(shlex.join(command) + "\n")
        file.flush()
        try:
            return subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False,
                                  timeout=seconds, env={**os.environ, **(environment or {})}
                                  ).returncode
        except subprocess.TimeoutExpired:
            return None
        except OSError as error:
            raise InputError(f"{command[0]}: {error.strerror}") from error


def last_message(log):
    """The last error that a program has printed, else its last line."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()[1:]
    errors = [line for line in lines if line.startswith("error: ")]
    found = (errors or [line for line in lines if line.strip()] or ["no message"])[-1]
    return one_line(found.removeprefix("error: "), 300)


def check_stopped(code, message, folder):
    """Raises an error if a program has ended for a reason that the next start may not have."""
    is_full = os.strerror(errno.ENOSPC) in message or shutil.disk_usage(folder).free < 1 << 20
    if is_full and code != 0:
        raise Stopped(f"the disk is full ({folder.resolve()})")
    if code is not None and code < 0 and -code in STOPPED:
        raise Stopped(f"the program was ended by {signal.Signals(-code).name}")
    if code == 2:
        raise InputError(message)


def failure_of(code, message, seconds):
    """Why a run counts as failed; None if it has succeeded."""
    if code is None:
        return f"not finished after {seconds:g} s"
    if code < 0:
        return f"crashed with {signal.Signals(-code).name}"
    return None if code == 0 else message


# ---- figures


def ask(command):
    """The JSON report of an evaluation; None if it refuses its input, for example no poses."""
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        return None
    try:
        return json.loads(result.stdout)
    except ValueError as error:
        raise Stopped(f"{shlex.join(command)}: has printed no JSON: {one_line(error)}") from error


def evaluate(plan, run, folder, summary):
    """The figures of a finished run."""
    out, figures = folder / "out", of_trajectory(summary)
    alignments = ("se3", "sim3") if run["mode"] == "rgbd" else ("sim3",)
    scale = 1.0
    truth = folder / "groundtruth.txt"
    for file, prefix in (("trajectory.txt", ""), ("keyframes.txt", "keyframes_")):
        for alignment in alignments if truth.exists() else ():
            report = ask([plan["evaluate"], "trajectory", str(truth), str(out / file), "--align",
                          alignment, "--json"])
            figures[f"{prefix}ate_{alignment}"] = value_at(report, ("ate_m", "rmse"))
            if run["mode"] == "mono" and not prefix:
                scale = value_at(report, ("scale",))
    if summary.get("objects") is None:
        return figures
    figures |= of_objects(summary, scale)
    if run["objects"] is not None:
        report = ask([plan["evaluate"], "objects", str(out), "--groundtruth", run["objects"],
                      "--json"])
        figures |= of_true_objects(report or {})
    return figures


def keep_groundtruth(run, folder):
    """Copies the true trajectory beside the run, because degraded sequences are removed later."""
    converted = folder / "out" / "groundtruth.txt"
    source = pathlib.Path(run["groundtruth"]) if run["groundtruth"] else converted
    target = folder / "groundtruth.txt"
    target.unlink(missing_ok=True)
    if source.is_file():
        shutil.copyfile(source, target)


# ---- jobs


def make_run(plan, name):
    """Makes a run and writes its result, unless the result is there already.

    Returns whether it did.
    """
    run = plan["runs"][name]
    folder = pathlib.Path("runs") / name
    result = pathlib.Path(result_file(name, run))
    with locked(folder / ".lock"):
        known = try_read_json(result)
        if known is not None and known.get("fingerprint") == run["fingerprint"]:
            return False
        for old in [*folder.glob("result-*"), folder / ERROR]:
            old.unlink(missing_ok=True)
        shutil.rmtree(folder / "out", ignore_errors=True)
        log = folder / LOG
        code = execute([*run["command"], "--output", str(folder / "out")], log, plan["timeout"],
                       {"HULLSLAM_CONFIG": plan["config"]})
        message = last_message(log)
        check_stopped(code, message, folder)
        summary = try_read_json(folder / "out" / "summary.json") or {}
        if (summary.get("provenance") or {}).get("interrupted"):
            raise Stopped("the program was interrupted")
        keep_groundtruth(run, folder)
        write_result(result, run, summary, failure_of(code, message, plan["timeout"]),
                     evaluate(plan, run, folder, summary))
    return True


def write_result(path, run, summary, failure, figures):
    provenance = summary.get("provenance") or {}
    content = {"version": RESULT_VERSION, "fingerprint": run["fingerprint"], "failure": failure,
               "preset": provenance.get("preset"), "git": provenance.get("git"),
               "settings_hash": provenance.get("settings_hash"), "figures": figures}
    write(path, json.dumps(content, indent=1) + "\n")


def make_folder(plan, name):
    """Renders or degrades a sequence, unless it is there already. Returns whether it did."""
    folder = plan["folders"][name]
    target, output = pathlib.Path(name), pathlib.Path(folder_output(name, folder))
    part = target.with_name(target.name + ".part")
    with locked(target.with_name(f".{target.name}.lock")):
        if output.exists() and target.exists():
            return False
        for old in target.parent.glob(glob.escape(target.name) + ".made-*"):
            old.unlink()
        for old in (target, part):
            shutil.rmtree(old, ignore_errors=True)
        log = target.with_name(target.name + ".log")
        command = [str(part) if word == "{folder}" else word for word in folder["command"]]
        code = execute(command, log, None)
        if code != 0:
            message = last_message(log)
            check_stopped(code, message, target.parent)
            raise Stopped(f"{message} (exit code {code}, see {log})")
        part.rename(target)
        if output != target:
            output.touch()
    return True


def error_file(kind, name):
    """Where a job writes why it could not be made."""
    return pathlib.Path("runs") / name / ERROR if kind == "run" else pathlib.Path(f"{name}.{ERROR}")


def write_time(kind, name, begin):
    """Writes how long the job took. It is no part of the result, which must always be the same."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    cpu = sum(usage.ru_utime + usage.ru_stime for usage in used)
    write(time_file(kind, name), json.dumps(
        {"cpu_s": round(cpu, 2), "wall_s": round(time.monotonic() - begin, 2)}) + "\n")


def time_file(kind, name):
    return error_file(kind, name).with_name("time.json" if kind == "run" else
                                            f"{pathlib.Path(name).name}.time.json")


def main(words):
    """Makes the job KIND NAME of a PLAN. Exit codes: 0 done, 1 stopped, 2 bad input."""
    plan_file, kind, name = words
    plan = json.loads(pathlib.Path(plan_file).read_text(encoding="utf-8"))
    error, begin = error_file(kind, name), time.monotonic()
    try:
        error.unlink(missing_ok=True)
        if (make_run if kind == "run" else make_folder)(plan, name):
            write_time(kind, name, begin)
        return 0
    except (InputError, Stopped, OSError) as problem:
        is_full = isinstance(problem, OSError) and problem.errno == errno.ENOSPC
        message = "the disk is full" if is_full else str(problem)
        code = 2 if isinstance(problem, InputError) else 1
        with contextlib.suppress(OSError):
            error.parent.mkdir(parents=True, exist_ok=True)
            error.write_text(f"{code} {message}\n", encoding="utf-8")
        return code
