// Values read off a picture: under the pointer, or by the arrow keys where the picture is focused; Enter or a double click enlarges it. What can be read stands
// as JSON in the <metadata> of the drawing (plot/readings.rs). Without this script the page lacks nothing else.
"use strict";

function readable(figure, target, svg) {
  const data = svg.querySelector("metadata");
  const panels = data ? JSON.parse(data.textContent) : [];
  if (panels.length === 0) return;
  const said = document.createElement("p");
  said.className = "reading";
  said.textContent = "Values: point at the picture, or focus it and use the arrow keys.";
  const larger = document.createElement("button");
  larger.type = "button";
  larger.className = "larger";
  larger.addEventListener("click", () => enlarge());
  function enlarge(on = !figure.classList.contains("large")) {
    figure.classList.toggle("large", on);
    larger.textContent = on ? "Close" : "Enlarge";
  }
  enlarge(false);
  figure.append(said, larger);
  const scale = svg.viewBox.baseVal.width / Number(svg.getAttribute("width"));
  const overlay = document.createElementNS("http://www.w3.org/2000/svg", "g");
  svg.append(overlay);
  const marked = (name, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    overlay.append(made);
  };
  const number = (value, digits = 3) => {
    if (value === null) return "none";
    const plain = Number(value.toPrecision(digits));
    const isPlain = plain === 0 || (Math.abs(plain) >= 1e-3 && Math.abs(plain) < 1e5);
    return isPlain ? String(plain) : plain.toExponential().replace("e+", "e");
  };
  const named = (title, value, digits) => {
    const [, name, unit] = title.match(/^(.*?)(?: \(([^()]*)\))?$/);
    return `${name} ${number(value, digits)}${unit ? ` ${unit}` : ""}`;
  };
  const share = ([, isLog, first, last], value) =>
    value === null || (isLog && value <= 0) ? null : ((isLog ? Math.log10(value) : value) - first) / (last - first);
  const nearest = (axis, values, at) => values.reduce((best, value, i) => {
    const off = Math.abs((share(axis, value) ?? Infinity) - at);
    return off < best.off ? { i, off } : best;
  }, { i: -1, off: Infinity });

  const valueAt = ([, isLog, first, last], part) => {
    const value = first + part * (last - first);
    return isLog ? 10 ** value : value;
  };
  // The point of a series that is nearest across, if it is near.
  function point(x, xs, ys, part) {
    const { i, off } = nearest(x, xs, part);
    return off < 0.03 ? { at: xs[i], value: ys[i] } : {};
  }
  // Where a drawn line is at a place: straight between its points, on the scales of the axes. Between points without a value there is none.
  function along(x, y, xs, ys, part) {
    let isWithin = false;
    for (let i = 1; i < xs.length; i += 1) {
      const [a, b] = [share(x, xs[i - 1]), share(x, xs[i])];
      if (a === null || b === null || part < Math.min(a, b) || part > Math.max(a, b)) continue;
      isWithin = true;
      const [low, high] = [share(y, ys[i - 1]), share(y, ys[i])];
      if (low === null || high === null || a === b) continue;
      return { at: valueAt(x, part), value: valueAt(y, low + (part - a) / (b - a) * (high - low)) };
    }
    return isWithin ? { at: valueAt(x, part), value: null } : {};
  }

  // The panel, and the place within it as shares of its width and height, from the left and from below.
  let panel = 0;
  let place = { x: 0.5, y: 0.5 };

  function read() {
    const { at: [left, top, right, bottom], x, y, curves, columns, rows, name, values, names, series } = panels[panel];
    const [px, py] = [(part) => scale * (left + part * (right - left)), (part) => scale * (bottom - part * (bottom - top))];
    overlay.replaceChildren();
    const line = (x1, y1, x2, y2) => marked("line", { x1, y1, x2, y2, stroke: "#1A1A1A", "stroke-width": scale, "stroke-dasharray": 4 * scale });
    const ring = (cx, cy) => marked("circle", { cx, cy, r: 4 * scale, stroke: "#1A1A1A", "stroke-width": 1.5 * scale, fill: "#FFFFFF" });
    if (curves) {
      const here = valueAt(x, place.x);
      const found = curves.map(([label, xs, ys, isLine]) => ({ label, ...(isLine ? along(x, y, xs, ys, place.x) : point(x, xs, ys, place.x)) }))
        .filter((one) => one.at !== undefined);
      line(px(place.x), py(0), px(place.x), py(1));
      const parts = found.map(({ label, at, value }) => {
        const high = share(y, value);
        if (high !== null && high >= 0 && high <= 1) ring(px(share(x, at)), py(high));
        // A point beside the line says where it is.
        const beside = at === here ? "" : ` at ${number(at, 4)}`;
        return `${label}${label && ": "}${number(value)}${beside}`;
      });
      said.textContent = `${named(x[0], here, 4)}. ${parts.length > 0 ? `${y[0]}: ${parts.join("; ")}` : "Nothing is drawn here."}`;
    } else if (columns) {
      const [column, row] = [nearest(x, columns, place.x).i, nearest(y, rows, place.y).i];
      ring(px(share(x, columns[column])), py(share(y, rows[row])));
      const value = values[row * columns.length + column];
      said.textContent = `${named(x[0], columns[column], 4)}, ${named(y[0], rows[row], 4)}. ${named(name, value)}`;
    } else {
      const row = Math.max(0, Math.min(names.length - 1, Math.floor((1 - place.y) * names.length)));
      const height = 1 - (row + 0.5) / names.length;
      line(px(0), py(height), px(1), py(height));
      said.textContent = `${names[row]}. ${x[0]}: ${series.map(([label, all]) => [label, number(all[row])].filter(Boolean).join(" ")).join("; ")}`;
    }
  }

  svg.addEventListener("pointermove", (event) => {
    const box = svg.getBoundingClientRect();
    const unit = Number(svg.getAttribute("width")) / box.width;
    const [x, y] = [(event.clientX - box.left) * unit, (event.clientY - box.top) * unit];
    const under = panels.findIndex(({ at: [left, top, right, bottom] }) => x >= left && x <= right && y >= top && y <= bottom);
    if (under < 0) return;
    const [left, top, right, bottom] = panels[under].at;
    panel = under;
    place = { x: (x - left) / (right - left), y: (bottom - y) / (bottom - top) };
    said.removeAttribute("role");
    read();
  });
  target.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const { curves, names } = panels[panel];
    const step = event.shiftKey ? 0.1 : 0.01;
    const up = names ? 1 / names.length : step;
    const moved = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, up], ArrowDown: [0, -up] }[event.key];
    if (event.key === "Enter") enlarge();
    else if (!moved) return;
    else if (curves && moved[1] !== 0) panel = (panel + (moved[1] < 0 ? 1 : panels.length - 1)) % panels.length;
    else place = { x: Math.min(1, Math.max(0, place.x + moved[0])), y: Math.min(1, Math.max(0, place.y + moved[1])) };
    event.preventDefault();
    if (!moved) return;
    // Where the picture is wider than its frame, the place is kept in view.
    const [left, , right] = panels[panel].at;
    const middle = (left + place.x * (right - left)) / Number(svg.getAttribute("width")) * target.scrollWidth;
    target.scrollLeft = middle - 0.5 * target.clientWidth;
    // Whoever uses the keys may not see the picture.
    said.setAttribute("role", "status");
    read();
  });
  svg.addEventListener("dblclick", () => enlarge());
  figure.addEventListener("keydown", (event) => { if (event.key === "Escape") enlarge(false); });
}
