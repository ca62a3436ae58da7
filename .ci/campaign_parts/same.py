"""The same bytes: one question in folders of other names and depth, on 1, 2 and 7 threads, and on three kinds of processor."""

import resource
import shutil

from . import inputs, oracle

PROCESSORS = ["Nehalem", "Haswell", "max"]
# An emulated processor is some ten times slower, and takes address space as it likes.
EMULATED = [(resource.RLIMIT_CPU, 1200), (resource.RLIMIT_AS, resource.RLIM_INFINITY)]
# What writes a report, and is no matter of a moment's random choice.
ASKED = [(words, reads) for words, reads in inputs.COMMANDS if words[0] not in ("materials", "cameras") and "--verify" not in words]


def prepare(context):
    context.emulator = shutil.which("qemu-x86_64") or shutil.which("qemu-x86_64-static")
    return [] if context.emulator else ["skipped: kinds of processor, there is no qemu-x86_64"]


def case(rng, context, folder, number):
    """One command several times; the first is what the others are held against."""
    order = sorted(range(len(ASKED)), key=lambda index: (index * 7919 + context.seed) % 10_007)
    words, reads = ASKED[order[number % len(order)]]
    ways = [("a", "1", None), ("b/of more depth/é", "2", None), ("c", "7", None)]
    ways += [(f"p/{processor}", "1", processor) for processor in PROCESSORS if context.emulator]
    faults, first, outcome = [], None, None
    for place, threads, processor in ways:
        found, outcome, wrong = answered(context, folder / place, words, reads, threads, processor)
        faults += wrong
        first = first if first is not None else found
        differing = oracle.changed(first, found)
        if differing:
            how = f"emulated {processor}" if processor else f"{threads} threads, folder {place}"
            faults.append((oracle.DIFFERENT, f"{how}: {', '.join(differing)[:300]}"))
    return faults, f"hadar {' '.join(words)}", outcome


def answered(context, place, words, reads, threads, processor):
    """All that a question says and writes, by name, and the last run."""
    work, temporary = place / "work", place / "tmp"
    work.mkdir(parents=True)
    temporary.mkdir()
    for name in reads:
        shutil.copy(context.pool / name, work / name)
    tracer = [context.emulator, "-cpu", processor] if processor else []
    found, faults, outcome = {}, [], None
    for form in ([], ["--json"]):
        asked = [*words, "--threads", threads, *form, *([] if "--out" in words else ["--out", "out"])]
        outcome = oracle.run([context.hadar, *asked], work, {"TMPDIR": str(temporary)}, tracer=tracer, limits=EMULATED if processor else [])
        if not processor:
            faults += oracle.ended(outcome, asked)
        found[f"stdout {' '.join(form)}"] = outcome.stdout
        for path in sorted((work / "out").rglob("*")):
            if path.is_file() and ".sweep" not in path.parts:
                found[f"{path.relative_to(work)} {' '.join(form)}"] = oracle.digest(path)
        shutil.rmtree(work / "out", ignore_errors=True)
    return found, outcome, faults
