"""Kills at every system call that writes, and calls, memory, stack, file handles and files that fail; by strace, and by limits without it.

A report that is being written is, at whatever moment its process ends: the old one whole, the new one whole, or without hadar.json and
completed by the next run that names the folder. A run that says it is done has written the new one.
"""

import collections
import random
import re
import resource
import shutil
import signal

from . import oracle
from .mutations import sentinel

# Calls that change what is on disk.
WRITING = [
    "write", "pwrite64", "writev", "openat", "rename", "renameat", "renameat2", "mkdir", "mkdirat", "unlink", "unlinkat", "rmdir", "link",
    "linkat", "symlink", "symlinkat", "fchmod", "fchmodat", "chmod", "ftruncate", "copy_file_range", "sendfile", "fsync", "fdatasync",
]  # fmt: skip
READING = ["read", "pread64", "statx", "newfstatat", "getdents64", "flock", "readlink", "fcntl"]
MEMORY = ["mmap", "brk", "mremap"]
ERRORS = {"write": ["ENOSPC", "EIO", "EDQUOT"], "openat": ["ENOSPC", "EACCES", "EMFILE", "EIO"], "rename": ["ENOSPC", "EACCES", "EXDEV", "EIO"]}
OTHER_ERRORS = ["EIO", "EACCES", "ENOSPC", "EINTR"]
OTHER = ["--set", 'target.distance="10 m"']


def sizing(*more):
    return ["size", "size.toml", "--threads", "1", "--quiet", *more]


SWEEP = ["sweep", "size.toml", "--vary", "target.distance=5 m,20 m", "--columns", "verdict", "--threads", "1", "--quiet", "--out", "out"]
# What is asked, in which folder; by what an older report was made, and what else is in the folder.
SETUPS = {
    "new": (sizing("--out", "out"), None, []),
    "exchanged": (sizing("--out", "out"), sizing(*OTHER, "--out", "out"), []),
    "hidden file": (sizing("--out", "out"), sizing(*OTHER, "--out", "out"), [".keep"]),
    "forced": (sizing("--out", "out", "--force"), sizing(*OTHER, "--out", "out"), ["notes.txt"]),
    "in folders to be made": (sizing("--out", "out/a/b"), None, []),
    "fewer files": (["identify", "size.toml", "--threads", "1", "--quiet", "--out", "out"], sizing("--out", "out"), [".keep"]),
    "sweep": (SWEEP, None, []),
    "sweep again": (SWEEP, [word.replace("5 m,20 m", "5 m,10 m") for word in SWEEP], []),
    "maps": (["decompose", "exact.toml", "--threads", "1", "--quiet", "--out", "out"], None, []),
    "certificate": (["rule", "rule.toml", "--threads", "1", "--quiet", "--out", "out"], None, []),
}
READ = ["size.toml", "exact.toml", "exact.npy", "library15.csv", "rule.toml", "two.csv"]


def begin(context, name, folder):
    """The folder of a setup before the run."""
    words, older, beside = SETUPS[name]
    work = folder / "work"
    (folder / "tmp").mkdir()
    sentinel(folder / "outside")
    template = context.pool / "before" / name
    shutil.copytree(template if template.exists() else context.pool, work, ignore=None if template.exists() else lambda _, names: set(names) - set(READ))
    if not template.exists():
        if older:
            run(context, older, folder)
        for extra in beside:
            (work / "out" / extra).write_text("a stranger's")
        shutil.copytree(work, template)
    return words


def run(context, words, folder, **how):
    environment = {"HOME": str(folder / "outside"), "TMPDIR": str(folder / "tmp"), **how.pop("env", {})}
    return oracle.run([context.hadar, *words], folder / "work", environment, **how)


def prepare(context):
    """What every setup writes if nothing fails, and which calls it makes; lines that say what is skipped."""
    context.tracer, context.finals, context.points = shutil.which("strace"), {}, []
    for name in SETUPS:
        folder = context.cases / "prepared"
        folder.mkdir()
        words = begin(context, name, folder)
        log = folder / "log"
        trace = ",".join(WRITING + READING + MEMORY)
        tracer = [context.tracer, "-f", "-qq", "-o", str(log), "-e", f"trace=?{trace.replace(',', ',?')}"] if context.tracer else []
        outcome = run(context, words, folder, tracer=tracer)
        if outcome.code != 0 and tracer and "ptrace" in outcome.stderr:
            context.tracer = None
            outcome = run(context, words, folder)
        if outcome.code != 0:
            raise SystemExit(f"{name}: {outcome.stderr}")
        context.finals[name] = visible(folder / "work" / "out")
        if context.tracer:
            context.points += [(name, *point) for point in points(log.read_text("utf-8", "replace"))]
        shutil.rmtree(folder)
    random.Random(f"{context.seed} points").shuffle(context.points)
    return [] if context.tracer else ["skipped: kills and failing system calls, there is no strace that may trace"]


