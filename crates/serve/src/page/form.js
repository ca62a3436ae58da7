// The form: five questions first, all other keys of the scenario below them.
"use strict";

const OWN_CAMERA =
  'exposure = "10 ms"\npixel = "12 um"\nf_number = 1.0\nfocal_length = "24 mm"\nnetd = "30 mK"\nnetd_temperature = "30 degC"\n' +
  'netd_f_number = 1.0\nnetd_pixel = "12 um"\nnoise_exposure = "10 ms"\n';
let signature = "";
const ranges = new Map();

// What is asked first. Of several keys that answer a question the one that is written is shown.
const QUESTIONS = [
  { asks: "What is the target?", keys: ["target.material"], kind: "material" },
  { asks: "What must it be distinguished from?", keys: ["alternatives.materials"], kind: "materials", none: "every other material of the library" },
  { asks: "How far away is it?", keys: ["target.distance"], kind: "quantity", none: "not stated: no air, no pixels counted" },
  { asks: "Which camera?", keys: ["camera.preset"], kind: "camera" },
  {
    asks: "How sure must the answer be?", keys: ["requirement.detection_probability", "requirement.distance"], kind: "number",
    notes: ["probability of a correct decision, from 0.5 to 1", "statistical distance d: 1 is 84.13 % correct decisions, 2.326 is 99 %"],
  },
];

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
  const asked = QUESTIONS.map((question) => questioned(question, form));
  const first = new Set(asked.map((one) => one.path));
  at("question").replaceChildren(...asked.map((one) => one.made));
  const sections = form.sections.map((section) => sectionElement(section, first));
  at("sections").replaceChildren(...sections, adder("Add to the scenario", form.absent));
  const others = form.sections.flatMap((section) => section.fields).filter((field) => !first.has(field.path)).length;
  at("more-count").textContent = `${others} more`;
  if (focused) at(focused)?.focus();
}

// The field of a question, and the key that it shows. Of a key that is not written the field says what holds without it.
function questioned({ asks, keys, kind, none, notes }, form) {
  const written = form.sections.flatMap((section) => section.fields);
  const path = keys.find((key) => written.some((field) => field.path === key)) ?? keys[0];
  const name = path.split(".")[0];
  const section = form.sections.find((one) => one.path === name);
  const known = written.find((field) => field.path === path);
  const absent = section?.absent.find((one) => one.path === path) ?? form.absent.find((one) => one.path === name);
  const field = known ?? { path, word: path, name: asks, meaning: absent?.meaning ?? "", kind, value: "", items: [], choices: [], slider: null, removable: false };
  const made = kind === "camera" ? cameraPicker(section, asks) : fieldElement({ ...field, inNew: !section }, asks);
  const note = known ? notes?.[keys.indexOf(path)] : none ?? notes?.[0];
  if (note) made.append(element("small", { className: "note" }, note));
  made.classList.add("asked");
  return { path, made };
}

// What puts a value at a key whose table may not be there.
function setting(field, value) {
  if (!field.inNew) return { do: "set", key: field.path, value };
  const [table, key] = field.path.split(".");
  const toml = field.kind === "number" || field.kind === "materials" ? value : JSON.stringify(value);
  return { do: "table", key: table, toml: `${key} = ${toml}\n` };
}

const idOf = (path, what) => `${what}:${path}`;

function sectionElement(section, first) {
  const name = section.path === "" ? "Title" : counted(section.path);
  const legend = element("legend", {}, section.word ? means(section.word, name, section.meaning) : name);
  const parts = [legend];
  if (section.meaning) parts.push(element("p", {}, section.meaning));
  parts.push(...section.fields.filter((field) => !first.has(field.path)).map((field) => fieldElement(field)));
  const more = section.absent.length > 0 ? adder(`Add to ${name}`, section.absent) : element("div", { className: "more" });
  if (section.removable) {
    const attributes = { id: idOf(section.path, "take") };
    more.append(button(`Remove ${name}`, () => restructure({ do: "remove", key: section.path }), attributes));
  }
  return element("fieldset", { "data-section": section.path }, ...parts, more);
}

function cameraPicker(section, asks) {
  const id = idOf("camera", "pick");
  const preset = section?.fields.find((field) => field.path === "camera.preset")?.value ?? "";
  const options = [element("option", { value: "" }, "one of my own figures")];
  options.push(...named.cameras.map((camera) => element("option", { value: camera.name, title: camera.about }, camera.name)));
  const select = element("select", { id, "data-path": "camera.preset" }, ...options);
  chosen(select, preset);
  select.addEventListener("change", () => {
    const toml = select.value === "" ? OWN_CAMERA : `preset = ${JSON.stringify(select.value)}\n`;
    restructure({ do: "table", key: "camera", toml });
  });
  const about = element("span", {}, means("camera", "?"));
  about.firstChild.className = "means";
  about.firstChild.setAttribute("aria-label", "what a camera is here");
  return element("div", { className: "field" }, element("label", { htmlFor: id }, asks), select, about);
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

function fieldElement(field, asks = null) {
  const id = idOf(field.path, "field");
  const control = controlOf(field, id, asks);
  const about = element("span", {}, means(field.word, "?", field.meaning));
  about.firstChild.className = "means";
  about.firstChild.setAttribute("aria-label", `what ${spoken(field)} means`);
  if (field.removable && !asks) {
    const attributes = { className: "small", "aria-label": `remove ${spoken(field)}` };
    about.append(" ", button("×", () => restructure({ do: "remove", key: field.path }), attributes));
  }
  const label = element("label", { htmlFor: id }, asks ?? field.name);
  const parts = [label, control, about];
  if (field.kind === "materials") parts.push(chips(field));
  const range = rangeOf(field);
  if (range) parts.push(sliderElement(field, range));
  return element("div", { className: "field" }, ...parts);
}

function controlOf(field, id, asks) {
  const label = asks ?? spoken(field);
  const set = (value) => (field.inNew ? restructure : change)(setting(field, value));
  const choose = (choices) => {
    const select = element("select", { id, "data-path": field.path, "aria-label": label }, ...choices.map((one) => element("option", { value: one }, one)));
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
    const select = element("select", { id, "data-path": field.path, "aria-label": label }, element("option", { value: "" }, field.items.length > 0 ? "one more…" : "choose…"), ...options);
    const list = () => JSON.stringify([...field.items, select.value]);
    const add = () => select.value && restructure(setting(field, list()));
    return element("div", { className: "pick" }, select, button("Add", add, { "aria-label": `add to ${spoken(field)}` }));
  }
  const input = element("input", { id, type: "text", value: field.value, "data-path": field.path, "aria-label": label, spellcheck: false });
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
    changeBy(holds, { do: "set", key: field.path, value });
  });
  for (const taken of ["pointerdown", "focus"]) slider.addEventListener(taken, () => { holds += 1; });
  return slider;
}

// The same fields with other values; what is being used is left alone.
function refresh(field) {
  const control = at(idOf(field.path, "field"));
  if (!control) return;
  const slider = at(idOf(field.path, "slider"));
  const moving = document.activeElement === slider;
  if (field.kind === "materials") {
    const items = control.closest(".field").querySelector(".items");
    if (items) items.replaceWith(chips(field));
  }
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

