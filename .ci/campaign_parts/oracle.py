"""A run of the program, what it took, and what is wrong with how it ended, with what it said and with what it left behind."""

import dataclasses
import hashlib
import json
import math
import multiprocessing
import os
import re
import resource
import signal
import stat
import subprocess
import tempfile

# Processor time of a run, s: a run of what is small takes some tenths of one, and none more than it is allowed by --time-limit.
LONGEST_S = 30
# A run that waits, as on a pipe or a lock, takes no processor time at all; one on a busy machine takes little.
LONGEST_WAIT_S = 30
MOST_BYTES = 2 << 30
# Address space, so that what asks for more cannot harm the machine.
ADDRESS_SPACE = 6 << 30

# Classes of faults, the worst first.
WRITTEN_OUTSIDE = "written outside"
BELIEVED = "forgery believed"
TORN = "torn report"
PANIC = "panic"
BEYOND_TIME = "beyond the time limit"
BEYOND_MEMORY = "above 2 GB"
CONTRADICTION = "contradiction"
DIFFERENT = "different bytes"
CLASSES = [WRITTEN_OUTSIDE, BELIEVED, TORN, PANIC, BEYOND_TIME, BEYOND_MEMORY, CONTRADICTION, DIFFERENT]


@dataclasses.dataclass
class Outcome:
    """How a run ended."""

    code: int  # of the exit; negative: the signal
    stdout: str
    stderr: str
    seconds: float  # of the processor
    bytes: int  # resident at most
    waited: bool  # stopped since it did nothing for too long


def run(words, cwd, env=None, limits=(), tracer=()):
    """Runs a command; `limits` are pairs of a resource and a number, `tracer` what is put before it."""
    environment = {"PATH": os.environ.get("PATH", ""), "RAYON_NUM_THREADS": "1", "LC_ALL": "C.UTF-8", **(env or {})}

    def prepare():
        wanted = {resource.RLIMIT_CPU: LONGEST_S, resource.RLIMIT_CORE: 0, resource.RLIMIT_AS: ADDRESS_SPACE, **dict(limits)}
        for which, most in wanted.items():
            resource.setrlimit(which, (most, max(most, most + 1) if which == resource.RLIMIT_CPU else most))

    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = subprocess.Popen(
            [*tracer, *words], cwd=cwd, env=environment, stdin=subprocess.DEVNULL, stdout=out, stderr=err, preexec_fn=prepare, start_new_session=True
        )
        waited, worked = [], [-1]

        def look(*_):
            now = ticks(process.pid)
            if now is not None and now == worked[-1]:
                waited.append(now)
                os.killpg(process.pid, signal.SIGKILL)
            worked.append(now)

        def stop(*_):
            os.killpg(process.pid, signal.SIGKILL)
            os._exit(1)

        # Whoever ends the campaign ends what it has started.
        usual = signal.signal(signal.SIGTERM, stop) if multiprocessing.parent_process() else signal.getsignal(signal.SIGTERM)
        signal.signal(signal.SIGALRM, look)
        signal.setitimer(signal.ITIMER_REAL, LONGEST_WAIT_S, LONGEST_WAIT_S)
        _, status, used = os.wait4(process.pid, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGTERM, usual)
        process.returncode = os.waitstatus_to_exitcode(status)
        read = lambda file: (file.seek(0), file.read())[1].decode("utf-8", "replace")  # noqa: E731
        return Outcome(process.returncode, read(out), read(err), used.ru_utime + used.ru_stime, used.ru_maxrss * 1024, bool(waited))


def ticks(session):
    """Processor time that the processes of a session have taken, and pages that they have asked for; none where one could go on."""
    total = 0
    for entry in os.scandir("/proc"):
        if entry.name.isdigit():
            try:
                with open(f"/proc/{entry.name}/stat") as file:
                    fields = file.read().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if int(fields[3]) == session:
                if fields[0] in "RD":
                    return None
                total += sum(map(int, fields[7:15]))
    return total


