// Finished runs with their harmonics, and coefficients over frequency beside earlier ones.
import { byId, digits, html, nice, plusMinus, svg, text } from "./svg.js";

const FORCES = ["N", "N m"];
const SIGNS = { complete: "✓", stopped: "■", fault: "▲" };

export class Finished {
  begin(hello, entries) {
    this.channels = hello.channels;
    byId("finished-table").tBodies[0].replaceChildren();
    this.count = 0;
    entries.forEach((one) => this.add(one));
  }

  add(entry) {
    this.count += 1;
    text(byId("finished-count"), `${this.count} so far`);
    const rows = entry.rows.filter((one) => FORCES.includes(one.unit));
    const needles = entry.needles;
    const made = (rows.length ? rows : [null]).map((row, k) => {
      const at = row ? this.channels.findIndex((one) => one.name === row.channel) : -1;
      const width = row ? Math.max(needles?.widths[at]?.[1] ?? 0, needles?.widths[at]?.[2] ?? 0) || row.half_width : null;
      const first = k ? ["", ""] : [`${SIGNS[entry.outcome] ?? ""} ${entry.run}`, String(entry.periods)];
      const still = row && row.in_phase === 0 && row.quadrature === 0;
      const numbers = !row ? ["", "", "", ""] : [row.channel,
        still ? `mean ${digits(row.mean, width)}` : digits(row.in_phase, width), still ? "" : digits(row.quadrature, width), plusMinus(width)];
      return html("tr", { ...(k ? { class: "more" } : {}), "data-run": entry.run, title: `${entry.outcome} ${entry.reason}` },
        ...[...first, ...numbers].map((one, n) => html("td", n === 1 || n > 2 ? { class: "n" } : {}, one)));
    });
    byId("finished-table").tBodies[0].prepend(...made);
  }
}

const W = 620, H = 225, LEFT = 62, RIGHT = 12, TOP = 22, BOTTOM = 34;

export class Coefficients {
  constructor() {
    this.points = [];
    byId("coefficient").addEventListener("change", () => this.draw());
    this.draw();
  }

  take(figures) {
    this.points = figures.points ?? [];
    text(byId("coefficient-problems"), (figures.problems ?? []).join("; "));
    const names = [...new Set(this.points.map((one) => one.name))];
    const box = byId("coefficient"), chosen = names.includes(box.value) ? box.value : names[0];
    box.replaceChildren(...names.map((one) => html("option", one === chosen ? { selected: "" } : {}, one)));
    this.draw();
  }

  draw() {
    const name = byId("coefficient").value;
    const points = this.points.filter((one) => one.name === name && one.value !== null && one.frequency_hz !== null);
    if (!points.length) {
      byId("coefficient-chart").replaceChildren(html("p", { class: "quiet" }, "Coefficients come when runs in water have ended and their inertia is known."));
      return;
    }
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
    parts.push(svg("text", { class: "note-text", x: W - RIGHT, y: H - 1, "text-anchor": "end" }, ["frequency [Hz]"]),
      svg("text", { class: "note-text", x: 2, y: 13 }, [`${name} [${points[0].unit}]   ● now   ◇ earlier   - - reference`]));
    const curve = points.filter((one) => one.of === "reference").sort((a, b) => a.frequency_hz - b.frequency_hz);
    if (curve.length) parts.push(svg("polyline", { class: "curve", points: curve.map((one) => `${x(one.frequency_hz)},${y(one.value)}`).join(" ") }));
    for (const one of points.filter((each) => each.of !== "reference")) {
      const [px, py, half] = [x(one.frequency_hz), y(one.value), one.half_width ?? 0];
      parts.push(svg("line", { class: `bar ${one.of}`, x1: px, x2: px, y1: y(one.value - half), y2: y(one.value + half) }));
      const title = svg("title", {}, [`${one.campaign}: ${one.runs.join(", ")}: ${digits(one.value, half)} ${plusMinus(half)}`]);
      parts.push(one.of === "now" ? svg("circle", { class: "dot now", cx: px, cy: py, r: 4.5 }, [title])
        : svg("path", { class: "dot earlier", d: `M ${px} ${py - 6} l 6 6 l -6 6 l -6 -6 z` }, [title]));
    }
    byId("coefficient-chart").replaceChildren(svg("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": `${name} over frequency` }, parts));
  }
}
