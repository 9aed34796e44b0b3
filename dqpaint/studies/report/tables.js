
// Tables are sorted by the heading that is chosen: smallest first, largest first, as they were.

const NUMBER = /^(-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)(?: ± .*)?$/;

function sortable(table) {
  const body = table.tBodies[0], rows = [...body.rows];
  const heads = [...table.tHead.rows[0].cells];
  let at = 0;
  const places = heads.map((head) => { const place = at; at += head.colSpan; return place; });
  const key = (row, place) => {
    const text = row.cells[place].textContent, found = text.match(NUMBER);
    return found ? Number(found[1]) : text;
  };
  const compare = (a, b, sign) => { // what is no number comes last either way
    if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
    return a < b ? -sign : a > b ? sign : 0;
  };
  heads.forEach((head, i) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const next = { none: "ascending", ascending: "descending", descending: "none" }[head.ariaSort || "none"];
      heads.forEach((other) => { other.ariaSort = null; });
      if (next !== "none") head.ariaSort = next;
      const sign = next === "descending" ? -1 : 1;
      const order = next === "none" ? rows
        : [...rows].sort((a, b) => compare(key(a, places[i]), key(b, places[i]), sign));
      body.append(...order);
    });
  });
}

document.querySelectorAll("table.sorted").forEach(sortable);

// What is hidden is empty until a script draws it.
document.querySelectorAll(".charts, .map").forEach((block) => { block.hidden = false; });

const given = new Map([...document.querySelectorAll("script[type='application/json']")].map((data) =>
  [data.dataset.figure, JSON.parse(data.textContent)]));
for (const block of document.querySelectorAll(".charts")) {
  const charts = [...block.querySelectorAll(".chart")].map((figure) => ({ figure, panel: given.get(figure.id) }));
  if ("shared" in block.dataset) {
    const holder = document.createElement("div");
    block.prepend(holder);
    view(holder, charts);
  } else charts.forEach((chart) => view(chart.figure, [chart]));
}
for (const [name, { kind, ...map }] of given) if (kind === "heat") heat(document.getElementById(name), map);
document.querySelectorAll(".hint").forEach((hint, i) => { hint.hidden = i > 0; });
