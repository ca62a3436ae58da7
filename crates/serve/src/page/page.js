// The page of `hadar serve`. The text of the scenario is the only state: the form shows it, and changes it by its keys.
"use strict";

const STEPS = 200;
const REST_MS = 250;
const PATIENCE_MS = 300;
let text = "";
let begin = "";
let named = { materials: [], cameras: [], examples: [], longest_s: 60 };
let tradeOff = null;
// What waits to be asked: changes of the form, a text that was typed, all of the answer.
let changes = [];
let typed = false;
let whole = true;
let busy = false;
let controller = null;
let clock = 0;
let revision = 0;
let resting = 0;
let typing = 0;
let refocus = null;
// How often a slider was taken hold of, and which of these times made the last change; 0: none did.
let holds = 0;
let hold = 0;
// The field that is wrong, and the line.
let mistake = null;

// Asking: one question at a time, the newest state next.

const change = (...edits) => changeBy(0, ...edits);

// `taken`: the hold of a slider that makes the change; 0: none.
function changeBy(taken, ...edits) {
  hold = taken;
  for (const edit of edits) {
    const last = changes.at(-1);
    if (edit.do === "set" && last?.do === "set" && last.key === edit.key) changes.pop();
    changes.push(edit);
  }
  ask();
}

// A change after which the form has other fields: until it has, nothing else in it can be used.
function restructure(edit) {
  const focused = document.activeElement;
  refocus = { id: focused?.id, section: focused?.closest("[data-section]")?.dataset.section };
  at("form").inert = true;
  change(edit);
}

function usable() {
  at("form").inert = false;
  if (!refocus) return;
  const within = refocus.section === undefined ? null : `[data-section="${CSS.escape(refocus.section)}"]`;
  const target = (refocus.id && at(refocus.id)) || (within && document.querySelector(`${within} select, ${within} input`));
  (target || at("form").querySelector("input, select"))?.focus();
  refocus = null;
}

// What is shown is of an older state from now on: it does not look like an answer.
function pass() {
  at("sentence").textContent = "Computing what you changed.";
  at("sentence").className = "";
  at("answer").classList.add("passing");
  document.title = "hadar";
}

// A question that takes longer than a moment shows how long it has taken of the time that it is given, and can be stopped.
function working(on) {
  clearInterval(clock);
  if (!on) {
    at("working").hidden = true;
    return;
  }
  const begun = Date.now();
  clock = setInterval(() => {
    const seconds = (Date.now() - begun) / 1000;
    if (seconds < 1) return;
    at("working").hidden = false;
    at("progress").max = named.longest_s;
    at("progress").value = seconds;
    at("clock").textContent = `${Math.round(seconds)} s of at most ${named.longest_s} s`;
  }, 250);
}

function stopAsking() {
  controller?.abort();
}

async function ask() {
  if (busy) return;
  busy = true;
  while (changes.length > 0 || typed || whole) {
    const question = { scenario: text, edits: changes, trade_off: tradeOff, full: whole };
    const asked = revision;
    // Whoever takes hold of a slider meanwhile has not made this state.
    const by = hold;
    const waiting = setTimeout(pass, changes.length > 0 || typed ? PATIENCE_MS : 10000);
    changes = [];
    typed = whole = false;
    let trouble = null;
    controller = new AbortController();
    working(true);
    at("again").hidden = true;
    try {
      const reply = await post("/ask", question, AbortSignal.any([controller.signal, AbortSignal.timeout(LONGEST_MS)]));
      if (!reply.ok) trouble = `The program says: ${await reply.text()}`;
      else {
        const answered = await reply.json();
        // A text that was typed meanwhile is newer than this answer.
        if (asked === revision) show(answered, question, by);
      }
    } catch {
      trouble = controller.signal.aborted
        ? "Stopped. What you changed is asked with your next change, or by the button below."
        : "The program does not answer. Start `hadar serve` again, then change something here.";
    }
    const isStopped = controller.signal.aborted;
    working(false);
    clearTimeout(waiting);
    clearTimeout(resting);
    usable();
    if (trouble) {
      // Nothing is lost: it is asked again with the next change.
      if (asked === revision) changes = [...question.edits, ...changes];
      typed = whole = true;
      failed(trouble, null, isStopped ? "Stopped: there is no answer to what you changed." : undefined);
      at("again").hidden = false;
      if (isStopped) at("again").focus();
      break;
    }
    if (!question.full) resting = setTimeout(() => { whole = true; ask(); }, REST_MS);
  }
  busy = false;
}

