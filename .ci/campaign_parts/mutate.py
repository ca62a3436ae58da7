"""Changes of a file's bytes, of a TOML or CSV text by its lines, numbers and words, and of binary files by their lengths and samples."""

import re
import struct

NUMBERS = [
    "0", "-0.0", "-1", "1", "1e308", "-1e308", "5e-324", "nan", "inf", "-inf", "1e20", "1e11", "1e-300", "1e160", "0.9999999999999999",
    "18446744073709551615", "18446744073709551616", "9223372036854775807", "1000000007", "340282350000000000000000000000000000000", "1e-9",
]  # fmt: skip
UNITS = ["K", "degC", "mK", "m", "km", "nm", "um", "s", "ms", "min", "h", "cm^-1", "mph", "km/h", "m/s", "%", "deg", "Hz", ""]
WORDS = [
    "\u202eevil", "\u2066x", "=1+1", "@SUM(1)", "+1", "-1", "=cmd|' /C calc'!A0", "\u0000", "\u001b[31m", "", "a" * 300, "../a", "/dev/zero",
    "/dev/null", "/dev/stdin", "pipe", ".", "..", "skin", "nan", "inf", "\ufeff", "\ud7ff", "é", "a\nb", "<script>", "`x`", "|", "{{", "%s",
]  # fmt: skip
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d*)?(?:[eE][+-]?\d+)?")
QUOTED = re.compile(r'"([^"\n]*)"')
TEXT = (".toml", ".csv", ".json", ".hdr", ".txt", ".jdx", ".yml", ".jsonl", ".md")


def mutated(rng, name, content):
    """The content with one to three changes, and words that say which."""
    said = []
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        textual = name.endswith(TEXT) and rng.random() < 0.88
        content, what = text(rng, name, content) if textual else binary(rng, name, content)
        said.append(what)
    return content, ", ".join(said)


def text(rng, name, content):
    """A text with one change of what it says."""
    old = content.decode("utf-8", "surrogateescape")
    new, what = (TOML_CHANGES if name.endswith(".toml") else TABLE_CHANGES)[rng.randrange(0, 64) % 12](rng, old)
    return new.encode("utf-8", "surrogatepass" if "\ud7ff" in new else "surrogateescape"), what


def number(rng, old):
    """One of its numbers is another one."""
    places = [found for found in NUMBER.finditer(old) if not in_comment(old, found.start())]
    if not places:
        return old, "nothing"
    place, value = rng.choice(places), rng.choice(NUMBERS)
    return old[: place.start()] + value + old[place.end() :], f"{place.group()} -> {value}"


def scaled(rng, old):
    """One of its numbers is multiplied."""
    places = [found for found in NUMBER.finditer(old) if not in_comment(old, found.start())]
    if not places:
        return old, "nothing"
    place = rng.choice(places)
    value = repr(float(place.group()) * rng.choice([-1.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 2.0, 10.0, 1e3, 1e6, 1e12]))
    return old[: place.start()] + value + old[place.end() :], f"{place.group()} -> {value}"


def every(rng, old):
    """All numbers of one line are the same one."""
    lines = old.split("\n")
    chosen = [index for index, line in enumerate(lines) if NUMBER.search(line) and not line.startswith("#")]
    if not chosen:
        return old, "nothing"
    index, value = rng.choice(chosen), rng.choice(NUMBERS)
    lines[index] = NUMBER.sub(lambda _: value, lines[index])
    return "\n".join(lines), f"line {index + 1}: all numbers {value}"


def word(rng, old):
    """A text in quotes is another one."""
    places = [found for found in QUOTED.finditer(old) if not in_comment(old, found.start())]
    if not places:
        return old, "nothing"
    place, value = rng.choice(places), rng.choice(WORDS)
    value = value if rng.random() < 0.6 else place.group(1)[: rng.randrange(0, len(place.group(1)) + 1)] + value
    return old[: place.start()] + f'"{value}"' + old[place.end() :], f"{place.group()} -> {value!r:.40}"


def unit(rng, old):
    """A quantity has another unit."""
    places = [found for found in QUOTED.finditer(old) if re.match(r"-?[\d.e+-]+ ", found.group(1))]
    if not places:
        return old, "nothing"
    place, value = rng.choice(places), rng.choice(UNITS)
    changed = f'"{place.group(1).split(" ")[0]} {value}"'
    return old[: place.start()] + changed + old[place.end() :], f"{place.group()} -> {changed}"


def without(rng, old):
    """A line is gone."""
    lines = old.split("\n")
    index = rng.randrange(len(lines))
    return "\n".join(lines[:index] + lines[index + 1 :]), f"line {index + 1} deleted"


