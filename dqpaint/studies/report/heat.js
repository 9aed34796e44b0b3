
// Heat maps.

// Viridis, darkest for the largest: nine of its colours, straight lines between.
const VIRIDIS = [[253, 231, 37], [170, 220, 50], [94, 201, 98], [40, 174, 128], [33, 144, 141],
  [44, 114, 142], [59, 82, 139], [71, 45, 123], [68, 1, 84]];

const RAMP = 160; // px
const WIDEST = 120; // px of a cell

function colour(part) {
  const at = Math.min(1, Math.max(0, part)) * (VIRIDIS.length - 1);
  const i = Math.min(VIRIDIS.length - 2, Math.floor(at));
  return VIRIDIS[i].map((v, c) => Math.round(v + (at - i) * (VIRIDIS[i + 1][c] - v)));
}

// What the colours mean: the least and the largest, and all between.
function ramp(legend, low, high, log) {
  make(legend, "span", {}, said(low));
  const strip = make(legend, "svg", { width: RAMP, height: 12 });
  for (let px = 0; px < RAMP; px += 4)
    make(strip, "rect", { x: px, width: 4, height: 12, fill: `rgb(${colour(px / (RAMP - 4))})` });
  make(legend, "span", {}, `${said(high)}${log ? ", logarithmic" : ""}`);
}

function heat(figure, map) {
  const good = map.values.flatMap((row, j) => row.filter((v, i) => v !== null && !map.marked[j][i]));
  const of = map.log ? Math.log10 : (v) => v;
  const [low, high] = [Math.min(...good.map(of)), Math.max(...good.map(of))];
  if (good.length) ramp(make(figure, "div", { class: "legend" }), Math.min(...good), Math.max(...good), map.log);
  const svg = make(figure, "svg", { role: "slider", tabindex: 0, class: "plot", "aria-valuenow": 0,
    "aria-label": map.title, "aria-valuetext": "nothing read yet; the arrow keys read" });
  const tip = make(figure, "div", { class: "tip" });
  tip.hidden = true;
  let drawn = 0, at = null; // [row, column] that is read
  function read(place) {
    at = place;
    svg.querySelectorAll(".read").forEach((cell) => cell.classList.remove("read"));
    tip.hidden = at === null;
    if (at === null) return;
    const [j, i] = at;
    const told = [`${map.x_label} ${map.x[i]}, ${map.y_label} ${map.y[j]}`,
      `${said(map.values[j][i])}${map.marked[j][i] ? ", no result" : ""}`];
    tip.replaceChildren();
    make(tip, "b", {}, told[0]);
    make(tip, "span", {}, told[1]);
    tip.classList.toggle("left", i >= map.x.length / 2);
    svg.querySelectorAll(".cell")[j * map.x.length + i].classList.add("read");
    svg.setAttribute("aria-valuetext", told.join(": "));
  }
  function draw() {
    [drawn] = sizeOf(figure);
    const left = 16 + 8 * Math.min(14, Math.max(5, ...map.y.map((t) => t.length)));
    const width = Math.min(drawn, left + WIDEST * Math.max(2, map.x.length) + MARGIN.right);
    svg.style.maxWidth = `${width}px`;
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
        class: marked ? "unstable" : dark ? "onDark" : "onLight" }, marked ? "no result" : said(value));
      for (const kind of ["pointermove", "pointerdown"]) group.addEventListener(kind, () => read([j, i]));
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
  svg.addEventListener("pointerleave", (event) => { if (event.pointerType !== "touch") read(null); });
  svg.addEventListener("blur", () => read(null));
  const keys = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 0], ArrowDown: [-1, 0] };
  svg.addEventListener("keydown", (event) => {
    const step = keys[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || !step) return;
    event.preventDefault();
    const inside = (value, count) => Math.min(count - 1, Math.max(0, value));
    read(at === null ? [0, 0] : [inside(at[0] + step[0], map.y.length), inside(at[1] + step[1], map.x.length)]);
  });
  watch(figure, () => sizeOf(figure)[0] !== drawn, draw);
  draw();
}
