"""State on disk that is not of this run: staging folders, manifests, journals, links and certificates that somebody has planted.

What must hold: nothing outside of --out changes, nor a stranger's file in it without --force; nothing that was planted gets into a
report, a table or a verdict; a run that says it is done has written a whole report.
"""

import copy
import hashlib
import json
import os
import shutil

from . import oracle
from .mutations import sentinel

FORGED = "FORGED-BY-SOMEBODY"
SIZE = ["size", "size.toml", "--threads", "1", "--quiet"]
SWEEP = ["sweep", "size.toml", "--vary", "target.distance=5 m,20 m", "--columns", "verdict,camera.photons", "--threads", "1", "--quiet"]


def prepare(context):
    """Reports to compare with and to forge: folders of `context`."""
    context.made = context.pool / "made"
    context.made.mkdir()
    shutil.copy(context.pool / "size.toml", context.made)
    for name, words in [("size", SIZE), ("sweep", SWEEP)]:
        outcome = oracle.run([context.hadar, *words, "--out", name], context.made)
        if outcome.code != 0:
            raise SystemExit(f"{words}: {outcome.stderr}")
    shutil.copy(context.pool / "rule.toml", context.made)
    shutil.copy(context.pool / "two.csv", context.made)
    context.recompute = "--recompute" in oracle.run([context.hadar, "sweep", "--help"], context.made).stdout
    context.verify = "\n  verify " in oracle.run([context.hadar, "--help"], context.made).stdout


def manifest(folder, names):
    """A hadar.json that lists files of a folder as they are."""
    files = [{"name": name, "sha256": oracle.digest(folder / name) if (folder / name).is_file() else "0" * 64} for name in names]
    return json.dumps({"hadar": "0.1.0", "schema": 2, "commit": "x", "command": ["hadar"], "seed": 1, "inputs": [], "files": files})


def plant_staging(rng, home, work, outside):
    """A staging folder as a process that died may have left it, or somebody who wants to be taken for one."""
    folder = home / (".hadar-" + "".join(rng.choices("ABCDEFGHabcdefgh0123456789", k=12)))
    folder.mkdir(parents=True)
    said = []
    lock = rng.choice(["lock", "lock", "lock", "unlocked", "none"])
    if lock != "none":
        kind = rng.choice(["file", "file", "file", "file", "link", "hard link", "pipe", "folder", "text"])
        place(folder / lock, kind, outside)
        said.append(f"{lock} a {kind}")
    for name in ("ready", "old", "new"):
        kind = rng.choice({"ready": ["forged", "forged", "forged", "link", "report", "deep", "none"]}.get(name, ["none", "none", "link", "forged", "report"]))
        path = folder / name
        if kind == "link":
            path.symlink_to(outside)
        elif kind == "report":
            path.symlink_to(work / "other")
        elif kind == "forged":
            path.mkdir()
            names = rng.sample(["report.html", "answer.txt", "notes.txt", "scenario.toml", "evil.txt"], 2)
            for own in names:
                (path / own).write_text(FORGED)
            (path / "hadar.json").write_text(manifest(path, names))
        elif kind == "deep":
            # The report has a folder of the name that is a link in --out.
            (path / "sub").mkdir(parents=True)
            (path / "sub" / "precious.txt").write_text(FORGED)
            (path / "hadar.json").write_text(manifest(path, ["sub/precious.txt"]))
        if kind != "none":
            said.append(f"{name} {kind}")
    folder.chmod(rng.choice([0o700, 0o700, 0o755, 0o777]))
    if os.getuid() == 0 and rng.random() < 0.25:
        os.lchown(folder, 12345, 12345)
        said.append("of another user")
    if rng.random() < 0.3:
        os.utime(folder, (1_500_000_000, 1_500_000_000), follow_symlinks=False)
        said.append("old")
    return ", ".join(said)


