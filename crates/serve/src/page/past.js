// Where the page has been: a state is a text with its answer. Each is an entry of the browser's history, so that Back is an undo, and its
// address is a link that restores it.
"use strict";

// States by their number in the history; those before a reload are in the browser's history alone.
const past = [];
let current = -1;
let keeping = Promise.resolve();
const COLUMNS = 5;
const CHANGES = 6;

// Links: the text, compressed, with the number of letters, by which one that was cut off is noticed.

const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());

async function linkTo(scenario) {
  const bytes = await through(new TextEncoder().encode(scenario), new CompressionStream("deflate-raw"));
  let binary = "";
  bytes.forEach((byte) => { binary += String.fromCharCode(byte); });
  const letters = btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  return `#z=${letters.length}.${letters}`;
}

// The text of the address; null where it has none, undefined where it is broken. Older links (`s`) are not compressed.
async function restored() {
  if (location.hash.length < 2) return null;
  const found = /^#([sz])=(\d+)\.([\w-]*)$/.exec(location.hash);
  try {
    if (!found || Number(found[2]) !== found[3].length) return undefined;
    const binary = atob(found[3].replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(binary, (char) => char.charCodeAt(0));
    const plain = found[1] === "z" ? await through(bytes, new DecompressionStream("deflate-raw")) : bytes;
    return new TextDecoder("utf-8", { fatal: true }).decode(plain);
  } catch {
    return undefined;
  }
}

async function open(otherwise) {
  const scenario = history.state?.text ?? await restored();
  if (history.state) {
    current = history.state.n;
    showPast();
  }
  if (scenario === undefined) failed("This link is broken or cut off; ask for it again, or begin again below.");
  else take(scenario ?? otherwise);
}

// Keeps a state once it has an answer or a mistake; one after another, since a link takes a moment. `by`: the hold of a slider that made it.
function keep(scenario, form, answer, by) {
  keeping = keeping.then(async () => {
    const address = await linkTo(scenario);
    // A newer text is on its way.
    if (scenario !== text) return;
    const here = history.state;
    // What was a mistake is replaced, not kept to be gone back to; so is where a slider paused that is still held.
    const isSame = here?.text === scenario;
    const replaces = here && (isSame || here.mistaken || (by > 0 && here.hold === by));
    if (current < 0 || !here) current = Math.max(current, 0);
    if (here && !replaces) current += 1;
    if (!isSame) past.length = current;
    past[current] = { scenario, form, answer };
    const state = { n: current, text: scenario, mistaken: !answer, hold: by };
    if (here && !replaces) history.pushState(state, "", address);
    else history.replaceState(state, "", address);
    showPast();
  });
}

function move(by) {
  if (at(by < 0 ? "undo" : "redo").getAttribute("aria-disabled") !== "true") history.go(by);
}

// The answers so far, side by side.

const valuesOf = (form) => new Map((form?.sections ?? []).flatMap((section) => section.fields.map((field) => [field.path, field.value])));

function changesOf(state, before) {
  if (!before) return ["The first question"];
  const [old, now] = [valuesOf(before.form), valuesOf(state.form)];
  const said = [];
  for (const [path, value] of now) {
    if (!old.has(path)) said.push(`${path}: ${value}, new`);
    else if (old.get(path) !== value) said.push(`${path}: ${old.get(path)} → ${value}`);
  }
  for (const path of old.keys()) if (!now.has(path)) said.push(`${path}: removed`);
  if (said.length === 0) return ["Nothing that is a field"];
  return said.length > CHANGES ? [...said.slice(0, CHANGES), `and ${said.length - CHANGES} more`] : said;
}

// A path may break behind its dots.
const broken = (said) => said.split(/(?<=[a-z\]]\.)/).flatMap((part) => [part, document.createElement("wbr")]);

function showPast() {
  at("undo").setAttribute("aria-disabled", String(current <= 0));
  at("redo").setAttribute("aria-disabled", String(current >= past.length - 1));
  const answered = past.map((state, n) => ({ state, n })).filter(({ state }) => state?.answer);
  const shown = answered.slice(-COLUMNS);
  at("answers").hidden = answered.length < 2;
  const before = (n) => answered[answered.findIndex((one) => one.n === n) - 1]?.state;
  const heads = shown.map(({ state, n }) => {
    const head = element("th", { scope: "col" }, `Answer ${n + 1}`);
    if (n === current) head.append(" ", element("strong", {}, "(shown)"));
    else head.append(" ", button("Show", () => take(state.scenario), { className: "small", "aria-label": `Show answer ${n + 1}` }));
    return head;
  });
  at("answer-heads").replaceChildren(element("tr", {}, element("td"), ...heads));
  const line = (label, cells) => element("tr", {}, element("th", { scope: "row" }, label), ...cells);
  const lists = shown.map(({ state, n }) => element("td", {}, ...changesOf(state, before(n)).map((one) => element("div", {}, ...broken(one)))));
  const rows = [line("What changed", lists), line("Verdict", shown.map(({ state }) => cell(state.answer.sentence)))];
  const labels = new Set(shown.flatMap(({ state }) => state.answer.numbers.map((one) => one.label)));
  for (const label of labels) {
    const values = shown.map(({ state }) => state.answer.numbers.find((one) => one.label === label)?.value);
    if (new Set(values).size > 1) rows.push(line(label, values.map((value) => cell(value, "number"))));
  }
  at("answer-rows").replaceChildren(...rows);
}

addEventListener("popstate", () => open(text));
at("undo").addEventListener("click", () => move(-1));
at("redo").addEventListener("click", () => move(1));
addEventListener("keydown", (event) => {
  // In a text the browser's own undo is what is meant.
  const isText = event.target.matches?.("textarea, input[type=text]");
  if (isText || !(event.ctrlKey || event.metaKey) || event.altKey) return;
  const key = event.key.toLowerCase();
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  move(key === "y" || event.shiftKey ? 1 : -1);
});
