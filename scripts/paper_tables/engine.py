# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the jobs of experiments: programs that run at once on this machine, or a plan of runs (plan.py)
as jobs of Snakemake on a cluster. Each result is written when its run is complete, so work that was
stopped in any way goes on at the next start."""

import concurrent.futures
import contextlib
import ctypes
import errno
import fcntl
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time

from paper_tables.figures import evaluate
from support import InputError, Stopped, call, one_line, try_read_json, write

DIGITS = 16  # of a fingerprint in the name of a file
RESULT_VERSION = 2  # of the files that runs leave; a new one repeats all runs
PLAN, LOG, ERROR = "plan.json", "log.txt", "error.txt"
STEP = 0.5  # s, between two looks at what is done
LINE_EVERY = 20.0  # s, between two lines of progress that go to a file
WEIGHTS = {"rendered": 4.0, "degraded": 1.0}  # the time of a frame in relation to that of a run
STOPPED = {signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP}
SET_PARENT_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)
PRCTL = ctypes.CDLL(None).prctl  # loaded here, because a new process of many threads must load nothing
SNAKEFILE = pathlib.Path(__file__).resolve().parent / "Snakefile"


def stop_by_signals():
    """Signals stop the script as Ctrl-C does."""
    def stop(number, _):
        raise Stopped(f"ended by {signal.Signals(number).name}; start again to go on")
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:  # nohup ignores SIGHUP
            signal.signal(number, stop)


@contextlib.contextmanager
def locked(path, refusal=None):
    """Holds the lock of a file, which the system removes if the process is killed. Waits for another
    process that has it, or refuses with an error."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | (fcntl.LOCK_NB if refusal else 0))
        except BlockingIOError as error:
            file.seek(0)
            owner = file.read(20).strip() or "unknown"
            raise InputError(refusal.format(owner)) from error
        file.truncate(0)
        file.write(f"{os.getpid()}\n")
        file.flush()
        yield


@contextlib.contextmanager
def at_work(plan, out):
    """Holds the lock of a folder for runs, into which the plan is written."""
    with locked(out / ".lock", f"{out}: another table run is at work in this folder (process {{}}); "
                               "wait for its end or give another --out"):
        write(out / PLAN, json.dumps(plan, indent=1) + "\n")
        yield


# ---- programs


class Programs:
    """The programs that run now. They end with this script, also if it is killed."""

    def __init__(self):
        self.running, self.lock, self.is_ended = set(), threading.Lock(), False

    def run(self, command, seconds=None, log=None, environment=None):
        """The exit code of a program, whose messages go to the file `log`; None after a timeout."""
        with log.open("w", encoding="utf-8") as file:
            file.write(shlex.join(command) + "\n")
            file.flush()
            with self.lock:
                if self.is_ended:
                    raise Stopped("stopped")
                try:
                    process = subprocess.Popen(
                        command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                        env={**os.environ, **(environment or {})}, start_new_session=True,
                        preexec_fn=lambda: PRCTL(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL))
                except OSError as error:
                    raise InputError(f"{command[0]}: {error.strerror}") from error
                self.running.add(process)
            try:
                return process.wait(timeout=seconds)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                return None
            finally:
                self.running.discard(process)

    def end(self):
        """Ends all programs: politely, and after 5 s by force."""
        with self.lock:
            self.is_ended, left = True, list(self.running)
        for process in left:
            process.terminate()
        for process in left:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(timeout=5.0)
            process.kill()


PROGRAMS = Programs()


