"use strict";
// What the charts of a report have in common. All is drawn from data that lie beside it: no library,
// no network. The page's other scripts follow this one.

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 70, right: 14, top: 10, bottom: 46 };
const PAPER = 860; // px of a line of charts on paper

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

// A number beside a logarithmic axis, in few letters.
function short(value) {
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  return Math.abs(exponent) < 4 ? said(value) : `${said(value / 10 ** exponent)}e${exponent}`;
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
      words ? words[at] : panel.log_x ? short(at) : said(at));
  }
  for (const at of y.ticks((bottom - MARGIN.top) / 42)) {
    const py = y(at);
    make(svg, "line", { x1: MARGIN.left, x2: right, y1: py, y2: py, class: "grid" });
    make(svg, "text", { x: MARGIN.left - 8, y: py + 4, class: "tick", "text-anchor": "end" },
      panel.log_y ? short(at) : said(at));
  }
  make(svg, "path", { d: `M${MARGIN.left},${MARGIN.top}V${bottom}H${right}`, class: "frame" });
  make(svg, "text", { x: (MARGIN.left + right) / 2, y: height - 8, class: "name",
    "text-anchor": "middle" }, panel.x_label);
  make(svg, "text", { class: "name", "text-anchor": "middle",
    transform: `translate(14 ${(MARGIN.top + bottom) / 2}) rotate(-90)` }, panel.y_label);
}

const redraws = [];
let printing = false;

function watch(figure, stale, draw) {
  redraws.push(draw);
  new ResizeObserver(() => requestAnimationFrame(() => {
    if (figure.clientWidth && stale() && !printing) draw();
  })).observe(figure);
}

// Paper is not measured before it is printed on: charts are drawn for about the size they will have.
for (const [kind, on] of [["beforeprint", true], ["afterprint", false]])
  window.addEventListener(kind, () => { printing = on; redraws.forEach((draw) => draw()); });

function sizeOf(figure) {
  const columns = (figure.parentElement.className.match(/columns(\d)/) || [0, 1])[1];
  const width = Math.max(280, printing ? PAPER / columns : figure.clientWidth);
  return [width, Math.round(Math.min(400, Math.max(240, 0.6 * width)))];
}
