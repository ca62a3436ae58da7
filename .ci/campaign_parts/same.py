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
    ways = [("a", "1", None), ("b/of more depth/é", "2", None), ("c", "7", None), ("older", "2", OLDER)]
    ways += [(f"p/{processor}", "1", processor) for processor in PROCESSORS if context.emulator]
    faults, first, outcome, quick = [], None, None, False
    for place, threads, processor in ways:
        emulated = isinstance(processor, str)
        if emulated and not quick:
            continue
        found, outcome, wrong = answered(context, folder / place, words, reads, threads, processor)
        faults += wrong
        if first is None:
            first, quick = found, outcome.seconds < EMULATED_UP_TO
        differing = oracle.changed({name: first.get(name) for name in found} if emulated else first, found)
        if differing:
            how = f"emulated {processor}" if emulated else f"{threads} threads, folder {place}"
            faults.append((oracle.DIFFERENT, f"{how}: {', '.join(differing)[:300]}"))
    return faults, f"hadar {' '.join(words)}", outcome


def answered(context, place, words, reads, threads, processor):
    """All that a question says and writes, by name, and the last run."""
    work, temporary = place / "work", place / "tmp"
    work.mkdir(parents=True)
    temporary.mkdir()
    for name in reads:
        shutil.copy(context.pool / name, work / name)
    emulated, more = isinstance(processor, str), processor if isinstance(processor, dict) else {}
    tracer = [context.emulator, "-cpu", processor] if emulated else []
    found, faults, outcome = {}, [], None
    for form in [["--json"]] if emulated else ([], ["--json"]):
        asked = [*words, "--threads", threads, *form, *([] if "--out" in words else ["--out", "out"])]
        outcome = oracle.run([context.hadar, *asked], work, {"TMPDIR": str(temporary), **more}, tracer=tracer, limits=EMULATED if emulated else [])
        if not emulated:
            faults += oracle.ended(outcome, asked)
        found[f"stdout {' '.join(form)}"] = outcome.stdout
        for path in sorted((work / "out").rglob("*")):
            if path.is_file() and ".sweep" not in path.parts:
                found[f"{path.relative_to(work)} {' '.join(form)}"] = oracle.digest(path)
        shutil.rmtree(work / "out", ignore_errors=True)
    return found, outcome, faults