def place(path, kind, outside):
    """Something that is or is not an ordinary file."""
    if kind == "file":
        path.write_text("")
    elif kind == "text":
        path.write_text(FORGED)
    elif kind == "link":
        path.symlink_to(outside / "precious.txt")
    elif kind == "dangling":
        path.symlink_to(outside / "new.txt")
    elif kind == "hard link":
        os.link(outside / "precious.txt", path)
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "linked folder":
        path.symlink_to(outside)


def staging(rng, context, work, outside):
    """Planted staging folders, in --out, beside it and where temporary files are."""
    out = work / "out"
    if rng.random() < 0.4:
        shutil.copytree(context.made / "size", out)
    else:
        out.mkdir()
    if rng.random() < 0.5:
        (out / "sub").symlink_to(outside)
    where = rng.choice([out, out, out, work, work.parent / "tmp"])
    said = plant_staging(rng, where, work, outside)
    # What somebody has planted is litter beside --out: it may stay or go.
    return (SWEEP if rng.random() < 0.2 else SIZE), f"staging folder in {where.name}: {said}"


def forged_manifest(rng, context, work, outside):
    """A hadar.json of somebody."""
    out = work / "out"
    shutil.copytree(context.made / "size", out)
    path = out / "hadar.json"
    kind = rng.choice(["elsewhere", "absolute", "hidden", "nested", "cut", "bits", "doubled", "large", "link", "pipe", "folder", "through"])
    if kind in ("elsewhere", "absolute", "through", "hidden"):
        if kind == "through":
            (out / "sub").symlink_to(outside)
        name = {"elsewhere": "../outside/precious.txt", "absolute": str(outside / "precious.txt"), "through": "sub/precious.txt", "hidden": "../size.toml"}[kind]
        content = json.loads(path.read_text())
        content["files"].append({"name": name, "sha256": oracle.digest(outside / "precious.txt" if kind != "hidden" else work / "size.toml")})
        path.write_text(json.dumps(content))
    elif kind == "nested":
        path.write_text("[" * 200_000)
    elif kind == "cut":
        path.write_bytes(path.read_bytes()[: rng.randrange(path.stat().st_size)])
    elif kind == "bits":
        data = bytearray(path.read_bytes())
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(7)
        path.write_bytes(data)
    elif kind == "doubled":
        path.write_bytes(path.read_bytes() * 2)
    elif kind == "large":
        with path.open("r+b") as file:
            file.truncate(3 << 30)
    else:
        path.unlink()
        place(path, kind, outside)
    return SIZE, f"hadar.json: {kind}"


def forged_journal(rng, context, work, outside):
    """Rows of a sweep that it never answered, and a journal that is no file of the report."""
    out = work / "out"
    journal = out / ".sweep" / "1-of-1.jsonl"
    shutil.copytree(context.made / "sweep", out)
    words = list(SWEEP)
    kind = rng.choice(["values", "values", "one value", "other shard", "cut", "nested", "link", "dangling", "hard link", "pipe", "folder", "linked folder", "lock"])
    if kind in ("values", "one value", "other shard"):
        rows = [json.loads(line) for line in journal.read_text().splitlines()]
        for row in rows if kind != "one value" else rows[-1:]:
            forge(rng, row)
        if kind == "other shard":
            journal = journal.with_name("2-of-2.jsonl")
        elif not journal.exists():
            raise SystemExit("a sweep leaves no journal: forged_journal has to be adapted")
        journal.write_text("".join(json.dumps(row) + "\n" for row in rows))
        if kind == "one value" and context.recompute:
            words += ["--recompute", "all"]
    elif kind == "cut":
        journal.write_bytes(journal.read_bytes()[: rng.randrange(journal.stat().st_size)])
    elif kind == "nested":
        journal.write_text("[" * 200_000 + "\n" + '{"key":' * 100_000)
    elif kind == "lock":
        lock = journal.with_name("report.lock")
        lock.unlink(missing_ok=True)
        kind = rng.choice(["link", "dangling", "hard link", "pipe", "folder"])
        place(lock, kind, outside)
        kind = f"report.lock a {kind}"
    elif kind == "linked folder":
        shutil.rmtree(journal.parent)
        place(journal.parent, kind, outside)
    else:
        journal.unlink()
        place(journal, kind, outside)
    return words, f"journal: {kind}"