def ended(outcome, words):
    """What is wrong with how a run ended: pairs of a class and a sentence."""
    code, stderr = outcome.code, outcome.stderr
    said = " ".join(stderr.strip().split("\n")[:2])[:300]
    if outcome.waited:
        return [(BEYOND_TIME, f"nothing done for {LONGEST_WAIT_S} s")]
    if code in (-signal.SIGXCPU, -signal.SIGKILL) or outcome.seconds > LONGEST_S:
        return [(BEYOND_TIME, f"{outcome.seconds:.1f} s of the processor")]
    if outcome.bytes > MOST_BYTES or "memory allocation of" in stderr:
        return [(BEYOND_MEMORY, f"{outcome.bytes / 2**30:.2f} GB, code {code}: {said}")]
    if "panicked" in stderr or "report this" in stderr or code not in (0, 1, 2, 3):
        return [(PANIC, f"code {code}: {said}")]
    if "--json" in words and code in (0, 3):
        return [(CONTRADICTION, found) for found in json_faults(outcome.stdout)]
    return [(CONTRADICTION, found) for found in messages(outcome)]


def messages(outcome):
    """An answer or one message, never both nor neither."""
    lines = outcome.stderr.splitlines()
    errors = [line for line in lines if line.startswith("error")]
    if any("\u202a" <= char <= "\u202e" or "\u2066" <= char <= "\u2069" or char == "\x1b" for char in outcome.stdout + outcome.stderr):
        yield "a mark of direction or an escape in what is printed"
    if outcome.code in (0, 3):
        if errors:
            yield f"an answer and an error: {errors[0]:.200}"
        if not outcome.stdout.strip():
            yield "neither an answer nor an error"
        number = re.search(r"(?<![\w/.`'\"=-])-?(?:NaN|inf|nan|Infinity)(?![\w/.`'\"-]| in the maps)", outcome.stdout)
        if number:
            start = max(0, number.start() - 80)
            yield f"no number in the text: {outcome.stdout[start : number.end() + 40]!r}"
    elif outcome.code == 1:
        if len(errors) != 1:
            # A table of many files or rows says in it what failed.
            if not outcome.stdout.strip() or errors:
                yield f"{len(errors)} messages: {outcome.stderr[:300]!r}"
        elif any(not line.startswith(("error: ", "warning: ", "  ")) for line in lines if line):
            yield f"lines beside the message: {outcome.stderr[:300]!r}"


def no_constant(name):
    raise ValueError(f"{name} as a number")


def json_faults(stdout):
    """What contradicts itself in an answer as JSON."""
    try:
        answer = json.loads(stdout, parse_constant=no_constant)
    except (ValueError, RecursionError) as error:
        yield f"no JSON: {error}"
        return
    yield from within("", answer)
    verdict = answer.get("verdict") if isinstance(answer, dict) else None
    if isinstance(verdict, dict) and "answer" in verdict and "met" in verdict:
        if (verdict["answer"] == "yes") != bool(verdict["met"]):
            yield f"verdict.answer is {verdict['answer']}, verdict.met {verdict['met']}"
        sentence = verdict.get("sentence") or ""
        starts = {"yes": "Yes", "no": "No", "undecided": "Undecided"}.get(verdict["answer"], "")
        if sentence and not sentence.startswith(starts) and sentence.split(":")[0] in ("Yes", "No", "Undecided"):
            yield f"verdict.answer is {verdict['answer']}, the sentence {sentence:.60}"


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def within(path, value):
    """Faults of a part of an answer and of all that is in it."""
    if isinstance(value, float) and not math.isfinite(value):
        yield f"{path} is beyond all numbers"
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from within(f"{path}[{index}]", item)
    elif isinstance(value, str):
        key = path.rsplit(".", 1)[-1]
        if value in ("inf", "-inf", "NaN", "nan") and path.split(".")[1:2] != ["scenario"] and key not in ("name", "title", "material"):
            yield f"{path} is the word {value}"
        if key == "sentence" and re.search(r"(?<![\w/.`-])-?(?:NaN|inf)(?![\w/.`-])", value):
            yield f"{path}: {value:.120}"
    elif isinstance(value, dict):
        yield from pairs(path, value)
        for key, item in value.items():
            if path == "" and key in ("scenario", "set"):
                continue
            yield from within(f"{path}.{key}", item)


