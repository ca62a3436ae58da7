// The page for rules. What is shown is the answer to one text and one day; where either changes, it no longer looks like an answer.
"use strict";

let packs = [];
// What somebody wrote, which no choice of a pack takes away.
let own = null;
let askedDay = "";
// The question that is computed, and the one that is shown with its answer.
let asking = null;
let shown = null;
// Reforms of the shown rule: the question about them and its answer.
let reforming = null;
let reforms = null;
let clock = 0;
let typing = 0;
const REST_MS = 700;
const TOLD = { yes: "yes", no: "no" };

const rule = () => at("rule").value;

// What stands there is of another question from now on.
function pass(sentence) {
  asking?.abort();
  reforming?.abort();
  asking = reforming = null;
  ticking(false);
  at("sentence").textContent = sentence;
  at("sentence").className = "";
  at("answer").classList.add("passing");
  at("answer").inert = true;
  at("error").hidden = true;
  at("rule").removeAttribute("aria-invalid");
  document.title = "hadar";
}

function ticking(on) {
  clearInterval(clock);
  at("stop").hidden = !on;
  at("clock").textContent = "";
  if (!on) return;
  const begun = Date.now();
  clock = setInterval(() => { at("clock").textContent = `${Math.round((Date.now() - begun) / 1000)} s`; }, 1000);
}

// The answer to a question; none where it was given up, a sentence where there is none.
async function answered(path, body, controller) {
  try {
    const reply = await post(path, body, controller.signal);
    if (!reply.ok) return { error: { message: `The program says: ${await reply.text()}` } };
    return await reply.json();
  } catch {
    if (controller.signal.aborted) return null;
    return { error: { message: "The program does not answer. Start `hadar serve` again, then press Answer." } };
  }
}

async function ask() {
  clearTimeout(typing);
  pass("Computing every camera before every clause; a large rule takes a minute or more.");
  const controller = new AbortController();
  asking = controller;
  ticking(true);
  const question = { rule: rule(), on: at("day").value || null };
  const found = await answered("/rule", question, controller);
  // A newer question stands in its place.
  if (asking !== controller || !found) return;
  asking = null;
  ticking(false);
  if (found.error) failed(found.error);
  else show(question, found.answer);
}

function failed({ message, line }) {
  shown = reforms = null;
  at("answer").hidden = true;
  at("sentence").textContent = "There is no answer.";
  at("error").textContent = message;
  at("error").hidden = false;
  if (line) at("rule").setAttribute("aria-invalid", "true");
}

// Showing an answer.

function show(question, answer) {
  shown = { question, answer };
  reforms = null;
  const told = answer.shown;
  at("answer").hidden = at("answer").inert = false;
  at("answer").classList.remove("passing");
  at("sentence").textContent = told.sentence;
  // Only what is passed looks passed: a 'yes, if' and a warning look like neither.
  at("sentence").className = { PASSED: "yes", FAILED: "no" }[told.result] ?? "";
  document.title = `${told.result}: ${told.title}`;
  at("passed").textContent = told.passed;
  at("reasons").replaceChildren(...told.reasons.map((reason) => element("li", {}, reason)));
  at("market").textContent = told.market ?? "";
  showClauses(told);
  showReforms(answer.reforms);
  at("scenes").replaceChildren(...told.clauses.flatMap((clause, index) => scenesOf(clause, told.cameras, answer.clauses_rest_on[index])));
  at("pictures").replaceChildren(...answer.pictures.map(pictureOf));
  at("conditions").hidden = answer.conditions.length === 0;
  at("condition-rows").replaceChildren(...answer.conditions.flatMap(conditionsOf));
  at("warnings").hidden = answer.warnings.length === 0;
  at("warning-rows").replaceChildren(...answer.warnings.map(warningItem));
  at("tests").hidden = !told.tests;
  at("test-text").textContent = told.tests ?? "";
  at("what-it-is").textContent = told.what_it_is;
  at("about").replaceChildren(...told.about.flatMap(meaningOf));
  at("text").textContent = answer.text;
  at("done").textContent = "";
}

