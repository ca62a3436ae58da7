// The page of `hadar serve`. The text of the scenario is the only state: the form shows it, and changes it by its keys.
"use strict";

const STEPS = 200;
const REST_MS = 250;
const PATIENCE_MS = 300;
const OWN_CAMERA =
  'exposure = "10 ms"\npixel = "12 um"\nf_number = 1.0\nfocal_length = "24 mm"\nnetd = "30 mK"\nnetd_temperature = "30 degC"\n' +
  'netd_f_number = 1.0\nnetd_pixel = "12 um"\nnoise_exposure = "10 ms"\n';

let text = "";
let begin = "";
let named = { materials: [], cameras: [] };
let tradeOff = null;
// What waits to be asked: changes of the form, a text that was typed, all of the answer.
let changes = [];
let typed = false;
let whole = true;
let busy = false;
let revision = 0;
let resting = 0;
let typing = 0;
let refocus = null;
let signature = "";
const ranges = new Map();

// Asking: one question at a time, the newest state next.

function change(...edits) {
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

async function ask() {
  if (busy) return;
  busy = true;
  while (changes.length > 0 || typed || whole) {
    const question = { scenario: text, edits: changes, trade_off: tradeOff, full: whole };
    const asked = revision;
    const waiting = setTimeout(pass, changes.length > 0 || typed ? PATIENCE_MS : 10000);
    changes = [];
    typed = whole = false;
    let trouble = null;
    try {
      const reply = await post("/ask", question);
      if (!reply.ok) trouble = `The program says: ${await reply.text()}`;
      else {
        const answered = await reply.json();
        // A text that was typed meanwhile is newer than this answer.
        if (asked === revision) show(answered, question);
      }
    } catch {
      trouble = "The program does not answer. Start `hadar serve` again, then change something here.";
    }
    clearTimeout(waiting);
    clearTimeout(resting);
    usable();
    if (trouble) {
      // Nothing is lost: it is asked again with the next change.
      if (asked === revision) changes = [...question.edits, ...changes];
      typed = true;
      failed(trouble);
      break;
    }
    if (!question.full) resting = setTimeout(() => { whole = true; ask(); }, REST_MS);
  }
  busy = false;
}

function failed(message, place = null) {
  at("answer").hidden = true;
  document.title = "hadar";
  at("sentence").textContent = "No answer: the scenario cannot be computed as it stands.";
  at("sentence").className = "";
  at("error").textContent = message;
  at("error").hidden = false;
  document.querySelectorAll("[aria-invalid]").forEach((old) => old.removeAttribute("aria-invalid"));
  if (!place) return;
  const field = place.key && document.querySelector(`[data-path="${CSS.escape(place.key)}"]`);
  if (field) field.setAttribute("aria-invalid", "true");
  if (place.line) at("scenario").setAttribute("aria-invalid", "true");
}

// Showing an answer.

function show({ scenario, form, answer, error }, { scenario: before, edits, full }) {
  // A change that is refused leaves the text: what was typed for it is taken back.
  if (edits.length > 0 && error && scenario === before) signature = "";
  text = scenario;
  if (at("scenario").value !== text) at("scenario").value = text;
  if (form) showForm(form);
  if (full || error) history.replaceState(null, "", link());
  if (error) return failed(error.message, error);
  document.querySelectorAll("[aria-invalid]").forEach((old) => old.removeAttribute("aria-invalid"));
  at("error").hidden = true;
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

// The form.

function showForm(form) {
  const shape = JSON.stringify([
    form.sections.map((section) => [
      section.path, section.absent.map((one) => one.path),
      section.fields.map((field) => [field.path, field.kind, field.choices, field.items.length, !!field.slider]),
    ]),
    form.absent.map((one) => one.path),
  ]);
  if (shape === signature) {
    const fields = form.sections.flatMap((section) => section.fields);
    fields.forEach(refresh);
    const picked = at("pick:camera");
    if (picked) chosen(picked, fields.find((field) => field.path === "camera.preset")?.value ?? "");
    return;
  }
  signature = shape;
  const focused = document.activeElement?.id;
  const sections = form.sections.map(sectionElement);
  at("form").replaceChildren(...sections, adder("Add to the scenario", form.absent));
  if (focused) at(focused)?.focus();
}

const idOf = (path, what) => `${what}:${path}`;

function sectionElement(section) {
  const name = section.path === "" ? "Title" : counted(section.path);
  const legend = element("legend", {}, section.word ? means(section.word, name, section.meaning) : name);
  const parts = [legend];
  if (section.meaning) parts.push(element("p", {}, section.meaning));
  if (section.path === "camera") parts.push(cameraPicker(section));
  parts.push(...section.fields.map(fieldElement));
  const more = section.absent.length > 0 ? adder(`Add to ${name}`, section.absent) : element("div", { className: "more" });
  if (section.removable) {
    const attributes = { id: idOf(section.path, "take") };
    more.append(button(`Remove ${name}`, () => restructure({ do: "remove", key: section.path }), attributes));
  }
  return element("fieldset", { "data-section": section.path }, ...parts, more);
}

function cameraPicker(section) {
  const id = idOf(section.path, "pick");
  const preset = section.fields.find((field) => field.name === "preset")?.value ?? "";
  const options = [element("option", { value: "" }, "figures of its own")];
  options.push(...named.cameras.map((camera) => element("option", { value: camera.name, title: camera.about }, camera.name)));
  const select = element("select", { id }, ...options);
  chosen(select, preset);
  const take = button("Take", () => {
    const toml = select.value === "" ? OWN_CAMERA : `preset = ${JSON.stringify(select.value)}\n`;
    restructure({ do: "table", key: section.path, toml });
  });
  const pick = element("div", { className: "pick" }, select, take);
  return element("div", { className: "field" }, element("label", { htmlFor: id }, "a known camera"), pick);
}

// Shows a value, which may be none of the known ones.
function chosen(select, value) {
  if (![...select.options].some((option) => option.value === value)) select.prepend(element("option", { value }, value));
  select.value = value;
}

function adder(label, absent) {
  const id = idOf(label, "add");
  const options = absent.map((one) => element("option", { value: one.path, title: one.meaning }, one.name));
  const select = element("select", { id }, element("option", { value: "" }, "…"), ...options);
  const add = button("Add", () => select.value && restructure({ do: "add", key: select.value }), { "aria-label": label });
  return element("div", { className: "more" }, element("label", { htmlFor: id }, label), select, add);
}

// A field as it is read out: many have the same name.
const spoken = (field) => [...field.path.split(".").slice(0, -1).map(counted), field.name].join(", ");
const counted = (part) => part.replace(/\[(\d+)\]/, (_, index) => ` ${Number(index) + 1}`);

function fieldElement(field) {
  const id = idOf(field.path, "field");
  const control = controlOf(field, id);
  const about = element("span", {}, means(field.word, "?", field.meaning));
  about.firstChild.className = "means";
  about.firstChild.setAttribute("aria-label", `what ${spoken(field)} means`);
  if (field.removable) {
    const attributes = { className: "small", "aria-label": `remove ${spoken(field)}` };
    about.append(" ", button("×", () => restructure({ do: "remove", key: field.path }), attributes));
  }
  const label = element("label", { htmlFor: id, title: field.meaning }, field.name);
  const parts = [label, control, about];
  if (field.kind === "materials") parts.push(chips(field));
  const range = rangeOf(field);
  if (range) parts.push(sliderElement(field, range));
  return element("div", { className: "field" }, ...parts);
}

function controlOf(field, id) {
  const set = (value) => change({ do: "set", key: field.path, value });
  const choose = (choices) => {
    const select = element("select", { id, "data-path": field.path, "aria-label": spoken(field) }, ...choices.map((one) => element("option", { value: one }, one)));
    chosen(select, field.value);
    select.addEventListener("change", () => set(select.value));
    return select;
  };
  const materials = named.materials.map((one) => one.name);
  if (field.kind === "choice") return choose(field.choices);
  if (field.kind === "flag") return choose(["true", "false"]);
  if (field.kind === "material") return choose(materials);
  if (field.kind === "materials") {
    const others = materials.filter((name) => !field.items.includes(name));
    const options = others.map((name) => element("option", { value: name }, name));
    const select = element("select", { id, "data-path": field.path, "aria-label": spoken(field) }, element("option", { value: "" }, "one more…"), ...options);
    const list = () => JSON.stringify([...field.items, select.value]);
    const add = () => select.value && restructure({ do: "set", key: field.path, value: list() });
    return element("div", { className: "pick" }, select, button("Add", add, { "aria-label": `add to ${spoken(field)}` }));
  }
  const input = element("input", { id, type: "text", value: field.value, "data-path": field.path, "aria-label": spoken(field), spellcheck: false });
  // What is typed counts as it stands, after a moment: no verdict of another value stays beside it.
  input.addEventListener("input", () => {
    pass();
    clearTimeout(typing);
    typing = setTimeout(() => set(input.value), REST_MS);
  });
  input.addEventListener("change", () => { clearTimeout(typing); set(input.value); });
  return input;
}

function chips(field) {
  const chip = (name, index) => {
    const rest = () => JSON.stringify(field.items.filter((_, other) => other !== index));
    const drop = () => restructure({ do: "set", key: field.path, value: rest() });
    return button(`${name} ×`, drop, { className: "small", "aria-label": `remove ${name}` });
  };
  return element("div", { className: "items" }, ...field.items.map(chip));
}

// A slider keeps its range while the number stays within it.
function rangeOf(field) {
  if (!field.slider) return null;
  const kept = ranges.get(field.path);
  const { number, unit } = field.slider;
  const held = document.activeElement === at(idOf(field.path, "slider"));
  if (kept && kept.unit === unit && (held || (number >= kept.low && number <= kept.high))) return { ...kept, number };
  ranges.set(field.path, field.slider);
  return field.slider;
}

const towards = {
  linear: [(x) => x, (x) => x],
  log: [Math.log, Math.exp],
  nines: [(x) => -Math.log10(1 - x), (x) => 1 - 10 ** -x],
};

function positionOf(range) {
  const [there] = towards[range.scale];
  const [low, high] = [there(range.low), there(range.high)];
  return Math.round((STEPS * (there(range.number) - low)) / (high - low));
}

function numberAt(range, position) {
  const [there, back] = towards[range.scale];
  const [low, high] = [there(range.low), there(range.high)];
  const number = back(low + ((high - low) * position) / STEPS);
  // Rounding leaves no end of the range.
  const rounded = (digits) => Math.min(Math.max(Number(digits), range.low), range.high);
  if (range.whole) return String(rounded(Math.round(number)));
  if (range.scale === "nines") {
    const places = Math.ceil(-Math.log10(1 - number)) + 1;
    return String(rounded(number.toFixed(places)));
  }
  if (range.scale === "linear") return String(rounded(number.toFixed(range.high - range.low > 2 ? 1 : 3)));
  return String(rounded(number.toPrecision(3)));
}

const written = (range, number) => (range.unit ? `${number} ${range.unit}` : number);

function sliderElement(field, range) {
  const id = idOf(field.path, "slider");
  const slider = element("input", {
    id, type: "range", min: 0, max: STEPS, step: 1, value: positionOf(range), "aria-label": `${spoken(field)}, slider`,
    "aria-valuetext": field.value,
  });
  slider.addEventListener("input", () => {
    const value = written(ranges.get(field.path), numberAt(ranges.get(field.path), slider.valueAsNumber));
    at(idOf(field.path, "field")).value = value;
    slider.setAttribute("aria-valuetext", value);
    change({ do: "set", key: field.path, value });
  });
  return slider;
}

// The same fields with other values; what is being used is left alone.
function refresh(field) {
  const control = at(idOf(field.path, "field"));
  if (!control) return;
  const slider = at(idOf(field.path, "slider"));
  const moving = document.activeElement === slider;
  if (field.kind === "materials") control.closest(".field").replaceWith(fieldElement(field));
  else if (document.activeElement !== control && !moving) {
    if (control.tagName === "SELECT") chosen(control, field.value);
    else control.value = field.value;
  }
  const range = rangeOf(field);
  if (slider && range && !moving) {
    slider.value = positionOf(range);
    slider.setAttribute("aria-valuetext", field.value);
  }
}

// Files and links.

const encoded = (string) => {
  const bytes = new TextEncoder().encode(string);
  let binary = "";
  bytes.forEach((byte) => { binary += String.fromCharCode(byte); });
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
};
const decoded = (string) => {
  const binary = atob(string.replaceAll("-", "+").replaceAll("_", "/"));
  return new TextDecoder("utf-8", { fatal: true }).decode(Uint8Array.from(binary, (char) => char.charCodeAt(0)));
};
// With the number of letters, by which one that was cut off is told.
const link = () => { const letters = encoded(text); return `#s=${letters.length}.${letters}`; };

// The scenario of the address; null where it has none, undefined where it is broken.
function restored() {
  if (location.hash.length < 2) return null;
  const found = /^#s=(\d+)\.([\w-]*)$/.exec(location.hash);
  try {
    return found && Number(found[1]) === found[2].length ? decoded(found[2]) : undefined;
  } catch {
    return undefined;
  }
}

function open(otherwise) {
  const scenario = restored();
  if (scenario === undefined) failed("This link is broken or cut off; ask for it again, or begin again below.");
  else take(scenario ?? otherwise);
}

async function fetched(path, name, kind) {
  at("done").textContent = "One moment.";
  const reply = await post(path, { scenario: text }).catch(() => null);
  const content = await reply?.text().catch(() => null);
  if (reply?.ok) save(name, kind, content);
  else at("done").textContent = `There is no ${name}: ${content ?? "the program does not answer"}`;
}

function take(scenario) {
  document.activeElement?.blur();
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
at("reset").addEventListener("click", () => take(begin));
at("link").addEventListener("click", async () => {
  history.replaceState(null, "", link());
  try {
    await navigator.clipboard.writeText(location.href);
    at("done").textContent = "The link is in your clipboard.";
  } catch {
    at("done").textContent = "The link is in the address line.";
  }
});
addEventListener("beforeprint", () => { at("printed").textContent = at("scenario").value; });
addEventListener("hashchange", () => open(text));

(async () => {
  try {
    const start = await (await fetch("/start")).json();
    begin = start.scenario;
    named = start;
    at("version").textContent = start.version;
  } catch {
    return failed("The program does not answer. Start `hadar serve` again, then load this page anew.");
  }
  open(begin);
})();