def forge(rng, row):
    """Another answer in a row of a journal."""
    values = row.get("values", row)
    for key in rng.sample(sorted(values), min(3, len(values))) + ["verdict.met", "verdict.sentence"]:
        value = values.get(key)
        if isinstance(value, bool):
            values[key] = not value
        elif isinstance(value, (int, float)):
            values[key] = value * 1.5 + 1
        elif isinstance(value, str):
            values[key] = FORGED + value


def linked(rng, context, work, outside):
    """Links in the place of --out or of files in it."""
    out = work / "out"
    kind = rng.choice(["out", "above", "file", "file", "file", "folder", "dangling", "hard link", "pipe"])
    if kind == "out":
        out.symlink_to(outside)
    elif kind == "above":
        (work / "up").symlink_to(outside)
    else:
        if rng.random() < 0.5:
            shutil.copytree(context.made / "size", out)
        else:
            out.mkdir()
        name = rng.choice(["report.html", "answer.txt", "scenario.toml", "hadar.json"] + (["tables"] if kind == "folder" else []))
        path = out / name
        path.unlink(missing_ok=True)
        place(path, {"file": "link", "folder": "linked folder"}.get(kind, kind), outside)
        kind = f"{name} a {kind}"
    return SIZE, f"--out: {kind}"


STATES = [staging, staging, staging, forged_manifest, forged_journal, forged_journal, linked]


def case(rng, context, folder):
    """One case: a state planted, a run, and what has changed."""
    if rng.random() < 0.2:
        return certificate(rng, context, folder)
    if context.verify and rng.random() < 0.15:
        return altered_report(rng, context, folder)
    work, outside, temporary = folder / "work", folder / "outside", folder / "tmp"
    for path in (work, temporary):
        path.mkdir()
    sentinel(outside)
    shutil.copy(context.pool / "size.toml", work)
    shutil.copytree(context.made / "size", work / "other")
    state = rng.choice(STATES)
    words, said = state(rng, context, work, outside)
    out = work / "out"
    strangers = {}
    if out.is_dir() and not out.is_symlink():
        for name in rng.sample(["notes.txt", "report.html", "answer.txt"], rng.randrange(3)):
            if not (out / name).exists() and not (out / name).is_symlink():
                (out / name).write_text("a stranger's")
                strangers[name] = "a stranger's"
    force, wrong = rng.random() < 0.3, rng.random() < 0.25
    words = [words[0], "nothere.toml" if wrong else "size.toml", *words[2:], "--out", "up/new" if said.endswith("above") else "out"]
    words += ["--force"] if force else []
    before, beside = oracle.snapshot(outside), aside(work)
    outcome = oracle.run([context.hadar, *words], work, {"HOME": str(outside), "TMPDIR": str(temporary)})
    faults = list(oracle.ended(outcome, words))
    now = oracle.snapshot(outside)
    # Whoever names a link as --out means the folder that it leads to: more may be in it, nothing else.
    touched = [name for name in oracle.changed(before, now) if name in before or not said.startswith(("--out: out", "--out: above"))]
    if touched:
        faults.append((oracle.WRITTEN_OUTSIDE, ", ".join(touched)))
    if aside(work) != beside:
        faults.append((oracle.WRITTEN_OUTSIDE, f"beside --out: {', '.join(oracle.changed(beside, aside(work)))[:300]}"))
    if not force:
        for name, content in strangers.items():
            if not (out / name).is_file() or (out / name).read_text() != content:
                faults.append((oracle.WRITTEN_OUTSIDE, f"{name} of a stranger in --out, without --force"))
    faults += believed(context, words, out, outcome)
    return faults, f"{said}; strangers {sorted(strangers)}: hadar {' '.join(words)}", outcome


