// Finished runs with their harmonics, and coefficients over frequency beside earlier ones.
import { FORCES } from "./readings.js";
import { byId, digits, html, nice, plusMinus, svg, text } from "./svg.js";

const SIGNS = { complete: "✓", stopped: "■", fault: "▲" };
const FEW = 4; // gauges that are listed together
const cell = (value, column) => html("td", column > 1 ? { class: "n" } : {}, value);
const number = (value, width) => `${digits(value, width)} ${plusMinus(width)}`.trim();

export class Finished {
  constructor() {
    this.entries = [];
    byId("finished-gauge").addEventListener("change", () => this.draw());
  }

  begin(hello, entries) {
    this.channels = hello.channels;
    this.entries = entries;
    const gauges = hello.channels.filter((one) => FORCES.includes(one.unit)).map((one) => one.name);
    const box = byId("finished-gauge"), all = html("option", { value: "" }, "all");
    const chosen = box.value || (gauges.length > FEW ? gauges[0] : "");
    box.replaceChildren(all, ...gauges.map((one) => html("option", one === chosen ? { selected: "" } : {}, one)));
    this.draw();
  }

  add(entry) {
    this.entries = [...this.entries, entry];
    this.draw();
  }

  draw() {
    text(byId("finished-count"), this.entries.length ? `${this.entries.length} so far` : "none");
    byId("finished-table").tBodies[0].replaceChildren(...this.entries.toReversed().flatMap((one) => this.rows(one)));
  }

  // A row for each gauge and harmonic; the run's name stands in the first.
  rows(entry) {
    const gauge = byId("finished-gauge").value;
    const shown = entry.rows.filter((one) => FORCES.includes(one.unit) && (!gauge || one.channel === gauge));
    const lines = shown.length ? shown.flatMap((one) => this.harmonics(entry, one)) : [["", "", "", ""]];
    const notes = [entry.outcome === "complete" ? "" : `${entry.outcome}: ${entry.reason}`, ...entry.flags];
    return [...lines.map((one, k) => {
      const first = [`${SIGNS[entry.outcome] ?? ""} ${entry.run}`, `${entry.periods} periods`][k] ?? "";
      const kind = [k ? "more" : "", one[1] > "1" ? "higher" : ""].join(" ").trim();
      const cells = [first, ...one].map(cell);
      cells[0].dataset.periods = `, ${entry.periods} periods`; // beside the name where there is no room below
      return html("tr", { class: kind, "data-run": entry.run }, ...cells);
    }), ...notes.filter((one, k) => one && !notes.slice(0, k).some((before) => before.includes(one))).map((one) => html("tr", { class: "more said", "data-run": entry.run }, html("td", { colspan: 5 }, one)))];
  }

  harmonics(entry, row) {
    const at = this.channels.findIndex((one) => one.name === row.channel);
    const [values, widths] = [entry.needles?.values[at], entry.needles?.widths[at]];
    if (row.in_phase === 0 && row.quadrature === 0) return [[row.channel, "mean", number(row.mean, row.half_width), ""]];
    if (!values) return [[row.channel, "1", number(row.in_phase, row.half_width), number(row.quadrature, row.half_width)]];
    const orders = Array.from({ length: (values.length - 1) / 2 }, (_, k) => k + 1);
    return orders.filter((n) => n === 1 || values[2 * n] !== null).map((n) =>
      [n > 1 ? "" : row.channel, String(n), number(values[2 * n - 1], widths[2 * n - 1]), number(values[2 * n], widths[2 * n])]);
  }
}

const LEAST = 190, LEFT = 62, RIGHT = 12, TOP = 22, BOTTOM = 34;

export class Coefficients {
  constructor() {
    this.points = [];
    byId("coefficient").addEventListener("change", () => this.draw());
    const box = byId("coefficient-chart");
    new ResizeObserver(() => { if (box.clientWidth !== this.width || box.clientHeight !== this.height) this.draw(); }).observe(box);
    this.draw();
  }

  take(figures) {
    this.points = figures.points ?? [];
    text(byId("coefficient-problems"), (figures.problems ?? []).join("; "));
    const names = [...new Set(this.points.map((one) => one.name))];
    const box = byId("coefficient"), chosen = names.includes(box.value) ? box.value : names[0];
    box.replaceChildren(...names.map((one) => html("option", one === chosen ? { selected: "" } : {}, one)));
    box.parentElement.hidden = !names.length;
    this.draw();
  }

