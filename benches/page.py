"""The figures of README.md beside this file, measured now: our benches and NumPy's in turn, the least of several rounds.

    python3 benches/page.py [ROUNDS]     # some eight minutes with three rounds; needs numpy

One thread is CPU time where a case takes longer than a run of half a second, all threads is time of the clock. The rates of one core are
measured in every round by `hardware.rs`; its counts of operations are those of the shares. Local distances and single pairs use one thread.
"""

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Our bench and case, NumPy's case, name in the table.
CASES = [
    ("matrices", "local pair", "local pair", "local distance, one pair"),
    ("matrices", "searched pair", "nearest pair", "nearest distance, one pair, searched"),
    ("matrices", "nearest pair", "nearest pair", "nearest distance, one pair, proved"),
    ("matrices", "local 30", "local 30", "local distances, 30 × 30"),
    ("matrices", "local 300", "local 300", "local distances, 300 × 300"),
    ("matrices", "local 1000", "local 1000", "local distances, 1 000 × 1 000"),
    ("matrices", "searched 30", "nearest 30", "nearest distances, 30 × 30, searched"),
    ("matrices", "nearest 30", "nearest 30", "nearest distances, 30 × 30, proved"),
    ("matrices", "searched 300", "nearest 300", "nearest distances, 300 × 300, searched"),
    ("matrices", "nearest 300", "nearest 300", "nearest distances, 300 × 300, proved"),
    ("matrices", "apart 30", "apart 30", "told apart of 30, d = 1, proved"),
    ("matrices", "apart 300", "apart 300", "told apart of 300, d = 1, proved"),
    ("matrices", "apart 1000", "apart 1000", "told apart of 1 000, d = 1, proved"),
    ("matrices", "close 30", "close 30", "told apart of 30, d = 20, proved"),
    ("matrices", "close 300", "close 300", "told apart of 300, d = 20, proved"),
    ("witnesses", "10 000 spectra of 536 bands drawn and judged", "judged spectra", "10 000 Poisson spectra drawn and judged"),
    ("ranging", "540 x 960 x 54/Full alone, windows of 5 x 5", "windows 5 x 5", "windows of a cube, both resolutions"),
]
# Matrices whose operations are counted: our case, kernel of `hardware.rs`.
COUNTED = [("local 300", "local matrix of 300"), ("local 1000", "local matrix of 1000"), ("searched 300", "nearest"), ("nearest 300", "nearest")]
MILLISECONDS = {"ns": 1e-6, "µs": 1e-3, "us": 1e-3, "ms": 1.0, "s": 1e3}
RESULT = r"sum of the windows, textured: (\S+)|spectra of each class: (\S+) right"


def run(command, threads=None):
    """What a command prints, and its CPU milliseconds."""
    environment = dict(os.environ, **({"RAYON_NUM_THREADS": str(threads)} if threads else {}))
    before = os.times()
    found = subprocess.run(command, cwd=HERE.parent, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    after = os.times()
    if found.returncode:
        sys.exit(f"{' '.join(command)}\n{found.stdout}{found.stderr}")
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return found.stdout, 1e3 * cpu


def built(bench):
    """The program of a bench."""
    lines, _ = run(["cargo", "bench", "--locked", "--no-run", "--bench", bench, "--message-format", "json"])
    messages = [json.loads(line) for line in lines.splitlines() if line.startswith("{")]
    return next(one["executable"] for one in messages if one.get("target", {}).get("name") == bench and one.get("executable"))


def ours(program, bench, case, threads):
    """Milliseconds and result of a case."""
    if bench == "matrices":
        text, cpu = run([program, "--bench", *case.split()], threads)
        found = re.search(r": ([\d.]+) ms, (\S+)", text)
        milliseconds, result = float(found[1]), float(found[2])
        # A whole process that takes no longer than the case did by the clock was disturbed by others.
        return (min(milliseconds, cpu) if threads == 1 else milliseconds), result
    text, _ = run([program, "--bench", "--quick", case], threads)
    found = re.search(r"time:\s+\[\S+ \S+ (\S+) (\S+) \S+ \S+\]", text)
    return float(found[1]) * MILLISECONDS[found[2]], float(next(filter(None, re.search(RESULT, text).groups())))


def peer(case):
    text, _ = run([sys.executable, str(HERE / "numpy_peer.py"), *case.split(" ", 1)])
    found = re.search(r": (\S+) ms, (\S+)", text)
    return float(found[1]), float(found[2])


def short(milliseconds):
    for unit, factor in [("s", 1e3), ("ms", 1.0), ("µs", 1e-3)]:
        if milliseconds >= factor:
            break
    value = milliseconds / factor
    return f"{value:.{max(0, 2 - int(math.log10(value)))}f} {unit}"


def shared(one, other):
    """What both results have in common."""
    if one == other:
        return f"{one:.12g}"
    digits = max(1, min(12, int(-math.log10(abs(one / other - 1.0)))))
    return f"{one:.{digits}g}"


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    programs = {bench: built(bench) for bench in ("matrices", "witnesses", "ranging", "hardware")}
    one, both, theirs, results, hardware = {}, {}, {}, {}, []
    for _ in range(rounds):
        now = {}
        for bench, case, numpys, _ in CASES:
            alone = case.startswith("local") or case.endswith("pair")
            for times, threads in ((one, 1),) if alone else ((one, 1), (both, None)):
                milliseconds, result = ours(programs[bench], bench, case, threads)
                times[case] = min(times.get(case, milliseconds), milliseconds)
            if numpys not in now:
                now[numpys] = peer(numpys)
                theirs[numpys] = min(theirs.get(numpys, now[numpys][0]), now[numpys][0])
            results[case] = (result, now[numpys][1])
            print(".", end="", file=sys.stderr, flush=True)
        hardware.append(run([programs["hardware"], "--bench"])[0])

    import numpy

    processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line), "")
    rustc = run(["rustc", "--version"])[0].split()[1]
    print(f"\n{processor}, {os.cpu_count()} cores; rustc {rustc}, NumPy {numpy.__version__}, Python {sys.version.split()[0]}; least of {rounds}\n")
    print("| case | one thread | all threads | NumPy, one thread | NumPy ÷ ours, one thread | result of both |\n|---|---|---|---|---|---|")
    for _, case, numpys, name in CASES:
        times = f"{short(one[case])} | {short(both[case]) if case in both else ''} | {short(theirs[numpys])}"
        print(f"| {name} | {times} | {theirs[numpys] / one[case]:.2g} | {shared(*results[case])} |")

    # Of the round in which the core was the fastest.
    rate, fastest = max((float(re.search(r"([\d.]+) G vector operations", text)[1]) * 1e9, text) for text in hardware)
    rows = [line.split("|") for line in fastest.splitlines() if line.startswith("|")][2:]
    operations = {row[1].strip(): float(row[3]) for row in rows}
    print("\n| matrix | operations | ours, of the rate of a core | NumPy |\n|---|---|---|---|")
    for case, kernel in COUNTED:
        count = int(case.split()[1])
        all_operations = operations[kernel] * count * (count - 1)
        numpys, name = next((numpys, name) for _, own, numpys, name in CASES if own == case)
        shares = [f"{1e5 * all_operations / rate / milliseconds:.0f} %" for milliseconds in (one[case], theirs[numpys])]
        print(f"| {name} | {all_operations:.2g} | {' | '.join(shares)} |")
    print(f"\n{fastest}")
    print(run([".ci/instructions"])[0])


if __name__ == "__main__":
    main()
