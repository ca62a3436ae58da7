"""The page for rules of `hadar serve` in a browser: a pack, a day, a reform, a mistake."""

import json
import subprocess

SETTLED = "document.readyState === 'complete' && !asking && !reforming && packs.length > 0"
ANSWERED = f"{SETTLED} && shown && !document.getElementById('answer').inert"


def check(browser, url, hadar, folder):
    page = browser.page(f"{url}rules#fmvss_127_night.toml")
    page.until("document.readyState === 'complete' && typeof packs === 'object'")
    page.until(ANSWERED)
    page.picture(folder / "rules.png")

    # The page says what the command says of the same text, and looks passed only where it is.
    said = of_command(hadar, page, [])
    assert text_of(page, "sentence") == said.splitlines()[0]
    assert text_of(page, "text").strip() == said.strip()
    assert "FAILED" in text_of(page, "passed") and page.js("document.getElementById('sentence').className") == "no"
    cells = page.js("[...document.querySelectorAll('#clause-rows td strong')].map((one) => one.textContent)")
    assert len(cells) == 24 and all(cell.startswith(("yes", "no", "undecided")) for cell in cells), cells
    assert page.js("document.querySelectorAll('#pictures svg').length === shown.answer.pictures.length")

    # A reform is a row beside the rule, said in words; the rule's own rows stay.
    rows = "document.getElementById('clause-rows').textContent"
    before = page.js(rows)
    page.js("document.getElementById('reform:0').focus()")
    page.key(" ", "Space", 32)
    page.until(f"reforms && {SETTLED}")
    assert page.js("document.querySelectorAll('#reform-rows tr').length") == 1
    switched = text_of(page, "reform-rows")
    assert "before: " in switched and "after: " in switched and "same verdict" in switched, switched
    assert "no certificate" in text_of(page, "reforms-done") and page.js(rows) == before
    asked = of_command(hadar, page, ["--reforms", "--json"])
    assert same(page.js("reforms.json"), asked)
    page.picture(folder / "reform.png")
    page.picture(folder / "rules_whole.png", whole=True)
    page.js("document.getElementById('reform:0').click()")
    assert page.js("document.querySelectorAll('#reform-rows tr').length") == 0
    assert "switched off" in text_of(page, "reforms-done")

    # Another pack, and a day on which it does not hold.
    page.js("document.getElementById('pack').value = 'fever_screening.toml', document.getElementById('pack').dispatchEvent(new Event('change'))")
    assert page.js("document.getElementById('answer').inert"), "an older answer can be used"
    page.until(f"{ANSWERED} && shown.question.rule === rule()")
    assert same(page.js("shown.answer.json"), of_command(hadar, page, ["--json"]))
    page.js("document.getElementById('day').value = '1990-01-01', document.getElementById('day').dispatchEvent(new Event('input'))")
    page.until(f"{ANSWERED} && shown.question.on === '1990-01-01'")
    assert "WARNED" in text_of(page, "passed") and page.js("document.getElementById('sentence').className") == ""
    assert text_of(page, "sentence").startswith("Nothing is required")

    # What is written is no answer until it is asked; a mistake is told, and what a rule says is never run.
    area = "document.getElementById('rule')"
    page.js(f"{area}.value = {area}.value.replace('[rule]', '[rule'), {area}.dispatchEvent(new Event('input'))")
    assert page.js("document.getElementById('answer').classList.contains('passing')")
    page.js("document.getElementById('answer-it').click()")
    page.until(f"!document.getElementById('error').hidden && {SETTLED}")
    assert page.js("document.getElementById('answer').hidden") and "line" in text_of(page, "error")
    page.picture(folder / "rules_mistake.png")
    sly = "<img src=x onerror=alert(1)>"
    page.js(f"{area}.value = {area}.value.replace('[rule', '[rule]').replace(/^name = .*$/m, 'name = \"{sly}\"'), "
            f"{area}.dispatchEvent(new Event('input')), document.getElementById('answer-it').click()")
    page.until(f"{ANSWERED} && shown.question.rule === rule()")
    assert sly in page.js("document.title") and page.js("document.querySelectorAll('img').length") == 0
    # What was written is not lost by a look at a pack.
    mine = page.js("rule()")
    choose = "document.getElementById('pack').value = '{}', document.getElementById('pack').dispatchEvent(new Event('change'))"
    page.js(choose.format("delivery_robots_washington.toml"))
    page.until("asking && !document.getElementById('stop').hidden")
    page.js("document.getElementById('stop').click()")
    assert "Stopped" in text_of(page, "sentence") and page.js("document.getElementById('answer').inert")
    page.js(choose.format(""))
    page.until(f"{ANSWERED} && shown.question.rule === rule()")
    assert page.js("rule()") == mine

    names = page.names()
    assert len(names) > 12 and all(name.strip() for _, name in names), names
    phone = browser.page(f"{url}rules#fever_screening.toml", 400, 844)
    phone.until("document.readyState === 'complete' && typeof packs === 'object'")
    phone.until(ANSWERED)
    assert phone.js("document.documentElement.scrollWidth <= innerWidth"), "a telephone scrolls sideways"
    phone.picture(folder / "rules_phone.png")
    phone.picture(folder / "rules_phone_whole.png", whole=True)
    for one in [page, phone]:
        assert all(asked.startswith((url, "data:", "blob:", "about:")) for asked in one.requests()), one.requests()
        assert one.errors() == [], one.errors()


def text_of(page, name):
    return page.js(f"document.getElementById('{name}').textContent")


def of_command(hadar, page, flags):
    command = [hadar, "rule", "-", *flags]
    return subprocess.run(command, input=page.js("rule()"), capture_output=True, text=True, check=True).stdout


def same(one, other):
    """Whether two answers are the same but for the name of the file and the work."""
    one, other = json.loads(one), json.loads(other)
    for answer in [one, other]:
        answer.pop("stats")
        answer.pop("inputs", None)
    return one == other
