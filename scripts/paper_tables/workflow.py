# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the jobs of a plan with Snakemake, and says how far it is and why it had to stop."""

import contextlib
import ctypes
import fcntl
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

from paper_tables.job import Stopped, error_file
from paper_tables.plan import folder_output, result_file
from run_errors import InputError, one_line
from run_statistics import try_read_json

LOG = "snakemake.log"
SNAKEFILE = pathlib.Path(__file__).resolve().parent / "Snakefile"
STEP = 0.5  # s, between two looks at what is done
STARTS = 3  # of Snakemake, which sometimes ends with jobs left
JOBS_LEFT = "Out of jobs ready to be started, but not all files built yet"
LINE_EVERY = 20.0  # s, between two lines of progress that go to a file
RENDERING_WEIGHT = 4.0  # the time of a rendered frame in relation to that of a frame of a run
DEGRADING_WEIGHT = 1.0
SET_PARENT_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)


@contextlib.contextmanager
def table_lock(out):
    """Refuses a second table run in the same folder. The system removes the lock of a process that
    was killed, so a lock is never stale."""
    path = out / ".lock"
    with path.open("a+") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            file.seek(0)
            owner = file.read(20).strip() or "unknown"
            raise InputError(f"{out}: another table run is at work in this folder (process "
                             f"{owner}); wait for its end or give another --out") from error
        file.truncate(0)
        file.write(f"{os.getpid()}\n")
        file.flush()
        yield


def die_with_parent():
    """Makes the system kill Snakemake if this program is killed, so that a new start can go on."""
    ctypes.CDLL(None).prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)


def snakemake_command(plan_file, jobs, profile, is_dry_run):
    program = shutil.which("snakemake")
    if program is None:
        raise InputError("snakemake is not installed; run scripts/setup.sh")
    # The lock of table_lock() is enough, and that of Snakemake would outlive a kill.
    command = [program, "--snakefile", str(SNAKEFILE), "--config", f"plan={plan_file}",
               f"python={sys.executable}", "--nolock", "--rerun-incomplete", "--rerun-triggers",
               "mtime", "--scheduler", "greedy", "--nocolor"]
    if profile is None:
        command += ["--cores", str(jobs)]
    else:
        command += ["--profile", profile_folder(profile), *(["--jobs", str(jobs)] if jobs else [])]
    return command + (["--dry-run", "--quiet"] if is_dry_run else [])


def profile_folder(profile):
    """The folder of a profile: a path, or one of those that come with this script."""
    own = SNAKEFILE.parent / "profiles" / profile
    return str(own) if own.is_dir() else profile


# ---- progress


class Progress:
    """What is done and when the rest may be, from the number of frames of all jobs."""

    def __init__(self, plan, out):
        self.out = out
        self.missing = {}  # output -> weight
        for name, run in plan["runs"].items():
            self.missing[result_file(name, run)] = run["frames"] or 1
        for name, folder in self.needed_folders(plan):
            is_rendered = folder["kind"] == "rendered"
            weight = RENDERING_WEIGHT if is_rendered else DEGRADING_WEIGHT
            self.missing[folder_output(name, folder)] = weight * (folder["frames"] or 1)
        self.count = len(plan["runs"])
        self.done_runs = self.done_weight = 0
        self.look()
        self.begin, self.total = time.monotonic(), sum(self.missing.values())
        self.at_begin, self.done_weight = self.done_runs, 0.0

    def needed_folders(self, plan):
        """The folders that a run without a result needs."""
        pending = [run["folder"] for name, run in plan["runs"].items() if run["folder"]
                   and not (self.out / result_file(name, run)).exists()]
        needed = {name for name in pending}
        needed |= {plan["folders"][name]["source"] for name in needed} - {None}
        return [(name, plan["folders"][name]) for name in sorted(needed)]

    def look(self):
        """Counts the jobs whose output has appeared."""
        for path in [path for path in self.missing if (self.out / path).exists()]:
            self.done_weight += self.missing.pop(path)
            self.done_runs += path.startswith("runs/")

    def line(self):
        text = f"{self.done_runs} of {self.count} runs"
        folders = sum(not path.startswith("runs/") for path in self.missing)
        if folders and self.done_runs < self.count:
            text += f", {folders} sequence{'s' if folders > 1 else ''} to make"
        if self.done_weight and self.missing:
            rest = (time.monotonic() - self.begin) * (self.total / self.done_weight - 1.0)
            text += f", about {duration(rest)} left"
        return text


def duration(seconds):
    minutes = round(seconds / 60.0)
    if minutes < 1:
        return f"{max(1, round(seconds))} s"
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


