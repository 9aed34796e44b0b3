"use strict";
// Curves and heat maps of a report, drawn from the data that lie beside them: no library, no network.
// A drag zooms along x, a double click shows all again, a name in the legend shows or hides its line.

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 64, right: 14, top: 10, bottom: 46 };
const NEAR = 14; // px at which a lone point is pointed at
const MOST_NAMED = 12; // lines in a tooltip

function make(parent, name, attributes, text) {
  const made = parent.namespaceURI === SVG || name === "svg"
    ? document.createElementNS(SVG, name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return parent.appendChild(made);
}

function said(value) {
  if (value === null || !Number.isFinite(value)) return "-";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e5)) return value.toExponential(3).replace(/\.?0+e/, "e");
  return String(Number(value.toPrecision(4)));
}

function scale(low, high, log, from, to) {
  const of = log ? Math.log10 : (v) => v;
  const [a, b] = [of(low), of(high)];
  const place = (v) => from + (of(v) - a) / (b - a || 1) * (to - from);
  place.back = (px) => {
    const v = a + (px - from) / (to - from) * (b - a);
    return log ? 10 ** v : v;
  };
  place.ticks = (room) => log ? logTicks(a, b, room) : linearTicks(low, high, room);
  return place;
}

function linearTicks(low, high, room) {
  const rough = (high - low) / Math.max(2, room);
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * size).find((s) => s >= rough);
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++)
    found.push(Number((i * step).toPrecision(12)));
  return found;
}

function logTicks(a, b, room) {
  const inside = (v) => v >= a - 1e-9 && v <= b + 1e-9;
  for (const parts of [[1, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]]) {
    const found = [];
    for (let d = Math.floor(a); d <= Math.ceil(b); d++)
      for (const part of parts) if (inside(d + Math.log10(part))) found.push(part * 10 ** d);
    if (found.length <= room + 1) return found.length < 2 ? linearTicks(10 ** a, 10 ** b, room) : found;
  }
  const step = Math.ceil((b - a) / room), found = [];
  for (let d = Math.ceil(a); d <= b; d += step) found.push(10 ** d);
  return found;
}

function axes(svg, width, height, x, y, panel) {
  const bottom = height - MARGIN.bottom, right = width - MARGIN.right;
  const words = panel.ticks;
  const along = words ? words.map((_, i) => i) : x.ticks((right - MARGIN.left) / 80);
  for (const at of along) {
    const px = x(at);
    if (px < MARGIN.left - 1 || px > right + 1) continue;
    make(svg, "line", { x1: px, x2: px, y1: MARGIN.top, y2: bottom, class: "grid" });
    make(svg, "text", { x: px, y: bottom + 16, class: "tick", "text-anchor": "middle" },
      words ? words[at] : said(at));
  }
  for (const at of y.ticks((bottom - MARGIN.top) / 42)) {
    const py = y(at);
    make(svg, "line", { x1: MARGIN.left, x2: right, y1: py, y2: py, class: "grid" });
    make(svg, "text", { x: MARGIN.left - 8, y: py + 4, class: "tick", "text-anchor": "end" }, said(at));
  }
  make(svg, "path", { d: `M${MARGIN.left},${MARGIN.top}V${bottom}H${right}`, class: "frame" });
  make(svg, "text", { x: (MARGIN.left + right) / 2, y: height - 8, class: "name",
    "text-anchor": "middle" }, panel.x_label);
  make(svg, "text", { class: "name", "text-anchor": "middle",
    transform: `translate(14 ${(MARGIN.top + bottom) / 2}) rotate(-90)` }, panel.y_label);
}

function watch(figure, stale, draw) {
  new ResizeObserver(() => requestAnimationFrame(() => {
    if (figure.clientWidth && stale()) draw();
  })).observe(figure);
}

function sizeOf(figure) {
  const width = Math.max(280, figure.clientWidth);
  return [width, Math.round(Math.min(400, Math.max(240, 0.6 * width)))];
}