function failed(message, place = null, sentence = "No answer: the scenario cannot be computed as it stands.") {
  at("answer").hidden = true;
  document.title = "hadar";
  at("sentence").textContent = sentence;
  at("sentence").className = "";
  unmark();
  at("error-text").textContent = message;
  at("error").hidden = false;
  const wrong = place && marked(message, place);
  at("to-error").hidden = !wrong;
  if (!wrong) return;
  at("to-error").textContent = wrong === at("scenario") ? `Show line ${place.line}` : "Show the field";
  // Whoever types is not interrupted.
  const active = document.activeElement;
  if (!active || active === document.body || !active.matches("input, select, textarea")) toError();
}

function unmark() {
  document.querySelectorAll("[aria-invalid]").forEach((old) => {
    old.removeAttribute("aria-invalid");
    if (old !== at("scenario")) old.removeAttribute("aria-describedby");
  });
  document.querySelectorAll(".fault").forEach((old) => old.remove());
  at("scenario").setAttribute("aria-describedby", "scenario-says");
  at("error").hidden = true;
  mistake = null;
}

// Marks what is wrong and says why beside it; returns it.
function marked(message, { key, line }) {
  const path = key && CSS.escape(key);
  const field = key && document.querySelector(`[data-path="${path}"], [data-section="${path}"] select`);
  if (line) {
    at("scenario").setAttribute("aria-invalid", "true");
    at("scenario").setAttribute("aria-describedby", "scenario-says error-text");
  }
  if (field) {
    const fault = element("p", { className: "fault", id: `fault:${key}` }, message);
    (field.closest(".field, .more") ?? field).append(fault);
    field.setAttribute("aria-invalid", "true");
    field.setAttribute("aria-describedby", fault.id);
  }
  mistake = field || line ? { field: field || at("scenario"), line } : null;
  return mistake?.field;
}

// To the field that is wrong, or to the line of the text.
function toError() {
  if (!mistake) return;
  const { field, line } = mistake;
  if (at("more").contains(field)) at("more").open = true;
  field.focus();
  if (field !== at("scenario")) return;
  const before = text.split("\n").slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
  field.setSelectionRange(before, before + (text.split("\n")[line - 1] ?? "").length);
}

// Showing an answer.

function show({ scenario, form, answer, error }, { scenario: before, edits, full }, by) {
  // A change that is refused leaves the text: what was typed for it is taken back.
  if (edits.length > 0 && error && scenario === before) signature = "";
  text = scenario;
  forgetFound();
  if (at("scenario").value !== text) at("scenario").value = text;
  if (form) showForm(form);
  if (full || error) keep(text, form, answer, by);
  if (error) return failed(error.message, error);
  unmark();
  at("answer").hidden = false;
  at("answer").classList.remove("passing");
  if (at("sentence").textContent !== answer.sentence) at("sentence").textContent = answer.sentence;
  // A 'yes' that hangs on something does not look like one.
  at("sentence").className = answer.met === null || (answer.met && answer.conditional) ? "" : answer.met ? "yes" : "no";
  const said = { true: answer.conditional ? "Yes, if: " : "Yes: ", false: "No: ", null: "" };
  document.title = `${said[answer.met]}hadar`;
  at("solved").hidden = answer.solved.length === 0;
  at("solved-heading").textContent = answer.met
    ? "How far each figure may go, with the rest as it is"
    : "What would meet it, each with the rest as it is";
  at("solved-rows").replaceChildren(...answer.solved.map((one) => row(one, solvedCells(one))));
  at("numbers").hidden = answer.numbers.length === 0;
  at("number-rows").replaceChildren(...answer.numbers.map((one) => row(one, [cell(one.value, "number")])));
  at("pair-rows").replaceChildren(...answer.pairs.map(pairRow));
  at("conditions").hidden = answer.conditions.length === 0;
  at("condition-rows").replaceChildren(...answer.conditions.map(warningItem));
  at("warnings").hidden = answer.warnings.length === 0;
  at("warning-rows").replaceChildren(...answer.warnings.map(warningItem));
  showPictures(answer);
  // Of a state that is passing there is no text: none of an older one stands beside its numbers.
  at("text").textContent = full ? answer.text : "";
}