class Reporter:
    """Shows the progress: one line that changes on a terminal, else a line now and then."""

    def __init__(self, progress, is_quiet):
        self.progress, self.is_quiet = progress, is_quiet
        self.is_terminal = sys.stderr.isatty()
        self.shown, self.last = "", -LINE_EVERY  # so that the first line comes at once

    def update(self, is_last=False):
        self.progress.look()
        text = self.progress.line()
        if self.is_quiet or (text == self.shown and not is_last):
            return
        if self.is_terminal:
            print(f"\r{text:<60}", end="\n" if is_last else "", file=sys.stderr, flush=True)
        elif is_last or time.monotonic() - self.last > LINE_EVERY:
            print(text, file=sys.stderr, flush=True)
        else:
            return
        self.shown, self.last = text, time.monotonic()


# ---- the run of Snakemake


def run_snakemake(command, out, reporter):
    """The exit code of Snakemake, whose messages go to snakemake.log."""
    with (out / LOG).open("w", encoding="utf-8") as log:
        process = subprocess.Popen(command, cwd=out, stdout=log, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, start_new_session=True,
                                   preexec_fn=die_with_parent)
        try:
            while True:
                try:
                    return process.wait(timeout=STEP)
                except subprocess.TimeoutExpired:
                    reporter.update()
        except BaseException:  # also Ctrl-C: the programs of all jobs must end
            end_session(process)
            raise


def end_session(process):
    """Ends a process and all that it has started: politely, and after 5 s by force."""
    for signal_number in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal_number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(timeout=5.0)


def errors_of(plan, out):
    """(exit code, job, message) of the jobs that could not be made."""
    found = []
    for kind, names in (("run", plan["runs"]), ("folder", plan["folders"])):
        for name in names:
            with contextlib.suppress(OSError):
                text = (out / error_file(kind, name)).read_text(encoding="utf-8")
                code, _, message = text.strip().partition(" ")
                found.append((2 if code == "2" else 1, name, one_line(message, 300)))
    return found


def raise_error(plan, out):
    """Says why Snakemake has stopped."""
    free = shutil.disk_usage(out).free
    errors = errors_of(plan, out)
    bad = [(name, message) for code, name, message in errors if code == 2]
    if bad:
        raise InputError(f"{bad[0][0]}: {bad[0][1]}")
    if free < 1 << 20 or any("disk is full" in message for _, _, message in errors):
        raise Stopped(f"the disk is full ({out.resolve()}); finished runs are kept. Make room and "
                      "start again: the rest will be run")
    if errors:
        raise Stopped(f"{errors[0][1]}: {errors[0][2]}; start again to go on")
    with contextlib.suppress(OSError):
        lines = (out / LOG).read_text(encoding="utf-8", errors="replace").strip().splitlines()
        if any(line.startswith("Will exit after finishing") for line in lines):
            raise Stopped("Snakemake was ended by a signal; start again to go on")
        told = [line for line in lines if "Error" in line or "error" in line or JOBS_LEFT in line]
        told = told or lines[-1:]
        raise Stopped(f"Snakemake has stopped: {one_line(told[-1], 300) if told else 'no message'} "
                      f"(see {out / LOG})")
    raise Stopped("Snakemake has stopped")


def clean(plan, out):
    """Removes what killed or changed table runs have left: errors and degraded sequences.

    A degraded sequence that is needed is made again, because a kill may have left a part of it.
    """
    for kind, names in (("run", plan["runs"]), ("folder", plan["folders"])):
        for name in names:
            (out / error_file(kind, name)).unlink(missing_ok=True)
    for path in (out / "degraded").glob("*/seed-*"):
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)


def has_jobs_left(out):
    """Whether Snakemake has ended without making all jobs and without an error of one.

    Snakemake 7 does this (its issue 823) if outputs appear while it plans, as those of jobs do that
    a killed Snakemake has left running. A new start goes on.
    """
    return JOBS_LEFT in (out / LOG).read_text(encoding="utf-8", errors="replace")


def make_all(plan, plan_file, out, jobs, profile, is_quiet):
    """Makes all jobs of the plan. Raises Stopped or InputError if one could not be made."""
    clean(plan, out)
    progress = Progress(plan, out)
    reporter = Reporter(progress, is_quiet)
    if not progress.missing:
        return
    reporter.update()
    command = snakemake_command(plan_file, jobs, profile, False)
    for _ in range(STARTS):
        code = run_snakemake(command, out, reporter)
        if code == 0 or not has_jobs_left(out):
            break
    reporter.update(is_last=True)
    missing = [name for name, run in plan["runs"].items()
               if not (out / result_file(name, run)).exists()]
    if code != 0 or missing:
        raise_error(plan, out)


def read_results(plan, out):
    """{name of a run: its result}; None for those that are not there."""
    return {name: try_read_json(out / result_file(name, run)) for name, run in plan["runs"].items()}
