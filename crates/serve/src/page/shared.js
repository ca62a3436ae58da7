// What the pages of `hadar serve` have in common: elements, questions, pictures, downloads.
"use strict";

const at = (id) => document.getElementById(id);
const LONGEST_MS = 150000;

const element = (name, attributes = {}, ...children) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key in made && key !== "list") made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
};

const post = (path, body, signal = AbortSignal.timeout(LONGEST_MS)) =>
  fetch(path, { method: "POST", signal, headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });

const cell = (value, className = "") => element("td", { className }, value ?? "-");
const means = (word, label, hint = "") =>
  element("a", { href: `/explain/${word}`, target: "_blank", rel: "noopener", title: hint }, label);

const warningItem = (warning) =>
  element("li", {}, means(warning.code, `[${warning.code}]`), ` ${warning.message} `, element("small", {}, `(${warning.remedy})`));

const button = (label, pressed, attributes = {}) => {
  const made = element("button", { type: "button", ...attributes }, label);
  made.addEventListener("click", pressed);
  return made;
};

// A drawing of the program as a figure that is read out by its title.
function pictureOf([name, svg]) {
  const parsed = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
  const title = parsed.querySelector("title")?.textContent ?? name;
  parsed.setAttribute("role", "img");
  parsed.setAttribute("aria-label", title);
  return element("figure", { className: "picture" }, document.importNode(parsed, true));
}

function save(name, kind, content) {
  const url = URL.createObjectURL(new Blob([content], { type: kind }));
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
  at("done").textContent = `${name} is in your downloads.`;
}