def points(log):
    """Calls after the program is loaded: name, number among those of its name and thread, whether it changes the disk."""
    lines = log.splitlines()
    loaded = max((index for index, line in enumerate(lines) if re.search(r'openat\(.*\.so[."]', line)), default=0)
    counts = collections.Counter()
    for index, line in enumerate(lines):
        found = re.match(r"(\d+) +(\w+)\(", line)
        if not found:
            continue
        counts[found.groups()] += 1
        call = found.group(2)
        if index > loaded:
            creates = call in WRITING and (call != "openat" or "O_CREAT" in line)
            yield call, counts[found.groups()], creates


def visible(out):
    """Content of the files of a report, without what is hidden."""
    if not out.is_dir():
        return {}
    paths = [path for path in sorted(out.rglob("*")) if path.is_file() and not any(part.startswith(".") for part in path.relative_to(out).parts)]
    return {str(path.relative_to(out)): oracle.digest(path) for path in paths}


def injected(context, call, what):
    return [context.tracer, "-f", "-qq", "-o", "/dev/null", "-e", f"trace={call}", "-e", f"inject={call}:{what}"]


def told(context):
    """The point that --at names, in the words of a case: which calls there are, and so their numbers, differs a little from run to run."""
    found = re.match(r"(.+?): (?:killed at (\w+) number (\d+)|(\w+) fails with (\w+), number (\d+\+?))", context.at or "")
    if not found:
        return None
    name, killed, number, failing, error, when = found.groups()
    return (name, killed, number) if killed else (name, failing, when, error)


def kill(rng, context, folder, number):
    """The process is killed at one call that writes."""
    deadly = [point for point in context.points if point[3]]
    name, call, count = told(context) or deadly[number % len(deadly)][:3]
    words = begin(context, name, folder)
    before = visible(folder / "work" / "out")
    outcome = run(context, words, folder, tracer=injected(context, call, f"signal=KILL:when={count}"))
    faults = [] if outcome.code in (-9, 137, 0) else list(oracle.ended(outcome, words))
    faults += left(context, name, folder, before, outcome, words)
    return faults, f"{name}: killed at {call} number {count}: hadar {' '.join(words)}", outcome


def failure(rng, context, folder, number):
    """One call fails, or all from one on; or a limit is reached."""
    name = rng.choice(sorted(SETUPS))
    how, env, limits, tracer = "", {}, [], []
    if told(context):
        name, call, count, error = told(context)
        how, tracer = f"{call} fails with {error}, number {count}", injected(context, call, f"error={error}:when={count}")
    elif context.tracer and rng.random() < 0.7:
        name, call, count, _ = context.points[number % len(context.points)]
        error = "ENOMEM" if call in MEMORY else rng.choice(ERRORS.get(call, OTHER_ERRORS))
        # A call that is interrupted is made again, for ever if it is interrupted for ever.
        when = f"{count}+" if rng.random() < 0.4 and error != "EINTR" else f"{count}"
        how, tracer = f"{call} fails with {error}, number {when}", injected(context, call, f"error={error}:when={when}")
    else:
        how, env, limits = limit(rng)
    words = begin(context, name, folder)
    before = visible(folder / "work" / "out")
    outcome = run(context, words, folder, tracer=tracer, env=env, limits=limits)
    faults = verdict(outcome, words, how)
    if outcome.code == 0 and visible(folder / "work" / "out") != context.finals[name]:
        faults.append((oracle.TORN, f"exit code 0 with another report: {oracle.changed(context.finals[name], visible(folder / 'work' / 'out'))}"))
    faults += left(context, name, folder, before, outcome, words)
    return faults, f"{name}: {how}: hadar {' '.join(words)}", outcome


