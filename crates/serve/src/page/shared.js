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
  const drawing = document.importNode(parsed, true);
  const figure = element("figure", { className: "picture", tabIndex: 0, role: "group", "aria-label": title }, drawing);
  readable(figure, figure, drawing);
  return figure;
}

function save(name, kind, content) {
  const url = URL.createObjectURL(new Blob([content], { type: kind }));
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
  at("done").textContent = `${name} is in your downloads.`;
}

// What a word means, beside it: the page of the word in a box that Esc closes. Where there are no such boxes the page itself opens.
async function explained(link) {
  const box = at("help") ?? element("div", { id: "help", popover: "auto", role: "dialog", tabIndex: -1, "aria-label": "What the word means" });
  const reply = await fetch(link.href).catch(() => null);
  const found = reply?.ok && new DOMParser().parseFromString(await reply.text(), "text/html").querySelector("main");
  if (!found) return;
  found.querySelector("p:last-child")?.remove();
  const word = element("p", {}, element("strong", {}, found.querySelector("h1")?.textContent ?? ""));
  found.querySelector("h1")?.remove();
  found.querySelectorAll("h2").forEach((head) => head.replaceWith(element("p", {}, element("strong", {}, head.textContent))));
  const close = button("Close", () => box.hidePopover(), { className: "small close" });
  box.replaceChildren(close, word, ...found.childNodes);
  if (!box.isConnected) document.body.append(box);
  const place = link.getBoundingClientRect();
  box.showPopover();
  box.style.left = `${Math.max(8, Math.min(place.left, innerWidth - box.offsetWidth - 8))}px`;
  box.style.top = `${Math.max(8, Math.min(place.bottom + 6, innerHeight - box.offsetHeight - 8))}px`;
  box.scrollTop = 0;
  close.focus();
  // Opening is told in the same way, a moment later.
  box.ontoggle = (event) => { if (event.newState === "closed" && link.isConnected) link.focus(); };
}

document.addEventListener("click", (event) => {
  const link = event.target.closest?.("a[href^='/explain/']");
  const isPlain = !(event.ctrlKey || event.metaKey || event.shiftKey);
  if (!link || !isPlain || !HTMLElement.prototype.showPopover) return;
  event.preventDefault();
  explained(link);
});