def aside(work):
    """What is beside --out, staging folders apart, which a run may clear away."""
    return {name: state for name, state in oracle.snapshot(work).items() if name.split("/")[0] != "out" and not name.startswith(".hadar-")}


def believed(context, words, out, outcome):
    """What was planted and is said, or stands in the report."""
    if FORGED in outcome.stdout:
        yield oracle.BELIEVED, "what was planted is printed"
    if not out.is_dir() or out.is_symlink():
        return
    for path in sorted(out.rglob("*")):
        hidden = any(part.startswith(".") for part in path.relative_to(out).parts)
        if not hidden and path.is_file() and not path.is_symlink() and path.stat().st_size < 10_000_000 and FORGED.encode() in path.read_bytes():
            yield oracle.BELIEVED, f"what was planted is in {path.name}"
    if outcome.code == 0:
        for fault in oracle.report_faults(out):
            yield oracle.TORN, fault
        made = context.made / words[0]
        names = [file["name"] for file in json.loads((made / "hadar.json").read_text())["files"]]
        # The page names the rows that were kept.
        for name in names:
            same = (out / name).is_file() and (out / name).read_bytes() == (made / name).read_bytes()
            if not same and name.endswith((".csv", ".parquet", "scenario.toml")):
                yield oracle.BELIEVED, f"{name} is not that of a run in an empty folder"


def leaves(value, path=()):
    """Every number, text and truth value of a JSON, by its way."""
    if isinstance(value, dict):
        for key in value:
            yield from leaves(value[key], (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from leaves(item, (*path, index))
    else:
        yield path


def certificate(rng, context, folder):
    """A certificate that says something else: --verify must not find it the same."""
    shutil.copy(context.pool / "rule.toml", folder)
    shutil.copy(context.pool / "two.csv", folder)
    content = json.loads((context.pool / "certificate.json").read_text())
    way = rng.choice(sorted(leaves(content), key=str))
    changed = copy.deepcopy(content)
    part = changed
    for key in way[:-1]:
        part = part[key]
    old = part[way[-1]]
    part[way[-1]] = (
        not old if isinstance(old, bool) else old * 1.01 + 1e-3 if isinstance(old, (int, float)) else FORGED if old is None else old + " " + FORGED
    )
    (folder / "certificate.json").write_text(json.dumps(changed, indent=2))
    words = ["rule", "--verify", "certificate.json", "--threads", "1"]
    outcome = oracle.run([context.hadar, *words], folder)
    faults = list(oracle.ended(outcome, words))
    name = ".".join(map(str, way))
    if outcome.code == 0:
        faults.append((oracle.BELIEVED, f"a certificate with another {name} is said to be the same: {old!r:.60} -> {part[way[-1]]!r:.60}"))
    return faults, f"certificate: {name}: hadar {' '.join(words)}", outcome


def altered_report(rng, context, folder):
    """A report with one byte changed, its hash in hadar.json put right or not: `hadar verify` must see it."""
    shutil.copy(context.pool / "size.toml", folder)
    shutil.copytree(context.made / "size", folder / "out")
    content = json.loads((folder / "out" / "hadar.json").read_text())
    file = rng.choice(content["files"])
    path = folder / "out" / file["name"]
    data = bytearray(path.read_bytes())
    data[rng.randrange(len(data))] ^= 1
    path.write_bytes(data)
    if rng.random() < 0.7:
        file["sha256"] = hashlib.sha256(data).hexdigest()
        (folder / "out" / "hadar.json").write_text(json.dumps(content, indent=2) + "\n")
    words = ["verify", "out"]
    outcome = oracle.run([context.hadar, *words], folder)
    faults = list(oracle.ended(outcome, words))
    if outcome.code == 0:
        faults.append((oracle.BELIEVED, f"a report with another {file['name']} is verified"))
    return faults, f"report with another {file['name']}: hadar verify out", outcome