def limit(rng):
    """A limit of the machine: words, variables and limits."""
    kind = rng.choice(["memory", "memory", "memory", "stack", "stacks of threads", "handles", "length", "no TMPDIR"])
    kilobyte = 1024
    if kind == "memory":
        size = rng.randrange(12_000, 120_000) * kilobyte
        return f"{size >> 20} MB of address space", {}, [(resource.RLIMIT_AS, size)]
    if kind == "stack":
        size = rng.choice([128, 160, 192, 256, 384, 512, 1024]) * kilobyte
        return f"a stack of {size >> 10} kB", {}, [(resource.RLIMIT_STACK, size)]
    if kind == "stacks of threads":
        size = rng.choice([1, 1000, 16_384, 65_536, 131_072, 262_144])
        return f"stacks of {size} bytes for threads", {"RUST_MIN_STACK": str(size)}, []
    if kind == "handles":
        size = rng.randrange(3, 12)
        return f"{size} file handles", {}, [(resource.RLIMIT_NOFILE, size)]
    if kind == "length":
        size = rng.choice([0, 1, 500, 4096, 20_000, 60_000])
        return f"files of at most {size} bytes", {}, [(resource.RLIMIT_FSIZE, size)]
    return "no TMPDIR", {"TMPDIR": "/nowhere/at/all"}, []


def verdict(outcome, words, how):
    """Faults of how a run ended under a failure; what the machine itself says is no fault of the program."""
    outcome.aborted = outcome.code in (-signal.SIGABRT, 134) and "memory allocation of" in outcome.stderr
    loader = outcome.code in (126, 127) or "error while loading shared libraries" in outcome.stderr
    by_signal = outcome.code == -signal.SIGXFSZ and "files of at most" in how
    # A program that is not loaded yet.
    unloaded = outcome.code in (-signal.SIGSEGV, -signal.SIGKILL) and not outcome.stderr and ("address space" in how or "a stack of" in how or re.search(r"mmap fails with ENOMEM, number \d\+?$", how))
    # The standard library lays out a stack for its own handler of overflows before the program's first line.
    unloaded = unloaded or outcome.code != 0 and "failed to allocate an alternative stack" in outcome.stderr
    if outcome.aborted or loader or by_signal or unloaded:
        return []
    silent = "write fails" in how and how.endswith("+") or "files of at most" in how
    if silent and outcome.code == 1 and "panicked" not in outcome.stderr:
        return []
    # Without room for a block the allocator of the C library searches for every one anew, some tens of seconds in the system.
    cramped = "address space" in how
    return [fault for fault in oracle.ended(outcome, words) if not (cramped and fault[0] == oracle.BEYOND_TIME)]


def left(context, name, folder, before, outcome, words):
    """What is wrong with the report that a run left which was ended or failed, and with the next run."""
    out, final = folder / "work" / "out", context.finals[name]
    report = out / "a/b" if name.startswith("in folders") else out
    now = visible(out)
    if (report / "hadar.json").exists():
        for fault in oracle.report_faults(report):
            yield oracle.TORN, fault
        if now not in (before, final):
            yield oracle.TORN, f"neither the old report nor the new one: {oracle.changed(before, now)} and {oracle.changed(final, now)}"
    fresh = folder / "fresh"
    sentinel(fresh)
    kept = {path: state for path, state in oracle.snapshot(fresh).items()}
    if oracle.snapshot(folder / "outside") != kept:
        yield oracle.WRITTEN_OUTSIDE, ", ".join(oracle.changed(kept, oracle.snapshot(folder / "outside")))
    for extra in SETUPS[name][2]:
        if not (out / extra).is_file() or (out / extra).read_text() != "a stranger's":
            yield oracle.WRITTEN_OUTSIDE, f"{extra} of a stranger is gone"
    again = run(context, words, folder)
    if again.code != 0:
        yield oracle.TORN, f"the next run ends with {again.code}: {again.stderr[:200]}"
    elif visible(out) != final:
        yield oracle.TORN, f"the next run leaves another report: {oracle.changed(final, visible(out))}"
    strays = [str(path.relative_to(folder)) for path in folder.rglob(".hadar-*")] if again.code == 0 else []
    if strays:
        yield oracle.TORN, f"left after the next run: {', '.join(strays)}"
    beside = {path.name for path in (folder / "work").iterdir()} - {"out"} - set(READ) - {path.split("/")[1] for path in strays if path.startswith("work/")}
    if beside:
        yield oracle.WRITTEN_OUTSIDE, f"beside --out: {beside}"
