"""What whole commands take, from the start of the program to the last line written: a table for README.md beside this file.

    cargo build --release --locked -p hadar-cli
    python3 benches/commands.py [ROUNDS]

Every command in turn with `--no-skip` (all is computed, also what a proof makes unnecessary) and without, the least of several
rounds (of as many as begin within half a minute); CPU seconds are those of user and system of all threads. Nothing is kept from run
to run: every one has a temporary folder of its own.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENOUGH_S = 30.0
COMMANDS = [
    "--version",
    "materials list",
    "size examples/human_vs_robot.toml",
    "size examples/human_vs_robot.toml --json",
    "size examples/human_vs_robot.toml --check",
    "size examples/human_vs_robot.toml --out OUT",
    "size examples/sizing.toml",
    "rule examples/rule_delivery_robots_at_night.toml",
    "rule examples/rule_delivery_robots_at_night.toml --check",
    "identify examples/five_materials.toml",
    "identify examples/five_materials.toml --apart",
    "identify examples/five_materials.toml --matrix",
    "identify examples/what_can_my_flir_tell_apart.toml --matrix",
    "range examples/street.toml",
    "simulate examples/human_vs_robot_3_bands.toml",
    "sweep examples/human_vs_robot.toml --vary target.distance=20m..40m:3 --out OUT",
]


def measured(program, words):
    """CPU and wall seconds, and the largest resident memory in megabytes."""
    with tempfile.TemporaryDirectory() as folder:
        command = [str(program), *(word.replace("OUT", f"{folder}/out") for word in words)]
        start = time.perf_counter()
        child = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        said = child.stderr.read().decode()
        _, status, used = os.wait4(child.pid, 0)
        wall = time.perf_counter() - start
        # 1 and 3 are answers: not met, not decided.
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode not in (0, 1, 3):
            sys.exit(f"{' '.join(command)}: {child.returncode}\n{said}")
        return used.ru_utime + used.ru_stime, wall, used.ru_maxrss / 1024


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    program = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "hadar"
    print("| command | CPU | wall | memory | CPU with `--no-skip` | with ÷ without |\n|---|---|---|---|---|---|")
    for command in COMMANDS:
        words = command.split()
        skips = words[0] not in ("--version", "materials")
        ways = [words, [*words, "--no-skip"]] if skips else [words]
        runs, start = [], time.perf_counter()
        while len(runs) < rounds and time.perf_counter() - start < ENOUGH_S:
            runs.append([measured(program, way) for way in ways])
        (cpu, wall, memory), *whole = (tuple(map(min, zip(*way))) for way in zip(*runs))
        end = f"{whole[0][0]:.3f} s | {whole[0][0] / cpu:.2f}" if whole else " | "
        print(f"| `{command}` | {cpu:.3f} s | {wall:.3f} s | {memory:.0f} MB | {end} |", flush=True)


if __name__ == "__main__":
    main()