def last_message(log):
    """The last error that a program has printed, else its last line."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()[1:]
    errors = [line for line in lines if line.startswith("error: ")]
    found = (errors or [line for line in lines if line.strip()] or ["no message"])[-1]
    return one_line(found.removeprefix("error: "), 300)


def check_stopped(code, message, folder):
    """Raises an error if a program has ended for a reason that is none of the run."""
    is_full = os.strerror(errno.ENOSPC) in message or shutil.disk_usage(folder).free < 1 << 20
    if is_full and code != 0:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
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


def work_off(jobs, count, look=lambda: None):
    """Makes the jobs {name: (function, names of the jobs before)}, `count` at once and in their order,
    and calls look() now and then. Returns {name: what the function returns}. The first error ends
    all programs."""
    waiting, running, results, PROGRAMS.is_ended = dict(jobs), {}, {}, False
    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        try:
            while waiting or running:
                unfinished = waiting.keys() | set(running.values())
                for name in list(waiting):
                    if len(running) < count and not set(waiting[name][1]) & unfinished:
                        running[pool.submit(waiting.pop(name)[0])] = name
                done, _ = concurrent.futures.wait(
                    running, timeout=STEP, return_when=concurrent.futures.FIRST_COMPLETED)
                for future in done:
                    results[running.pop(future)] = future.result()
                look()
        except BaseException:  # also Ctrl-C
            PROGRAMS.end()
            raise
    return results


# ---- jobs of a plan, in the working directory


def result_file(name, run):
    """Where the result of a run is. A changed input gives another name, so the run is repeated."""
    return f"runs/{name}/result-{run['fingerprint'][:DIGITS]}.json"


def folder_output(name, folder):
    """The path that shows that a folder is complete and was made from the present inputs."""
    return name if folder["kind"] == "degraded" else f"{name}.made-{folder['fingerprint'][:DIGITS]}"


def make_run(plan, name):
    """Makes a run and writes its result, unless the result is there already."""
    run = plan["runs"][name]
    folder, result = pathlib.Path("runs") / name, pathlib.Path(result_file(name, run))
    with locked(folder / ".lock"):
        if (try_read_json(result) or {}).get("fingerprint") == run["fingerprint"]:
            return
        for old in [*folder.glob("result-*"), folder / ERROR, folder / "groundtruth.txt"]:
            old.unlink(missing_ok=True)
        shutil.rmtree(folder / "out", ignore_errors=True)
        code = PROGRAMS.run([*run["command"], "--output", str(folder / "out")], plan["timeout"],
                            folder / LOG, {"HULLSLAM_CONFIG": plan["config"]})
        message = last_message(folder / LOG)
        check_stopped(code, message, folder)
        summary = try_read_json(folder / "out" / "summary.json") or {}
        provenance = summary.get("provenance") or {}
        if provenance.get("interrupted"):
            raise Stopped("the program was interrupted")
        truth = pathlib.Path(run["groundtruth"] or folder / "out" / "groundtruth.txt")
        if truth.is_file():  # kept beside the run, because degraded sequences are removed later
            shutil.copyfile(truth, folder / "groundtruth.txt")
        content = {"version": RESULT_VERSION, "fingerprint": run["fingerprint"],
                   "failure": failure_of(code, message, plan["timeout"]),
                   **{key: provenance.get(key) for key in ("preset", "git", "settings_hash")},
                   "figures": evaluate(plan["hullslam"], run, folder, summary)}
        write(result, json.dumps(content, indent=1) + "\n")


def make_folder(plan, name):
    """Renders or degrades a sequence, unless it is there already."""
    folder = plan["folders"][name]
    target, output = pathlib.Path(name), pathlib.Path(folder_output(name, folder))
    part, log = (target.with_name(target.name + end) for end in (".part", ".log"))
    with locked(target.with_name(f".{target.name}.lock")):
        if output.exists() and target.exists():
            return
        for old in target.parent.glob(f"{target.name}.made-*"):
            old.unlink()
        for old in (target, part):
            shutil.rmtree(old, ignore_errors=True)
        command = [str(part) if word == "{folder}" else word for word in folder["command"]]
        code = PROGRAMS.run(command, None, log)
        if code != 0:
            message = last_message(log)
            check_stopped(code, message, target.parent)
            raise Stopped(f"{message} (exit code {code}, see {log})")
        part.rename(target)
        if output != target:
            output.touch()


def explained(name, work, *arguments):
    """Does a job. Its errors name it."""
    try:
        work(*arguments)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
    except Stopped as error:
        raise Stopped(f"{name}: {error}; start again to go on") from error
    except OSError as error:
        if error.errno != errno.ENOSPC:
            raise
        raise Stopped(f"the disk is full ({pathlib.Path.cwd()}); finished runs are kept. Make room and "
                      "start again: the rest will be run") from error


def local_jobs(plan):
    """The missing jobs of a plan for work_off(): each folder just before its first run. Degraded
    sequences are removed after their last run."""
    jobs, users = {}, {}

    def add_folder(name):
        folder = plan["folders"][name]
        before = add_folder(folder["source"]) if folder["source"] else []
        if not (pathlib.Path(folder_output(name, folder)).exists() and pathlib.Path(name).exists()):
            jobs.setdefault(name, (lambda: explained(name, make_folder, plan, name), before))
        return [name]

    def make(name, folder):
        explained(name, make_run, plan, name)
        if folder:
            users[folder].discard(name)
            if not users[folder] and plan["folders"][folder]["kind"] == "degraded":
                shutil.rmtree(folder, ignore_errors=True)

    for name, run in plan["runs"].items():
        if not pathlib.Path(result_file(name, run)).exists():
            folder = run["folder"]
            users.setdefault(folder, set()).add(name)
            jobs[name] = (lambda name=name, folder=folder: make(name, folder),
                          add_folder(folder) if folder else [])
    return jobs


# ---- progress


class Progress:
    """Prints what is done and when the rest may be: one line that changes on a terminal, else a line
    now and then."""

    def __init__(self, plan, jobs, is_quiet):
        self.is_quiet, self.count = is_quiet, len(plan["runs"])
        runs = {name: run for name, run in plan["runs"].items() if name in jobs}
        weights = {result_file(name, run): run["frames"] for name, run in runs.items()}
        weights |= {folder_output(name, folder): WEIGHTS[folder["kind"]] * folder["frames"]
                    for name, folder in plan["folders"].items() if name in jobs}
        self.missing = {output: max(weight, 1) for output, weight in weights.items()}
        self.begin, self.total = time.monotonic(), sum(self.missing.values())
        self.last, self.shown = -LINE_EVERY, ""  # so that the first line comes at once

    def show(self, is_last=False):
        for path in [path for path in self.missing if pathlib.Path(path).exists()]:
            del self.missing[path]
        runs = sum(path.startswith("runs/") for path in self.missing)
        folders, left = len(self.missing) - runs, sum(self.missing.values())
        text = f"{self.count - runs} of {self.count} runs"
        if folders and runs:
            text += f", {folders} sequence{'s' if folders > 1 else ''} to make"
        if self.missing and left < self.total:
            rest = (time.monotonic() - self.begin) * left / (self.total - left)
            text += f", about {duration(rest)} left"
        is_terminal, is_due = sys.stderr.isatty(), time.monotonic() - self.last > LINE_EVERY
        if not self.is_quiet and (is_last or (text != self.shown and (is_terminal or is_due))):
            print(f"\r{text:<60}" if is_terminal else text, file=sys.stderr, flush=True,
                  end="" if is_terminal and not is_last else "\n")
            self.shown, self.last = text, time.monotonic()


def duration(seconds):
    minutes = round(seconds / 60.0)
    if minutes < 1:
        return f"{max(1, round(seconds))} s"
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


# ---- a whole plan


def make_all(plan, out, jobs=None, profile=None, is_quiet=False):
    """Makes all jobs of the plan: `jobs` at once on this machine or, with a profile, by Snakemake.
    Raises Stopped or InputError if one could not be made."""
    with contextlib.chdir(out):
        # A kill may have left a part of a degraded sequence.
        for path in pathlib.Path("degraded").glob("*/seed-*"):
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
        missing = local_jobs(plan)
        progress = Progress(plan, missing, is_quiet)
        if missing:
            progress.show()
            if profile is None:
                work_off(missing, jobs or os.cpu_count(), progress.show)
            else:
                run_snakemake(plan, jobs, profile, progress)
            progress.show(is_last=True)


def read_results(plan, out):
    """{name of a run: its result}; None for those that are not there."""
    return {name: try_read_json(out / result_file(name, run)) for name, run in plan["runs"].items()}


def snakemake_command(jobs, profile, is_dry_run=False):
    program = shutil.which("snakemake")
    if program is None:
        raise InputError("snakemake is not installed; run scripts/setup.sh")
    # The lock of at_work() is enough, and that of Snakemake would outlive a kill.
    command = [program, "--snakefile", str(SNAKEFILE), "--config", f"plan={PLAN}",
               f"python={sys.executable}", "--nolock", "--rerun-incomplete", "--rerun-triggers",
               "mtime", "--scheduler", "greedy", "--nocolor"]
    if profile is None:
        command += ["--cores", str(jobs or os.cpu_count())]
    else:
        own = SNAKEFILE.parent / "profiles" / profile
        command += ["--profile", str(own if own.is_dir() else profile),
                    *(["--jobs", str(jobs)] if jobs else [])]
    return command + (["--dry-run", "--quiet"] if is_dry_run else [])


def describe_dry_run(out, jobs, profile):
    """What Snakemake would do."""
    result = call(*snakemake_command(jobs, profile, True), cwd=out)
    if result.returncode != 0:
        raise Stopped(f"the dry run of Snakemake has failed: {result.stderr.strip()[-500:]}")
    return result.stdout.strip()


def run_snakemake(plan, jobs, profile, progress):
    """Makes the jobs by Snakemake, whose messages go to snakemake.log."""
    errors = {error_file(kind, name): name for kind, names in
              (("run", plan["runs"]), ("folder", plan["folders"])) for name in names}
    for path in errors:
        path.unlink(missing_ok=True)
    log, command = pathlib.Path("snakemake.log"), snakemake_command(jobs, profile)
    code, = work_off({"snakemake": (lambda: PROGRAMS.run(command, None, log), [])}, 1, progress.show).values()
    for path, name in errors.items():
        if path.exists():
            kind, _, message = path.read_text(encoding="utf-8").strip().partition(" ")
            raise (InputError if kind == "2" else Stopped)(one_line(message, 300))
    if code != 0 or not all(pathlib.Path(result_file(*item)).exists() for item in plan["runs"].items()):
        raise Stopped(f"Snakemake has stopped: {last_message(log)} (see {log.resolve()}); start again "
                      "to go on")


def error_file(kind, name):
    """Where a job of Snakemake writes why it could not be made."""
    return pathlib.Path(f"runs/{name}/{ERROR}" if kind == "run" else f"{name}.{ERROR}")


def job(words):
    """The job KIND NAME of a PLAN, which Snakemake starts. Exit codes: 0 done, 1 stopped, 2 bad input."""
    plan_file, kind, name = words
    plan, error = json.loads(pathlib.Path(plan_file).read_text(encoding="utf-8")), error_file(kind, name)
    try:
        explained(name, make_run if kind == "run" else make_folder, plan, name)
        return 0
    except (InputError, Stopped, OSError) as problem:
        code = 2 if isinstance(problem, InputError) else 1
        with contextlib.suppress(OSError):
            error.parent.mkdir(parents=True, exist_ok=True)
            error.write_text(f"{code} {problem}\n", encoding="utf-8")
        return code


if __name__ == "__main__":
    sys.exit(job(sys.argv[1:]))