  draw() {
    const name = byId("coefficient").value;
    this.width = byId("coefficient-chart").clientWidth;
    this.height = byId("coefficient-chart").clientHeight;
    const points = this.points.filter((one) => one.name === name && one.value !== null && one.frequency_hz !== null);
    if (!points.length) {
      byId("coefficient-chart").replaceChildren(html("p", { class: "quiet" }, "Coefficients come when runs in water have ended and their inertia is known."));
      return;
    }
    const W = Math.max(280, this.width), H = Math.max(LEAST, this.height);
    const highs = points.map((one) => one.value + (one.half_width ?? 0)), lows = points.map((one) => one.value - (one.half_width ?? 0));
    const right = Math.max(...points.map((one) => one.frequency_hz)) * 1.1;
    const span = Math.max(Math.max(...highs) - Math.min(...lows), 0.05 * Math.abs(points[0].value), 1e-12);
    const middle = (Math.max(...highs) + Math.min(...lows)) / 2;
    const high = middle + 0.65 * span, low = middle - 0.65 * span;
    const x = (f) => LEFT + (f / right) * (W - LEFT - RIGHT);
    const y = (v) => TOP + ((high - v) / (high - low)) * (H - TOP - BOTTOM);
    const step = nice(span / 6);
    const parts = [];
    for (let v = Math.ceil(low / step) * step; v <= high; v += step) {
      parts.push(svg("line", { class: "ring", x1: LEFT, x2: W - RIGHT, y1: y(v), y2: y(v) }),
        svg("text", { class: "note-text", x: LEFT - 6, y: y(v) + 4, "text-anchor": "end" }, [String(Number(v.toPrecision(4)))]));
    }
    const stepX = nice(right / 6);
    for (let f = 0; f <= right; f += stepX) {
      parts.push(svg("text", { class: "note-text", x: x(f), y: H - 14, "text-anchor": "middle" }, [String(Number(f.toPrecision(3)))]));
    }
    parts.push(svg("text", { class: "note-text", x: W - RIGHT, y: H - 3, "text-anchor": "end" }, ["frequency [Hz]"]),
      svg("text", { class: "note-text", x: 2, y: 13 }, [`${name} [${points[0].unit}]   ● now   ◇ earlier   -+- reference`]));
    const references = points.filter((one) => one.of === "reference").sort((a, b) => a.frequency_hz - b.frequency_hz);
    for (const speed of new Set(references.map((one) => one.speed_m_s))) { // a curve for each; a lone point has its cross
      const curve = references.filter((one) => one.speed_m_s === speed).map((one) => [x(one.frequency_hz), y(one.value)]);
      parts.push(svg("polyline", { class: "curve", points: curve.join(" ") }, [svg("title", {}, [`${references[0].campaign}, ${speed ?? "–"} m/s`])]),
        svg("path", { class: "cross", d: curve.map(([px, py]) => `M ${px - 4} ${py} h 8 M ${px} ${py - 4} v 8`).join(" ") }));
    }
    const measured = ["earlier", "now"].flatMap((of) => points.filter((each) => each.of === of)); // what is new on top
    for (const one of measured) {
      const [px, py, half] = [x(one.frequency_hz), y(one.value), one.half_width ?? 0];
      parts.push(svg("line", { class: `bar ${one.of}`, x1: px, x2: px, y1: y(one.value - half), y2: y(one.value + half) }));
      const title = svg("title", {}, [`${one.campaign}: ${one.runs.join(", ")}: ${digits(one.value, half)} ${plusMinus(half)}`]);
      parts.push(one.of === "now" ? svg("circle", { class: "dot now", cx: px, cy: py, r: 4.5 }, [title])
        : svg("path", { class: "dot earlier", d: `M ${px} ${py - 6} l 6 6 l -6 6 l -6 -6 z` }, [title]));
    }
    byId("coefficient-chart").replaceChildren(svg("svg", { viewBox: `0 0 ${W} ${H}`, height: H, role: "img", "aria-label": `${name} over frequency` }, parts));
  }
}