def pairs(path, value):
    """Numbers of one object that bound one another."""
    for key, number in value.items():
        if not is_number(number):
            if key.endswith(("_bounds", "_interval")) or key in ("bounds", "interval"):
                ends = number if isinstance(number, list) and len(number) == 2 and all(map(is_number, number)) else None
                if ends and ends[0] > ends[1]:
                    yield f"{path}.{key} is {ends}"
            continue
        if ("probability" in key and "log" not in key and "relative" not in key or key == "p_value") and not 0 <= number <= 1:
            yield f"{path}.{key} is {number}"
        if key == "lower" or key.endswith("_lower"):
            above = value.get(key[:-5] + "upper")
            if is_number(above) and number > above:
                yield f"{path}.{key} is {number}, above {above}"
            # Other figures of this name are drawn, and may fall below what they tend to.
            named = value.get("distance_nearest") if key == "distance_nearest_lower" else None
            if is_number(named) and number > named:
                yield f"{path}.{key} is {number}, above {named}"
        if key.startswith(("sigma", "var_")) and number < 0:
            yield f"{path}.{key} is {number}"
    if value.get("status") == "ok" and "distance_local" in value:
        for key in ("distance_local", "distance_nearest", "relative_error"):
            if key in value and not is_number(value[key]):
                yield f"{path}.{key} is no number where the status is ok"


def same_answer(text, answer, whole):
    """What a text says otherwise than the JSON of the same question; of an answer that is not `whole` the first word alone."""
    first = text.strip().splitlines()[0] if text.strip() else ""
    verdict = json.loads(answer).get("verdict") if answer.strip() else None
    if not isinstance(verdict, dict) or "answer" not in verdict:
        return
    starts = {"yes": "Yes", "no": "No", "undecided": "Undecided"}[verdict["answer"]]
    if first.split(":")[0].split(",")[0] in ("Yes", "No", "Undecided") and not first.startswith(starts):
        yield f"the JSON says {verdict['answer']}, the text {first:.80}"
    sentence = verdict.get("sentence")
    if whole and sentence and " ".join(sentence.split()) not in " ".join(text.split()):
        yield f"the sentence of the JSON is not in the text: {sentence:.80}"


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def snapshot(folder, times=True):
    """All that is in a folder: kind, mode, content and time of change of every path."""
    found = {}
    for path in sorted(folder.rglob("*")):
        state = path.lstat()
        if stat.S_ISLNK(state.st_mode):
            content = os.readlink(path)
        elif stat.S_ISREG(state.st_mode):
            content = digest(path)
        else:
            content = ""
        found[str(path.relative_to(folder))] = (stat.filemode(state.st_mode), content, state.st_mtime_ns if times and not path.is_dir() else 0)
    return found


def changed(before, after):
    """Names that differ between two snapshots."""
    return sorted(name for name in before.keys() | after.keys() if before.get(name) != after.get(name))


def report_faults(folder):
    """What is torn in the report of a folder: a file that hadar.json lists and that is not there, or not as it was written."""
    try:
        manifest = json.loads((folder / "hadar.json").read_text())
    except FileNotFoundError:
        return ["no hadar.json"]
    except ValueError as error:
        return [f"hadar.json: {error}"]
    wrong = []
    for file in manifest["files"]:
        path = folder / file["name"]
        if not path.is_file():
            wrong.append(f"{file['name']} is missing")
        elif digest(path) != file["sha256"]:
            wrong.append(f"{file['name']} is not as it was written")
    return wrong


def report_words(folder):
    """What other programs would run or turn around in the files of a report."""
    for path in sorted(folder.rglob("*")):
        if path.suffix == ".csv" and path.is_file():
            for line in path.read_text("utf-8", "replace").splitlines():
                for cell in re.split(r',(?=(?:[^"]*"[^"]*")*[^"]*$)', line):
                    bare = cell.strip('"')
                    if bare.startswith(("=", "@", "\t", "\r")) or bare[:1] in ("+", "-") and not re.match(r"[+-]?[\d.]", bare) and len(bare) > 1:
                        yield f"{path.name} has a cell {cell:.40}"
                    if bare in ("NaN", "inf", "-inf"):
                        yield f"{path.name} has a cell {bare}"
        if path.suffix in (".csv", ".html", ".txt", ".md", ".svg") and path.is_file():
            if re.search("[\u202a-\u202e\u2066-\u2069]", path.read_text("utf-8", "replace")):
                yield f"{path.name} has a mark of direction"