function curves(figure, panel) {
  const hidden = new Set();
  let zoom = null; // [low, high] of x while zoomed
  const legend = make(figure, "div", { class: "legend" });
  panel.lines.forEach((line, i) => {
    const button = make(legend, "button", { type: "button", "aria-pressed": "true" });
    make(make(button, "svg", { width: 18, height: 10, class: "series" }), line.width ? "line" : "circle",
      line.width ? { x1: 0, x2: 18, y1: 5, y2: 5, stroke: line.colour, "stroke-width": 3 }
        : { cx: 9, cy: 5, r: 4, fill: line.colour });
    make(button, "span", {}, line.label);
    button.addEventListener("click", () => {
      if (!hidden.delete(i)) hidden.add(i);
      button.setAttribute("aria-pressed", String(!hidden.has(i)));
      draw();
    });
  });
  if (panel.lines.some((line) => (line.marks || []).some(Boolean)))
    make(legend, "span", { class: "unstable" }, "◯ unstable");
  const all = make(legend, "button", { type: "button", class: "whole" }, "show all");
  const svg = make(figure, "svg", { role: "img", "aria-label": panel.title, class: "plot" });
  const tip = make(figure, "div", { class: "tip" });
  const whole = () => { zoom = null; draw(); };
  all.addEventListener("click", whole);
  let x, y, size;

  const shown = () => panel.lines.map((line, i) => ({ ...line, i })).filter((line) => !hidden.has(line.i));
  const can = (line, k) => line.y[k] !== null && (!panel.log_x || line.x[k] > 0)
    && (!panel.log_y || line.y[k] > 0);

  function domain() {
    let xs = [], ys = [];
    for (const line of shown()) line.x.forEach((v, k) => {
      if (!can(line, k)) return;
      xs.push(v);
      if (!zoom || (v >= zoom[0] && v <= zoom[1])) {
        ys.push(line.y[k]);
        const bar = line.bars && line.bars[k];
        if (bar) ys.push(line.y[k] + bar, ...(panel.log_y && line.y[k] <= bar ? [] : [line.y[k] - bar]));
      }
    });
    if (panel.bound !== null && (!panel.log_y || panel.bound > 0)) ys.push(panel.bound);
    if (panel.wall !== null && (!panel.log_x || panel.wall > 0)) xs.push(panel.wall);
    const ends = (values, log, pad) => {
      let [low, high] = values.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
      if (!(low <= high)) [low, high] = [log ? 0.1 : 0, 1];
      if (low === high) [low, high] = log ? [low / 2, high * 2] : [low - (Math.abs(low) || 1) / 2, high + (Math.abs(high) || 1) / 2];
      if (log) { const f = (high / low) ** pad; return [low / f, high * f]; }
      return [low - pad * (high - low), high + pad * (high - low)];
    };
    const along = zoom || ends(xs, panel.log_x, panel.ticks ? 0.08 : 0.02);
    let [low, high] = ends(ys, panel.log_y, 0.06);
    if (panel.log_y && panel.decades < 300) low = Math.max(low, high * 10 ** -panel.decades);
    return [along, [low, high]];
  }

  function draw() {
    size = sizeOf(figure);
    const [width, height] = size;
    const [[x0, x1], [y0, y1]] = domain();
    const bottom = height - MARGIN.bottom, right = width - MARGIN.right;
    x = scale(x0, x1, panel.log_x, MARGIN.left, right);
    y = scale(y0, y1, panel.log_y, bottom, MARGIN.top);
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    all.hidden = zoom === null;
    axes(svg, width, height, x, y, panel);
    const clip = make(make(svg, "clipPath", { id: `${figure.id}-clip` }), "rect",
      { x: MARGIN.left, y: MARGIN.top, width: right - MARGIN.left, height: bottom - MARGIN.top });
    clip.parentNode.removeAttribute("class");
    const ground = make(svg, "g", { "clip-path": `url(#${figure.id}-clip)`, class: "series" });
    if (panel.bound !== null)
      make(ground, "line", { x1: MARGIN.left, x2: right, y1: y(panel.bound), y2: y(panel.bound), class: "bound" });
    if (panel.wall !== null)
      make(ground, "line", { x1: x(panel.wall), x2: x(panel.wall), y1: MARGIN.top, y2: bottom, class: "bound" });
    for (const line of shown()) drawLine(ground, line);
    make(svg, "g", { class: "pointer" });
  }

  function drawLine(ground, line) {
    let path = "", on = false;
    line.x.forEach((v, k) => {
      if (!can(line, k)) { on = false; return; }
      path += `${on ? "L" : "M"}${x(v).toFixed(1)},${y(line.y[k]).toFixed(1)}`;
      on = true;
    });
    if (line.width)
      make(ground, "path", { d: path, stroke: line.colour, "stroke-width": line.width, class: "line" });
    line.x.forEach((v, k) => {
      if (!can(line, k)) return;
      const at = { cx: x(v), cy: y(line.y[k]) };
      const bar = line.bars && line.bars[k];
      if (bar) {
        const low = panel.log_y && line.y[k] <= bar ? y.back(size[1]) : line.y[k] - bar;
        make(ground, "path", { stroke: line.colour, class: "line", "stroke-width": 1,
          d: `M${at.cx},${y(low)}V${y(line.y[k] + bar)}` });
      }
      if (line.marks || !line.width) make(ground, "circle", { ...at, r: line.width ? 3 : 4, fill: line.colour });
      if (line.marks && line.marks[k]) make(ground, "circle", { ...at, r: 7, class: "mark" });
    });
  }

  const place = (event) => {
    const box = svg.getBoundingClientRect();
    const f = size[0] / box.width;
    return [(event.clientX - box.left) * f, (event.clientY - box.top) * f];
  };
  const pointer = () => svg.querySelector(".pointer");
  let from = null;

  function point(event) {
    const [px, py] = place(event);
    const group = pointer();
    group.replaceChildren();
    tip.replaceChildren();
    tip.hidden = true;
    if (from !== null) {
      make(group, "rect", { x: Math.min(from, px), width: Math.abs(px - from), y: MARGIN.top,
        height: size[1] - MARGIN.top - MARGIN.bottom, class: "drag" });
      return;
    }
    const near = [];
    for (const line of shown()) {
      let best = null;
      line.x.forEach((v, k) => {
        if (!can(line, k)) return;
        const dx = Math.abs(x(v) - px), dy = line.width ? 0 : Math.abs(y(line.y[k]) - py);
        if (best === null || dx + dy < best.off) best = { line, k, off: dx + dy };
      });
      if (best && best.off < (line.width ? 40 : NEAR)) near.push(best);
    }
    if (!near.length) return;
    const first = near.reduce((a, b) => (b.off < a.off ? b : a));
    const at = x(first.line.x[first.k]);
    make(group, "line", { x1: at, x2: at, y1: MARGIN.top, y2: size[1] - MARGIN.bottom, class: "cross" });
    const value = first.line.x[first.k];
    make(tip, "b", {}, `${panel.x_label} ${panel.ticks ? panel.ticks[value] : said(value)}`);
    for (const { line, k } of near.slice(0, MOST_NAMED)) {
      make(group, "circle", { cx: x(line.x[k]), cy: y(line.y[k]), r: 4, fill: line.colour });
      const bar = line.bars && line.bars[k] ? ` ± ${said(line.bars[k])}` : "";
      const mark = line.marks && line.marks[k] ? ", unstable" : "";
      make(tip, "span", {}, `${line.label}: ${said(line.y[k])}${bar}${mark}`);
    }
    tip.hidden = false;
    tip.classList.toggle("left", at > size[0] / 2);
  }

  svg.addEventListener("pointermove", point);
  svg.addEventListener("pointerleave", () => { pointer().replaceChildren(); tip.hidden = true; });
  svg.addEventListener("pointerdown", (event) => { if (!panel.ticks) from = place(event)[0]; });
  svg.addEventListener("pointerup", (event) => {
    const to = place(event)[0], begun = from;
    from = null;
    if (begun === null || Math.abs(to - begun) < 8) return;
    zoom = [x.back(Math.min(begun, to)), x.back(Math.max(begun, to))];
    draw();
  });
  svg.addEventListener("pointercancel", () => { from = null; });
  svg.addEventListener("dblclick", whole);
  tip.hidden = true;
  watch(figure, () => sizeOf(figure)[0] !== size[0], draw);
  draw();
}

