"""A file of one command is changed; what the command then says and leaves must make sense."""

import os
import re
import shutil

from . import inputs, mutate, oracle


TIME_LIMIT = ["--time-limit", "20 s"]
MEMORY_LIMIT = ["--memory-limit", "2 GB"]


def sentinel(folder):
    """A tree that no run may touch, and that stands for the rest of the disk."""
    (folder / "sub").mkdir(parents=True)
    for name, content, mode in [("precious.txt", "mine\n", 0o600), ("script.sh", "export A=1\n", 0o755), ("sub/report.html", "another\n", 0o644)]:
        path = folder / name
        path.write_text(content)
        path.chmod(mode)
        os.utime(path, (1_500_000_000, 1_500_000_000))


def prepare(context):
    """Which commands can be held to a time and a memory, as everybody holds them who asks for files of others."""
    context.limited = {}
    for command, _ in inputs.COMMANDS:
        depth = 2 if command[0] in ("materials", "cameras", "calibrate") else 1
        said = oracle.run([context.hadar, *command[:depth], "--help"], context.pool).stdout
        context.limited[command[0]] = [*TIME_LIMIT, *MEMORY_LIMIT] if TIME_LIMIT[0] in said else []


def case(rng, context, folder):
    """One case in an empty folder; faults as pairs of a class and a sentence, and what was done."""
    command, reads = rng.choice(inputs.COMMANDS)
    work, outside, temporary = folder / "work", folder / "outside", folder / "tmp"
    for path in (work, temporary):
        path.mkdir()
    sentinel(outside)
    for name in reads:
        shutil.copy(context.pool / name, work / name)
    name = reads[0] if rng.random() < 0.6 else rng.choice(reads)
    changed, what = mutate.mutated(rng, name, (context.pool / name).read_bytes())
    (work / name).write_bytes(changed)
    words = list(command)
    as_json, report, both = rng.random() < 0.7, rng.random() < 0.25, rng.random() < 0.12
    if (report or command[0] in ("render", "library", "calibrate")) and "--out" not in words and command[0] not in ("materials", "cameras"):
        words += ["--out", "out"]
    if command[0] not in ("materials", "cameras"):
        words += ["--threads", "1"]
    words += context.limited[command[0]]
    before, own = oracle.snapshot(outside), oracle.snapshot(work)
    environment = {"HOME": str(outside), "TMPDIR": str(temporary)}
    if as_json:
        words += ["--json"]
    outcome = oracle.run([context.hadar, *words], work, environment)
    faults = list(oracle.ended(outcome, words))
    if both and as_json and not faults and outcome.code in (0, 3):
        plain = [word for word in words if word != "--json"] + (["--force"] if "--out" in words else [])
        text = oracle.run([context.hadar, *plain], work, environment)
        faults += oracle.ended(text, plain)
        # Beside other work the one may reach its limit of time and the other not.
        stopped = "the limit of time" in text.stderr
        if text.code != outcome.code and not stopped:
            faults.append((oracle.CONTRADICTION, f"exit code {outcome.code} with --json, {text.code} without: {text.stderr:.100}"))
        elif text.code in (0, 3):
            faults += [(oracle.CONTRADICTION, found) for found in oracle.same_answer(text.stdout, outcome.stdout, "--check" not in plain)]
    if oracle.snapshot(outside) != before:
        faults.append((oracle.WRITTEN_OUTSIDE, ", ".join(oracle.changed(before, oracle.snapshot(outside)))))
    now = {name: state for name, state in oracle.snapshot(work).items() if name.split("/")[0] != "out"}
    if now != own:
        faults.append((oracle.WRITTEN_OUTSIDE, f"beside --out: {', '.join(oracle.changed(own, now))}"))
    if any(temporary.iterdir()):
        faults.append((oracle.WRITTEN_OUTSIDE, f"left in TMPDIR: {next(temporary.iterdir()).name}"))
    if (work / "out").exists():
        if outcome.code in (0, 3):
            faults += [(oracle.TORN, found) for found in oracle.report_faults(work / "out")]
        elif outcome.code == 1 and command[0] != "sweep" and any((work / "out").iterdir()):
            faults.append((oracle.TORN, f"exit code 1, and a report: {sorted(os.listdir(work / 'out'))}"))
        faults += [(oracle.CONTRADICTION, found) for found in oracle.report_words(work / "out")]
    # Who calls an object `inf` finds it under its name.
    if re.search(r"\b(inf|nan)\b", what, re.IGNORECASE):
        faults = [fault for fault in faults if fault[0] != oracle.CONTRADICTION or not re.search(r"\binf\b|nan\b", fault[1], re.IGNORECASE)]
    return faults, f"{name}: {what}: hadar {' '.join(words)}", outcome
