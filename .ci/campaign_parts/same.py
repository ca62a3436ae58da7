"""The same bytes: one question in folders of other names and depth, on 1, 2 and 7 threads, and on three kinds of processor."""

import resource
import shutil

from . import inputs, oracle

PROCESSORS = ["Nehalem", "Haswell", "max"]
# An emulated processor is some hundred times slower, and takes address space as it likes: what is slow is asked without.
EMULATED = [(resource.RLIMIT_CPU, 1200), (resource.RLIMIT_AS, resource.RLIM_INFINITY)]
EMULATED_UP_TO = 0.25  # seconds of this processor
# Functions of the C library as those of an older processor, at full speed.
OLDER = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4"}
# What writes a report, and is no matter of a moment's random choice.
ASKED = [(words, reads) for words, reads in inputs.COMMANDS if words[0] not in ("materials", "cameras") and "--verify" not in words]


def prepare(context):
    context.emulator = shutil.which("qemu-x86_64") or shutil.which("qemu-x86_64-static")
    return [] if context.emulator else ["skipped: kinds of processor, there is no qemu-x86_64"]


def case(rng, context, folder, number):
    """One command several times; the first is what the others are held against."""
    order = sorted(range(len(ASKED)), key=lambda index: (index * 7919 + context.seed) % 10_007)
    words, reads = ASKED[order[number % len(order)]]
    ways = [("a", "1", {}, []), ("b/of more depth/é", "2", {}, []), ("c", "7", {}, []), ("older library", "2", OLDER, [])]
    ways += [(f"emulated {name}", "1", {}, [context.emulator, "-cpu", name]) for name in PROCESSORS if context.emulator]
    faults, first, outcome, quick = [], None, None, False
    for place, threads, environment, emulator in ways:
        if emulator and not quick:
            continue
        found, outcome, wrong = answered(context, folder / place, words, reads, threads, environment, emulator)
        faults += wrong
        if first is None:
            first, quick = found, outcome.seconds < EMULATED_UP_TO
        differing = oracle.changed({name: first.get(name) for name in found} if emulator else first, found)
        if differing:
            faults.append((oracle.DIFFERENT, f"{threads} threads, {place}: {', '.join(differing)[:300]}"))
    return faults, f"hadar {' '.join(words)}", outcome


def answered(context, place, words, reads, threads, environment, emulator):
    """All that a question says and writes, by name, and the last run; under an emulator in one form of two."""
    work, temporary = place / "work", place / "tmp"
    work.mkdir(parents=True)
    temporary.mkdir()
    for name in reads:
        shutil.copy(context.pool / name, work / name)
    found, faults, outcome = {}, [], None
    for form in [["--json"]] if emulator else ([], ["--json"]):
        asked = [*words, "--threads", threads, *form, *([] if "--out" in words else ["--out", "out"])]
        outcome = oracle.run([context.hadar, *asked], work, {"TMPDIR": str(temporary), **environment}, tracer=emulator, limits=EMULATED if emulator else [])
        if not emulator:
            faults += oracle.ended(outcome, asked)
        found[f"stdout {' '.join(form)}"] = outcome.stdout
        for path in sorted((work / "out").rglob("*")):
            if path.is_file() and ".sweep" not in path.parts:
                found[f"{path.relative_to(work)} {' '.join(form)}"] = oracle.digest(path)
        shutil.rmtree(work / "out", ignore_errors=True)
    return found, outcome, faults