const row = (one, cells) =>
  element("tr", {}, element("th", { scope: "row" }, one.label ? means(one.key, one.label) : ""), ...cells);

function solvedCells(one) {
  const value = cell(one.value + one.remark, "number");
  value.append(...one.caps.map((cap) => element("small", {}, cap)));
  return [value, cell(one.now)];
}

function pairRow(pair) {
  const verdict = pair.told ?? "-";
  const numbers = [pair.distance_nearest, pair.photons_required, pair.statistical_distance, pair.detection_probability];
  return element(
    "tr", {},
    element("th", { scope: "row" }, pair.alternative),
    ...numbers.map((value) => cell(value, "number")), cell(verdict),
  );
}

function showPictures(answer) {
  at("pictures").replaceChildren(...answer.pictures.map(pictureOf));
  at("pick").hidden = answer.trade_offs.length < 2;
  const known = [...at("trade-off").options].map((option) => option.value).join();
  if (known !== answer.trade_offs.join()) {
    const options = answer.trade_offs.map((name) => element("option", { value: name }, NAMES[name] ?? name));
    at("trade-off").replaceChildren(...options);
  }
  at("trade-off").value = answer.trade_off ?? "";
}

const NAMES = {
  exposure_s: "exposure over f-number", noise_counts: "noise over pixel", frames: "frames over distance",
  speed_m_s: "speed over exposure",
};

// Files, examples, links.

async function fetched(path, name, kind) {
  at("done").textContent = "One moment.";
  const reply = await post(path, { scenario: text }).catch(() => null);
  const content = await reply?.text().catch(() => null);
  if (reply?.ok) save(name, kind, content);
  else at("done").textContent = `There is no ${name}: ${content ?? "the program does not answer"}`;
}

function take(scenario) {
  hold = 0;
  const example = named.examples.findIndex((one) => one.text === scenario);
  at("example").value = example < 0 ? "" : example;
  clearTimeout(typing);
  pass();
  text = scenario;
  revision += 1;
  changes = [];
  typed = whole = true;
  ranges.clear();
  ask();
}

at("form").addEventListener("submit", (event) => event.preventDefault());
at("scenario").addEventListener("input", () => {
  text = at("scenario").value;
  hold = 0;
  revision += 1;
  changes = [];
  pass();
  clearTimeout(typing);
  typing = setTimeout(() => { typed = whole = true; ask(); }, REST_MS);
});
at("trade-off").addEventListener("change", () => { tradeOff = at("trade-off").value; typed = true; ask(); });
at("save-scenario").addEventListener("click", () => save("scenario.toml", "text/plain", text));
at("save-report").addEventListener("click", () => fetched("/report", "report.html", "text/html"));
at("save-json").addEventListener("click", () => fetched("/json", "hadar.json", "application/json"));
at("print").addEventListener("click", () => print());
at("stop").addEventListener("click", stopAsking);
at("again").addEventListener("click", () => ask());
at("to-error").addEventListener("click", toError);
at("skip").addEventListener("click", (event) => { event.preventDefault(); at("verdict").focus(); at("verdict").scrollIntoView(); });
at("example").addEventListener("change", () => {
  const example = named.examples[Number(at("example").value)];
  if (example) take(example.text);
});
at("reset").addEventListener("click", () => take(begin));
at("link").addEventListener("click", async () => {
  await keeping;
  try {
    await navigator.clipboard.writeText(location.href);
    at("done").textContent = "The link is in your clipboard.";
  } catch {
    at("done").textContent = "The link is in the address line.";
  }
});
addEventListener("beforeprint", () => { at("printed").textContent = at("scenario").value; });

(async () => {
  try {
    const start = await (await fetch("/start")).json();
    begin = start.scenario;
    named = start;
    at("version").textContent = start.version;
    const options = start.examples.map((one, index) => element("option", { value: index }, one.title));
    at("example").replaceChildren(element("option", { value: "" }, "choose an example…"), ...options);
  } catch {
    return failed("The program does not answer. Start `hadar serve` again, then load this page anew.");
  }
  open(begin);
})();