const meaningOf = ([word, meaning]) => [element("dt", {}, word), element("dd", {}, meaning)];
const headed = (names) => element("tr", {}, ...names.map((name) => element("th", { scope: "col" }, name)));
const rowOf = (name, cells, className = "") =>
  element("tr", { className }, element("th", { scope: "row" }, name), ...cells);

function showClauses(told) {
  const cells = (all) => all.map((one) => element(
    "td", {}, element("strong", { className: TOLD[one.verdict] ?? "" }, one.short), element("small", {}, `margin ${one.margin}`),
  ));
  at("clause-heads").replaceChildren(headed(["clause", ...told.cameras]));
  const rows = told.clauses.map((clause) => rowOf(clause.name, cells(clause.cells)));
  if (told.whole.length > 0) rows.push(rowOf("the whole rule", cells(told.whole), "whole"));
  at("clause-rows").replaceChildren(...rows);
}

// A clause camera by camera: what comes of it, where it is hardest, and what would help.
function scenesOf(clause, cameras, rests) {
  const said = [clause.text, clause.demanded, clause.stop && `Stop: ${clause.stop}.`, clause.sentence, ...clause.remarks];
  const folded = (name, ...content) => element("details", {}, element("summary", {}, name), ...content);
  const ofCamera = (one, index) => element(
    "div", { className: "scene" }, element("h4", {}, cameras[index]),
    element("p", {}, element("strong", { className: TOLD[one.verdict] ?? "" }, one.full), ` (margin ${one.margin}, ${one.evidence})`),
    element("p", {}, `Hardest scene: ${one.scene}.`),
    ...(rests[index].length > 0 ? [folded(`What this rests on (${rests[index].length})`, element("ul", {}, ...rests[index].map(warningItem)))] : []),
    ...(one.would_do ? [folded("What would do", element("p", {}, one.would_do))] : []),
  );
  return [
    element("h3", {}, `${clause.name} (${clause.kind})`),
    ...said.filter(Boolean).map((sentence) => element("p", { className: "faint" }, sentence)),
    ...clause.cells.map(ofCamera),
  ];
}

const conditionsOf = ({ camera, conditions }) =>
  [element("h3", {}, camera), element("ul", {}, ...conditions.map(warningItem))];

// Reforms as switches: each alone beside the rule as it is, whose answer stays.

function showReforms(offered) {
  at("reforms-say").textContent = offered.length === 0
    ? "This rule names no reforms; [[reform]] holds other values beside it."
    : "Each alone, beside the rule as it is: what is switched on is a row of the table above, with every camera before and after it.";
  at("switches").replaceChildren(...offered.map(switchOf));
  at("reform-rows").replaceChildren();
  at("reforms-error").hidden = at("save-reforms").hidden = true;
  at("reforms-done").textContent = "";
}

function switchOf(offered, index) {
  const id = `reform:${index}`;
  const box = element("input", { type: "checkbox", id, "aria-describedby": `${id}:says` });
  box.addEventListener("change", () => turn(box));
  const from = offered.from ? `from ${offered.from}` : null;
  const about = [from, offered.status].filter(Boolean).join(", ");
  const says = element("p", { id: `${id}:says`, className: "faint" }, about);
  const found = element("p", { id: `${id}:found`, role: "status" });
  return element("div", { className: "switch" }, element("label", { htmlFor: id }, box, offered.name), says, found);
}

async function turn(box) {
  at("reforms-error").hidden = true;
  if (!box.checked) at("reforms-done").textContent = "The reform is switched off; the table is of the rule as it is.";
  else if (!reforms) at("reforms-done").textContent = "Computing every camera by every reform.";
  if (box.checked && !reforms && !reforming) {
    const controller = new AbortController();
    reforming = controller;
    const found = await answered("/rule/reforms", { rule: shown.question.rule }, controller);
    if (reforming !== controller || !found) return;
    reforming = null;
    if (found.error) return reformsFailed(found.error.message);
    reforms = found.answer;
  }
  if (reforms) showSwitched(box.checked);
}