// Viridis, darkest for the largest: nine of its colours, straight lines between.
const VIRIDIS = [[253, 231, 37], [170, 220, 50], [94, 201, 98], [40, 174, 128], [33, 144, 141],
  [44, 114, 142], [59, 82, 139], [71, 45, 123], [68, 1, 84]];

function colour(part) {
  const at = Math.min(1, Math.max(0, part)) * (VIRIDIS.length - 1);
  const i = Math.min(VIRIDIS.length - 2, Math.floor(at));
  return VIRIDIS[i].map((v, c) => Math.round(v + (at - i) * (VIRIDIS[i + 1][c] - v)));
}

function heat(figure, map) {
  const good = map.values.flatMap((row, j) => row.filter((v, i) => v !== null && !map.marked[j][i]));
  const of = map.log ? Math.log10 : (v) => v;
  const [low, high] = [Math.min(...good.map(of)), Math.max(...good.map(of))];
  const svg = make(figure, "svg", { role: "img", "aria-label": map.title, class: "plot" });
  const tip = make(figure, "div", { class: "tip" });
  tip.hidden = true;
  let drawn = 0;
  function draw() {
    const [width] = sizeOf(figure);
    drawn = width;
    const left = 16 + 8 * Math.min(14, Math.max(5, ...map.y.map((t) => t.length)));
    const cell = (width - left - MARGIN.right) / map.x.length;
    const tall = Math.min(56, Math.max(22, cell * 0.7));
    const height = MARGIN.top + tall * map.y.length + MARGIN.bottom;
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    map.values.forEach((row, j) => row.forEach((value, i) => {
      const top = height - MARGIN.bottom - (j + 1) * tall;
      const marked = map.marked[j][i];
      const box = { x: left + i * cell, y: top, width: cell, height: tall };
      const paint = marked || value === null ? null : colour((of(value) - low) / (high - low || 1));
      const group = make(svg, "g", { class: marked ? "cell marked" : "cell" });
      make(group, "rect", paint ? { ...box, fill: `rgb(${paint})` } : { ...box, class: "none" });
      const dark = paint && 0.3 * paint[0] + 0.6 * paint[1] + 0.1 * paint[2] < 128;
      if (cell >= 44) make(group, "text", { x: box.x + cell / 2, y: top + tall / 2 + 4, "text-anchor": "middle",
        class: marked ? "unstable" : dark ? "onDark" : "onLight" }, marked ? "unstable" : said(value));
      group.addEventListener("pointermove", () => {
        tip.replaceChildren();
        make(tip, "b", {}, `${map.x_label} ${map.x[i]}, ${map.y_label} ${map.y[j]}`);
        make(tip, "span", {}, `${said(value)}${marked ? ", unstable" : ""}`);
        tip.hidden = false;
        tip.classList.toggle("left", box.x > width / 2);
      });
    }));
    const every = Math.ceil(46 / cell);
    map.x.forEach((text, i) => {
      if (i % every === 0) make(svg, "text", { x: left + (i + 0.5) * cell, y: height - MARGIN.bottom + 16,
        class: "tick", "text-anchor": "middle" }, text);
    });
    map.y.forEach((text, j) => make(svg, "text", { x: left - 6, y: height - MARGIN.bottom - (j + 0.5) * tall + 4,
      class: "tick", "text-anchor": "end" }, text));
    make(svg, "text", { x: (left + width) / 2, y: height - 8, class: "name", "text-anchor": "middle" }, map.x_label);
    make(svg, "text", { class: "name", "text-anchor": "middle",
      transform: `translate(12 ${(height - MARGIN.bottom) / 2}) rotate(-90)` }, map.y_label);
  }
  svg.addEventListener("pointerleave", () => { tip.hidden = true; });
  watch(figure, () => sizeOf(figure)[0] !== drawn, draw);
  draw();
}

const DRAWERS = { curves, heat };
for (const data of document.querySelectorAll("script[type='application/json']")) {
  const { kind, ...given } = JSON.parse(data.textContent);
  DRAWERS[kind](document.getElementById(data.dataset.figure), given);
}
