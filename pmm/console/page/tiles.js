// A gauge in small: both readings, each over a straight scale with its needle and its interval.
import { attribute, digits, html, nice, plusMinus, svg, text } from "./svg.js";

const HALF = 58; // of the scale, in the drawing's units

class Line {
  constructor(kind, name) {
    this.band = svg("line", { class: "band", y1: 6, y2: 6 });
    this.needle = svg("line", { class: "needle", y1: 1, y2: 11 });
    this.value = html("b");
    const scale = svg("svg", { viewBox: "0 0 120 12", "aria-hidden": "true" }, [
      svg("line", { class: "rail", x1: 60 - HALF, x2: 60 + HALF, y1: 6, y2: 6 }),
      svg("line", { class: "tick", x1: 60, x2: 60, y1: 2, y2: 10 }), this.band, this.needle,
    ]);
    this.root = html("span", { class: `line-reading ${kind}`, title: name }, this.value, scale);
  }

  show(value, width, full) {
    text(this.value, digits(value, width));
    const x = 60 + Math.max(-1, Math.min(1, (value ?? 0) / full)) * HALF;
    const half = width > 0 ? Math.max(1, (width / full) * HALF) : 0;
    for (const end of ["x1", "x2"]) attribute(this.needle, end, x.toFixed(1));
    attribute(this.band, "x1", Math.max(60 - HALF, x - half).toFixed(1));
    attribute(this.band, "x2", Math.min(60 + HALF, x + half).toFixed(1));
  }
}

export class Tile {
  constructor(channel, chosen) {
    this.lines = [new Line("in-phase", "in phase"), new Line("quadrature", "quadrature")];
    this.width = html("span", { class: "quiet" });
    this.root = html("button", { class: "tile", type: "button", "data-channel": channel.name, title: "show large" },
      html("span", { class: "name" }, html("span", {}, `${channel.name} [${channel.unit}]`), this.width), ...this.lines.map((one) => one.root));
    this.root.addEventListener("click", chosen);
  }

  show(row, widths, order, final) {
    const parts = [row[2 * order - 1], row[2 * order]];
    const full = nice(Math.max(...parts.map((one) => Math.abs(one ?? 0)), 1e-9) * 1.15);
    this.lines.forEach((line, k) => line.show(parts[k], widths[2 * order - 1 + k], full));
    text(this.width, plusMinus(Math.max(...[0, 1].map((k) => widths[2 * order - 1 + k] ?? 0))));
    attribute(this.root, "data-final", final ? "yes" : "no");
    attribute(this.root, "data-empty", "no");
  }

  clear() {
    this.lines.forEach((line) => line.show(null, null, 1));
    text(this.width, "");
    attribute(this.root, "data-empty", "yes");
  }
}