function reformsFailed(message) {
  document.querySelectorAll("#switches input").forEach((box) => { box.checked = false; });
  at("reforms-done").textContent = "";
  at("reforms-error").textContent = `No reform is shown. ${message}`;
  at("reforms-error").hidden = false;
}

function showSwitched(switchedOn) {
  const rows = [];
  reforms.reforms.forEach((reform, index) => {
    const on = at(`reform:${index}`).checked;
    const found = at(`reform:${index}:found`);
    found.textContent = on ? `${reform.changes} ${reform.sets}` : "";
    if (on) rows.push(rowOf(`by ${reform.name}, alone`, reform.cells.map(changeOf), "reform"));
  });
  at("reform-rows").replaceChildren(...rows);
  at("save-reforms").hidden = rows.length === 0;
  if (switchedOn) at("reforms-done").textContent = reforms.beside;
}

const changeOf = (one) => element(
  "td", {}, element("strong", {}, one.changed ? "another verdict" : "same verdict"),
  element("small", {}, `before: ${one.before}`), element("small", {}, `after: ${one.after}`),
);

// Choosing and writing.

function choose(file) {
  const pack = packs.find((pack) => pack.file === file);
  at("rule").value = pack ? pack.text : own ?? "";
  at("pack-says").textContent = pack ? pack.status : "";
  history.replaceState(null, "", pack ? `#${pack.file}` : "#");
  ask();
}

function wrote() {
  writes();
  pass("The rule was changed: press Answer.");
}

function writes() {
  own = rule();
  if (!at("pack").querySelector("option[value='']")) {
    at("pack").prepend(element("option", { value: "" }, "your own text"));
  }
  at("pack").value = "";
  at("pack-says").textContent = "";
  history.replaceState(null, "", "#");
}

at("ask").addEventListener("submit", (event) => { event.preventDefault(); ask(); });
at("pack").addEventListener("change", () => choose(at("pack").value));
at("day").addEventListener("input", () => {
  if (at("day").value === askedDay) return;
  askedDay = at("day").value;
  pass("The day was changed.");
  clearTimeout(typing);
  typing = setTimeout(ask, REST_MS);
});
at("rule").addEventListener("input", wrote);
at("rule").addEventListener("keydown", (event) => {
  if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) { event.preventDefault(); ask(); }
});
at("stop").addEventListener("click", () => { pass("Stopped: press Answer to begin again."); at("answer-it").focus(); });
at("save-rule").addEventListener("click", () => save("rule.toml", "text/plain", rule()));
at("save-report").addEventListener("click", () => save("report.html", "text/html", shown.answer.report));
at("save-json").addEventListener("click", () => save("answer.json", "application/json", shown.answer.json));
at("save-reforms").addEventListener("click", () => save("reforms.json", "application/json", reforms.json));
at("print").addEventListener("click", () => print());
addEventListener("beforeprint", () => { at("printed").textContent = rule(); });

(async () => {
  let begin = null;
  try {
    const start = await (await fetch("/rules/start")).json();
    packs = start.packs;
    at("version").textContent = start.version;
    begin = start.begin;
    at("words").replaceChildren(...start.words.flatMap(meaningOf));
  } catch {
    return failed({ message: "The program does not answer. Start `hadar serve` again, then load this page anew." });
  }
  at("pack").replaceChildren(...packs.map((pack) => element("option", { value: pack.file }, pack.name)));
  const named = packs.find((pack) => `#${pack.file}` === location.hash);
  if (begin !== null && !named) {
    at("rule").value = begin;
    writes();
    return ask();
  }
  const wanted = named ?? packs[0];
  at("pack").value = wanted.file;
  choose(wanted.file);
})();
