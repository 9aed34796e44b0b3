
// Curves. What is read, zoomed and hidden belongs to a view; charts that share one have one legend,
// and those of them that are over the same thing are read and zoomed together.

const NEAR = 14; // px at which a lone point is pointed at
const FAR = 40; // px beyond which a line has no value to be read
const MOST_NAMED = 12; // lines in a tip
const PART = 100; // an arrow key goes about so much of all points
const DRAGGED = 8; // px that are no click

function view(holder, charts) {
  const state = { hidden: new Set(), zooms: new Map(), at: null, charts };
  const lines = new Map(charts.flatMap(({ panel }) => panel.lines.map((line) => [line.label, line])));
  const legend = make(holder, "div", { class: "legend" });
  const all = charts.every(({ panel }) => panel.lines.length === 1) && lines.size === 1 ? [] : lines;
  const buttons = [...all].map(([label, line]) => [label, entry(legend, label, line, state)]);
  if (charts.some(({ panel }) => panel.lines.some((line) => (line.marks || []).some(Boolean))))
    make(legend, "span", { class: "unstable" }, "◯ no result");
  const limit = charts.map(({ panel }) => panel.limit).find(Boolean);
  if (limit) make(legend, "span", {}, `┄ ${limit}`);
  const whole = make(legend, "button", { type: "button", class: "whole" }, "show all");
  whole.addEventListener("click", () => { state.hidden.clear(); state.zooms.clear(); state.draw(); });
  state.draw = () => {
    for (const [label, button] of buttons) button.setAttribute("aria-pressed", String(!state.hidden.has(label)));
    whole.hidden = !state.zooms.size && !state.hidden.size;
    charts.forEach((chart) => chart.draw());
  };
  state.zoom = (over, ends) => { if (ends) state.zooms.set(over, ends); else state.zooms.delete(over); state.draw(); };
  state.read = (at) => { state.at = at; charts.forEach((chart) => chart.read()); };
  state.labels = () => [...lines.keys()];
  for (const chart of charts) Object.assign(chart, curves(chart.figure, chart.panel, state, chart));
  state.draw();
}

function entry(legend, label, line, state) {
  const button = make(legend, "button", { type: "button", title: "hide or show; twice: this alone" });
  make(make(button, "svg", { width: 18, height: 10, class: "series" }), line.width ? "line" : "circle",
    line.width ? { x1: 0, x2: 18, y1: 5, y2: 5, stroke: line.colour, "stroke-width": 3 }
      : { cx: 9, cy: 5, r: 4, fill: line.colour });
  make(button, "span", {}, label);
  button.addEventListener("click", () => {
    if (!state.hidden.delete(label)) state.hidden.add(label);
    state.draw();
  });
  button.addEventListener("dblclick", () => {
    const others = state.labels().filter((other) => other !== label);
    const alone = others.every((other) => state.hidden.has(other)) && !state.hidden.has(label);
    state.hidden = new Set(alone ? [] : others);
    state.draw();
  });
  const quiet = (on) => state.charts.forEach(({ figure }) => figure.querySelectorAll("[data-line]")
    .forEach((drawn) => drawn.classList.toggle("quiet", on && drawn.dataset.line !== label)));
  for (const [kind, on] of [["pointerenter", true], ["focus", true], ["pointerleave", false], ["blur", false]])
    button.addEventListener(kind, () => quiet(on));
  return button;
}

