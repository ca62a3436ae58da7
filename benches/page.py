"""Every figure of README.md beside this file, measured now: prints the tables' rows.

    python3 benches/page.py        # some minutes; the machine should be quiet. NumPy's column needs numpy.

Runs the benches with one thread and with all (the least of several short runs), NumPy's peers, the bounds of the hardware,
and the instruction counts.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
RUNS = 4
# Our name, NumPy's name, name in the table.
CASES = [
    ("local distance, one pair, 536 bands", "local, one pair", "local distance, one pair"),
    ("nearest distance, one pair, 536 bands", "nearest, one pair", "nearest distance, one pair"),
    ("nearest distance with its proof, one pair, 536 bands", "", "the same with its proof, to 1e-6"),
    ("30 x 30 local matrix, 536 bands", "local, 30 x 30", "30 × 30 local matrix"),
    ("libraries/30 x 30 nearest matrix, 536 bands", "nearest, 30 x 30", "30 × 30 nearest matrix"),
    ("libraries/30 x 30 nearest matrix with proofs, 536 bands", "", "the same with proofs, to 1e-6"),
    ("libraries/which of 30 can be told apart at d = 1, skipping On", "", "told apart at d = 1, proved"),
    ("libraries/which of 30 can be told apart at d = 1, skipping Off", "", "every distance in full, not proved"),
    ("libraries/which of 30 can be told apart at d = 40, skipping On", "", "told apart at d = 40, proved"),
    ("libraries/which of 30 can be told apart at d = 40, skipping Off", "", "every distance in full, not proved"),
]
SECONDS = {"ns": 1e-9, "µs": 1e-6, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def run(command, threads=None):
    environment = dict(os.environ)
    if threads:
        environment["RAYON_NUM_THREADS"] = str(threads)
    found = subprocess.run(command, cwd=HERE.parent, env=environment, capture_output=True, text=True)
    if found.returncode:
        sys.exit(f"{' '.join(command)}\n{found.stdout}{found.stderr}")
    return found.stdout


def criterion(threads):
    """Seconds of every case: the least middle estimate of several short runs."""
    least = {}
    for _ in range(RUNS):
        name = None
        for line in run(["cargo", "bench", "--bench", "distances", "--", "--quick"], threads).splitlines():
            match = re.search(r"^(.*?)\s*time:\s+\[\S+ \S+ (\S+) (\S+) \S+ \S+\]", line)
            if match:
                seconds = float(match[2]) * SECONDS[match[3]]
                case = match[1].strip() or name
                least[case] = min(least.get(case, seconds), seconds)
            elif line.strip():
                name = line.strip()
    return least


def numpy_peer():
    """Seconds and result of every case in NumPy."""
    try:
        import numpy
    except ImportError:
        return "", {}
    rows = {}
    for line in run([sys.executable, str(HERE / "numpy_peer.py")]).splitlines():
        match = re.search(r"^(.*?)\s+([\d.]+) us\s+(\S+)$", line)
        rows[match[1].strip()] = (float(match[2]) * 1e-6, match[3])
    return f"NumPy {numpy.__version__}, Python {sys.version.split()[0]}", rows


def short(seconds):
    for unit, factor in [("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)]:
        if seconds >= factor:
            return f"{seconds / factor:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def main():
    version, peers = numpy_peer()
    one, all_threads = criterion(1), criterion(None)
    processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line), "")
    rustc = run(["rustc", "--version"]).split()[1]
    print(f"{processor}, {os.cpu_count()} cores; rustc {rustc}; {version}\n")
    print("| case | one thread | all threads | NumPy | ratio, one thread |\n|---|---|---|---|---|")
    for ours, theirs, name in CASES:
        peer = peers.get(theirs, (float("nan"), ""))[0]
        print(f"| {name} | {short(one[ours])} | {short(all_threads[ours])} | {short(peer)} | {peer / one[ours]:.2g} |")
    print("\n" + run(["cargo", "bench", "--bench", "hardware"]))
    print(run([".ci/instructions"]))


if __name__ == "__main__":
    main()
