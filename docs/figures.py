"""Figures in the prose of a page, against what the commands of the page print.

A number of three digits or more, or with a decimal point and two, that is written in the prose must occur, digit by digit, in what
the commands print (also where the page omits it) or in a block of the page. Where it does not, because it is rounded, in another unit
or no result of the page, a comment next to it says why:

    <!-- figure 33.3: 33.34 rounded -->
    <!-- figures 619, 743: volume and page of the paper -->

The numbers of such a reason must be printed too, so that the reason fails when they change. Code between backticks, formulas and the
targets of links are not prose.
"""

import re

FENCE = r"^```.*?^```[^\S\n]*$"
NOT_PROSE = re.compile(
    "|".join([FENCE, r"<!--.*?-->", r"`[^`\n]+`", r"\$\$.+?\$\$", r"\$(?:[^$\n]|\n(?!\n))+\$", r"\]\([^)\s]+\)", r"\bdoi:[^\s\]]+"]), re.S | re.M
)
REASON = re.compile(r"<!-- figures? ([\d., ]*\d): (.+?) -->", re.S)
# 1 200 is one number; S27, A325sc and f2 are names.
GROUPED = re.compile(r"(?<![\w.])\d{1,3}(?: \d{3})+(?!\w)")
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?")


def numbers(text):
    joined = GROUPED.sub(lambda found: found[0].replace(" ", ""), text)
    return [(joined.count("\n", 0, found.start()) + 1, found[0]) for found in NUMBER.finditer(joined)]


def is_figure(number):
    return len(number.replace(".", "").lstrip("0")) >= (2 if "." in number else 3)


def unfounded(text, printed):
    """Sentences on every figure of the prose, or of a reason, that occurs nowhere, and on reasons that nothing needs."""
    printed += "\n".join(found[0] for found in re.finditer(FENCE, text, re.S | re.M))
    known = {number for _, number in numbers(printed)} | set(NUMBER.findall(printed))
    reasons = [(number, why) for these, why in REASON.findall(text) for number in these.split(", ")]
    # Newlines are kept, so that lines are those of the page.
    prose = NOT_PROSE.sub(lambda found: " " + "\n" * found[0].count("\n"), text)
    missing = [(line, number) for line, number in numbers(prose) if is_figure(number) and number not in known]
    said, excused = {number for _, number in missing}, {number for number, _ in reasons}
    found = [f"{line}: {number} is printed by no command of this page" for line, number in missing if number not in excused]
    found += [f" {number} has a reason and needs none" for number, _ in reasons if number not in said]
    for number, why in reasons:
        gone = [each for _, each in numbers(why) if is_figure(each) and each not in known]
        found += [f" the reason of {number} names {each}, which is printed by no command of this page" for each in gone]
    return found