function curves(figure, panel, state, self) {
  const svg = make(figure, "svg", { role: "slider", tabindex: 0, "aria-label": `${panel.title}, over ${panel.x_label}`,
    "aria-valuetext": "nothing read yet; the arrow keys read", class: "plot" });
  const tip = make(figure, "div", { class: "tip" });
  let x, y, size;

  const shown = () => panel.lines.filter((line) => !state.hidden.has(line.label));
  const can = (line, k) => line.y[k] !== null && (!panel.log_x || line.x[k] > 0)
    && (!panel.log_y || line.y[k] > 0);
  const zoom = () => state.zooms.get(panel.x_label);
  const stretch = () => zoom() || panel.x_span;
  const within = (v) => !stretch() || (v >= stretch()[0] && v <= stretch()[1]);

  function domain() {
    const xs = [], ys = [];
    for (const line of shown()) line.x.forEach((v, k) => {
      if (!can(line, k)) return;
      xs.push(v);
      if (!within(v)) return;
      ys.push(line.y[k]);
      const bar = line.bars && line.bars[k];
      if (bar) ys.push(line.y[k] + bar, ...(panel.log_y && line.y[k] <= bar ? [] : [line.y[k] - bar]));
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
    const along = zoom() || panel.x_span || ends(xs, panel.log_x, panel.ticks ? 0.08 : 0.02);
    if (panel.span && !zoom()) return [along, panel.span];
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
    axes(svg, width, height, x, y, panel);
    make(make(svg, "clipPath", { id: `${figure.id}-clip` }), "rect",
      { x: MARGIN.left, y: MARGIN.top, width: right - MARGIN.left, height: bottom - MARGIN.top });
    const ground = make(svg, "g", { "clip-path": `url(#${figure.id}-clip)`, class: "series" });
    if (panel.bound !== null)
      make(ground, "line", { x1: MARGIN.left, x2: right, y1: y(panel.bound), y2: y(panel.bound), class: "bound" });
    if (panel.wall !== null)
      make(ground, "line", { x1: x(panel.wall), x2: x(panel.wall), y1: MARGIN.top, y2: bottom, class: "bound" });
    for (const line of shown()) drawLine(make(ground, "g", { "data-line": line.label }), line);
    make(svg, "g", { class: "pointer" });
    svg.setAttribute("aria-valuemin", String(x0));
    svg.setAttribute("aria-valuemax", String(x1));
    read();
  }

  function drawLine(ground, line) {
    const marked = (k) => line.marks && line.marks[k];
    let path = "", on = false;
    line.x.forEach((v, k) => {
      if (!can(line, k) || marked(k)) { on = false; return; }
      path += `${on ? "L" : "M"}${x(v).toFixed(1)},${y(line.y[k]).toFixed(1)}`;
      on = true;
    });
    if (line.band) drawBand(ground, line);
    if (line.width)
      make(ground, "path", { d: path, stroke: line.colour, "stroke-width": line.width, class: "line" });
    if (line.width && !line.marks) return;
    line.x.forEach((v, k) => {
      if (!can(line, k)) return;
      const at = { cx: x(v), cy: y(line.y[k]) };
      const bar = line.bars && line.bars[k];
      if (bar) {
        const low = panel.log_y && line.y[k] <= bar ? y.back(size[1]) : line.y[k] - bar;
        make(ground, "path", { stroke: line.colour, class: "line", "stroke-width": 1,
          d: `M${at.cx},${y(low)}V${y(line.y[k] + bar)}` });
      }
      make(ground, "circle", { ...at, r: line.width ? 3 : 4, fill: line.colour });
      if (marked(k)) make(ground, "circle", { ...at, r: 7, class: "mark" });
    });
  }

  function drawBand(ground, line) { // what a logarithmic axis has no room for lies at its foot
    const at = (v) => (panel.log_y && v <= 0 ? size[1] : y(v)).toFixed(1);
    const known = line.x.map((_, k) => k).filter((k) => line.band.every((edge) => edge[k] !== null));
    const edge = (values, ks) => ks.map((k) => `${x(line.x[k]).toFixed(1)},${at(values[k])}`);
    const round = [...edge(line.band[1], known), ...edge(line.band[0], [...known].reverse())];
    if (known.length) make(ground, "path", { d: `M${round.join("L")}Z`, fill: line.colour, class: "band" });
  }

  // What lies at the place that is read: of each line the nearest point, of lone points those that
  // are near; along x alone, where no pointer says how high.
  function nearest(px, py) {
    const near = [];
    for (const line of shown()) {
      let best = null;
      line.x.forEach((v, k) => {
        if (!can(line, k) || !within(v)) return;
        const dx = Math.abs(x(v) - px);
        const off = line.width || py === null ? dx : dx + Math.abs(y(line.y[k]) - py);
        if (best === null || off < best.off) best = { line, k, off };
      });
      if (best && best.off < (line.width ? FAR : py === null ? 1 : NEAR)) near.push(best);
    }
    return near;
  }

  function read() {
    const group = svg.querySelector(".pointer");
    group.replaceChildren();
    tip.replaceChildren();
    tip.hidden = true;
    if (state.at === null || state.at.chart.panel.x_label !== panel.x_label) return;
    const own = state.at.chart === self;
    const px = x(state.at.x);
    const near = nearest(px, own ? state.at.py : null);
    if (!near.length) return;
    const first = near.reduce((a, b) => (b.off < a.off ? b : a));
    const value = first.line.x[first.k], at = x(value);
    make(group, "line", { x1: at, x2: at, y1: MARGIN.top, y2: size[1] - MARGIN.bottom, class: "cross" });
    const told = [`${panel.x_label} ${panel.ticks ? panel.ticks[value] : said(value)}`];
    if (own) make(tip, "b", {}, told[0]);
    near.sort((a, b) => b.line.y[b.k] - a.line.y[a.k]);
    for (const { line, k } of near.slice(0, MOST_NAMED)) {
      make(group, "circle", { cx: x(line.x[k]), cy: y(line.y[k]), r: 4, fill: line.colour });
      const ends = line.band && line.band.map((edge) => said(edge[k])).join(" to ");
      const bar = line.bars && line.bars[k] ? ` ± ${said(line.bars[k])}` : ends ? ` (${ends})` : "";
      const mark = line.marks && line.marks[k] ? ", no result" : "";
      const text = `${line.label}: ${said(line.y[k])}${bar}${mark}`;
      const row = make(tip, "span", {});
      make(make(row, "svg", { width: 9, height: 9, class: "series" }), "rect", { width: 9, height: 9, fill: line.colour });
      make(row, "span", {}, text);
      told.push(text);
    }
    tip.hidden = false;
    tip.classList.toggle("own", own);
    tip.classList.toggle("left", at > size[0] / 2);
    svg.setAttribute("aria-valuenow", String(value));
    svg.setAttribute("aria-valuetext", told.join("; "));
  }

  byPointer(svg, { state, self, panel, scale: () => x, size: () => size });
  byKeys(svg, { state, self, panel, points: () => [...new Set(shown().flatMap((line) =>
    line.x.filter((v, k) => can(line, k) && within(v))))].sort((a, b) => a - b), ends: () => domain()[0] });
  tip.hidden = true;
  watch(figure, () => sizeOf(figure)[0] !== size[0], draw);
  return { draw, read };
}

// A mouse reads where it is and zooms by a drag; a finger reads along its way, two fingers zoom.
function byPointer(svg, { state, self, panel, scale: x, size }) {
  const fingers = new Map();
  let from = null;
  const place = (event) => {
    const box = svg.getBoundingClientRect();
    const f = size()[0] / box.width;
    return [(event.clientX - box.left) * f, (event.clientY - box.top) * f];
  };
  const readAt = ([px, py]) => state.read({ chart: self, x: x().back(px), py });
  const leave = () => { if (!fingers.size) state.read(null); };

  svg.addEventListener("pointerdown", (event) => {
    const at = place(event);
    if (event.pointerType !== "touch") { from = panel.ticks ? null : at[0]; return; }
    fingers.set(event.pointerId, { px: at[0], v: x().back(at[0]) });
    readAt(at);
  });
  svg.addEventListener("pointermove", (event) => {
    const at = place(event), finger = fingers.get(event.pointerId);
    if (finger) finger.px = at[0];
    if (fingers.size === 2 && !panel.ticks) { spread(); return; }
    if (from === null || Math.abs(at[0] - from) < DRAGGED) { readAt(at); return; }
    state.read(null);
    make(svg.querySelector(".pointer"), "rect", { x: Math.min(from, at[0]), width: Math.abs(at[0] - from),
      y: MARGIN.top, height: size()[1] - MARGIN.top - MARGIN.bottom, class: "drag" });
  });
  function spread() { // what was below each finger stays there
    const [a, b] = [...fingers.values()].sort((one, other) => one.px - other.px);
    if (b.px - a.px < 2 * DRAGGED || a.v >= b.v) return;
    const of = panel.log_x ? Math.log10 : (v) => v, back = panel.log_x ? (v) => 10 ** v : (v) => v;
    const slope = (of(b.v) - of(a.v)) / (b.px - a.px), right = size()[0] - MARGIN.right;
    state.at = null;
    state.zoom(panel.x_label, [MARGIN.left, right].map((px) => back(of(a.v) + slope * (px - a.px))));
  }
  svg.addEventListener("pointerup", (event) => {
    const to = place(event)[0], begun = from;
    from = null;
    fingers.delete(event.pointerId);
    if (begun === null || Math.abs(to - begun) < DRAGGED) return;
    state.zoom(panel.x_label, [x().back(Math.min(begun, to)), x().back(Math.max(begun, to))]);
  });
  svg.addEventListener("pointercancel", (event) => { from = null; fingers.delete(event.pointerId); });
  svg.addEventListener("pointerleave", (event) => { if (event.pointerType !== "touch") { from = null; leave(); } });
  svg.addEventListener("dblclick", () => state.zoom(panel.x_label, null));
}

// Arrows go from point to point, + and - zoom about the one that is read, Escape shows all again.
function byKeys(svg, { state, self, panel, points, ends }) {
  const go = (steps) => {
    const all = points();
    if (!all.length) return;
    const step = Math.max(1, Math.round(all.length / PART));
    const here = state.at === null ? -1 : all.reduce((best, v, i) =>
      (Math.abs(v - state.at.x) < Math.abs(all[best] - state.at.x) ? i : best), 0);
    const last = all.length - 1;
    const next = here >= 0 || !Number.isFinite(steps) ? Math.max(0, here) + steps * step : steps < 0 ? last : 0;
    state.read({ chart: self, x: all[Math.min(last, Math.max(0, next))], py: null });
  };
  const zoom = (part) => {
    if (panel.ticks) return;
    const of = panel.log_x ? Math.log10 : (v) => v, back = panel.log_x ? (v) => 10 ** v : (v) => v;
    const [low, high] = ends().map(of);
    const middle = state.at === null ? (low + high) / 2 : of(state.at.x);
    state.zoom(panel.x_label, [middle - part * (middle - low), middle + part * (high - middle)].map(back));
  };
  const keys = {
    ArrowRight: () => go(1), ArrowLeft: () => go(-1), PageUp: () => go(10), PageDown: () => go(-10),
    Home: () => go(-Infinity), End: () => go(Infinity), "+": () => zoom(0.5), "=": () => zoom(0.5),
    "-": () => zoom(2), Escape: () => { state.at = null; state.zoom(panel.x_label, null); },
  };
  svg.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
  svg.addEventListener("blur", () => state.read(null));
}