def twice(rng, old):
    """A line, or a whole part, is there again, perhaps many times."""
    lines = old.split("\n")
    index, length, count = rng.randrange(len(lines)), rng.choice([1, 1, 3, 6]), rng.choice([1, 1, 1, 8, 200])
    part = lines[index : index + length]
    return "\n".join(lines[:index] + part * count + lines[index:]), f"lines from {index + 1} {count} times more"


def swapped(rng, old):
    """Two lines have changed places."""
    lines = old.split("\n")
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return "\n".join(lines), f"lines {a + 1} and {b + 1} swapped"


def switched_on(rng, old):
    """A line that is a comment is no comment any more, or the other way round."""
    lines = old.split("\n")
    index = rng.randrange(len(lines))
    lines[index] = lines[index][2:] if lines[index].startswith("# ") else "# " + lines[index]
    return "\n".join(lines), f"line {index + 1}: comment or not"


def listed(rng, old):
    """A list has one item more, fewer, or two thousand."""
    places = list(re.finditer(r"\[([^\[\]\n]+)\]", old))
    if not places:
        return old, "nothing"
    place = rng.choice(places)
    items = place.group(1).split(",")
    items = rng.choice([items[:-1], items + items[-1:], items[::-1], items * 2000, ["[" * 500 + "]" * 500]])
    return old[: place.start(1)] + ",".join(items) + old[place.end(1) :], f"a list of {len(items)}"


def cell(rng, old):
    """A cell of a table is another one."""
    lines = old.split("\n")
    index = rng.randrange(len(lines))
    separator = "," if "," in lines[index] else " "
    cells = lines[index].split(separator)
    at, value = rng.randrange(len(cells)), rng.choice(NUMBERS + WORDS)
    cells[at] = value
    lines[index] = separator.join(cells)
    return "\n".join(lines), f"line {index + 1}, cell {at + 1}: {value!r:.40}"


def in_comment(old, place):
    return old[old.rfind("\n", 0, place) + 1 : place].lstrip().startswith("#")


TOML_CHANGES = [number, number, number, scaled, scaled, every, word, unit, without, twice, switched_on, listed]
TABLE_CHANGES = [number, number, number, scaled, every, word, cell, cell, without, twice, swapped, number]


def binary(rng, name, content):
    """Bytes with one change."""
    data = bytearray(content)
    if not data:
        return bytes(data), "empty"
    change = rng.randrange(8)
    if change == 0:
        for _ in range(rng.choice([1, 1, 4, 16])):
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
        return bytes(data), "bits flipped"
    if change == 1:
        return bytes(data[: rng.randrange(len(data))]), "cut off"
    if change == 2:
        # Headers are at the beginning.
        at = rng.randrange(min(len(data), 400) if rng.random() < 0.7 else len(data))
        value = rng.choice([0, 1, 0x7F, 0xFF, 0x80, ord("9"), ord("\n"), ord('"')])
        width = rng.choice([1, 2, 4, 8])
        data[at : at + width] = bytes([value]) * min(width, len(data) - at)
        return bytes(data), f"{width} bytes at {at} are {value}"
    if change == 3:
        digits = [found for found in re.finditer(rb"\d+", bytes(data[:400]))]
        if digits:
            place = rng.choice(digits)
            value = rng.choice([b"0", b"1", b"99999", b"4294967296", b"18446744073709551615", b"1000000", b"-1"])
            return bytes(data[: place.start()] + value + data[place.end() :]), f"{place.group().decode()} -> {value.decode()}"
    if change in (3, 4):
        # A length in a header, in either order of bytes.
        at = rng.randrange(min(len(data), 1200))
        value = rng.choice([2**31 - 1, 2**32 - 1, 2**30, 2**24, 2**16, 10**6, 10**9])
        packed = struct.pack(rng.choice("<>") + rng.choice("IQ"), value)
        data[at : at + len(packed)] = packed
        return bytes(data), f"length {value} at {at}"
    if change in (5, 6):
        # Samples; they are at the end.
        width, kind = rng.choice([(4, "f"), (8, "d")])
        value = rng.choice([0.0, -1.0, float("nan"), float("inf"), 1e20, 1e11, 3e38, 1e-38, 1e-45])
        packed = struct.pack("<" + kind, value)
        first = len(data) % width + width * rng.randrange(max(1, len(data) // width // 2), max(2, len(data) // width))
        count = rng.choice([1, 1, 7, len(data)])
        for at in range(first, min(len(data) - width + 1, first + count * width), width):
            data[at : at + width] = packed
        return bytes(data), f"samples from {first} are {value}"
    at, length = rng.randrange(len(data)), rng.choice([1, 4, 64])
    return bytes(data[:at] + data[at : at + length] * rng.choice([0, 2, 50]) + data[at + length :]), f"{length} bytes at {at} out or repeated"
